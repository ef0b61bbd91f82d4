//! Errors of the stack as exceptions that carry what they know.

use mm_sim::scenario;
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

pyo3::create_exception!(
    mmsim,
    ScenarioError,
    PyValueError,
    "A scenario, robot or controller is not as it should be.\n\n\
     Attributes of the first problem: ``file``, ``line``, ``column`` (None without a place), ``key``, ``expected``, ``nearest``;\n\
     all of them in ``problems``, a list of dicts."
);
pyo3::create_exception!(
    mmsim,
    FuzzyError,
    PyValueError,
    "A fuzzy system cannot be read, evaluated or compiled.\n\nAttributes ``file``, ``line``, ``column`` where there is a place."
);
pyo3::create_exception!(
    mmsim,
    ControlError,
    PyRuntimeError,
    "A controller refused its input; its state is as before."
);

/// A scenario that is wrong, with all its problems.
pub(crate) fn scenario(py: Python<'_>, error: &scenario::ScenarioError) -> PyErr {
    let exception = ScenarioError::new_err(error.to_string());
    match described(py, &exception, error) {
        Ok(()) => exception,
        Err(other) => other,
    }
}

fn described(py: Python<'_>, exception: &PyErr, error: &scenario::ScenarioError) -> PyResult<()> {
    let problems = pyo3::types::PyList::empty(py);
    for problem in error.problems() {
        let place = error.location(problem);
        let entry = pyo3::types::PyDict::new(py);
        entry.set_item("file", place.map(|(file, _, _)| file))?;
        entry.set_item("line", place.map(|(_, line, _)| line))?;
        entry.set_item("column", place.map(|(_, _, column)| column))?;
        entry.set_item("key", problem.key())?;
        entry.set_item("message", problem.message())?;
        entry.set_item("expected", problem.expected_text())?;
        entry.set_item("nearest", problem.nearest_name())?;
        problems.append(entry)?;
    }
    let value = exception.value(py);
    if let Ok(first) = problems.get_item(0) {
        for name in ["file", "line", "column", "key", "expected", "nearest"] {
            value.setattr(name, first.get_item(name)?)?;
        }
    }
    value.setattr("problems", problems)
}

/// Another error of the stack, with its causes.
pub(crate) fn with_causes(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(error.source(), |&cause| cause.source());
    causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}

/// A fuzzy system that is wrong.
pub(crate) fn fuzzy(error: &dyn std::error::Error) -> PyErr {
    FuzzyError::new_err(with_causes(error))
}

/// An input that a controller refused.
pub(crate) fn refused(error: &mm_control::ControlError) -> PyErr {
    ControlError::new_err(error.to_string())
}

/// A file or a thread that the system does not give.
pub(crate) fn system(error: &dyn std::error::Error) -> PyErr {
    pyo3::exceptions::PyOSError::new_err(with_causes(error))
}
