//! Processor in the loop on all machines: builds the firmware and lets `mmsim pil` compare a run, tick by tick.

use std::path::PathBuf;
use std::process::{ExitCode, Output};

use anyhow::{Context, Result};
use serde_json::Value;

use crate::mmsim::Mmsim;
use crate::shell::{root, run as run_command};
use crate::table::{Table, grouped};
use crate::targets::Compiler;
use crate::tools::{QEMU_ARM, QEMU_RISCV, require};

/// What is compared, and how long.
struct Case {
    target: &'static str,
    /// Target of the compiler.
    compiler: &'static str,
    precision: &'static str,
    /// Simulated time, s; some 10 ms of waiting a tick.
    seconds: f64,
}

const M4: (&str, &str) = ("qemu:cortex-m4", "thumbv7em-none-eabihf");
const M3: (&str, &str) = ("qemu:cortex-m3", "thumbv7m-none-eabi");
const M0: (&str, &str) = ("qemu:cortex-m0", "thumbv6m-none-eabi");
const RISC_V: (&str, &str) = ("qemu:riscv32", "riscv32imac-unknown-none-elf");

const fn case(machine: (&'static str, &'static str), precision: &'static str, seconds: f64) -> Case {
    Case { target: machine.0, compiler: machine.1, precision, seconds }
}

/// The Cortex-M4 in both precisions, for every change.
const SHORT: [Case; 2] = [case(M4, "f32", 1.0), case(M4, "f64", 0.2)];

/// The microbit has no room for double precision.
const CASES: [Case; 6] = [
    case(M4, "f32", 2.0),
    case(M4, "f64", 2.0),
    case(M3, "f32", 0.5),
    case(M0, "f32", 0.5),
    case(RISC_V, "f32", 0.5),
    case(RISC_V, "f64", 0.5),
];

/// Builds of the program: features and targets.
const BUILDS: [(&[&str], &[&str]); 2] =
    [(&[], &[M4.1, M3.1, RISC_V.1]), (&["--no-default-features"], &[M0.1])];

/// How much is compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scope {
    /// Nothing: the firmware is built.
    Build,
    /// A second on the Cortex-M4, with a program that is quickly linked.
    Short,
    /// Some time on every machine.
    Usual,
    /// The whole scenario on the Cortex-M4, in both precisions.
    Full,
}

/// What the job is asked for.
pub(crate) struct Options {
    /// How much is compared.
    pub(crate) scope: Scope,
    /// Builds with Debian's compiler.
    pub(crate) fallback: bool,
}

/// Builds and compares; fails where a tick differs.
pub(crate) fn run(options: &Options, mmsim: impl FnOnce() -> Result<Mmsim>) -> Result<ExitCode> {
    Ok(if check(options, mmsim)? { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Builds and compares; whether every tick is equal.
pub(crate) fn check(options: &Options, mmsim: impl FnOnce() -> Result<Mmsim>) -> Result<bool> {
    let programs = build(options)?;
    if options.scope == Scope::Build {
        return Ok(true);
    }
    require(&[QEMU_ARM, QEMU_RISCV])?;
    let mmsim = mmsim()?;
    let mut table = Table::new(&[
        "target",
        "precision",
        "ticks",
        "equal",
        "seconds",
        "instructions",
        "most",
        "flash",
        "",
    ]);
    let mut well = true;
    let cases = if options.scope == Scope::Usual { CASES.as_slice() } else { SHORT.as_slice() };
    for Case { target, compiler, precision, seconds } in cases {
        let program = programs.join(compiler).join(options.profile()).join("pil").display().to_string();
        let mut arguments = vec!["pil", "--scenario", "square-compare", "--no-log", "--json"];
        arguments.extend(["--target", target, "--precision", precision, "--firmware", &program]);
        let seconds = format!("{seconds}");
        if options.scope != Scope::Full {
            arguments.extend(["--seconds", &seconds]);
        }
        let Output { status, stdout, stderr } = mmsim.output(&arguments)?;
        let report: Value = serde_json::from_slice(&stdout)
            .with_context(|| format!("{target}, {precision}: {}", String::from_utf8_lossy(&stderr)))?;
        table.add(row(target, precision, &report, status.success()));
        if !status.success() {
            eprintln!("{target}, {precision}: {} {}", report["first_difference"], report["link_error"]);
            well = false;
        }
    }
    table.print();
    Ok(well)
}

impl Options {
    fn profile(&self) -> &'static str {
        if self.scope == Scope::Short { "quick" } else { "release" }
    }
}

/// Builds the program for all machines that take part, and says in which folder.
fn build(options: &Options) -> Result<PathBuf> {
    let only_m4: [(&[&str], &[&str]); 1] = [(&[], &[M4.1])];
    let builds = match options.scope {
        Scope::Build | Scope::Usual => BUILDS.as_slice(),
        Scope::Short | Scope::Full => only_m4.as_slice(),
    };
    let mut folder = PathBuf::new();
    for (features, targets) in builds {
        let mut compiler = Compiler::find(options.fallback)?;
        compiler.cargo.current_dir(root().join("firmware"));
        folder = compiler.directory.join("firmware");
        compiler.cargo.env("CARGO_TARGET_DIR", &folder);
        // By its package: the features of the other programs are none of its own.
        compiler.cargo.args(["--profile", options.profile(), "--locked", "--package", "pil"]);
        compiler.cargo.args(*features);
        for target in *targets {
            compiler.cargo.args(["--target", target]);
        }
        run_command(&mut compiler.cargo)?;
    }
    Ok(folder)
}

fn row(target: &str, precision: &str, report: &Value, is_good: bool) -> Vec<String> {
    let count = |value: &Value| value.as_u64().map_or_else(String::new, grouped);
    let number = |value: &Value| value.as_f64().map_or_else(String::new, |number| format!("{number:.1}"));
    let cost = &report["cost"];
    vec![
        target.to_owned(),
        precision.to_owned(),
        count(&report["ticks"]),
        count(&report["equal_ticks"]),
        number(&report["summary"]["wall_s"]),
        number(&cost["mean"]),
        count(&cost["max"]),
        count(&report["firmware"]["flash_bytes"]),
        if is_good { "ok" } else { "DIFFERENT" }.to_owned(),
    ]
}
