//! Python bindings: the module `mmsim._mmsim`, which the package `mmsim` (in `python/`) makes pleasant.
//!
//! Nothing is computed here: arrays and dictionaries become the types of the stack and back.

mod arrays;
mod command;
mod controller;
mod errors;
mod fis;
mod json;
mod outside;
mod recording;
mod reproduce;
mod robot;
mod scenario;
mod simulate;
mod supervisor;
mod sweep;
mod trajectory;
mod tune;

/// The compiled part of the package `mmsim`.
#[pyo3::pymodule]
mod _mmsim {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::command::main;
    #[pymodule_export]
    use crate::controller::Controller;
    #[pymodule_export]
    use crate::errors::{ControlError, FuzzyError, ScenarioError};
    #[pymodule_export]
    use crate::fis::{Fis, Table};
    #[pymodule_export]
    use crate::reproduce::reproduce;
    #[pymodule_export]
    use crate::robot::Robot;
    #[pymodule_export]
    use crate::scenario::{Scenario, bundled};
    #[pymodule_export]
    use crate::simulate::{log_run, simulate};
    #[pymodule_export]
    use crate::supervisor::{Command, Supervisor};
    #[pymodule_export]
    use crate::sweep::{sample_edits, sweep_report, sweep_rows};
    #[pymodule_export]
    use crate::trajectory::Trajectory;
    #[pymodule_export]
    use crate::tune::tune;

    /// Adds the version of the linked stack as `__version__`.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", mm_sim::VERSION)
    }
}
