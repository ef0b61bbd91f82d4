//! The experiments of the thesis.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use mm_sim::reproduce::{Options, Plan, ReproduceError, Watch};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::tune::interruptible;
use crate::{errors, json};

/// Runs all experiments of the thesis and writes their figures: the object of ``mmsim reproduce --json``.
#[pyfunction]
#[pyo3(signature = (out, jobs = 0, overrides = None, progress = None))]
pub(crate) fn reproduce<'py>(
    py: Python<'py>,
    out: PathBuf,
    jobs: usize,
    overrides: Option<&Bound<'_, PyDict>>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let sets = json::edits(overrides, "")?;
    let plan = Plan::new(&Options { jobs, sets }).map_err(|error| errors::scenario(py, &error))?;
    let ran = interruptible(py, progress.as_ref(), |stop, done| plan.run(&out, &Watched { stop, done }))?;
    let report = ran.map_err(|error| match error {
        ReproduceError::Interrupted => PyKeyboardInterrupt::new_err("interrupted"),
        error => errors::system(&error),
    })?;
    json::of(py, &report)
}

struct Watched<'a> {
    stop: &'a (dyn Fn() -> bool + Sync),
    done: &'a AtomicU64,
}

impl Watch for Watched<'_> {
    fn goes_on(&self) -> bool {
        !(self.stop)()
    }

    fn done(&self, _what: &str) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }
}
