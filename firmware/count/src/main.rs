//! Counts on a microcontroller and prints to its console; the program fails where anything went wrong.
#![no_std]
#![no_main]

use core::fmt::Write;

use board::Board;
use count::{Clock, Counter};

/// Ticks of 10,000 instructions of 1,024 ns (`-icount shift=10`) at the 25 MHz of mps2-an386, the 16 MHz of the microbit and the 1 GHz of
/// virt.
const TICKS: [u32; 3] = [256_000, 163_840, 10_240_000];

/// The clock of the board.
struct OnBoard<'a>(&'a board::Clock);

impl Clock for OnBoard<'_> {
    #[inline(always)]
    fn ticks(&self) -> u32 {
        self.0.ticks()
    }

    #[inline(always)]
    fn spend(&self, instructions: u32) {
        self.0.spend(instructions);
    }
}

board::program!(run);

fn run(board: &mut Board) -> bool {
    let Board { clock, console: out, .. } = board;
    let counter = match Counter::calibrated(OnBoard(clock)) {
        Ok(counter) => counter,
        Err(error) => {
            let _ = writeln!(out, "calibration: {error:?}");
            return false;
        }
    };
    // The loop and the clock have to agree on what an instruction is; a tick more or less is rounding.
    if !TICKS.iter().any(|ticks| counter.reference().abs_diff(*ticks) <= 1) {
        let _ = writeln!(out, "calibration: {} ticks, one of {TICKS:?} expected", counter.reference());
        return false;
    }
    match count::run(&counter, out) {
        Ok(()) => true,
        Err(error) => {
            let _ = writeln!(out, "tables: {error}");
            false
        }
    }
}
