//! Instructions of the fuzzy engines on microcontrollers, counted under QEMU.
//!
//! The programs are in `firmware/`. QEMU lets each instruction take a fixed time, the program calibrates a timer of the machine by a loop of
//! known length and prints what one evaluation takes. The same evaluations run here as well: the outputs have to be
//! the same, bit for bit.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};
use serde_json::{Map, Value, json};

use crate::shell::{cargo, command_with, output, root, run as run_command, target_directory};
use crate::table::{Table, grouped};
use crate::targets::Compiler;
use crate::tools::{QEMU_ARM, require};

/// A target and a machine of QEMU that has its processor.
struct Machine {
    target: &'static str,
    processor: &'static str,
    arguments: &'static [&'static str],
    /// What is known of the same system elsewhere, by the name of the measurement.
    peers: &'static [(&'static str, &'static str)],
}

const MACHINES: [Machine; 2] = [
    Machine {
        target: "thumbv7em-none-eabihf",
        processor: "Cortex-M4F",
        arguments: &["-machine", "mps2-an386", "-cpu", "cortex-m4"],
        peers: &[("fuzzy-f32-exact", "eFLL 5,865, with single-precision constants 2,946")],
    },
    Machine {
        target: "thumbv6m-none-eabi",
        processor: "Cortex-M0",
        arguments: &["-machine", "microbit"],
        peers: &[],
    },
];

/// An instruction takes 2^10 ns of the machine's time: many ticks of its timer.
const QEMU: [&str; 8] = [
    "-nographic",
    "-monitor",
    "none",
    "-semihosting-config",
    "enable=on,target=native",
    "-icount",
    "shift=10",
    "-kernel",
];

/// Seconds after which a machine hangs, such as in a fault.
const PATIENCE: &str = "120";

/// One line of the program: numbers by name, and the checksum of the outputs.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Count {
    numbers: BTreeMap<String, u64>,
    pub(crate) checksum: String,
}

pub(crate) type Counts = Vec<(String, Count)>;

