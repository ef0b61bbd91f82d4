//! Kinematics and dynamics of a differential-drive mobile manipulator, without allocation, panics or std.
//!
//! The robot is a base on two driven wheels that carries an arm. Its configuration q = (x, y, heading, joints) moves
//! only along the quasi-velocities nu = (forward speed, yaw rate, joint rates) that the wheels leave free, dq/dt = S(q) nu,
//! and obeys
//!
//! ```text
//! M(q) nu' + C(q, nu) nu + g(q) + friction(nu) = B tau + f_ext
//! ```
//!
//! with M symmetric positive definite and dM/dt - 2C skew. The constraint forces of the wheels are gone: this is the reduced
//! form (3.100) of the thesis that the equation numbers in this documentation refer to.
//!
//! ```text
//! RobotParams --check--> Robot --posture--> sines --inertia--> M a, C nu, g, M^-1 f
//!                                 '--> tip, Jacobian and its rate, manipulability
//! ```
//!
//! Everything is generic over the scalar ([`Real`]: `f32`, `f64` and the fixed-point [`Q32`]) and the number of joints; the arm with yaw, pitch and
//! pitch (N = 3) and the base alone (N = 0) are there in closed form. [`reference`](mod@reference) holds the literal, slow
//! form of the thesis, against which the closed form is tested.
//!
//! # Conventions
//! SI units and radians. World frame with z upwards; counter-clockwise is positive; heading 0 looks along x. Positive q2 and
//! q3 raise the arm, q3 counted from link 2. Forces on the left-hand side oppose the ones on the right.
//!
//! # Not modelled
//! Wheel slip, casters, elastic joints, motors, contact forces of the ground, slopes; roll and pitch of the base.
//!
//! # Features
//! `std` adds the standard library to nalgebra, nothing else; the numbers are the same bits with and without it.
//! `serde` makes parameters, inputs and outcomes serializable: fields in their order, arrays as tuples, numbers unchanged.
#![cfg_attr(not(test), no_std)]
#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::std_instead_of_core,
    clippy::alloc_instead_of_core
)]

mod angle;
mod arm;
#[cfg(feature = "serde")]
pub mod array;
mod base_only;
mod blocks;
mod bodies;
mod error;
mod mass;
mod mechanism;
mod params;
mod platform;
mod real;
mod robot;
mod tip;

pub mod reference;

/// Vectors in space are nalgebra's.
pub use nalgebra;

pub use angle::Angle;
pub use arm::{ArmInertia, ArmPosture, InverseKinematics, JointSolution};
pub use blocks::{Configuration, Force, Torque, Velocity};
pub use error::{ParamError, check};
pub use mass::{MassFactor, MassMatrix};
pub use mechanism::{ManipulabilitySlope, Mechanism, Sines, SinesOf};
pub use params::{Friction, Limits, Link, RobotParams};
pub use platform::WheelRates;
pub use real::{Q32, Real};
pub use robot::Robot;
pub use tip::TipJacobian;

/// Compiles the example in the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
