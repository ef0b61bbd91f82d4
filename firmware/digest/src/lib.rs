//! Computes recordings again, one after the other, and compares every bit; prints a line for each, or the first bit that differs.
//!
//! There is one program for each precision: both together are more than the flash of a small microcontroller. The file is named on the
//! command line of the emulator or debugger: `-semihosting-config enable=on,target=native,arg=FILE`.
#![no_std]
#![cfg(target_os = "none")]

use core::fmt::Write;

use board::{Board, File};
use mm_replay::{Source, Word, replay_in};

/// A file that is read in pieces that are worth the call.
struct Pieces {
    file: File,
    piece: [u8; 512],
    from: usize,
    to: usize,
}

impl Source for Pieces {
    fn read(&mut self, buffer: &mut [u8]) -> usize {
        if self.from == self.to {
            (self.from, self.to) = (0, self.file.read(&mut self.piece));
        }
        let rest = self.piece.get(self.from..self.to).unwrap_or_default();
        let count = rest.len().min(buffer.len());
        if let (Some(to), Some(from)) = (buffer.get_mut(..count), rest.get(..count)) {
            to.copy_from_slice(from);
        }
        self.from += count;
        count
    }
}

/// The program for one precision; whether all bits were the same.
#[must_use]
pub fn run<T: Word>(board: &mut Board) -> bool {
    let mut line = [0; 256];
    let Some(file) = board::argument(&mut line).and_then(File::open) else {
        let _ = writeln!(board.console, "no recording");
        return false;
    };
    let mut pieces = Pieces { file, piece: [0; 512], from: 0, to: 0 };
    let well = loop {
        // A line that cannot be written is missed on the other side.
        match replay_in::<T>(&mut pieces) {
            Ok(Some(replayed)) => {
                let _ = writeln!(board.console, "{replayed}");
            }
            Ok(None) => break true,
            Err(failure) => {
                let _ = writeln!(board.console, "{failure}");
                break false;
            }
        }
    };
    let _ = writeln!(board.console, "stack={} of {}", board.stack.deepest(), board.stack.size());
    well
}
