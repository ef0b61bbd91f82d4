//! `mmsim.Scenario`.

use mm_sim::experiment::{self, Experiment};
use mm_sim::scenario::{self, Loaded, Snapshot};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::robot::Robot;
use crate::trajectory::Trajectory;
use crate::{errors, json};

/// A scenario that was read and checked.
///
/// Parameters
/// ----------
/// spec : str or os.PathLike
///     A file, or the name of a bundled scenario (``mmsim.scenarios()``).
/// overrides : dict, optional
///     Dotted keys and their values, such as ``{"plant.mass_scale": 1.25}``.
/// controller : str, optional
///     Kind of the controller instead of the file's.
/// seed : int, optional
///     Seed of everything random.
///
/// Raises
/// ------
/// ScenarioError
///     Everything that is wrong, with ``file``, ``line``, ``column``, ``key``, ``expected`` and ``nearest``.
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> scenario = mmsim.Scenario("square", {"simulation.duration_s": 2.0})
/// >>> scenario.name, scenario.duration_s
/// ('square', 2.0)
#[pyclass(module = "mmsim", frozen)]
#[derive(Debug, Clone)]
pub(crate) struct Scenario {
    pub(crate) loaded: Loaded,
    pub(crate) experiment: Experiment,
}

impl Scenario {
    pub(crate) fn of(py: Python<'_>, loaded: Result<Loaded, scenario::ScenarioError>) -> PyResult<Self> {
        let built = loaded.and_then(|loaded| {
            let experiment = Experiment::build(&loaded)?;
            Ok(Self { loaded, experiment })
        });
        built.map_err(|error| errors::scenario(py, &error))
    }
}

fn edits(
    overrides: Option<&Bound<'_, PyDict>>,
    controller: Option<&str>,
    seed: Option<u64>,
) -> PyResult<Vec<String>> {
    let mut edits = json::edits(overrides, "")?;
    edits.extend(controller.map(|kind| format!("controller.kind={}", serde_json::Value::from(kind))));
    edits.extend(seed.map(|seed| format!("simulation.seed={seed}")));
    Ok(edits)
}

#[pymethods]
impl Scenario {
    #[new]
    #[pyo3(signature = (spec, overrides = None, *, controller = None, seed = None))]
    fn new(
        py: Python<'_>,
        spec: std::path::PathBuf,
        overrides: Option<&Bound<'_, PyDict>>,
        controller: Option<&str>,
        seed: Option<u64>,
    ) -> PyResult<Self> {
        let spec = spec.to_str().ok_or_else(|| PyValueError::new_err("spec: not a path in UTF-8"))?;
        Self::of(py, scenario::load(spec, &edits(overrides, controller, seed)?))
    }

    /// A scenario from its TOML text; ``name`` stands for the file in messages.
    #[staticmethod]
    #[pyo3(signature = (text, overrides = None, *, name = "scenario"))]
    fn from_text(
        py: Python<'_>,
        text: &str,
        overrides: Option<&Bound<'_, PyDict>>,
        name: &str,
    ) -> PyResult<Self> {
        Self::of(py, scenario::from_text(name, text, &json::edits(overrides, "")?))
    }

    /// The same scenario with more overrides laid over it.
    #[pyo3(signature = (overrides = None, *, controller = None, seed = None))]
    fn edited(
        &self,
        py: Python<'_>,
        overrides: Option<&Bound<'_, PyDict>>,
        controller: Option<&str>,
        seed: Option<u64>,
    ) -> PyResult<Self> {
        Self::of(py, self.loaded.edited(&edits(overrides, controller, seed)?))
    }

    /// The same scenario with edits ``KEY=VALUE`` laid over it.
    fn _with_edits(&self, py: Python<'_>, edits: Vec<String>) -> PyResult<Self> {
        Self::of(py, self.loaded.edited(&edits))
    }

    /// Overrides that were laid over the file, ``KEY=VALUE`` each.
    #[getter]
    fn edits(&self) -> Vec<String> {
        self.loaded.edits().to_vec()
    }

    /// Runs that tuning it takes, as far as ``[tune]`` says.
    #[getter]
    fn tune_runs(&self) -> u64 {
        let tune = &self.loaded.file.tune;
        u64::from(tune.particles) * u64::from(tune.iterations)
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        self.loaded.name()
    }

    /// Text of its file, without overrides.
    #[getter]
    fn text(&self) -> &str {
        self.loaded.text()
    }

    /// Kind of its controller.
    #[getter]
    fn controller(&self) -> &'static str {
        experiment::controller_name(self.loaded.file.controller.kind)
    }

    /// Duration, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.experiment.clock().duration()
    }

    /// Seed of everything random.
    #[getter]
    fn seed(&self) -> u64 {
        self.loaded.file.simulation.seed
    }

    /// The robot that its controller knows.
    #[getter]
    fn robot(&self, py: Python<'_>) -> PyResult<Robot> {
        let model = experiment::robot(&self.loaded).map_err(|error| errors::scenario(py, &error))?;
        Ok(Robot { model })
    }

    /// The motion of its reference.
    #[getter]
    fn trajectory(&self, py: Python<'_>) -> PyResult<Trajectory> {
        Trajectory::of(py, self)
    }

    fn __repr__(&self) -> String {
        format!(
            "Scenario({:?}, controller={:?}, duration_s={})",
            self.name(),
            self.controller(),
            self.duration_s()
        )
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.loaded.snapshot() == other.loaded.snapshot()
    }

    /// What a pickle is read with.
    #[staticmethod]
    fn _restored(py: Python<'_>, text: &str) -> PyResult<Self> {
        let snapshot: Snapshot =
            serde_json::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
        Self::of(py, snapshot.restore())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let text = serde_json::to_string(&slf.get().loaded.snapshot());
        let text = text.map_err(|error| PyValueError::new_err(error.to_string()))?;
        (slf.get_type().getattr("_restored")?, (text,)).into_pyobject(slf.py())
    }
}

/// Names and texts of the bundled scenarios, a dict.
#[pyfunction]
pub(crate) fn bundled(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for (name, text) in scenario::bundled() {
        all.set_item(name, text)?;
    }
    Ok(all)
}

/// TOML as Python's own objects.
pub(crate) fn parsed_toml<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    let table: toml::Table =
        toml::from_str(text).map_err(|error| PyValueError::new_err(error.to_string()))?;
    json::of(py, &table)
}
