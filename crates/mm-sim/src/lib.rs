//! Simulator, scenarios, logs and reports of robust mobile-manipulator control; the `mmsim` command is built on it.
//!
//! ```text
//! scenario file --load--> checked types --build--> Simulation --run--> metrics, digest, log
//! ```
//! The controller in the loop is [`mm_control::ControlStack`], the very code that firmware links; the plant is the same model with its own
//! parameters, integrated by Runge-Kutta.

mod channels;
pub mod cli;
pub mod digest;
pub mod disturbance;
pub mod experiment;
pub mod faults;
pub mod figures;
pub mod hardware;
pub mod imposed;
pub mod live;
pub mod log;
pub mod metrics;
pub mod monitors;
mod number;
pub mod parallel;
pub mod plant;
pub mod random;
pub mod report;
pub mod reproduce;
pub mod robot;
pub mod scenario;
mod shell;
pub mod simulation;
mod snippet;
mod stopper;
pub mod summary;
pub mod sweep;
pub mod trajectory;
pub mod tune;
mod whole;

/// Version of the stack.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
