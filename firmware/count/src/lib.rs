//! Instructions of one evaluation, counted by a clock that advances by a fixed time an instruction.
//!
//! An emulator can be told to do so: `qemu-system-arm -icount shift=10` lets every instruction take 1,024 ns of the machine's
//! time, and a timer of the machine shows that time. How many ticks an instruction takes is found out by a loop of known
//! length, so that the program does not have to know the clock; other lengths of the loop then have to give exactly
//! their length.
//!
//! An evaluation is measured as a call of a function that is not inlined, between two readings of the clock, less what the same takes with
//! an empty function.
#![no_std]

mod control;
mod fuzzy;
mod measure;
mod motions;
#[cfg(target_os = "none")]
mod on_board;

pub use control::{Counted, run as control};
pub use fuzzy::run;
pub use measure::{Clock, Count, Counter, Depth, Miscounted, NoDepth};
#[cfg(target_os = "none")]
pub use on_board::{OnBoard, OnStack, calibrated};
