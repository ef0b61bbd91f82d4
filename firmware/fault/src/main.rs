//! What the supervised controller does with inputs that are wrong, early, late or missing, and what it refuses; a line for each case.
#![no_std]
#![no_main]

mod cases;

board::program!(run);

fn run(board: &mut board::Board) -> bool {
    cases::run(&mut board.console)
}
