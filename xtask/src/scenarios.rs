//! Every bundled scenario, run as a user would: exit code 0, its `[expect]` met, and a supervisor that finds nothing in it.

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::mmsim::{Mmsim, Outcome};
use crate::shell::root;
use crate::table::{Table, number};
use crate::{parallel, shell};

/// Runs them all on all cores and prints a table.
pub(crate) fn run(mmsim: &Mmsim) -> Result<()> {
    let names = names()?;
    let outcomes = parallel::map(&names, |name| {
        let alone = mmsim.simulate(name, &[])?;
        let watched = if has_law_alone(&alone) { supervised(mmsim, name, &alone)? } else { Ok("-") };
        anyhow::Ok((alone, watched))
    });
    let mut table = Table::new(&[
        "scenario",
        "law",
        "ITAE sum, m s2",
        "max error, m",
        "torque TV, N m/s",
        "x real time",
        "supervised",
        "verdict",
    ]);
    let mut failures = Vec::new();
    for (name, outcome) in names.iter().zip(outcomes) {
        let (outcome, watched) = outcome?;
        let summary = outcome.summary.as_ref();
        let law = summary.and_then(|summary| summary.get("controller")?.as_str()).unwrap_or("-");
        table.add(vec![
            name.clone(),
            law.to_owned(),
            number(outcome.number("metrics.itae_m_s2.sum")),
            number(outcome.number("metrics.max_error_m")),
            number(outcome.number("metrics.torque_tv_n_m_per_s.sum")),
            number(outcome.number("real_time_factor")),
            watched.as_ref().map_or("differs", |word| *word).to_owned(),
            outcome.verdict(),
        ]);
        if let Err(found) = watched {
            failures.push(format!("{name} is not the same under a supervisor: {found}"));
        }
        if !outcome.is_good() {
            failures.push(format!("{name}: {}\n{}", outcome.verdict(), outcome.messages.trim_end()));
        }
    }
    table.print();
    for failure in &failures {
        println!("\n{failure}");
    }
    ensure!(failures.is_empty(), "{} of {} scenarios failed", failures.len(), names.len());
    Ok(())
}

/// Whether a law ran, and no supervisor yet.
fn has_law_alone(outcome: &Outcome) -> bool {
    outcome.summary.as_ref().is_some_and(|summary| {
        summary.get("controller").and_then(Value::as_str).is_some_and(|law| law != "none")
            && summary.get("supervisor").is_some_and(Value::is_null)
    })
}

/// Runs a scenario under a supervisor: it shall find nothing, and every bit be the same.
fn supervised(mmsim: &Mmsim, name: &str, alone: &Outcome) -> Result<Result<&'static str, String>> {
    let more = ["--set", "controller.supervisor.enabled=true"].map(str::to_owned);
    let watched = mmsim.simulate(name, &more)?;
    let part = |outcome: &Outcome, key: &str| outcome.summary.as_ref().and_then(|s| s.get(key)).cloned();
    let report = part(&watched, "supervisor").unwrap_or_default();
    let same = part(&watched, "digest").is_some() && part(&watched, "digest") == part(alone, "digest");
    let calm = report.get("mode").and_then(Value::as_str) == Some("run")
        && report.get("findings").and_then(Value::as_array).is_some_and(Vec::is_empty);
    Ok(if same && calm { Ok("same bits") } else { Err(format!("{report}\n{}", watched.messages.trim_end())) })
}

/// Names of the files in `scenarios/`, which are the bundled ones.
fn names() -> Result<Vec<String>> {
    let folder = root().join("scenarios");
    let mut names = Vec::new();
    for entry in std::fs::read_dir(&folder).context("no folder `scenarios`")? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "toml")
            && let Some(stem) = path.file_stem()
        {
            names.push(stem.to_string_lossy().into_owned());
        }
    }
    names.sort();
    ensure!(!names.is_empty(), "no scenario in {}", shell::relative(&folder));
    Ok(names)
}
