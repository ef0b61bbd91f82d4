//! The command `mmsim`, the same as the one without Python.

use pyo3::prelude::*;

/// Runs the command with arguments, the first being its name; the exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| mm_sim::cli::main_with(arguments) as u8)
}
