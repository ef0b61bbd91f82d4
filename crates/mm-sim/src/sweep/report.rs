//! What a sweep found: the object of `--json`.

use serde::Serialize;

use super::{Ended, Interval, QUANTITIES, Row, clopper_pearson, edits, quantile};
use crate::VERSION;
use crate::experiment::controller_name;
use crate::scenario::Loaded;
use crate::shell;

/// Name and version of the report's format.
pub const SCHEMA: &str = "mmsim.sweep/1";

/// Results of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Name and version of this format.
    pub schema: &'static str,
    /// Version of the stack.
    pub version: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the controller.
    pub controller: &'static str,
    /// Duration of the scenario, s.
    pub duration_s: f64,
    /// Seed of the sweep.
    pub seed: u64,
    /// Samples judged.
    pub samples: u64,
    /// RMS error above which a sample failed, m; none without a bound.
    pub fail_above_rmse_m: Option<f64>,
    /// Samples that failed.
    pub failures: u64,
    /// Probability of failure with its two-sided 95 % Clopper-Pearson bounds.
    pub failure_probability: Interval,
    /// Statistics of each quantity.
    pub statistics: Vec<Quantity>,
    /// The samples that failed.
    pub failed: Vec<Failure>,
    /// The file of samples.
    pub file: String,
}

/// Statistics of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Quantity {
    /// Its name in the summary of a run.
    pub name: &'static str,
    /// What half of the samples do not exceed; null where a sample that ended early would have to be counted.
    pub median: f64,
    /// What 95 % of the samples do not exceed; null likewise.
    pub percentile_95: f64,
    /// The worst of the samples that finished; none if none did.
    pub worst: Option<Worst>,
}

/// A sample with the worst value.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Worst {
    /// The value.
    pub value: f64,
    /// Number of the sample.
    pub sample: u64,
    /// Its seed.
    pub seed: u64,
    /// The command that runs it again.
    pub command: String,
}

/// A sample that failed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Failure {
    /// Number of the sample.
    pub sample: u64,
    /// Its seed.
    pub seed: u64,
    /// How it ended: a sample that finished failed by its RMS error.
    pub ended: Ended,
    /// When, s.
    pub simulated_s: f64,
    /// Its RMS error up to there, m.
    pub rmse_m: f64,
    /// The command that runs it again.
    pub command: String,
}

impl Report {
    /// Judges the samples of a sweep. `again` are the arguments of `mmsim` that run the scenario without a sample's edits.
    #[must_use]
    pub fn of(loaded: &Loaded, seed: u64, rows: &[Row], again: &[String], file: String) -> Self {
        let bound = loaded.file.sweep.fail_above_rmse_m;
        let command = |row: &Row| command(again, &edits(&loaded.file, seed, row.sample));
        let has_failed =
            |row: &&Row| row.ended != Ended::Finished || bound.is_some_and(|bound| !(rmse(row) <= bound));
        let failed: Vec<Failure> = rows
            .iter()
            .filter(has_failed)
            .map(|row| Failure {
                sample: row.sample,
                seed: row.seed,
                ended: row.ended,
                simulated_s: row.simulated_s,
                rmse_m: rmse(row),
                command: command(row),
            })
            .collect();
        let (failures, samples) = (failed.len() as u64, rows.len() as u64);
        let statistics =
            QUANTITIES.iter().enumerate().map(|(index, name)| statistics(name, index, rows, &command));
        Self {
            schema: SCHEMA,
            version: VERSION,
            scenario: loaded.name().to_owned(),
            controller: controller_name(loaded.file.controller.kind),
            duration_s: loaded.file.simulation.duration_s,
            seed,
            samples,
            fail_above_rmse_m: bound,
            failures,
            failure_probability: clopper_pearson(failures, samples),
            statistics: statistics.collect(),
            failed,
            file,
        }
    }

    /// The report as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

const fn rmse(row: &Row) -> f64 {
    let [rmse, ..] = row.values;
    rmse
}

/// Statistics of the quantity at a place of a row; a sample that ended early counts as worse than any other.
fn statistics(name: &'static str, index: usize, rows: &[Row], command: &dyn Fn(&Row) -> String) -> Quantity {
    let value = |row: &Row| row.values.get(index).copied().unwrap_or(f64::NAN);
    let finished = |row: &Row| row.ended == Ended::Finished;
    let values: Vec<f64> =
        rows.iter().map(|row| if finished(row) { value(row) } else { f64::INFINITY }).collect();
    // The first of equals, whatever the order of the comparison.
    let worst =
        rows.iter().filter(|row| finished(row)).reduce(|a, b| if value(b) > value(a) { b } else { a });
    Quantity {
        name,
        median: quantile(&values, 50).unwrap_or(f64::NAN),
        percentile_95: quantile(&values, 95).unwrap_or(f64::NAN),
        worst: worst.map(|row| Worst {
            value: value(row),
            sample: row.sample,
            seed: row.seed,
            command: command(row),
        }),
    }
}

/// The command line that runs a sample again.
fn command(again: &[String], edits: &[String]) -> String {
    let sets = edits.iter().flat_map(|edit| ["--set", edit]);
    shell::command(["mmsim"].into_iter().chain(again.iter().map(String::as_str)).chain(sets))
}
