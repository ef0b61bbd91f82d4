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

mod frame;
mod message;
mod node;
mod scalar;
mod setup;
pub mod signals;
mod stages;

pub use frame::{
    Damage, Frame, Header, Kind, LONGEST, LONGEST_ON_WIRE, Malformed, Receiver, TooLong, VERSION, encode,
};
pub use message::{Command, Counters, Ready, Reason, Refusal, Report, Seen, Tick};
pub use node::{Applied, Clock, Identity, Node, Port};
pub use scalar::Scalar;
pub use setup::{Fuzzy, Pace, Setup};
pub use signals::{Signal, Stage};
pub use stages::Stages;
