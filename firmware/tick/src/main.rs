//! One update of the supervised controller for each of a table of states: the whole `bfsmc` stack in single precision, linked as a user
//! would. Prints a checksum of what came out.
//!
//! A release build does not link if there is any way to panic.
#![no_std]
#![no_main]

mod table;
mod tick;

use board::Place;
use mm_control::SupervisedState;

board::program!(run, panics: board::refuse);

/// What the controller is and what it remembers: all the static memory it takes.
static STACK: Place<tick::Stack> = Place::new();
static STATE: Place<SupervisedState<f32, 3>> = Place::new();

fn run(board: &mut board::Board) -> bool {
    placed().is_some_and(|controller| tick::run(&mut board.console, controller))
}

/// Sets the controller up in its place.
#[inline(never)]
fn placed() -> Option<(&'static tick::Stack, &'static mut SupervisedState<f32, 3>)> {
    let stack = STACK.fill(tick::stack().ok()?)?;
    Some((stack, STATE.fill(stack.initial_state())?))
}
