//! `mmsim.Trajectory`.

use mm_sim::experiment;
use mm_sim::trajectory::Trajectory as Motion;
use numpy::{PyArrayDyn, PyArrayMethods as _, PyUntypedArrayMethods as _, get_array_module};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::reshaped;
use crate::errors;
use crate::scenario::Scenario;

/// Motion of the tip that a scenario asks for: position, velocity, acceleration at any time.
///
/// Parameters
/// ----------
/// scenario : Scenario
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> p, dp, ddp = mmsim.Trajectory(mmsim.Scenario("square")).at([0.0, 1.0])
/// >>> p.shape
/// (2, 3)
#[pyclass(module = "mmsim", frozen)]
#[derive(Debug, Clone)]
pub(crate) struct Trajectory {
    motion: Motion,
    scenario: Scenario,
}

/// Position, velocity and acceleration.
type Arrays<'py> = [Bound<'py, PyArrayDyn<f64>>; 3];

impl Trajectory {
    pub(crate) fn of(py: Python<'_>, scenario: &Scenario) -> PyResult<Self> {
        let motion = experiment::reference(&scenario.loaded).map_err(|error| errors::scenario(py, &error))?;
        Ok(Self { motion, scenario: scenario.clone() })
    }
}

#[pymethods]
impl Trajectory {
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario) -> PyResult<Self> {
        Self::of(py, scenario)
    }

    /// Position, velocity and acceleration at a time or many.
    ///
    /// Parameters
    /// ----------
    /// t : float or array_like, shape (k,)
    ///     Time, s.
    ///
    /// Returns
    /// -------
    /// tuple of three numpy.ndarray, shape (3,) or (k, 3)
    ///     m, m/s, m/s^2.
    fn at<'py>(&self, py: Python<'py>, t: &Bound<'py, PyAny>) -> PyResult<Arrays<'py>> {
        let times = get_array_module(py)?.call_method1("asarray", (t, "float64"))?;
        let times = times.cast_into::<PyArrayDyn<f64>>()?;
        let shape: Vec<usize> = times.shape().iter().copied().chain([3]).collect();
        if shape.len() > 2 {
            return Err(PyValueError::new_err("t: expected a number or shape (k,)"));
        }
        let times = times.to_vec()?;
        let mut parts = [const { Vec::new() }; 3];
        for t in times {
            let r = self.motion.at(t);
            for (part, v) in parts.iter_mut().zip([r.position, r.velocity, r.acceleration]) {
                part.extend([v.x, v.y, v.z]);
            }
        }
        let [p, dp, ddp] = parts;
        Ok([reshaped(py, p, &shape)?, reshaped(py, dp, &shape)?, reshaped(py, ddp, &shape)?])
    }

    fn __repr__(&self) -> String {
        format!("Trajectory({})", self.scenario.loaded.name())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, pyo3::types::PyType>, (Scenario,)) {
        (slf.get_type(), (slf.get().scenario.clone(),))
    }
}
