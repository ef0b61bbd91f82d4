//! `mmsim compare`: one scenario, several controllers, one table.

use std::collections::BTreeSet;
use std::path::PathBuf;

use clap::CommandFactory as _;
use clap::error::ErrorKind;
use serde::Serialize;

use super::run::{Ran, complain_of, execute, log_path, prepare, with_causes};
use super::{Cli, CompareArgs, Exit, complain, print, table};
use crate::experiment::Experiment;
use crate::metrics::PerAxisSum;
use crate::parallel::Pool;
use crate::scenario::Loaded;
use crate::summary::Summary;

/// The `--json` object of a comparison.
#[derive(Debug, Serialize)]
struct Comparison<'a> {
    runs: &'a [Summary],
    #[serde(skip_serializing_if = "Option::is_none")]
    improvement_percent: Option<PerAxisSum>,
}

/// Runs the scenario with each controller, on as many cores as there are.
pub(super) fn compare(args: &CompareArgs) -> Result<Exit, clap::Error> {
    let common = &args.common;
    let spec = common.scenario()?;
    common.refuse_stdout("is for one run")?;
    if let Some(kind) = named_twice(&args.controllers) {
        // Two runs at once would write one log.
        let message = format!("controller `{kind}` is named twice in --controllers");
        return Err(Cli::command().error(ErrorKind::ValueValidation, message));
    }
    let mut prepared = Vec::new();
    for kind in &args.controllers {
        match prepare(spec, &common.sets(Some(kind.trim()))) {
            Ok(ready) => prepared.push(ready),
            Err(exit) => return Ok(exit),
        }
    }
    let jobs: Vec<(&(Loaded, Experiment), Option<PathBuf>)> = prepared
        .iter()
        .zip(&args.controllers)
        .map(|(ready, kind)| {
            let name = format!("{}.{}", ready.0.name(), kind.trim());
            (ready, (!common.no_log).then(|| log_path(&common.out, &name)))
        })
        .collect();
    let mut runs = Vec::new();
    let mut endings = Vec::new();
    let mut exit = Exit::Done;
    let pool = match Pool::new(None) {
        Ok(pool) => pool,
        Err(error) => {
            complain(&format_args!("error: {}", with_causes(&error)));
            return Ok(Exit::Failed);
        }
    };
    for outcome in pool.map(&jobs, |(ready, log)| execute(ready, log.clone(), false)) {
        match outcome {
            Ok(Ran { summary, exit: ended, .. }) => {
                exit = exit.max(ended);
                endings.push(ended);
                runs.push(summary);
            }
            Err(failed) => exit = exit.max(failed),
        }
    }
    // Runs that ended early cannot be compared: their integrals cover less time.
    let improvement_percent = if exit == Exit::Done { improvement(&runs) } else { None };
    if common.json {
        let comparison = Comparison { runs: &runs, improvement_percent };
        exit = exit.max(print(&serde_json::to_string(&comparison).unwrap_or_default()));
    } else if !common.quiet {
        exit = exit.max(print(&table::comparison(&runs, improvement_percent, !common.sets(None).is_empty())));
    }
    for (run, ended) in runs.iter().zip(endings) {
        complain_of(run, ended, &format!("{}: ", run.controller));
    }
    Ok(exit)
}

/// The first controller that the list has a second time.
fn named_twice(kinds: &[String]) -> Option<&str> {
    let mut seen = BTreeSet::new();
    kinds.iter().map(|kind| kind.trim()).find(|kind| !seen.insert(*kind))
}

/// (BSMC - BFSMC)/BSMC x 100 of the ITAE, the form behind Table 5.2; (5.8) as printed divides by BFSMC.
fn improvement(runs: &[Summary]) -> Option<PerAxisSum> {
    let itae = |name: &str| runs.iter().find(|run| run.controller == name).map(|run| run.metrics.itae_m_s2);
    let (before, after) = (itae("bsmc")?, itae("bfsmc")?);
    let percent = |b: f64, a: f64| (b - a) / b * 100.0;
    Some(PerAxisSum {
        x: percent(before.x, after.x),
        y: percent(before.y, after.y),
        z: percent(before.z, after.z),
        sum: percent(before.sum, after.sum),
    })
}
