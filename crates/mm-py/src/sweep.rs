//! Samples of sweeps: work for any executor.

use mm_sim::parallel::Pool;
use mm_sim::sweep::{self, Ended, QUANTITIES, Report, Row, SweepError};
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};
use pyo3::prelude::*;

use crate::scenario::Scenario;
use crate::tune::interruptible;
use crate::{errors, json};

/// A sample as it travels: number, seed, how it ended, time simulated, quantities, digest.
type Travelling = (u64, u64, String, f64, [f64; QUANTITIES.len()], String);

/// The edits of a sample, ``KEY=VALUE`` each.
#[pyfunction]
pub(crate) fn sample_edits(scenario: &Scenario, seed: u64, sample: u64) -> Vec<String> {
    sweep::edits(&scenario.loaded.file, seed, sample)
}

/// Runs the samples from ``first`` up to ``end`` on so many threads; a list of tuples in their order.
#[pyfunction]
#[pyo3(signature = (scenario, seed, first, end, jobs = Some(1), progress = None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn sweep_rows(
    py: Python<'_>,
    scenario: &Scenario,
    seed: u64,
    first: u64,
    end: u64,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Vec<Travelling>> {
    let pool = Pool::new(jobs).map_err(|error| errors::system(&error))?;
    let mut rows = Vec::new();
    let ran = interruptible(py, progress.as_ref(), |stop, done| {
        sweep::samples(&scenario.loaded, seed, first..end, (&pool, stop), |row| {
            rows.push(travelling(row));
            done.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            Ok(())
        })
    })?;
    ran.map_err(|error| match &error {
        SweepError::Scenario { source, .. } => errors::scenario(py, source),
        SweepError::Stopped { .. } => PyKeyboardInterrupt::new_err(error.to_string()),
        SweepError::Store(_) => errors::system(&error),
    })?;
    Ok(rows)
}

fn travelling(row: Row) -> Travelling {
    let Row { sample, seed, ended, simulated_s, values, digest } = row;
    (sample, seed, ended.name().to_owned(), simulated_s, values, digest)
}

/// What the samples of a sweep show: the object of ``mmsim sweep --json``; ``again`` are the arguments that run the scenario.
#[pyfunction]
pub(crate) fn sweep_report<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    seed: u64,
    rows: Vec<Travelling>,
    again: Vec<String>,
) -> PyResult<Bound<'py, PyAny>> {
    let row = |(sample, seed, ended, simulated_s, values, digest): Travelling| {
        let ended = Ended::from_name(&ended)
            .ok_or_else(|| PyValueError::new_err(format!("no way for a run to end: {ended:?}")))?;
        Ok(Row { sample, seed, ended, simulated_s, values, digest })
    };
    let rows = rows.into_iter().map(row).collect::<PyResult<Vec<_>>>()?;
    json::of(py, &Report::of(&scenario.loaded, seed, &rows, &again, String::new()))
}
