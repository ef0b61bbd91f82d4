//! Frames between a simulator and a controller on a microcontroller.
#![cfg_attr(not(test), no_std)]
#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::std_instead_of_core,
    clippy::alloc_instead_of_core
)]

mod scalar;
mod setup;

pub use scalar::Scalar;
pub use setup::{Fuzzy, Pace, Setup};
