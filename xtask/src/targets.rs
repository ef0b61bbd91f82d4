//! Bare-metal builds of the crates without std, with whatever compiler for them can be had.
//!
//! First choice is the toolchain of rustup with the targets' own core. Where rustup reaches nothing, Debian's compiler builds core
//! itself from its source package; `--fallback` or MMSIM_TARGETS=debian asks for that.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::shell::{answers, cargo, command, command_with, install, output, root, run, target_directory};

/// A Cortex-M4F, a Cortex-M3, a Cortex-M0, which has neither a divider nor compare-and-swap, and a RISC-V without floating point.
const TARGETS: [&str; 4] =
    ["thumbv7em-none-eabihf", "thumbv7m-none-eabi", "thumbv6m-none-eabi", "riscv32imac-unknown-none-elf"];

/// The crates that have to build there.
const CRATES: [&str; 2] = ["mm-model", "mm-control"];

/// Packages of Debian's compiler with the sources of core.
const PACKAGES: [&str; 3] = ["rustc-web", "cargo-web", "rust-web-src"];

/// A cargo that builds for the targets, and where it puts that.
pub(crate) struct Compiler {
    /// The command up to `build`, options of the compiler included.
    pub(crate) cargo: Command,
    /// Its target directory.
    pub(crate) directory: PathBuf,
    debian: bool,
}

impl Compiler {
    /// That of rustup, or Debian's where that was asked for or rustup has no targets.
    pub(crate) fn find(fallback: bool) -> Result<Self> {
        let asked = fallback || std::env::var("MMSIM_TARGETS").is_ok_and(|value| value == "debian");
        let directory = target_directory()?;
        if !asked && ensure_rustup_targets() {
            return Ok(Self { cargo: cargo(&["build"]), directory, debian: false });
        }
        let directory = directory.join("debian");
        Ok(Self { cargo: debian(&directory)?, directory, debian: true })
    }

    /// What it is, in words.
    pub(crate) const fn name(&self) -> &'static str {
        if self.debian { "Debian's compiler, building core" } else { "the targets of rustup" }
    }

    /// Whether clippy knows the targets too.
    pub(crate) const fn has_clippy(&self) -> bool {
        !self.debian
    }
}

/// Builds the crates for all targets.
pub(crate) fn build(fallback: bool) -> Result<()> {
    let mut compiler = Compiler::find(fallback)?;
    println!("bare metal: {}", compiler.name());
    compiler.cargo.args(["--release", "--locked"]);
    for name in CRATES {
        compiler.cargo.args(["-p", name]);
    }
    for target in TARGETS {
        compiler.cargo.args(["--target", target]);
    }
    run(&mut compiler.cargo)?;
    println!("bare metal: {} built for {}", CRATES.join(" and "), TARGETS.join(" and "));
    Ok(())
}

/// Whether the toolchain in use has the targets, after an attempt to fetch those it lacks.
fn ensure_rustup_targets() -> bool {
    let installed = || output(&mut command_with("rustup", &["target", "list", "--installed"]));
    let Ok(list) = installed() else { return false };
    let missing: Vec<&str> =
        TARGETS.into_iter().filter(|target| !list.lines().any(|line| line == *target)).collect();
    if missing.is_empty() {
        return true;
    }
    let mut add = command_with("rustup", &["target", "add"]);
    run(add.args(&missing)).is_ok()
}

/// Debian's cargo, told to build core, with a linker and a target directory of its own.
fn debian(directory: &Path) -> Result<Command> {
    let has_sources = Path::new("/usr/lib/rustlib/src").exists();
    if !(answers("/usr/bin/cargo", &["--version"])
        && answers("/usr/bin/rustc", &["--version"])
        && has_sources)
    {
        install(&PACKAGES)?;
    }
    let mut cargo = command("/usr/bin/cargo");
    cargo.args(["build", "-Zbuild-std=core"]);
    cargo.env("RUSTC", "/usr/bin/rustc").env("RUSTC_BOOTSTRAP", "1");
    // What the cargo that runs this left behind belongs to another compiler.
    for variable in ["RUSTUP_TOOLCHAIN", "CARGO", "LD_LIBRARY_PATH", "RUSTC_WRAPPER", "RUSTFLAGS"] {
        cargo.env_remove(variable);
    }
    cargo.env("CARGO_TARGET_DIR", directory);
    let lld = linker_directory()?;
    let path = std::env::var_os("PATH").context("no PATH")?;
    let directories = std::env::split_paths(&path).chain(lld.map(Into::into));
    cargo.env("PATH", std::env::join_paths(directories)?);
    Ok(cargo)
}

/// Where rust-lld may be hidden: in the toolchain that the workspace is built with.
fn linker_directory() -> Result<Option<String>> {
    if answers("rust-lld", &["-flavor", "gnu", "--version"]) {
        return Ok(None);
    }
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let sysroot = output(command(compiler).args(["--print", "sysroot"]).current_dir(root()))?;
    Ok(Some(format!("{sysroot}/lib/rustlib/x86_64-unknown-linux-gnu/bin")))
}
