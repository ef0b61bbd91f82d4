//! `mmsim tune`: gains of one or more laws, out as TOML.

use std::fmt::Write as _;
use std::io::Write as _;
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
use crate::tune::{self, Outcome, TuneError, Tuned};
use crate::whole;

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
    if let Some(path) = &args.output {
        check_place(path)?;
    }
    let file = |all: &[Outcome]| tune::to_toml(&command(args, spec), &loaded, seed, all);
    let (all, exit) = search(args, &prepared, seed, |all| match &args.output {
        Some(path) => write(path, &file(all)),
        None => Ok(()),
    })?;
    Ok(match &args.output {
        _ if !all.iter().any(|(_, outcome)| outcome.is_ok()) => exit,
        None => exit.max(print(file(&all).trim_end())),
        Some(_) if args.quiet => exit,
        Some(path) => exit.max(print(&table(&all, path))),
    })
}

/// Refuses a place where no file can be, before work goes into it.
fn check_place(path: &Path) -> Result<(), Exit> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let reason = if path.is_dir() || path.file_name().is_none() {
        "it is a folder"
    } else if !folder.is_dir() {
        "there is no such folder"
    } else {
        return Ok(());
    };
    complain(&format_args!("error: cannot write {}: {reason}", path.display()));
    Err(Exit::Failed)
}

/// Tunes one law after the other, each on all threads; `keep` gets what is known after each that was tuned.
///
/// What fails, or is asked to stop, takes nothing away from the laws that were tuned before it.
fn search(
    args: &TuneArgs,
    prepared: &[(LawKind, (Loaded, Experiment))],
    seed: u64,
    keep: impl Fn(&[Outcome]) -> Result<(), Exit>,
) -> Result<(Vec<Outcome>, Exit), Exit> {
    interrupt::install();
    let fail = |error: &dyn std::error::Error| {
        complain(&format_args!("error: {}", with_causes(error)));
        Exit::Failed
    };
    let pool = Pool::new(args.jobs.map(NonZeroUsize::get)).map_err(|error| fail(&error))?;
    let runs = |(_, (loaded, _)): &(LawKind, (Loaded, Experiment))| {
        u64::from(loaded.file.tune.particles) * u64::from(loaded.file.tune.iterations)
    };
    let bar = progress::bar(!args.quiet, 0, prepared.iter().map(runs).sum());
    let (mut all, mut exit) = (Vec::new(), Exit::Done);
    for (law, (loaded, experiment)) in prepared {
        bar.set_message(law.name());
        let outcome =
            tune::tune((loaded, experiment), (*law, seed), &pool, &interrupt::asked, |more| bar.inc(more));
        exit = exit.max(bar.suspend(|| match &outcome {
            Ok(tuned) => warn_of(tuned),
            Err(error @ TuneError::NothingToTune { .. }) => fail(error).max(Exit::Usage),
            Err(error @ (TuneError::NoneFinished { .. } | TuneError::Stopped)) => fail(error),
        }));
        let stops = matches!(outcome, Err(TuneError::Stopped));
        all.push((*law, outcome));
        if all.iter().any(|(_, outcome)| outcome.is_ok()) {
            keep(&all)?;
        }
        if stops {
            break;
        }
    }
    bar.finish_and_clear();
    Ok((all, exit))
}

/// Says where the search found nothing as good as what is there.
fn warn_of(tuned: &Tuned) -> Exit {
    let Tuned { law, trial, given_cost, .. } = tuned;
    if trial.cost > *given_cost {
        complain(&format_args!(
            "warning: {}: the tuned gains cost {}, those that the scenario gives only {}",
            law.name(),
            short(trial.cost),
            short(*given_cost)
        ));
    }
    Exit::Done
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

/// Writes the gains.
fn write(path: &Path, text: &str) -> Result<(), Exit> {
    whole::write(path, |out| out.write_all(text.as_bytes())).map_err(|error| {
        complain(&format_args!("error: cannot write {}: {error}", path.display()));
        Exit::Failed
    })
}

/// What was gained.
fn table(all: &[Outcome], path: &Path) -> String {
    let mut out = format!(
        "{:20} {:>11} {:>11} {:>11} {:>11} {:>11}\n{:20} {:>11} {:>11} {:>11} {:>11} {:>11}\n",
        "", "cost", "by default", "as given", "ITAE sum", "variation", "", "", "", "", "m s^2", "N m/s"
    );
    for (law, outcome) in all {
        let Ok(tuned) = outcome else {
            let _ = writeln!(out, "{:20} {:>11}", law.name(), "-");
            continue;
        };
        let metrics = tuned.trial.result.as_ref().map(|(metrics, _)| metrics);
        let [itae, variation] = [
            metrics.map_or(f64::NAN, |m| m.itae_m_s2.sum),
            metrics.map_or(f64::NAN, |m| m.torque_tv_n_m_per_s.sum),
        ]
        .map(short);
        let [cost, default, given] = [tuned.trial.cost, tuned.default_cost, tuned.given_cost].map(short);
        let _ = writeln!(
            out,
            "{:20} {cost:>11} {default:>11} {given:>11} {itae:>11} {variation:>11}",
            law.name()
        );
    }
    let _ = write!(out, "\ngains in {}", path.display());
    out
}
