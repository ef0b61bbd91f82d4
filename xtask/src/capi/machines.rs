//! The C program on microcontrollers under QEMU.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};

use super::native::{Lines, PRECISIONS, Precision, compiled};
use super::{Request, archive};
use crate::shell::{command_with, output, root};
use crate::tools::{ARM_C, QEMU_ARM, require};

/// A target, its machine, and how C is compiled for it.
struct Machine {
    target: &'static str,
    qemu: &'static [&'static str],
    options: &'static [&'static str],
    /// Whether its memory is enough for an initialization in double precision (docs/c.md).
    doubles: bool,
}

/// The largest and the smallest processor first: they are what is run unless all are asked for.
const MACHINES: [Machine; 3] = [
    Machine {
        target: "thumbv7em-none-eabihf",
        qemu: &["-machine", "mps2-an386", "-cpu", "cortex-m4"],
        options: &["-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "-Wl,--defsym=RAM_SIZE=64K"],
        doubles: true,
    },
    Machine {
        target: "thumbv6m-none-eabi",
        qemu: &["-machine", "microbit"],
        options: &["-mcpu=cortex-m0"],
        doubles: false,
    },
    Machine {
        target: "thumbv7m-none-eabi",
        qemu: &["-machine", "mps2-an385", "-cpu", "cortex-m3"],
        options: &["-mcpu=cortex-m3", "-Wl,--defsym=RAM_SIZE=64K"],
        doubles: true,
    },
];

/// Machines that every change is run on.
const USUAL: usize = 2;

/// A target without a C compiler here: its archive is built.
const ALSO: &str = "riscv32imac-unknown-none-elf";

const C: &str = "arm-none-eabi-gcc";

/// What the program says goes to the standard output, not to the standard error.
const QEMU: [&str; 10] = [
    "-nographic",
    "-monitor",
    "none",
    "-serial",
    "none",
    "-chardev",
    "stdio,id=out",
    "-semihosting-config",
    "enable=on,target=native,chardev=out",
    "-kernel",
];

/// Seconds after which a machine hangs.
const PATIENCE: &str = "120";

/// Builds, links, looks into the program and runs it; the lines have to be those of this machine.
pub(super) fn check(request: &Request, here: &[Lines]) -> Result<()> {
    require(&[ARM_C, QEMU_ARM])?;
    let machines = if request.full { &MACHINES[..] } else { MACHINES.get(..USUAL).unwrap_or(&MACHINES) };
    let also = request.full.then_some(ALSO);
    let targets: Vec<&str> = machines.iter().map(|machine| machine.target).chain(also).collect();
    let archives = archive::build(&targets, request.fallback)?;
    for (machine, archive) in machines.iter().zip(&archives) {
        for (precision, lines) in
            PRECISIONS.iter().zip(here).filter(|(one, _)| machine.doubles || !one.doubles)
        {
            on(machine, archive, precision, lines)
                .with_context(|| format!("{}, {}", machine.target, precision.name))?;
        }
    }
    if request.full {
        println!("{ALSO}: archive built");
    }
    Ok(())
}

/// One program on one machine.
fn on(machine: &Machine, archive: &Path, precision: &Precision, here: &Lines) -> Result<()> {
    let program = linked(machine, archive, precision)?;
    let symbols = output(&mut command_with("arm-none-eabi-nm", &[&program.display().to_string()]))?;
    pure(&symbols, precision)?;
    let mut qemu = command_with("timeout", &[PATIENCE, "qemu-system-arm"]);
    qemu.args(machine.qemu).args(QEMU).arg(&program);
    let said = output(&mut qemu)?;
    let (notes, lines): (Vec<&str>, Vec<&str>) = said.lines().partition(|line| line.starts_with('#'));
    let there: Lines = lines.into_iter().map(str::to_owned).collect();
    same(here, &there)?;
    let notes: Vec<&str> = notes.iter().map(|note| note.trim_start_matches("# ")).collect();
    println!(
        "{}, {}: {} ticks with the bits of this machine; {} bytes of flash; {} bytes",
        machine.target,
        precision.name,
        there.len(),
        flash(&program)?,
        notes.join(", ")
    );
    Ok(())
}

/// The program for a machine. The archive's code is in sections of their own: what is not used falls away.
fn linked(machine: &Machine, archive: &Path, precision: &Precision) -> Result<PathBuf> {
    let sources = root().join("firmware/c");
    let program = archive.with_file_name(format!("ticks-{}.elf", precision.name));
    let mut gcc = compiled(C, &["-std=c11", "-Os", "-mthumb", "-ffunction-sections", "-nostartfiles"]);
    gcc.args(machine.options)
        .args(precision.options)
        .arg("-Wl,--gc-sections,--no-warn-rwx-segments,--no-warn-execstack");
    gcc.arg(format!("-T{}", sources.join("board.ld").display()));
    gcc.args([sources.join("ticks.c"), sources.join("board.c"), archive.to_path_buf()]);
    crate::shell::run(gcc.arg("-o").arg(&program))?;
    Ok(program)
}

/// No panic, no allocator; in single precision no operation in double precision either.
fn pure(symbols: &str, precision: &Precision) -> Result<()> {
    let names = symbols.lines().filter_map(|line| line.split_whitespace().last());
    for name in names {
        let panics = name.contains("panic") || name.contains("unwind_resume");
        let allocates = name.contains("alloc") || name == "free" || name == "_sbrk";
        ensure!(!panics, "a panic can be reached: {name}");
        ensure!(!allocates, "memory is allocated: {name}");
        ensure!(precision.doubles || !is_double(name), "an operation in double precision: {name}");
    }
    Ok(())
}

/// Whether a function of the compiler works on numbers of double precision.
fn is_double(name: &str) -> bool {
    let arm = name
        .strip_prefix("__aeabi_")
        .is_some_and(|rest| rest.starts_with('d') || rest.starts_with("cd") || rest.contains("2d"));
    arm || (name.starts_with("__") && name.contains("df"))
}

/// Bytes of code and constants.
fn flash(program: &Path) -> Result<u64> {
    let size = output(Command::new("arm-none-eabi-size").arg(program))?;
    let line = size.lines().nth(1).context("arm-none-eabi-size says nothing")?;
    let numbers: Vec<u64> = line.split_whitespace().take(2).filter_map(|word| word.parse().ok()).collect();
    Ok(numbers.iter().sum())
}

/// The same lines; else the first that differs is named.
fn same(here: &Lines, there: &Lines) -> Result<()> {
    for (here, there) in here.iter().zip(there) {
        ensure!(here == there, "the first tick that differs: `{there}`, here `{here}`");
    }
    ensure!(here.len() == there.len(), "{} ticks, here {}", there.len(), here.len());
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::{is_double, pure, same};
    use crate::capi::native::PRECISIONS;

    #[test]
    fn the_first_differing_tick_is_named() {
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        let here = lines("a tick 0 01\na tick 1 02\na tick 2 03");
        assert!(same(&here, &here).is_ok(), "the same");
        let error = same(&here, &lines("a tick 0 01\na tick 1 ff\na tick 2 ff")).expect_err("other bits");
        assert!(error.to_string().contains("`a tick 1 ff`"), "{error}");
        assert!(same(&here, &lines("a tick 0 01")).is_err(), "a program that ended early");
    }

    #[test]
    fn panics_allocators_and_doubles_are_found_by_name() {
        let [double, single] = &PRECISIONS;
        for bad in
            ["0 T mm_panic_reached", "0 t _ZN4core9panicking5panic17h0E", "0 T malloc", "0 T __rust_alloc"]
        {
            assert!(pure(bad, double).is_err(), "{bad}");
        }
        assert!(
            pure("0 T mmf_controller_update\n0 T __aeabi_fadd", single).is_ok(),
            "what a program may have"
        );
        for bad in
            ["__aeabi_dmul", "__aeabi_f2d", "__aeabi_i2d", "__aeabi_cdcmple", "__adddf3", "__extendsfdf2"]
        {
            assert!(is_double(bad), "{bad}");
        }
        for good in ["__aeabi_idiv", "__aeabi_fmul", "__aeabi_i2f", "__mulsf3", "__divsi3"] {
            assert!(!is_double(good), "{good}");
        }
    }
}
