//! Tuning, and long work that Ctrl-C ends.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

use mm_sim::experiment::law_kind;
use mm_sim::parallel::Pool;
use mm_sim::tune::{Gain, Trial, TuneError, Tuned, to_toml, tune as search};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::scenario::Scenario;
use crate::{errors, json};

/// How often the interpreter is asked.
const ASKED_EVERY: Duration = Duration::from_millis(50);

/// Work that asks whether to stop and counts what it has done.
type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

/// Does work on another thread, while this one asks the interpreter for interrupts and tells it the progress.
pub(crate) fn interruptible<R: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(Stop<'_>, &AtomicU64) -> R + Send,
) -> PyResult<R> {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    py.detach(|| {
        std::thread::scope(|scope| {
            let (sender, receiver) = mpsc::channel();
            let (stop, done) = (&stop, &done);
            scope.spawn(move || {
                // The other end waits until it has this.
                let _ = sender.send(work(&|| stop.load(Ordering::Relaxed), done));
            });
            let mut raised = None;
            loop {
                match receiver.recv_timeout(ASKED_EVERY) {
                    Ok(result) => return raised.map_or(Ok(result), Err),
                    Err(RecvTimeoutError::Disconnected) => {
                        return Err(PyRuntimeError::new_err("the work ended without a result"));
                    }
                    Err(RecvTimeoutError::Timeout) if raised.is_some() => {}
                    Err(RecvTimeoutError::Timeout) => {
                        let asked = Python::attach(|py| {
                            py.check_signals()?;
                            let count = done.load(Ordering::Relaxed);
                            progress.map_or(Ok(()), |progress| progress.call1(py, (count,)).map(|_| ()))
                        });
                        raised = asked.err();
                        stop.store(raised.is_some(), Ordering::Relaxed);
                    }
                }
            }
        })
    })
}

/// Tunes the controller of a scenario: a dict of gains, costs, metrics and digest.
#[pyfunction]
#[pyo3(signature = (scenario, seed = None, jobs = None, progress = None))]
pub(crate) fn tune<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    seed: Option<u64>,
    jobs: Option<usize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let Scenario { loaded, experiment } = scenario;
    let law = law_kind(loaded.file.controller.kind)
        .ok_or_else(|| PyValueError::new_err("imposed velocities have no gains"))?;
    let seed = seed.unwrap_or(loaded.file.tune.seed);
    let pool = Pool::new(jobs).map_err(|error| errors::system(&error))?;
    let tuned = interruptible(py, progress.as_ref(), |stop, done| {
        search((loaded, experiment), (law, seed), &pool, stop, |more| {
            done.fetch_add(more, Ordering::Relaxed);
        })
    })?;
    let tuned = tuned.map_err(|error| match error {
        TuneError::Stopped => PyKeyboardInterrupt::new_err(error.to_string()),
        TuneError::NothingToTune { .. } => PyValueError::new_err(error.to_string()),
        TuneError::NoneFinished { .. } => PyRuntimeError::new_err(error.to_string()),
    })?;
    let command =
        format!("mmsim tune --scenario {} --controller {} --seed {seed}", loaded.name(), law.name());
    let toml = to_toml(&command, loaded, seed, &[(law, Ok(tuned.clone()))]);
    described(py, &tuned, &toml)
}

fn described<'py>(py: Python<'py>, tuned: &Tuned, toml: &str) -> PyResult<Bound<'py, PyDict>> {
    let Tuned { law, factors, gains, trial: Trial { cost, result }, default_cost, given_cost, .. } = tuned;
    let table = PyDict::new(py);
    let values = PyDict::new(py);
    for (key, gain) in gains {
        match gain {
            Gain::One(value) => values.set_item(key, value)?,
            Gain::Each(list) => values.set_item(key, list.to_vec())?,
        }
    }
    table.set_item("controller", law.name())?;
    table.set_item("factors", factors)?;
    table.set_item("gains", values)?;
    table.set_item("cost", cost)?;
    table.set_item("default_cost", default_cost)?;
    table.set_item("given_cost", given_cost)?;
    let (metrics, digest) =
        result.as_ref().map_or((None, None), |(metrics, digest)| (Some(metrics), Some(digest)));
    table.set_item("metrics", metrics.map(|metrics| json::of(py, metrics)).transpose()?)?;
    table.set_item("digest", digest)?;
    table.set_item("toml", toml)?;
    Ok(table)
}
