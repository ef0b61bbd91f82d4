//! The C interface: header, archives, and C programs that use them here and on microcontrollers.
//!
//! The same ticks run in Rust (a test of mm-capi), in C on this machine and in C on every target; their outputs have to be the same bits.

mod archive;
mod header;
mod machines;
mod native;

use std::process::ExitCode;

use anyhow::Result;

/// What was asked for.
#[derive(Debug, Default)]
pub(crate) struct Request {
    /// Write the header instead of comparing it.
    pub(crate) bless: bool,
    /// Only build the archive for this target.
    pub(crate) target: Option<String>,
    /// All targets, not only the largest and the smallest processor.
    pub(crate) full: bool,
    /// Debian's compiler for the targets.
    pub(crate) fallback: bool,
}

/// Header, archives and programs.
pub(crate) fn run(request: &Request) -> Result<ExitCode> {
    let bless = request.bless || std::env::var_os("MMSIM_BLESS").is_some();
    header::check(bless)?;
    println!("mm_control.h: {}", if bless { "written" } else { "as the sources make it" });
    if let Some(target) = &request.target {
        let built = archive::build(&[target], request.fallback)?;
        built.iter().for_each(|archive| println!("{}", archive.display()));
        return Ok(ExitCode::SUCCESS);
    }
    if !bless {
        let lines = native::check()?;
        machines::check(request, &lines)?;
    }
    Ok(ExitCode::SUCCESS)
}
