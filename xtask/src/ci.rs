//! Everything that a change has to pass, step by step; the first failure ends it.

use std::process::ExitCode;
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};

use crate::mmsim::{Mmsim, Profile};
use crate::shell::{answers, cargo, run as run_command, watch};
use crate::{bench_targets, capi, fuzzy_peers, pil, qemu, report, scenarios, size, tools, wheel};

/// How a step ended, unless it failed.
enum End {
    Done,
    /// It was left out, for this reason.
    Skipped(&'static str),
}

/// Tests counted from the lines of their runners.
#[derive(Debug, Default, PartialEq, Eq)]
struct Tests {
    passed: u64,
    failed: u64,
}

/// The profile that everything here is compiled in.
const PROFILE: &str = "--profile=testrelease";

/// A step: what it is called and what it does.
type Step = (&'static str, fn(&mut Tests) -> Result<End>);

const STEPS: [Step; 14] = [
    ("format", |_| format()),
    // In the profile of the tests, so that what runs while compiling is built once.
    ("clippy", |_| {
        let lints = ["--", "-D", "warnings"];
        run_command(cargo(&["clippy", "--workspace", "--all-targets", "--locked", PROFILE]).args(lints))?;
        Ok(End::Done)
    }),
    ("documentation", |_| {
        let mut cargo = cargo(&["doc", "--workspace", "--no-deps", "--locked", PROFILE]);
        run_command(cargo.env("RUSTDOCFLAGS", "-D warnings"))?;
        Ok(End::Done)
    }),
    // Release code, since that is what people run, with overflow checked. That plain release code computes the same bits is seen on
    // microcontrollers, where nothing else is run.
    ("tests", |tests| test(tests, &["--workspace", PROFILE])),
    ("fuzzy engines from PyPI", |tests| {
        fuzzy_peers::check(|line| tests.add_python(line))?;
        Ok(End::Done)
    }),
    ("scenarios", |_| {
        scenarios::run(&Mmsim::find(None, Profile::TestRelease)?)?;
        Ok(End::Done)
    }),
    ("reports in a browser", |tests| {
        report::check(&Mmsim::find(None, Profile::TestRelease)?, |line| tests.add_python(line))?;
        Ok(End::Done)
    }),
    // Building the programs builds mm-model and mm-control for the targets.
    ("microcontrollers: lints, fuzzy engines", |_| {
        bench_targets::check()?;
        Ok(End::Done)
    }),
    ("microcontrollers: costs", |_| well(size::run(&size::Options::default())?)),
    ("microcontrollers: bits", |_| well(qemu::run(&qemu::Options::default())?)),
    ("microcontrollers: the C interface", |_| well(capi::run(&capi::Request::default())?)),
    ("microcontrollers: processor in the loop", |_| {
        let options = pil::Options { scope: pil::Scope::Short, fallback: false };
        well(pil::run(&options, || Mmsim::find(None, Profile::TestRelease))?)
    }),
    ("Python package", |tests| {
        let options = wheel::Options { test: true, quick: true };
        wheel::check(options, |line| tests.add_python(line))?;
        Ok(End::Done)
    }),
    ("licences and sources of dependencies", |_| deny()),
];

/// Runs all steps; prints the totals last.
pub(crate) fn run() -> Result<ExitCode> {
    let start = Instant::now();
    let mut tests = Tests::default();
    let mut times = Vec::new();
    let mut failure = None;
    thread::spawn(fetch_ahead);
    for (i, (name, step)) in STEPS.iter().enumerate() {
        println!("\n== {}/{} {name}", i + 1, STEPS.len());
        let begin = Instant::now();
        let end = step(&mut tests);
        let took = begin.elapsed();
        let verdict = match &end {
            Ok(End::Done) => "ok".to_owned(),
            Ok(End::Skipped(why)) => format!("skipped: {why}"),
            Err(_) => "FAILED".to_owned(),
        };
        println!("== {name}: {verdict} ({})", seconds(took));
        times.push((*name, verdict, took));
        if let Err(error) = end {
            failure = Some((*name, error));
            break;
        }
    }
    println!();
    for (name, verdict, took) in &times {
        println!("{:>8}  {name}: {verdict}", seconds(*took));
    }
    println!("{:>8}  altogether", seconds(start.elapsed()));
    if let Some((name, error)) = &failure {
        println!("stopped at the step `{name}`: {error:#}");
        // A step without tests, such as a lint, counts as one.
        tests.failed = tests.failed.max(1);
    }
    println!("{} passed, {} failed", tests.passed, tests.failed);
    Ok(if failure.is_none() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Installs tools and packages of Python while the first steps compile: that waits for the network more than for a processor. Where
/// it fails, the step that needs them tries again and says why.
fn fetch_ahead() {
    drop(tools::require(&tools::ALL));
    for prepare in [fuzzy_peers::prepare, wheel::prepare, report::prepare] {
        drop(prepare());
    }
}

/// Turns the verdict of another job into that of a step.
fn well(code: ExitCode) -> Result<End> {
    ensure!(code == ExitCode::SUCCESS, "see above");
    Ok(End::Done)
}

/// All workspaces: this one, that of the microcontrollers and that of the fuzz targets.
fn format() -> Result<End> {
    for manifest in ["Cargo.toml", "firmware/Cargo.toml", "fuzz/Cargo.toml"] {
        let manifest = format!("--manifest-path={manifest}");
        run_command(&mut cargo(&["fmt", "--all", "--check", &manifest]))?;
    }
    Ok(End::Done)
}

/// Tests of what the arguments select, in one invocation.
fn test(tests: &mut Tests, selection: &[&str]) -> Result<End> {
    let mut cargo = cargo(&["test", "--locked", "--no-fail-fast"]);
    watch(cargo.args(selection), |line| tests.add(line))?;
    Ok(End::Done)
}

fn deny() -> Result<End> {
    if !answers("cargo-deny", &["--version"]) {
        return Ok(End::Skipped("cargo-deny is not installed"));
    }
    // The tool looks at the dependencies of all platforms and does not fetch them itself.
    run_command(&mut cargo(&["fetch", "--locked"]))?;
    let check = ["deny", "--offline", "check", "--hide-inclusion-graph", "bans", "licenses", "sources"];
    run_command(&mut cargo(&check))?;
    Ok(End::Done)
}

impl Tests {
    /// Adds the numbers of a line such as `test result: ok. 3 passed; 0 failed; 0 ignored; ...`.
    fn add(&mut self, line: &str) {
        if let Some(counts) = line.strip_prefix("test result: ") {
            self.count(counts);
        }
    }

    /// Adds the numbers of the last line of pytest, such as `1 failed, 3 passed in 0.12s`.
    fn add_python(&mut self, line: &str) {
        if line.contains(" in ") && line.starts_with(|first: char| first.is_ascii_digit()) {
            self.count(line);
        }
    }

    fn count(&mut self, counts: &str) {
        let words: Vec<&str> = counts.split([' ', ';', ',', '.']).filter(|word| !word.is_empty()).collect();
        for pair in words.windows(2) {
            if let [number, word] = pair
                && let Ok(number) = number.parse::<u64>()
            {
                match *word {
                    "passed" => self.passed += number,
                    "failed" => self.failed += number,
                    _ => {}
                }
            }
        }
    }
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::Tests;

    #[test]
    fn counts_are_taken_from_the_runners_lines() {
        let mut tests = Tests::default();
        tests.add(
            "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.01s",
        );
        tests.add("test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.50s");
        tests.add("test some::test ... ok");
        assert_eq!(tests, Tests { passed: 15, failed: 2 }, "sums of both lines");
        tests.add_python("1 failed, 3 passed, 7 warnings in 0.12s (0:00:01)");
        tests.add_python("81 passed in 51.40s");
        tests.add_python("........ [ 88%]");
        assert_eq!(tests, Tests { passed: 99, failed: 3 }, "and of pytest's");
    }
}
