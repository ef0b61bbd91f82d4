//! Counts fuzzy inference on a microcontroller and prints to its console; the program fails where anything went wrong.
#![no_std]
#![no_main]

use core::fmt::Write;

board::program!(run);

fn run(board: &mut board::Board) -> bool {
    let Some((counter, _, out)) = count::calibrated(board) else { return false };
    match count::run(&counter, out) {
        Ok(()) => true,
        Err(error) => {
            let _ = writeln!(out, "tables: {error}");
            false
        }
    }
}
