//! `libmm_control.a` for this machine and for bare metal, in `target/capi/<target>/` with the header beside it.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::header;
use crate::shell::{cargo, output, root, run, target_directory};
use crate::targets::Compiler;

/// Builds the archives; their paths are in the order of the targets.
pub(super) fn build(targets: &[&str], fallback: bool) -> Result<Vec<PathBuf>> {
    targets.iter().map(|target| build_one(target, fallback)).collect()
}

fn build_one(target: &str, fallback: bool) -> Result<PathBuf> {
    let bare = target.contains("-none-");
    let (mut cargo, directory) = if bare { bare_metal(target, fallback)? } else { hosted(target)? };
    run(&mut cargo)?;
    let here = target_directory()?.join("capi").join(target);
    fs::create_dir_all(&here)?;
    let archive = here.join("libmm_control.a");
    let built = directory.join("libmm_capi.a");
    fs::copy(&built, &archive).with_context(|| format!("cannot copy {}", built.display()))?;
    fs::copy(root().join(header::DIRECTORY).join("mm_control.h"), here.join("mm_control.h"))?;
    Ok(archive)
}

const OPTIONS: [&str; 3] = ["-p", "mm-capi", "--locked"];

/// In one unit, as a user would build firmware: with several, checks of lengths that are known are not seen to be superfluous.
fn bare_metal(target: &str, fallback: bool) -> Result<(Command, PathBuf)> {
    let Compiler { mut cargo, directory, .. } = Compiler::find(fallback)?;
    let directory = directory.join("firmware");
    cargo.args(OPTIONS).args(["--release", "--features", "panic-handler", "--target", target]);
    cargo.env("CARGO_TARGET_DIR", &directory);
    Ok((cargo, directory.join(target).join("release")))
}

/// For this machine alone: another one's linker and libraries are not known here.
fn hosted(target: &str) -> Result<(Command, PathBuf)> {
    let host = host()?;
    ensure!(
        target == host,
        "no archive for {target}: this machine is {host}, the others have to be bare metal"
    );
    let mut cargo = cargo(&["build"]);
    cargo.args(OPTIONS).arg("--profile=testrelease");
    Ok((cargo, target_directory()?.join("testrelease")))
}

/// Target of the compiler's own machine.
pub(super) fn host() -> Result<String> {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    output(Command::new(compiler).args(["--print", "host-tuple"]).current_dir(root()))
}
