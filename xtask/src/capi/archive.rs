//! `libmm_control.a` for this machine and for bare metal, in `target/capi/<target>/` with the header beside it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::header;
use crate::shell::{answers, cargo, output, root, run, target_directory};
use crate::targets::Compiler;

/// Builds the archives for this machine or for bare-metal targets; their paths are in the order of the targets.
pub(super) fn build(targets: &[&str], fallback: bool) -> Result<Vec<PathBuf>> {
    let directory = if targets.iter().all(|target| target.contains("-none-")) {
        bare_metal(targets, fallback)?
    } else {
        hosted(targets)?
    };
    targets.iter().map(|target| kept(target, &directory(target))).collect()
}

/// Copies an archive and the header to where users find them.
fn kept(target: &str, built: &Path) -> Result<PathBuf> {
    let here = target_directory()?.join("capi").join(target);
    fs::create_dir_all(&here)?;
    let archive = here.join("libmm_control.a");
    let built = built.join("libmm_capi.a");
    fs::copy(&built, &archive).with_context(|| format!("cannot copy {}", built.display()))?;
    fs::copy(root().join(header::DIRECTORY).join("mm_control.h"), here.join("mm_control.h"))?;
    Ok(archive)
}

/// Where cargo puts what it builds for a target.
type Directory = Box<dyn Fn(&str) -> PathBuf>;

const OPTIONS: [&str; 3] = ["-p", "mm-capi", "--locked"];

/// In one unit, as a user would build firmware: with several, checks of lengths that are known are not seen to be superfluous.
fn bare_metal(targets: &[&str], fallback: bool) -> Result<Directory> {
    let Compiler { mut cargo, directory, .. } = Compiler::find(fallback)?;
    let directory = directory.join("firmware");
    // Those that only the archives are made for may be missing yet; without rustup the build says so itself.
    let _ = answers("rustup", &[&["target", "add"], targets].concat());
    cargo.args(OPTIONS).args(["--release", "--features", "panic-handler"]);
    for target in targets {
        cargo.args(["--target", target]);
    }
    run(cargo.env("CARGO_TARGET_DIR", &directory))?;
    Ok(Box::new(move |target| directory.join(target).join("release")))
}

/// For this machine alone: another one's linker and libraries are not known here.
fn hosted(targets: &[&str]) -> Result<Directory> {
    let host = host()?;
    ensure!(
        targets == [host.as_str()],
        "no archive for {}: this machine is {host}, the others have to be bare metal",
        targets.join(", ")
    );
    run(cargo(&["build", "--profile=testrelease"]).args(OPTIONS))?;
    let directory = target_directory()?.join("testrelease");
    Ok(Box::new(move |_| directory.clone()))
}

/// Target of the compiler's own machine.
pub(super) fn host() -> Result<String> {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    output(Command::new(compiler).args(["--print", "host-tuple"]).current_dir(root()))
}
