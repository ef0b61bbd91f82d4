//! Every bundled scenario, run as a user would: exit code 0, its `[expect]` met.

use anyhow::{Context, Result, ensure};

use crate::mmsim::Mmsim;
use crate::shell::root;
use crate::table::{Table, number};
use crate::{parallel, shell};

/// Runs them all on all cores and prints a table.
pub(crate) fn run(mmsim: &Mmsim) -> Result<()> {
    let names = names()?;
    let outcomes = parallel::map(&names, |name| mmsim.simulate(name, &[]));
    let mut table = Table::new(&[
        "scenario",
        "law",
        "ITAE sum, m s2",
        "max error, m",
        "torque TV, N m/s",
        "x real time",
        "verdict",
    ]);
    let mut failures = Vec::new();
    for (name, outcome) in names.iter().zip(outcomes) {
        let outcome = outcome?;
        let summary = outcome.summary.as_ref();
        let law = summary.and_then(|summary| summary.get("controller")?.as_str()).unwrap_or("-");
        table.add(vec![
            name.clone(),
            law.to_owned(),
            number(outcome.number("metrics.itae_m_s2.sum")),
            number(outcome.number("metrics.max_error_m")),
            number(outcome.number("metrics.torque_tv_n_m_per_s.sum")),
            number(outcome.number("real_time_factor")),
            outcome.verdict(),
        ]);
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
