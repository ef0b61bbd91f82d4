//! The counter on a board: its clock, and its stack as a depth that can be measured.

use core::fmt::Write;

use board::Board;

use crate::{Clock, Counter, Depth};

/// Ticks of 10,000 instructions of 1,024 ns (`-icount shift=10`) at the 25 MHz of mps2-an386, the 16 MHz of the microbit and the 1 GHz of
/// virt.
const TICKS: [u32; 3] = [256_000, 163_840, 10_240_000];

/// The clock of the board.
#[derive(Debug)]
pub struct OnBoard<'a>(&'a board::Clock);

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

/// The stack of the board, measured from where the measurement began.
#[derive(Debug)]
pub struct OnStack<'a> {
    stack: &'a mut board::Stack,
    begin: usize,
}

impl Depth for OnStack<'_> {
    #[inline(never)]
    fn begin(&mut self) {
        self.stack.paint();
        self.begin = self.stack.depth();
    }

    #[inline(never)]
    fn deepest(&self) -> u32 {
        u32::try_from(self.stack.deepest().saturating_sub(self.begin)).unwrap_or(u32::MAX)
    }
}

/// A counter by the board's clock, and its stack; complains to its console and gives none where the clock is not what it should be.
pub fn calibrated(board: &mut Board) -> Option<(Counter<OnBoard<'_>>, OnStack<'_>, &mut board::Console)> {
    let Board { clock, console: out, stack, .. } = board;
    let counter = match Counter::calibrated(OnBoard(clock)) {
        Ok(counter) => counter,
        Err(error) => {
            let _ = writeln!(out, "calibration: {error:?}");
            return None;
        }
    };
    // The loop and the clock have to agree on what an instruction is; a tick more or less is rounding.
    if !TICKS.iter().any(|ticks| counter.reference().abs_diff(*ticks) <= 1) {
        let _ = writeln!(out, "calibration: {} ticks, one of {TICKS:?} expected", counter.reference());
        return None;
    }
    Some((counter, OnStack { stack, begin: 0 }, out))
}
