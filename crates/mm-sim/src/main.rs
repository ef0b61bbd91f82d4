//! The `mmsim` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(mm_sim::cli::main_with(std::env::args_os()) as u8)
}
