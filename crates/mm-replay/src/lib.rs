//! Runs of a controller as recorded, computed again elsewhere and compared bit by bit.
//!
//! A recording holds what makes the stack ([`mm_link::Setup`]), then for each tick what entered it and what came out: torques,
//! outcomes and all signals. [`replay`] reads it piece by piece, in a few hundred bytes, updates a stack of its own with the
//! inputs, and ends at the first bit that differs: with the tick, the stage, the signal and both bit patterns.
//!
//! ```text
//! closed loop --Recording--> | head, setup | tick | tick | ... | --replay--> same bits, or the first that differs
//!      host                                                       host, or a microcontroller
//! ```
//! The example `record` writes recordings of the bundled scenarios.
//!
//! # Format
//! Numbers have their lowest byte first. A file holds one recording after the other.
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `mmreplay` |
//! | 1 | version, [`VERSION`] |
//! | 1 | bytes of a number: 4 for `f32`, 8 for `f64` |
//! | 1 | what enters: 0 configuration and velocity, 1 positions, 2 positions and wheel angles |
//! | 1 | length of the name |
//! | 4 | length of the setup |
//! | 4 | ticks |
//! | | name, in ASCII |
//! | | setup, as postcard writes it |
//! | per tick | number of the tick, 4 bytes; what enters, [`Seen`], and the reference, 9 numbers; what came out, [`SIGNALS`]; outcomes, 4 bytes |
#![cfg_attr(not(test), no_std)]
#![deny(
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::std_instead_of_core,
    clippy::alloc_instead_of_core
)]

mod failure;
mod format;
mod recording;
mod replay;
mod word;

pub use failure::{Difference, Failure, Name};
pub use format::{Entry, Head, Seen, VERSION};
pub use mm_link::signals::{SIGNALS, Signal, Stage};
pub use recording::{Full, RecordError, Recording, Sink};
pub use replay::{Replayed, Source, replay, replay_in};
pub use word::Word;
