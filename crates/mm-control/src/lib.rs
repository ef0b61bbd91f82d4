//! Backstepping fuzzy sliding mode control of a mobile manipulator, without allocation, panics or std.
//!
//! The tip of an arm on a two-wheel base follows a path in space while base and arm cooperate. An outer loop turns the tip's error
//! into a velocity that the robot should have (kinematic backstepping), an inner loop makes the robot have it (sliding
//! mode on the quasi-velocities, with the full dynamics as equivalent control), and a fuzzy system shapes the inner
//! loop's force.
//!
//! ```text
//! reference --> [ outer loop ] --nu_c, nu_c'--> [ inner loop: equivalent control + law(s) - d_hat ] --> limits --> torque
//!                     ^                                        ^
//!                     '---------------- q, nu -----------------'
//! ```
//! [`ControlStack::update`] is the one call that Python, C and firmware make, and the simulator with the sines of the state at hand
//! ([`ControlStack::update_with_sines`]). The laws are in [`laws`]; the fuzzy engine, usable
//! on its own, in [`fuzzy`].
//!
//! Errors are actual minus desired everywhere. Equation numbers are those of the thesis; where a formula differs from the printed
//! one, its documentation says so.
//!
//! # Not modelled
//! Actuator dynamics. A stack alone refuses what is not finite; a [`SupervisedStack`] also what is not plausible, and stops the robot.
//!
//! # Features
//! `std` adds the standard library to the dependencies, nothing else; the numbers are the same bits with and without it.
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

mod error;
mod estimator;
pub mod fuzzy;
pub mod laws;
mod observer;
mod outer;
mod reaching;
mod signals;
mod stack;
pub mod supervisor;
mod symmetric3;
#[cfg(feature = "serde")]
mod vector;

pub use error::{ControlError, SetupError};
pub use estimator::{Estimator, Measurement, WheelAngles};
pub use laws::{Bfsmc, Gains, Law, LawKind};
pub use outer::{OuterLoop, OuterOutput, OuterParams};
pub use reaching::required_gain;
pub use signals::{Input, Output, Reference, Signals, Status};
pub use stack::{ControlStack, ControlState, StackParams};
pub use supervisor::{Command, SupervisedStack, SupervisedState, SupervisorParams, Timing};

/// The example of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
