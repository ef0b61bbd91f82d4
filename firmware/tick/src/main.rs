//! One update of the supervised controller for each of a table of states: the whole `bfsmc` stack in single precision, linked as a user
//! would. Prints a checksum of what came out.
//!
//! A release build does not link if there is any way to panic.
#![no_std]
#![no_main]

mod table;
mod tick;

board::program!(run, panics: board::refuse);

fn run(board: &mut board::Board) -> bool {
    tick::run(&mut board.console)
}
