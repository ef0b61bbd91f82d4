//! The C programs on this machine: plain, under valgrind and with sanitizers; the header in C99 and C++17.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::{archive, header};
use crate::shell::{command, command_with, output, root, run, target_directory};
use crate::tools::{VALGRIND, require};

/// What a program prints, line by line.
pub(super) type Lines = Vec<String>;

/// A precision of the interface, and how the programs are told of it.
pub(super) struct Precision {
    pub(super) name: &'static str,
    pub(super) options: &'static [&'static str],
    /// Whether operations in double precision belong into its program.
    pub(super) doubles: bool,
}

pub(super) const PRECISIONS: [Precision; 2] = [
    Precision { name: "double", options: &[], doubles: true },
    Precision { name: "float", options: &["-DTICKS_FLOAT", "-Wdouble-promotion"], doubles: false },
];

/// As strict as compilers go; no fused multiplication and addition, whose bits would be others.
const STRICT: [&str; 8] =
    ["-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wundef", "-Werror", "-ffp-contract=off", "-g"];

/// What the archive needs of this machine.
const LIBRARIES: [&str; 3] = ["-lpthread", "-ldl", "-lm"];

/// Runs everything; the lines of the ticks are in the order of the precisions.
pub(super) fn check() -> Result<Vec<Lines>> {
    require(&[VALGRIND])?;
    let host = archive::host()?;
    let built = archive::build(&[&host], false)?;
    let archive = built.first().context("no archive")?;
    speak(&["cc", "-std=c99", "-x", "c"])?;
    speak(&["c++", "-std=c++17", "-x", "c++"])?;
    quick_start(archive)?;
    misuse(archive)?;
    let lines: Vec<Lines> =
        PRECISIONS.iter().map(|precision| ticks(archive, precision)).collect::<Result<_>>()?;
    println!("{host}: {} ticks", lines.iter().map(Vec::len).sum::<usize>());
    Ok(lines)
}

/// A compiler with the header's directory and what all programs are compiled with.
pub(super) fn compiled(compiler: &str, options: &[&str]) -> Command {
    let mut compiler = command_with(compiler, options);
    compiler.args(STRICT).arg("-I").arg(root().join(header::DIRECTORY));
    compiler
}

/// Compiles the header alone, twice included.
fn speak(compiler: &[&str]) -> Result<()> {
    let source = root().join("crates/mm-capi/tests/c/twice.c");
    let (program, options) = compiler.split_first().context("no compiler")?;
    run(compiled(program, options).arg("-fsyntax-only").arg(source))
}

/// The example of docs/c.md.
fn quick_start(archive: &Path) -> Result<()> {
    let text = fs::read_to_string(root().join("docs/c.md")).context("docs/c.md")?;
    let (_, rest) = text.split_once("```c\n").context("docs/c.md has no example")?;
    let (program, _) = rest.split_once("```").context("the example has no end")?;
    let source = target_directory()?.join("capi/quick.c");
    fs::write(&source, program)?;
    let said = output(&mut command(linked(&[&source], archive, "quick", &["-std=c99"])?))?;
    ensure!(said.starts_with("shoulder "), "the example of docs/c.md says: {said}");
    Ok(())
}

/// The calls that are wrong, three times.
fn misuse(archive: &Path) -> Result<()> {
    let source = root().join("crates/mm-capi/tests/c/misuse.c");
    let plain = linked(&[&source], archive, "misuse", &["-std=c99"])?;
    run(&mut command(&plain))?;
    run(command("valgrind")
        .args(["--quiet", "--error-exitcode=9", "--leak-check=full"])
        .arg(&plain)
        .arg("gaps"))?;
    let sanitized = ["-std=c99", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    run(&mut command(linked(&[&source], archive, "misuse-sanitized", &sanitized)?))
}

fn ticks(archive: &Path, precision: &Precision) -> Result<Lines> {
    let sources = root().join("firmware/c");
    let name = format!("ticks-{}", precision.name);
    let options = [&["-std=c11", "-O2"], precision.options].concat();
    let program = linked(&[&sources.join("ticks.c"), &sources.join("host.c")], archive, &name, &options)?;
    Ok(output(&mut command(program))?.lines().map(str::to_owned).collect())
}

fn linked(sources: &[&Path], archive: &Path, name: &str, options: &[&str]) -> Result<PathBuf> {
    let program = target_directory()?.join("capi").join(name);
    let mut cc = compiled("cc", options);
    cc.args(sources).arg(archive).args(LIBRARIES);
    run(cc.arg("-o").arg(&program))?;
    Ok(program)
}
