//! `mmsim tune`: gains of one or more laws, out as TOML.

use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;
use clap::{Args, CommandFactory as _, ValueEnum};
use mm_control::LawKind;

use super::run::{prepare, with_causes};
use super::table::short;
use super::{Cli, Exit, complain, interrupt, needs_scenario, print, progress};
use crate::experiment::Experiment;
use crate::parallel::Pool;
use crate::scenario::{self, Loaded};
use crate::shell;
use crate::tune::{self, TuneError, Tuned};

/// What `tune` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct TuneArgs {
    /// A scenario file, or the name of a bundled scenario; its table [tune] says budget and cost.
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// Controllers to tune, separated by commas, or `all`.
    #[arg(long, value_name = "KIND,...|all", value_delimiter = ',', required = true, value_parser = laws())]
    controller: Vec<String>,
    /// How to search.
    #[arg(long, value_enum, default_value_t = Method::Pso)]
    method: Method,
    /// Threads that share the work; it changes no result. Default: one for each core.
    #[arg(long, value_name = "J")]
    jobs: Option<NonZeroUsize>,
    /// Seed of the search. Default: tune.seed of the scenario.
    #[arg(long, allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Set a key of the scenario, by its dotted path; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// File for the gains. Default: standard output.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// No progress, and no table beside a file.
    #[arg(long, short)]
    quiet: bool,
}

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Method {
    /// Particle swarm.
    Pso,
}

const ALL: &str = "all";

/// The laws by name, and all of them.
fn laws() -> clap::builder::PossibleValuesParser {
    LawKind::ALL.map(LawKind::name).into_iter().chain([ALL]).collect::<Vec<_>>().into()
}

/// The laws that the argument names, each once.
fn named(names: &[String]) -> Result<Vec<LawKind>, clap::Error> {
    let mut found = Vec::new();
    for name in names {
        let these = match LawKind::from_name(name) {
            Some(law) => vec![law],
            None => LawKind::ALL.to_vec(),
        };
        for law in these {
            if found.contains(&law) {
                let message = format!("controller `{}` is named twice in --controller", law.name());
                return Err(Cli::command().error(ErrorKind::ValueValidation, message));
            }
            found.push(law);
        }
    }
    Ok(found)
}

/// Tunes each law and writes their gains.
pub(super) fn tune(args: &TuneArgs) -> Result<Exit, clap::Error> {
    let spec = needs_scenario(args.scenario.as_deref())?;
    let laws = named(&args.controller)?;
    Ok(run(args, spec, &laws).unwrap_or_else(|exit| exit))
}

fn run(args: &TuneArgs, spec: &str, laws: &[LawKind]) -> Result<Exit, Exit> {
    let Method::Pso = args.method;
    let loaded = scenario::load(spec, &args.set).map_err(|error| {
        complain(&error);
        Exit::Usage
    })?;
    let mut prepared = Vec::new();
    for law in laws {
        let kind = format!("controller.kind=\"{}\"", law.name());
        let sets = [args.set.as_slice(), &[kind]].concat();
        for version in &loaded.file.tune.also {
            prepare(spec, &[sets.as_slice(), version].concat())?;
        }
        prepared.push((*law, prepare(spec, &sets)?));
    }
    let seed = args.seed.unwrap_or(loaded.file.tune.seed);
    let tuned = search(args, &loaded, &prepared, seed)?;
    let text = tune::to_toml(&command(args, spec), &loaded, seed, &tuned);
    let Some(path) = &args.output else { return Ok(print(text.trim_end())) };
    write(path, &text).map_err(|error| {
        complain(&format_args!("error: cannot write {}: {error}", path.display()));
        Exit::Failed
    })?;
    Ok(if args.quiet { Exit::Done } else { print(&table(&tuned, path)) })
}

/// Tunes one law after the other, each on all threads.
fn search(
    args: &TuneArgs,
    loaded: &Loaded,
    prepared: &[(LawKind, (Loaded, Experiment))],
    seed: u64,
) -> Result<Vec<Tuned>, Exit> {
    interrupt::install();
    let fail = |error: &dyn std::error::Error| {
        complain(&format_args!("error: {}", with_causes(error)));
        Exit::Failed
    };
    let pool = Pool::new(args.jobs.map(NonZeroUsize::get)).map_err(|error| fail(&error))?;
    let tune = &loaded.file.tune;
    let runs = u64::from(tune.particles) * u64::from(tune.iterations) * prepared.len() as u64;
    let bar = progress::bar(!args.quiet, 0, runs);
    let mut tuned = Vec::new();
    for (law, (loaded, experiment)) in prepared {
        bar.set_message(law.name());
        let best =
            tune::tune((loaded, experiment), (*law, seed), &pool, &interrupt::asked, |more| bar.inc(more));
        match best {
            Ok(best) => tuned.push(best),
            Err(error) => {
                bar.finish_and_clear();
                return Err(match error {
                    TuneError::NothingToTune { .. } => fail(&error).max(Exit::Usage),
                    TuneError::NoneFinished { .. } | TuneError::Stopped => fail(&error),
                });
            }
        }
    }
    bar.finish_and_clear();
    Ok(tuned)
}

/// The command line that tunes the same again.
fn command(args: &TuneArgs, spec: &str) -> String {
    let seed = args.seed.map(|seed| seed.to_string());
    let controllers = args.controller.join(",");
    let mut words = vec!["mmsim", "tune", "--scenario", spec, "--controller", &controllers];
    words.extend(seed.iter().flat_map(|seed| ["--seed", seed]));
    words.extend(args.set.iter().flat_map(|set| ["--set", set]));
    shell::command(words)
}

/// Writes a file as a whole or not at all: beside it, then in its place.
fn write(path: &Path, text: &str) -> std::io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    if written.is_err() {
        let _ = std::fs::remove_file(&beside);
    }
    written
}

/// What was gained.
fn table(all: &[Tuned], path: &Path) -> String {
    let mut out = format!(
        "{:20} {:>11} {:>11} {:>11} {:>11}\n{:20} {:>11} {:>11} {:>11} {:>11}\n",
        "", "cost", "by default", "ITAE sum", "variation", "", "", "", "m s^2", "N m/s"
    );
    for tuned in all {
        let metrics = tuned.trial.result.as_ref().map(|(metrics, _)| metrics);
        let [itae, variation] = [
            metrics.map_or(f64::NAN, |m| m.itae_m_s2.sum),
            metrics.map_or(f64::NAN, |m| m.torque_tv_n_m_per_s.sum),
        ]
        .map(short);
        let [cost, default] = [tuned.trial.cost, tuned.default_cost].map(short);
        let _ = writeln!(out, "{:20} {cost:>11} {default:>11} {itae:>11} {variation:>11}", tuned.law.name());
    }
    let _ = write!(out, "\ngains in {}", path.display());
    out
}
