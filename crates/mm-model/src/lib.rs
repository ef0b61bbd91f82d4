//! Kinematics and dynamics of a differential-drive mobile manipulator.
#![cfg_attr(not(test), no_std)]
mod real;
pub use real::Real;
