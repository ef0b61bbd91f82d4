//! `mmsim sweep`: many random samples of one scenario, one table.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;

use super::run::{prepare, with_causes};
use super::table::short;
use super::{Exit, complain, interrupt, kinds, needs_scenario, print, progress};
use crate::parallel::Pool;
use crate::scenario::Loaded;
use crate::sweep::{self, Ended, Report, Store, StoreError, SweepError};

/// What `sweep` takes.
#[derive(Debug, Clone, Args)]
pub(super) struct SweepArgs {
    /// A scenario file, or the name of a bundled scenario; its table [sweep] says what varies.
    #[arg(long, value_name = "FILE|NAME")]
    scenario: Option<String>,
    /// How many samples; more of them later only add to those that are there.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..))]
    samples: u64,
    /// Threads that share the work; it changes no result. Default: one for each core.
    #[arg(long, value_name = "J")]
    jobs: Option<NonZeroUsize>,
    /// Seed of the sweep. Default: simulation.seed of the scenario.
    #[arg(long, allow_hyphen_values = true)]
    seed: Option<u64>,
    /// Set a key of the scenario, by its dotted path; repeatable.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Controller to use instead of the scenario's.
    #[arg(long, value_name = "KIND", value_parser = kinds())]
    controller: Option<String>,
    /// Folder for the file of samples, with which a later call goes on.
    #[arg(long, value_name = "DIR", default_value = "./out")]
    out: PathBuf,
    /// Forget the samples that are there.
    #[arg(long)]
    fresh: bool,
    /// Print the report as JSON on standard output, and nothing else there.
    #[arg(long)]
    json: bool,
    /// No progress, no table.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs the samples that are not there yet and reports on all of them.
pub(super) fn sweep(args: &SweepArgs) -> Result<Exit, clap::Error> {
    let spec = needs_scenario(args.scenario.as_deref())?;
    let mut sets = args.set.clone();
    sets.extend(args.controller.as_ref().map(|kind| format!("controller.kind=\"{kind}\"")));
    let loaded = match prepare(spec, &sets) {
        Ok((loaded, _)) => loaded,
        Err(exit) => return Ok(exit),
    };
    let seed = args.seed.unwrap_or(loaded.file.simulation.seed);
    interrupt::install();
    let rows = Pool::new(args.jobs.map(NonZeroUsize::get))
        .map_err(|error| fail(&error))
        .and_then(|pool| samples(args, &loaded, seed, &pool));
    let (rows, file) = match rows {
        Ok(done) => done,
        Err(exit) => return Ok(exit),
    };
    let mut again = vec!["run".to_owned(), "--scenario".to_owned(), spec.to_owned()];
    again.extend(args.controller.iter().flat_map(|kind| ["--controller".to_owned(), kind.clone()]));
    again.extend(args.set.iter().flat_map(|set| ["--set".to_owned(), set.clone()]));
    let report = Report::of(&loaded, seed, &rows, &again, file.display().to_string());
    Ok(if args.json {
        print(&report.to_json())
    } else if args.quiet {
        Exit::Done
    } else {
        print(&table(&report))
    })
}

/// All samples asked for, and the file that holds them.
fn samples(
    args: &SweepArgs,
    loaded: &Loaded,
    seed: u64,
    pool: &Pool,
) -> Result<(Vec<sweep::Row>, PathBuf), Exit> {
    let kind = args.controller.as_ref().map_or_else(String::new, |kind| format!(".{kind}"));
    let path = args.out.join(format!("{}{kind}.sweep.csv", loaded.name()));
    let mut store = Store::open(&path, loaded, seed, args.fresh).map_err(|error| match error {
        StoreError::Other { .. } | StoreError::Line { .. } => {
            complain(&format_args!("error: {error}"));
            Exit::Usage
        }
        StoreError::Io { .. } | StoreError::Busy { .. } => fail(&error),
    })?;
    let there = (store.rows().len() as u64).min(args.samples);
    let bar = progress::bar(!(args.quiet || args.json), there, args.samples);
    bar.set_message(loaded.name().to_owned());
    let ran = sweep::run(loaded, (seed, args.samples), (pool, &mut store), &interrupt::asked, |_| bar.inc(1));
    bar.finish_and_clear();
    ran.map(|rows| (rows, path)).map_err(|error| match &error {
        SweepError::Scenario { source, .. } => {
            complain(&format_args!("error: {error}\n{source}"));
            Exit::Usage
        }
        SweepError::Stopped { .. } => {
            complain(&format_args!("error: {error}; the same command goes on"));
            Exit::Failed
        }
        SweepError::Store(_) => fail(&error),
    })
}

fn fail(error: &dyn std::error::Error) -> Exit {
    complain(&format_args!("error: {}", with_causes(error)));
    Exit::Failed
}

/// How many failures are shown with their commands.
const SHOWN: usize = 5;

/// Heading, unit and factor of each quantity.
const ROWS: [(&str, &str, f64); sweep::QUANTITIES.len()] = [
    ("RMS error", "mm", 1e3),
    ("largest error", "mm", 1e3),
    ("ITAE, sum", "m s^2", 1.0),
    ("torque variation, sum", "N m/s", 1.0),
    ("saturated", "% of the periods", 100.0),
    ("largest speed", "m/s", 1.0),
];

/// The table of a sweep.
fn table(report: &Report) -> String {
    let Report { scenario, controller, samples, seed, .. } = report;
    let mut out = format!(
        "{scenario} with {controller}: {samples} samples of {} s, seed {seed}\n\n{:22} {:>11} {:>11} {:>21} {:>8}\n",
        short(report.duration_s),
        "",
        "median",
        "95 %",
        "worst of the finished",
        "sample"
    );
    let mut worst: BTreeMap<u64, (Vec<&str>, &str)> = BTreeMap::new();
    for (quantity, (name, unit, factor)) in report.statistics.iter().zip(ROWS) {
        let [median, most] = [quantity.median, quantity.percentile_95].map(|value| short(value * factor));
        let (value, sample) = quantity
            .worst
            .as_ref()
            .map_or(("-".to_owned(), "-".to_owned()), |w| (short(w.value * factor), w.sample.to_string()));
        let _ = writeln!(out, "{name:22} {median:>11} {most:>11} {value:>21} {sample:>8}  {unit}");
        if let Some(w) = &quantity.worst {
            worst.entry(w.sample).or_insert_with(|| (Vec::new(), &w.command)).0.push(name);
        }
    }
    let p = &report.failure_probability;
    let rule = report
        .fail_above_rmse_m
        .map_or_else(String::new, |bound| format!(" or above {} mm RMS", short(bound * 1e3)));
    let _ = write!(
        out,
        "\n{:22} {} of {samples} ended early{rule}: {} %, from {} to {} % with 95 % confidence\n{:22} {}\n",
        "failures",
        report.failures,
        short(p.share * 100.0),
        short(p.low * 100.0),
        short(p.high * 100.0),
        "samples",
        report.file
    );
    for (sample, (names, command)) in worst {
        let _ = write!(
            out,
            "\nsample {sample}, the worst of the finished by {}:\n  {command}\n",
            names.join(", ")
        );
    }
    for failure in report.failed.iter().take(SHOWN) {
        let how = match failure.ended {
            Ended::Finished => format!("RMS error {} mm", short(failure.rmse_m * 1e3)),
            Ended::Diverged => format!("diverged at t = {:.3} s", failure.simulated_s),
            Ended::Faulted => format!("fault at t = {:.3} s", failure.simulated_s),
            Ended::Refused => format!("input refused at t = {:.3} s", failure.simulated_s),
        };
        let _ = write!(out, "\nsample {} failed, {how}:\n  {}\n", failure.sample, failure.command);
    }
    let more = report.failed.len().saturating_sub(SHOWN);
    if more > 0 {
        let _ = write!(out, "\n{more} more failed, see {}\n", report.file);
    }
    out.trim_end().to_owned()
}
