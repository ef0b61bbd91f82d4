//! The fuzzy systems of the thesis and of `bfsmc` in whole numbers: the rules themselves, and compiled to a surface. No number in
//! this program has a point, and none of the routines that compute with such numbers is linked.
#![no_std]
#![no_main]

mod systems;

board::program!(run);

fn run(board: &mut board::Board) -> bool {
    systems::run(&mut board.console)
}
