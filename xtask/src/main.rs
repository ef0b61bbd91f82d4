//! Jobs of the workspace: `cargo xtask <job>`.
//!
//! Each job is a module; what they share is in [`shell`] (processes), [`parallel`] (threads) and [`table`] (output).

mod bench_targets;
mod capi;
mod ci;
mod claim;
mod count;
mod fuzz;
mod fuzzy_peers;
mod grid;
mod live;
mod log_kill;
mod mmsim;
mod parallel;
mod pil;
mod python;
mod qemu;
mod real_time;
mod report;
mod scenarios;
mod shell;
mod size;
mod table;
mod targets;
mod tools;
mod wheel;

use std::process::ExitCode;

use anyhow::{Context, Result, bail};

const HELP: &str = "\
cargo xtask <job>

  ci                  format, lints, tests, docs, bare-metal builds, scenarios, dependencies: everything a change has to pass
  targets             builds mm-model and mm-control for bare metal [--fallback: with Debian's compiler]
  scenarios           runs every bundled scenario and checks its [expect] [--mmsim FILE: with this command]
  fuzzy-peers         compares the fuzzy engine with engines from PyPI, system by system
  grid                maps the gains of bsmc on square-compare into docs/grid.csv [--mmsim FILE]
  claim               judges the thesis's claim on square-compare into docs/claim.csv [--mmsim FILE]
  bench-instructions  counts the instructions of each operation with callgrind [--json] [--target-cpu CPU]
  fuzz                feeds any text to the readers of .fis, FCL and logs, with nightly and cargo-fuzz [--seconds N: each target]
  log-kill            kills ten runs at random moments, recovers their logs and has Python packages from PyPI and Rerun read them
                      [--seed N] [--mmsim FILE]
  bench-targets       counts the instructions of the fuzzy engines on microcontrollers, under QEMU [--json] [--fallback]
  capi                checks mm_control.h, builds libmm_control.a, runs C programs here and under QEMU [--bless: writes the header]
                      [--target T: only the archive] [--full: all targets] [--fallback]
  qemu                runs the programs of firmware/ on emulated microcontrollers and compares every bit of the controller with this machine
                      [--full: all ticks] [--scenario NAME] [--fallback] [--json]
  pil                 runs the controller on emulated microcontrollers in the loop [--build: only builds it]
                      [--short: a second on the Cortex-M4] [--full: all of square-compare there] [--fallback] [--mmsim FILE]
  size                instructions, flash, memory and stack of the controller on microcontrollers [--json] [--bless] [--fallback]
                      [--fixed: fixed point beside single precision, on processors without floating point]
  wheel               the Python package: wheel and sdist into target/wheels, installed alone and tried
                      [--test: its tests, with packages from PyPI] [--quick: a wheel that is quickly linked, for its tests]
  report              opens reports in Debian's Chromium: silent, the slider moves the robot, every plot has data [--mmsim FILE]
  live                watches runs served by a build with the feature `live`, with a client from PyPI
  real-time           simulated seconds per second of CPU time [--runs N]
";

fn main() -> ExitCode {
    match run() {
        Ok(code) => code,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<ExitCode> {
    let mut arguments = Arguments::from_env();
    let Some(job) = arguments.job.take() else {
        print!("{HELP}");
        return Ok(ExitCode::from(2));
    };
    let code = match job.as_str() {
        "ci" => {
            arguments.finish()?;
            ci::run()?
        }
        "targets" => {
            let fallback = arguments.flag("--fallback");
            arguments.finish()?;
            targets::build(fallback)?;
            ExitCode::SUCCESS
        }
        "scenarios" => {
            let command = arguments.value("--mmsim")?;
            arguments.finish()?;
            scenarios::run(&mmsim::Mmsim::find(command, mmsim::Profile::Release)?)?;
            ExitCode::SUCCESS
        }
        "fuzzy-peers" => {
            arguments.finish()?;
            fuzzy_peers::check(|_| ())?;
            ExitCode::SUCCESS
        }
        "report" => {
            let command = arguments.value("--mmsim")?;
            arguments.finish()?;
            report::check(&mmsim::Mmsim::find(command, mmsim::Profile::TestRelease)?, |_| ())?;
            ExitCode::SUCCESS
        }
        "live" => {
            arguments.finish()?;
            live::run()?
        }
        "grid" => {
            let command = arguments.value("--mmsim")?;
            arguments.finish()?;
            grid::run(&mmsim::Mmsim::find(command, mmsim::Profile::Release)?)?;
            ExitCode::SUCCESS
        }
        "claim" => {
            let command = arguments.value("--mmsim")?;
            arguments.finish()?;
            claim::run(&mmsim::Mmsim::find(command, mmsim::Profile::Release)?)?;
            ExitCode::SUCCESS
        }
        "bench-instructions" => {
            let json = arguments.flag("--json");
            let cpu = arguments.value("--target-cpu")?;
            arguments.finish()?;
            count::run(json, cpu.as_deref())?
        }
        "fuzz" => {
            let seconds = arguments.value("--seconds")?;
            arguments.finish()?;
            let seconds = seconds.map_or(Ok(60), |seconds| seconds.parse());
            fuzz::fuzz(seconds.context("--seconds takes a whole number")?)?;
            ExitCode::SUCCESS
        }
        "log-kill" => {
            let (seed, command) = (arguments.value("--seed")?, arguments.value("--mmsim")?);
            arguments.finish()?;
            let seed = seed.map_or(Ok(0), |seed| seed.parse()).context("--seed takes a whole number")?;
            log_kill::run_all(&mmsim::Mmsim::find(command, mmsim::Profile::Release)?, seed)?;
            ExitCode::SUCCESS
        }
        "bench-targets" => {
            let json = arguments.flag("--json");
            let fallback = arguments.flag("--fallback");
            arguments.finish()?;
            bench_targets::run(json, fallback)?
        }
        "capi" => {
            let request = capi::Request {
                bless: arguments.flag("--bless"),
                full: arguments.flag("--full"),
                fallback: arguments.flag("--fallback"),
                target: arguments.value("--target")?,
            };
            arguments.finish()?;
            capi::run(&request)?
        }
        "qemu" => {
            let (full, fallback) = (arguments.flag("--full"), arguments.flag("--fallback"));
            let (json, scenario) = (arguments.flag("--json"), arguments.value("--scenario")?);
            arguments.finish()?;
            qemu::run(&qemu::Options { full, fallback, json, scenario })?
        }
        "pil" => {
            let scope = if arguments.flag("--build") {
                pil::Scope::Build
            } else if arguments.flag("--short") {
                pil::Scope::Short
            } else if arguments.flag("--full") {
                pil::Scope::Full
            } else {
                pil::Scope::Usual
            };
            let options = pil::Options { scope, fallback: arguments.flag("--fallback") };
            let command = arguments.value("--mmsim")?;
            arguments.finish()?;
            pil::run(&options, || mmsim::Mmsim::find(command, mmsim::Profile::Release))?
        }
        "size" => {
            let options = size::Options {
                json: arguments.flag("--json"),
                fixed: arguments.flag("--fixed"),
                bless: arguments.flag("--bless"),
                fallback: arguments.flag("--fallback"),
            };
            arguments.finish()?;
            size::run(&options)?
        }
        "wheel" => {
            let options = wheel::Options { test: arguments.flag("--test"), quick: arguments.flag("--quick") };
            arguments.finish()?;
            wheel::run(options)?
        }
        "real-time" => {
            let runs = arguments.value("--runs")?;
            arguments.finish()?;
            real_time::run(runs.map_or(Ok(9), |runs| runs.parse()).context("--runs takes a whole number")?)?;
            ExitCode::SUCCESS
        }
        "help" | "--help" | "-h" => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        other => bail!("no job `{other}`; `cargo xtask help` lists them"),
    };
    Ok(code)
}

/// The command line: a job, flags and values.
struct Arguments {
    job: Option<String>,
    rest: Vec<String>,
}

impl Arguments {
    fn from_env() -> Self {
        let mut all = std::env::args().skip(1);
        Self { job: all.next(), rest: all.collect() }
    }

    /// Whether a flag was given; takes it.
    fn flag(&mut self, name: &str) -> bool {
        let before = self.rest.len();
        self.rest.retain(|argument| argument != name);
        self.rest.len() < before
    }

    /// The value that follows a name, if given; takes both.
    fn value(&mut self, name: &str) -> Result<Option<String>> {
        let Some(at) = self.rest.iter().position(|argument| argument == name) else { return Ok(None) };
        let mut taken = self.rest.drain(at..).collect::<Vec<_>>().into_iter().skip(1);
        let value = taken.next().with_context(|| format!("{name} needs a value"))?;
        self.rest.extend(taken);
        Ok(Some(value))
    }

    /// Refuses whatever nobody took.
    fn finish(&self) -> Result<()> {
        match self.rest.first() {
            Some(argument) => bail!("unknown argument `{argument}`; `cargo xtask help`"),
            None => Ok(()),
        }
    }
}
