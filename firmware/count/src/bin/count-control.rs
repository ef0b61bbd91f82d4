//! Counts updates of the controller on a microcontroller, and how deep the stack goes.
#![no_std]
#![no_main]

use core::fmt::Write;

board::program!(run);

fn run(board: &mut board::Board) -> bool {
    let Some((counter, mut depth, out)) = count::calibrated(board) else { return false };
    match count::control::<f32, _>(&counter, &mut depth, out) {
        Ok(()) => true,
        Err(error) => {
            let _ = writeln!(out, "setup: {error}");
            false
        }
    }
}
