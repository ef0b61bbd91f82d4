//! `mmsim.Supervisor`.

use mm_control::supervisor::Findings;
use mm_control::{Command as Commanded, Input, SupervisedStack, SupervisedState, Timing};
use mm_sim::experiment;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Rows, configuration, of_torque, vector, velocity};
use crate::controller::{Controller, measurement, outcomes, reference};
use crate::errors;

/// A controller behind checks of what arrives: a torque within the limits, whatever comes in.
///
/// Run, hold (the last torque, two periods), stop (braking), fault (no torque, brakes). Limits are those given to the controller as
/// ``supervisor``, the rest follows from the robot.
///
/// Parameters
/// ----------
/// controller : Controller
///     Its stack; the supervisor begins with nothing learned.
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> ctrl = mmsim.Controller(mmsim.Robot.thesis())
/// >>> supervised = mmsim.Supervisor(ctrl)
/// >>> command = supervised.update([float("nan")] * 6, [0] * 5, [0.6, 0, 0.5])
/// >>> command.mode, command.findings
/// ('hold', ['state-not-finite'])
#[pyclass(module = "mmsim")]
#[derive(Debug, Clone)]
pub(crate) struct Supervisor {
    stack: SupervisedStack<f64, 3>,
    state: SupervisedState<f64, 3>,
    period: f64,
}

/// What a supervisor commands.
///
/// Attributes
/// ----------
/// torque : numpy.ndarray, shape (5,)
///     Within the limits; N m.
/// mode : str
///     ``"run"``, ``"hold"``, ``"stop"`` or ``"fault"``.
/// findings : list of str
///     What was wrong with the input.
/// brake : bool
///     Whether the brakes are to be on.
/// status : dict
///     Outcomes of the controller, None where it did not run.
#[pyclass(module = "mmsim", frozen)]
#[derive(Debug, Clone)]
pub(crate) struct Command(Commanded<f64, 3>);

#[pymethods]
impl Command {
    #[getter]
    fn torque<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, of_torque(&self.0.torque))
    }

    #[getter]
    const fn mode(&self) -> &'static str {
        self.0.mode.name()
    }

    #[getter]
    fn findings(&self) -> Vec<&'static str> {
        let all = Findings::ALL.into_iter();
        all.filter(|(finding, _)| self.0.findings.contains(*finding)).map(|(_, name)| name).collect()
    }

    #[getter]
    const fn brake(&self) -> bool {
        self.0.brake
    }

    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        self.0.output.as_ref().map(|output| outcomes(py, &output.status)).transpose()
    }

    fn __repr__(&self) -> String {
        format!(
            "Command(mode={:?}, torque={:?}, findings={:?})",
            self.mode(),
            of_torque(&self.0.torque),
            self.findings()
        )
    }
}

impl Supervisor {
    fn timing(&self, elapsed: Option<f64>, age: f64) -> Timing<f64> {
        Timing { elapsed: elapsed.unwrap_or(self.period), age }
    }
}

#[pymethods]
impl Supervisor {
    #[new]
    fn new(py: Python<'_>, controller: &Controller) -> PyResult<Self> {
        let loaded = controller.loaded(py)?;
        let stack = experiment::supervised(&loaded).map_err(|error| errors::scenario(py, &error))?;
        Ok(Self { state: stack.initial_state(), stack, period: loaded.file.simulation.control_period_s })
    }

    /// Command for a state and a reference, whatever they are.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,)
    /// nu : array_like, shape (5,)
    /// p_d, dp_d, ddp_d : array_like, shape (3,)
    /// elapsed_s : float, optional
    ///     Time since the last update, s; the period where it is not given.
    /// age_s : float
    ///     Age of the state, s.
    ///
    /// Returns
    /// -------
    /// Command
    #[pyo3(signature = (q, nu, p_d, dp_d = None, ddp_d = None, *, elapsed_s = None, age_s = 0.0))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn update(
        &mut self,
        q: &Bound<'_, PyAny>,
        nu: &Bound<'_, PyAny>,
        p_d: &Bound<'_, PyAny>,
        dp_d: Option<&Bound<'_, PyAny>>,
        ddp_d: Option<&Bound<'_, PyAny>>,
        elapsed_s: Option<f64>,
        age_s: f64,
    ) -> PyResult<Command> {
        let input = Input {
            q: configuration(&Rows::of(q, "q")?.one("q")?),
            nu: velocity(&Rows::of(nu, "nu")?.one("nu")?),
            reference: reference(p_d, dp_d, ddp_d)?,
        };
        let timing = self.timing(elapsed_s, age_s);
        Ok(Command(self.stack.update(&mut self.state, timing, &input)))
    }

    /// Command for measured positions; the velocity is estimated.
    #[pyo3(signature = (q, p_d, dp_d = None, ddp_d = None, *, wheels = None, elapsed_s = None, age_s = 0.0))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn update_measured(
        &mut self,
        q: &Bound<'_, PyAny>,
        p_d: &Bound<'_, PyAny>,
        dp_d: Option<&Bound<'_, PyAny>>,
        ddp_d: Option<&Bound<'_, PyAny>>,
        wheels: Option<&Bound<'_, PyAny>>,
        elapsed_s: Option<f64>,
        age_s: f64,
    ) -> PyResult<Command> {
        let (measured, reference) = (measurement(q, wheels)?, reference(p_d, dp_d, ddp_d)?);
        let timing = self.timing(elapsed_s, age_s);
        Ok(Command(self.stack.update_measured(&mut self.state, timing, &measured, &reference)))
    }

    /// Command where no input arrived in time.
    #[pyo3(signature = (elapsed_s = None))]
    fn missed(&mut self, elapsed_s: Option<f64>) -> Command {
        Command(self.stack.missed(&mut self.state, elapsed_s.unwrap_or(self.period)))
    }

    /// Ends a fault: a new state, nothing learned.
    fn reset(&mut self) {
        self.stack.reset(&mut self.state);
    }

    /// Mode after the last update.
    #[getter]
    const fn mode(&self) -> &'static str {
        self.state.mode().name()
    }

    fn __repr__(&self) -> String {
        format!("Supervisor(mode={:?})", self.mode())
    }
}
