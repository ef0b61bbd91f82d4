//! What the controller costs on microcontrollers: instructions of an update, flash, static memory and stack.
//!
//! Flash and static memory are the sections of `control-tick`, a program that holds the whole stack and hardly anything else; instructions and
//! depth of the stack are counted by `count-control` under QEMU. The numbers are kept in `firmware/budget.toml`: one that has moved
//! by more than 2 % fails with the difference, either way, and so does one beyond its limit.

mod budget;
mod fixed;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use object::{Object, ObjectSection, SectionFlags, elf};
use serde_json::{Map, Value};

use crate::bench_targets::{self, Counts};
use crate::parallel;
use crate::qemu::machine::{self, M0, M3, M4F, Machine};
use crate::shell::{root, run as run_command};
use crate::table::{Table, grouped};
use crate::targets::Compiler;

/// What the job was asked for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Options {
    /// JSON instead of a table.
    pub(crate) json: bool,
    /// Fixed point beside single precision.
    pub(crate) fixed: bool,
    /// Keep what is measured.
    pub(crate) bless: bool,
    /// Debian's compiler.
    pub(crate) fallback: bool,
}

/// The machines with a timer that counts instructions.
const MACHINES: [Machine; 3] = [M4F, M3, M0];

/// Numbers by name.
type Numbers = BTreeMap<&'static str, u64>;

/// The motions; the first is the usual one.
const MOTIONS: [&str; 9] = [
    "control-cruise",
    "control-stretched",
    "control-bound",
    "control-corner",
    "control-stalled",
    "control-limits",
    "control-far",
    "control-rest",
    "control-faulty",
];

/// Seconds after which a machine hangs.
const PATIENCE: Duration = Duration::from_secs(300);

/// Measures, shows and compares.
pub(crate) fn run(options: &Options) -> Result<ExitCode> {
    if options.fixed {
        return fixed::run(options.fallback);
    }
    machine::install_emulators(&MACHINES)?;
    let directory = build(options.fallback, &MACHINES, &["control-tick", "count-control"])?;
    let here = bench_targets::counts(&bench_targets::on_host()?)?;
    let numbers = parallel::map(&MACHINES, |machine| measured(&directory, machine, &here));
    let mut all = BTreeMap::new();
    for (machine, numbers) in MACHINES.iter().zip(numbers) {
        all.insert(machine.target, numbers?);
    }
    let path = root().join("firmware/budget.toml");
    let mut text =
        std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    if options.bless {
        text = budget::blessed(&text, &all);
        std::fs::write(&path, &text)?;
    }
    let problems = budget::problems(&toml::from_str(&text)?, &all)?;
    if options.json {
        println!("{}", described(&all));
    } else {
        show(&all);
    }
    for problem in &problems {
        eprintln!("{problem}");
    }
    Ok(if problems.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Builds programs for machines; gives the directory.
fn build(fallback: bool, machines: &[Machine], programs: &[&str]) -> Result<PathBuf> {
    let mut compiler = Compiler::find(fallback)?;
    let directory = compiler.directory.join("firmware");
    compiler.cargo.current_dir(root().join("firmware")).env("CARGO_TARGET_DIR", &directory);
    compiler.cargo.args(["--quiet", "--locked", "--release"]);
    for program in programs {
        compiler.cargo.args(["--bin", program]);
    }
    for machine in machines {
        compiler.cargo.args(["--target", machine.target]);
    }
    run_command(&mut compiler.cargo)?;
    Ok(directory)
}

/// All numbers of a machine.
fn measured(directory: &Path, machine: &Machine, here: &Counts) -> Result<Numbers> {
    let folder = directory.join(machine.target).join("release");
    let mut numbers = sections(&folder.join("control-tick"))?;
    let run = machine.count(&folder.join("count-control"), PATIENCE)?;
    ensure!(run.is_well, "count-control fails on the {}:\n{}", machine.processor, run.text);
    let counts = bench_targets::counts(&run.text)?;
    for (name, count) in &counts {
        // The updates counted were the right ones: the torques have the bits that they have here.
        let same = here.iter().any(|(other, here)| other == name && here.checksum == count.checksum);
        ensure!(same, "{name}: other torques on the {} than here", machine.processor);
    }
    let number = |line: &str, name: &str| -> Result<u64> {
        let found = counts.iter().find(|(other, _)| other == line);
        let (_, count) = found.with_context(|| format!("count-control does not print `{line}`"))?;
        Ok(count.number(name))
    };
    let most =
        MOTIONS.iter().try_fold(0, |most, line| -> Result<u64> { Ok(number(line, "max")?.max(most)) })?;
    numbers.insert("instructions", most);
    numbers.insert("instructions_mean", number(MOTIONS[0], "mean")?);
    numbers.insert("stack_bytes", number("stack", "update")?);
    numbers.insert("stack_setup_bytes", number("stack", "setup")?);
    Ok(numbers)
}

/// Bytes of flash and of static memory that a program takes.
///
/// Flash: every section that is loaded. Memory: every section that can be written, loaded (`.data`) or not (`.bss`), without stack and heap.
fn sections(program: &Path) -> Result<Numbers> {
    let bytes = std::fs::read(program).with_context(|| format!("cannot read {}", program.display()))?;
    let file = object::File::parse(bytes.as_slice())?;
    let (mut flash, mut ram) = (0, 0);
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
        let has = |flag: u32| sh_flags & u64::from(flag) != 0;
        let name = section.name().unwrap_or_default();
        if !has(elf::SHF_ALLOC) || name.contains("stack") || name.contains("heap") {
            continue;
        }
        let is_loaded = section.kind() != object::SectionKind::UninitializedData;
        flash += if is_loaded { section.size() } else { 0 };
        ram += if has(elf::SHF_WRITE) && !has(elf::SHF_EXECINSTR) { section.size() } else { 0 };
    }
    Ok(BTreeMap::from([("flash_bytes", flash), ("ram_bytes", ram)]))
}

/// The numbers as JSON: by target, then by name.
fn described(all: &BTreeMap<&'static str, Numbers>) -> Value {
    let entry = |numbers: &Numbers| -> Value {
        numbers
            .iter()
            .map(|(name, &number)| ((*name).to_owned(), number.into()))
            .collect::<Map<_, _>>()
            .into()
    };
    all.iter().map(|(target, numbers)| ((*target).to_owned(), entry(numbers))).collect::<Map<_, _>>().into()
}

fn show(all: &BTreeMap<&'static str, Numbers>) {
    let mut table = Table::new(&[
        "f32, bfsmc, supervised",
        "instructions",
        "mean",
        "flash, B",
        "static RAM, B",
        "stack, B",
        "of setup, B",
    ]);
    for machine in &MACHINES {
        let Some(numbers) = all.get(machine.target) else { continue };
        let number = |name: &str| grouped(numbers.get(name).copied().unwrap_or(0));
        table.add(vec![
            format!("{}, {}", machine.processor, machine.target),
            number("instructions"),
            number("instructions_mean"),
            number("flash_bytes"),
            number("ram_bytes"),
            number("stack_bytes"),
            number("stack_setup_bytes"),
        ]);
    }
    table.print();
}