/// Counts on all machines; fails when a budget is exceeded or an output differs from the one computed here.
pub(crate) fn run(json: bool, fallback: bool) -> Result<ExitCode> {
    Ok(if measure(json, fallback)? { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// What a change has to pass: format, lints, budgets and bits.
pub(crate) fn check() -> Result<()> {
    run_command(&mut firmware_cargo(&["fmt", "--check"])?)?;
    lint()?;
    ensure!(measure(false, false)?, "a budget is exceeded, or outputs differ");
    Ok(())
}

/// Counts and shows; whether all is well.
fn measure(json: bool, fallback: bool) -> Result<bool> {
    require(&[QEMU_ARM])?;
    let budgets = budgets()?;
    let here: Counts =
        counts(&on_host()?)?.into_iter().filter(|(name, _)| name.starts_with("fuzzy-")).collect();
    let programs = build(fallback)?;
    let mut well = true;
    let mut all = Map::new();
    for (machine, program) in MACHINES.iter().zip(&programs) {
        let counts = counts(&on_machine(machine, program)?)?;
        let budget = |name: &str| budgets.get(machine.target).and_then(|list| list.get(name)).copied();
        if json {
            let entry = |(name, count): &(String, Count)| (name.clone(), described(count, budget(name)));
            all.insert(machine.target.to_owned(), counts.iter().map(entry).collect::<Map<_, _>>().into());
        } else {
            show(machine, &counts, budget);
        }
        for problem in problems(&counts, &here, budgets.get(machine.target)) {
            eprintln!("{}: {problem}", machine.processor);
            well = false;
        }
    }
    if json {
        println!("{}", Value::Object(all));
    }
    Ok(well)
}

/// Lints of the programs, as strict as those of the workspace.
fn lint() -> Result<()> {
    let mut host = firmware_cargo(&["clippy", "--lib", "--examples"])?;
    run_command(host.args(["--locked", "--", "-D", "warnings"]))?;
    if Compiler::find(false)?.has_clippy() {
        let mut target = firmware_cargo(&["clippy", "--release", "--bins", "--target", MACHINES[0].target])?;
        run_command(target.args(["--locked", "--", "-D", "warnings"]))?;
    }
    Ok(())
}

/// Most instructions by target and name, from `firmware/budget.toml`.
fn budgets() -> Result<BTreeMap<String, BTreeMap<String, u64>>> {
    let path = root().join("firmware/budget.toml");
    let text = std::fs::read_to_string(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let table: toml::Table = toml::from_str(&text)?;
    let mut budgets = BTreeMap::new();
    for (target, section) in &table {
        let Some(list) = section.get("instructions").and_then(toml::Value::as_table) else { continue };
        let number = |(name, value): (&String, &toml::Value)| {
            let most = value.as_integer().and_then(|most| u64::try_from(most).ok());
            Ok((name.clone(), most.with_context(|| format!("budget.toml: {target}: {name} is no count"))?))
        };
        budgets.insert(target.clone(), list.iter().map(number).collect::<Result<_>>()?);
    }
    Ok(budgets)
}

/// Builds the program for all machines; the paths are in their order.
fn build(fallback: bool) -> Result<Vec<PathBuf>> {
    let mut compiler = Compiler::find(fallback)?;
    compiler.cargo.current_dir(root().join("firmware"));
    compiler.cargo.env("CARGO_TARGET_DIR", compiler.directory.join("firmware"));
    compiler.cargo.args(["--release", "--locked", "--bin", "count"]);
    for machine in &MACHINES {
        compiler.cargo.args(["--target", machine.target]);
    }
    run_command(&mut compiler.cargo)?;
    let path =
        |machine: &Machine| compiler.directory.join("firmware").join(machine.target).join("release/count");
    Ok(MACHINES.iter().map(path).collect())
}

/// What the program prints on a machine.
fn on_machine(machine: &Machine, program: &Path) -> Result<String> {
    let mut qemu = command_with("timeout", &[PATIENCE, "qemu-system-arm"]);
    qemu.args(machine.arguments).args(QEMU).arg(program);
    output(&mut qemu).with_context(|| format!("on the {}", machine.processor))
}

/// What the counting programs print here; the counts are zeros.
pub(crate) fn on_host() -> Result<String> {
    output(&mut firmware_cargo(&["run", "--quiet", "--locked", "--example", "host"])?)
}

/// The workspace's cargo in the one of the programs.
fn firmware_cargo(arguments: &[&str]) -> Result<Command> {
    let mut cargo = cargo(arguments);
    cargo.current_dir(root().join("firmware"));
    cargo.env("CARGO_TARGET_DIR", target_directory()?.join("firmware"));
    Ok(cargo)
}

/// The lines of the program: `name evaluations=1401 total=... checksum=...`.
pub(crate) fn counts(text: &str) -> Result<Counts> {
    let counts: Counts = text.lines().map(count).collect::<Result<_>>()?;
    ensure!(!counts.is_empty(), "the program printed nothing");
    Ok(counts)
}

fn count(line: &str) -> Result<(String, Count)> {
    let mut words = line.split_whitespace();
    let name = words.next().context("an empty line")?.to_owned();
    let (mut numbers, mut checksum) = (BTreeMap::new(), None);
    for word in words {
        match word.split_once('=') {
            Some(("checksum", value)) => checksum = Some(value.to_owned()),
            Some((key, value)) => {
                let value = value.parse().with_context(|| format!("`{word}` in `{line}`"))?;
                numbers.insert(key.to_owned(), value);
            }
            None => bail!("the program says: {line}"),
        }
    }
    Ok((name, Count { numbers, checksum: checksum.with_context(|| format!("no checksum: {line}"))? }))
}

/// What is wrong with the counts of a machine.
fn problems(counts: &Counts, here: &Counts, budgets: Option<&BTreeMap<String, u64>>) -> Vec<String> {
    let find = |list: &'_ Counts, name: &str| list.iter().position(|(other, _)| other == name);
    let mut problems = Vec::new();
    for (name, expected) in here {
        match find(counts, name).and_then(|index| counts.get(index)) {
            None => problems.push(format!("{name} was not counted")),
            Some((_, count)) if count.checksum != expected.checksum => problems.push(format!(
                "{name}: outputs differ from those of this machine (checksum {}, here {})",
                count.checksum, expected.checksum
            )),
            Some(_) => {}
        }
    }
    for (name, &budget) in budgets.into_iter().flatten() {
        match find(counts, name).and_then(|index| counts.get(index)) {
            None => problems.push(format!("{name} has a budget and was not counted")),
            Some((_, count)) if count.most() > budget => problems.push(format!(
                "{name}: {} instructions, budget {}",
                grouped(count.most()),
                grouped(budget)
            )),
            Some(_) => {}
        }
    }
    problems
}

impl Count {
    pub(crate) fn number(&self, name: &str) -> u64 {
        self.numbers.get(name).copied().unwrap_or(u64::MAX)
    }

    fn most(&self) -> u64 {
        self.number("max")
    }
}

/// A count as JSON.
fn described(count: &Count, budget: Option<u64>) -> Value {
    let mut entry: Map<String, Value> =
        count.numbers.iter().map(|(name, &number)| (name.clone(), number.into())).collect();
    entry.insert("checksum".to_owned(), count.checksum.clone().into());
    entry.insert("budget".to_owned(), json!(budget));
    entry.insert("within_budget".to_owned(), json!(budget.is_none_or(|budget| count.most() <= budget)));
    Value::Object(entry)
}

fn show(machine: &Machine, counts: &Counts, budget: impl Fn(&str) -> Option<u64>) {
    println!("instructions an evaluation, {}, {}, release build", machine.processor, machine.target);
    let mut table = Table::new(&["operation", "least", "mean", "most", "budget", "", "elsewhere"]);
    for (name, count) in counts {
        let limit = budget(name);
        let verdict = limit.map_or("", |limit| if count.most() <= limit { "ok" } else { "EXCEEDED" });
        let peer = machine.peers.iter().find(|(other, _)| other == name);
        table.add(vec![
            name.clone(),
            grouped(count.number("min")),
            grouped(count.number("mean")),
            grouped(count.most()),
            limit.map_or_else(String::new, grouped),
            verdict.to_owned(),
            peer.map_or_else(String::new, |(_, text)| (*text).to_owned()),
        ]);
    }
    table.print();
}

#[cfg(test)]
mod tests {
    use super::{count, counts, problems};
    use std::collections::BTreeMap;

    #[test]
    fn a_line_is_read_and_a_complaint_is_passed_on() {
        let (name, read) = count("fuzzy-q15 max=208 mean=188 checksum=00ff").expect("a good line");
        assert_eq!((name.as_str(), read.most(), read.checksum.as_str()), ("fuzzy-q15", 208, "00ff"), "parts");
        let error = count("calibration: Miscounted { expected: 2 }").expect_err("no count");
        assert!(error.to_string().contains("Miscounted"), "what the program says: {error}");
        assert!(counts("").is_err(), "silence");
    }

    #[test]
    fn other_bits_missing_lines_and_budgets_are_problems() {
        let here = counts("a max=0 checksum=01\nb max=0 checksum=02\n").expect("lines");
        let there = counts("a max=50 checksum=09\n").expect("a line");
        let budgets = BTreeMap::from([("a".to_owned(), 49), ("c".to_owned(), 9)]);
        let found = problems(&there, &here, Some(&budgets));
        let begins = ["a: outputs differ", "b was not counted", "a: 50 instructions", "c has a budget"];
        assert_eq!(found.len(), begins.len(), "{found:?}");
        assert!(found.iter().zip(begins).all(|(problem, begin)| problem.starts_with(begin)), "{found:?}");
        let budgets = BTreeMap::from([("a".to_owned(), 50)]);
        assert!(problems(&there, &there, Some(&budgets)).is_empty(), "a budget may be used up");
    }
}
