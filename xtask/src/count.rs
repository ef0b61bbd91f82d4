//! Instructions of each operation, counted exactly by callgrind.
//!
//! Unlike times, the counts are the same on a busy machine. Each operation runs in two lengths; the difference, divided by the
//! difference of the lengths, is one operation without any set-up.

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use serde_json::{Map, Value, json};

use crate::parallel;
use crate::shell::{self, cargo, command, target_directory};
use crate::table::{Table, grouped};
use crate::tools::{VALGRIND, require};

/// One operation of the `count` program.
struct Operation {
    /// Its name there.
    name: &'static str,
    what: &'static str,
    /// The shorter of the two lengths.
    times: u64,
    /// An operation that does nothing, whose instructions are taken away: the loop, where it would weigh.
    less: Option<&'static str>,
    /// Most instructions allowed, where a limit was set.
    budget: Option<u64>,
    /// The same operation elsewhere; see docs/benchmarks.md.
    peers: &'static str,
}

const fn operation(name: &'static str, what: &'static str, times: u64) -> Operation {
    Operation { name, what, times, less: None, budget: None, peers: "" }
}

const OPERATIONS: [Operation; 15] = [
    Operation {
        budget: Some(975),
        peers: "CasADi C 975, Pinocchio 10,364",
        ..operation("forward-dynamics", "forward dynamics, f64", 6_400)
    },
    operation("forward-dynamics-f32", "forward dynamics, f32", 6_400),
    Operation { peers: "CasADi C 868", ..operation("inverse-dynamics", "inverse dynamics", 6_400) },
    Operation { peers: "CasADi C 739", ..operation("mass-matrix", "mass matrix", 6_400) },
    Operation { peers: "CasADi C 527", ..operation("tip-jacobian", "tip Jacobian", 6_400) },
    operation("sin-cos", "sine and cosine, f64", 6_400),
    operation("sin-cos-f32", "sine and cosine, f32", 6_400),
    Operation {
        budget: Some(800),
        peers: "fuzzylite 23,884",
        ..operation("fuzzy-exact", "fuzzy system of the thesis, exact", 6_400)
    },
    operation("fuzzy-q15", "the same in fixed point", 6_400),
    Operation {
        less: Some("loop-q15"),
        budget: Some(40),
        ..operation("fuzzy-surface-q15", "the same compiled to a surface", 6_400)
    },
    operation("fuzzy-surface", "float surface, 65 knots", 6_400),
    operation("update-bfsmc", "controller update, bfsmc", 4_000),
    operation("update-bsmc", "controller update, bsmc", 4_000),
    operation("plant-step", "plant step, Runge-Kutta 4", 4_096),
    Operation {
        budget: Some(6_000),
        peers: "CasADi C RK4 + computed torque 5,967",
        ..operation("period", "closed-loop period of the square, bfsmc", 49_000)
    },
];

/// Counts every operation; fails when a budget is exceeded.
pub(crate) fn run(json: bool, target_cpu: Option<&str>) -> Result<ExitCode> {
    require(&[VALGRIND])?;
    let program = build(target_cpu)?;
    let counts = parallel::map(&OPERATIONS, |operation| count(&program, operation));
    let counts: Vec<u64> = counts.into_iter().collect::<Result<_>>()?;
    let results = || OPERATIONS.iter().zip(&counts);
    if json {
        let entries = results().map(|(operation, &instructions)| {
            let entry = json!({ "instructions": instructions, "budget": operation.budget });
            (operation.name.to_owned(), entry)
        });
        println!("{}", Value::Object(entries.collect::<Map<_, _>>()));
    } else {
        println!(
            "instructions an operation, x86-64, release build, target CPU {}",
            target_cpu.unwrap_or("default")
        );
        let mut table = Table::new(&["operation", "instructions", "budget", "elsewhere"]);
        for (operation, &instructions) in results() {
            table.add(vec![
                operation.what.to_owned(),
                grouped(instructions),
                operation.budget.map_or_else(String::new, grouped),
                operation.peers.to_owned(),
            ]);
        }
        table.print();
    }
    let mut code = ExitCode::SUCCESS;
    for (operation, &instructions) in results() {
        if let Some(budget) = operation.budget.filter(|budget| instructions > *budget) {
            eprintln!(
                "{}: {} instructions, budget {}",
                operation.what,
                grouped(instructions),
                grouped(budget)
            );
            code = ExitCode::FAILURE;
        }
    }
    Ok(code)
}

/// Builds the program that runs the operations; for another CPU in a directory of its own.
fn build(target_cpu: Option<&str>) -> Result<PathBuf> {
    let mut cargo = cargo(&["build", "--release", "-p", "mm-benches", "--bin", "count"]);
    let mut directory = target_directory()?;
    if let Some(cpu) = target_cpu {
        directory = directory.join(cpu);
        cargo.env("RUSTFLAGS", format!("-Ctarget-cpu={cpu}")).env("CARGO_TARGET_DIR", &directory);
    }
    shell::run(&mut cargo)?;
    Ok(directory.join("release").join("count"))
}

/// Instructions of one operation, rounded to the nearest whole number.
fn count(program: &PathBuf, operation: &Operation) -> Result<u64> {
    let around = operation.less.map_or(Ok(0), |name| counted(program, name, operation.times))?;
    Ok(counted(program, operation.name, operation.times)?.saturating_sub(around))
}

/// The same by name, with the loop around it.
fn counted(program: &PathBuf, name: &str, times: u64) -> Result<u64> {
    let total = |times: u64| {
        let mut valgrind = command("valgrind");
        valgrind.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
        valgrind.arg(program).args([name, &times.to_string()]);
        let output = valgrind.output().context("cannot start valgrind")?;
        let text = String::from_utf8_lossy(&output.stderr);
        collected(&text)
            .filter(|_| output.status.success())
            .with_context(|| format!("callgrind says:\n{text}"))
    };
    let (short, long) = (total(times)?, total(2 * times)?);
    Ok((long.saturating_sub(short) + times / 2) / times)
}

/// The total in the messages of callgrind: `==123== Collected : 456`.
fn collected(text: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.split_once("Collected :"))?;
    line.1.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_total_is_found_among_the_messages() {
        let text = "==7== Events    : Ir\n==7== Collected : 1234\n==7==\n";
        assert_eq!(super::collected(text), Some(1234), "the number after the colon");
        assert_eq!(super::collected("==7== nothing"), None, "no number");
    }
}
