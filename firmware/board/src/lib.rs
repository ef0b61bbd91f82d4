//! What a program needs of the machine it runs on, and no more: where to start, a console, files, a clock, a serial port, the
//! depth of the stack.
//!
//! A machine is one file: `mps2.rs` (a Cortex-M4F or a Cortex-M3), `microbit.rs` (a Cortex-M0), `virt.rs` (RISC-V). It has
//! `start`, which makes the machine ready, a `Serial`, a `Clock`, its `CLOCK_HZ` and a `NAME`; what all Cortex-M have in common is in `cortex.rs`.
//! Console, files and the way out go over semihosting, through the debugger or the emulator (`host.rs`). `build.rs`
//! says which machine a target means, and gives the linker the memory of it.
//!
//! ```ignore
//! #![no_std]
//! #![no_main]
//! board::program!(run);
//!
//! fn run(board: &mut board::Board) -> bool {
//!     writeln!(board.console, "{}", board.clock.ticks()).is_ok()
//! }
//! ```
//! A build script of the program asks for the runtime's linker script: `println!("cargo::rustc-link-arg-bins=-Tlink.x")`.
#![no_std]
#![cfg(target_os = "none")]

#[cfg(target_arch = "arm")]
mod cortex;
mod host;
#[cfg_attr(machine = "microbit", path = "microbit.rs")]
#[cfg_attr(machine = "mps2", path = "mps2.rs")]
#[cfg_attr(machine = "virt", path = "virt.rs")]
mod machine;
mod panics;
mod place;
mod register;
mod stack;

pub use host::{Console, File, argument, exit};
pub use machine::{CLOCK_HZ, Clock, NAME, Serial, entry};
pub use panics::{refuse, report};
pub use place::Place;
pub use stack::Stack;

/// The machine.
#[derive(Debug)]
#[non_exhaustive]
pub struct Board {
    /// Text to whoever watches.
    pub console: Console,
    /// Bytes over a wire.
    pub serial: Serial,
    /// Time.
    pub clock: Clock,
    /// How much of the stack was used.
    pub stack: Stack,
}

/// Makes the machine ready, runs a program and ends with its success; what [`program`] starts.
pub fn run(program: fn(&mut Board) -> bool) -> ! {
    let mut stack = Stack::new();
    stack.paint();
    let (serial, clock) = machine::start();
    let mut board = Board { console: Console::new(), serial, clock, stack };
    exit(program(&mut board))
}

/// Makes a function `fn(&mut Board) -> bool` the program; it says whether all went well.
///
/// A panic prints where it was, and the program has failed. With `program!(run, panics: board::refuse)` a release build does not link if
/// there is any way to panic.
#[macro_export]
macro_rules! program {
    ($run:path) => {
        $crate::program!($run, panics: $crate::report);
    };
    ($run:path, panics: $panics:path) => {
        #[$crate::entry]
        fn start() -> ! {
            $crate::run($run)
        }

        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
            $panics(info)
        }
    };
}
