//! `mmsim.Controller`.

use mm_control::{ControlStack, ControlState, Input, Measurement, Output, Reference, WheelAngles};
use mm_sim::experiment;
use mm_sim::scenario::{self, Loaded};
use nalgebra::Vector3;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyString, PyTuple};

use crate::arrays::{Rows, configuration, of_torque, of_velocity, vector, velocity};
use crate::robot::{FRAME, Robot, of_force};
use crate::{errors, json};

/// Bytes of a state that are enough for any law.
const MOST_BYTES: usize = 8192;

/// A control stack and what it remembers: outer loop, law and limits, bit for bit those of firmware and simulator.
///
/// Parameters
/// ----------
/// robot : Robot
///     What the controller knows.
/// kind : str
///     ``"bfsmc"``, ``"bsmc"``, ``"bsmc-sat"``, ``"bfsmc-thesis"``, ``"ctc"``, ``"pid"``, ``"lqr"``, ``"smc-decentralized"``,
///     ``"backstepping-adaptive"`` or ``"super-twisting"``.
/// period_s : float
///     Time between two updates, s.
/// outer, supervisor : dict, optional
///     Keys of ``[controller.outer]`` and ``[controller.supervisor]``.
/// estimator : str or dict, optional
///     How ``update_measured`` finds the velocity: ``"observer"``, ``"filtered-difference"``, or a dict with ``kind`` and ``cutoff_hz``.
/// fis : str or os.PathLike, optional
///     A fuzzy system from a file, for the laws that have one.
/// **gains
///     Keys of ``[controller.gains]``, such as ``switching_gain=[...]``.
///
/// Raises
/// ------
/// ScenarioError
///     An unknown key, or gains that do not work together.
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> ctrl = mmsim.Controller(mmsim.Robot.thesis(), kind="bfsmc", period_s=1e-3)
/// >>> tau = ctrl.update([0, 0, 0, 0, 1, -2], [0, 0, 0, 0, 0], [0.6, 0.0, 0.5])
/// >>> tau.shape
/// (5,)
#[pyclass(module = "mmsim")]
#[derive(Debug, Clone)]
pub(crate) struct Controller {
    pub(crate) stack: ControlStack<f64, 3>,
    state: ControlState<f64, 3>,
    last: Option<Output<f64, 3>>,
    robot: Robot,
    /// Everything but the robot, as TOML.
    text: String,
    kind: String,
    period: f64,
}

/// The text of the tables below `[controller]`.
fn described(
    (kind, period): (&str, f64),
    tables: [(&str, Option<&Bound<'_, PyDict>>); 3],
    (estimator, fis): (Option<&Bound<'_, PyAny>>, Option<&Bound<'_, PyAny>>),
) -> PyResult<String> {
    let mut text = format!(
        "[simulation]\nduration_s = {period:?}\ncontrol_period_s = {period:?}\nplant_step_s = {period:?}\n\
         [controller]\nkind = {}\n",
        serde_json::Value::from(kind)
    );
    if let Some(fis) = fis {
        text += &format!("fis = {}\n", json::toml(fis, "fis")?);
    }
    if let Some(estimator) = estimator {
        let table = match estimator.cast::<PyString>() {
            Ok(kind) => format!("{{kind = {}}}", json::toml(kind, "estimator")?),
            Err(_) => json::toml(estimator, "estimator")?,
        };
        text += &format!("estimator = {table}\n");
    }
    for (name, table) in tables {
        text += &format!("[controller.{name}]\n");
        for (key, value) in table.into_iter().flatten() {
            let key = key.extract::<String>()?;
            if !value.is_none() {
                text += &format!("{key} = {}\n", json::toml(&value, &key)?);
            }
        }
    }
    Ok(text)
}

/// The scenario that a robot and the tables of a controller make.
fn loaded(py: Python<'_>, robot: &Robot, text: &str) -> PyResult<Loaded> {
    let text = format!("{FRAME}{text}{}", robot.toml());
    scenario::from_text("Controller(...)", &text, &[]).map_err(|error| errors::scenario(py, &error))
}

impl Controller {
    fn of(py: Python<'_>, robot: &Robot, text: String) -> PyResult<Self> {
        let loaded = loaded(py, robot, &text)?;
        let stack = experiment::stack(&loaded).map_err(|error| errors::scenario(py, &error))?;
        Ok(Self {
            state: stack.initial_state(),
            stack,
            last: None,
            robot: robot.clone(),
            text,
            kind: experiment::controller_name(loaded.file.controller.kind).to_owned(),
            period: loaded.file.simulation.control_period_s,
        })
    }

    /// The scenario that it was read from.
    pub(crate) fn loaded(&self, py: Python<'_>) -> PyResult<Loaded> {
        loaded(py, &self.robot, &self.text)
    }
}

/// A reference from its arrays; what is not given stands still.
pub(crate) fn reference(
    p_d: &Bound<'_, PyAny>,
    dp_d: Option<&Bound<'_, PyAny>>,
    ddp_d: Option<&Bound<'_, PyAny>>,
) -> PyResult<Reference<f64>> {
    let of = |array: Option<&Bound<'_, PyAny>>, name: &str| match array {
        Some(array) => Rows::<3>::of(array, name)?.one(name).map(Vector3::from),
        None => Ok(Vector3::zeros()),
    };
    Ok(Reference {
        position: of(Some(p_d), "p_d")?,
        velocity: of(dp_d, "dp_d")?,
        acceleration: of(ddp_d, "ddp_d")?,
    })
}

/// Positions as sensors read them.
pub(crate) fn measurement(
    q: &Bound<'_, PyAny>,
    wheels: Option<&Bound<'_, PyAny>>,
) -> PyResult<Measurement<f64, 3>> {
    let q = configuration(&Rows::<6>::of(q, "q")?.one("q")?);
    let wheels = wheels.map(|wheels| Rows::<2>::of(wheels, "wheels")?.one("wheels")).transpose()?;
    Ok(Measurement { q, wheels: wheels.map(|[right, left]| WheelAngles { right, left }) })
}

/// The outcomes of an update, by name.
pub(crate) fn outcomes<'py>(py: Python<'py>, status: &mm_control::Status) -> PyResult<Bound<'py, PyDict>> {
    let mm_control::Status { saturated, near_singular, speed_limited, joint_limited, beyond_joint_limit } =
        *status;
    let table = PyDict::new(py);
    table.set_item("saturated", saturated)?;
    table.set_item("near_singular", near_singular)?;
    table.set_item("speed_limited", speed_limited)?;
    table.set_item("joint_limited", joint_limited)?;
    table.set_item("beyond_joint_limit", beyond_joint_limit)?;
    Ok(table)
}

#[pymethods]
impl Controller {
    #[new]
    #[pyo3(signature = (robot, kind = "bfsmc", period_s = 1e-3, *, outer = None, estimator = None, supervisor = None, fis = None, **gains))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        py: Python<'_>,
        robot: &Robot,
        kind: &str,
        period_s: f64,
        outer: Option<&Bound<'_, PyDict>>,
        estimator: Option<&Bound<'_, PyAny>>,
        supervisor: Option<&Bound<'_, PyDict>>,
        fis: Option<&Bound<'_, PyAny>>,
        gains: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let tables = [("outer", outer), ("supervisor", supervisor), ("gains", gains)];
        Self::of(py, robot, described((kind, period_s), tables, (estimator, fis))?)
    }

    /// Torque for a state and a reference.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,)
    /// nu : array_like, shape (5,)
    /// p_d, dp_d, ddp_d : array_like, shape (3,)
    ///     Where the tip should be, m, and how that moves; zero where it is not given.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (5,)
    ///     (right, left, tau1, tau2, tau3), N m, within the limits of the robot.
    ///
    /// Raises
    /// ------
    /// ControlError
    ///     An input that is not finite; the controller is then as before.
    #[pyo3(signature = (q, nu, p_d, dp_d = None, ddp_d = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn update<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        nu: &Bound<'py, PyAny>,
        p_d: &Bound<'py, PyAny>,
        dp_d: Option<&Bound<'py, PyAny>>,
        ddp_d: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        if self.stack.estimates() {
            return Err(PyValueError::new_err(
                "this controller estimates the velocity: call update_measured",
            ));
        }
        let input = Input {
            q: configuration(&Rows::of(q, "q")?.one("q")?),
            nu: velocity(&Rows::of(nu, "nu")?.one("nu")?),
            reference: reference(p_d, dp_d, ddp_d)?,
        };
        let output = self.stack.update(&mut self.state, &input).map_err(|error| errors::refused(&error))?;
        let torque = of_torque(&output.torque);
        self.last = Some(output);
        Ok(vector(py, torque))
    }

    /// Torque for measured positions; the velocity is estimated.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,)
    /// p_d, dp_d, ddp_d : array_like, shape (3,)
    /// wheels : array_like, shape (2,), optional
    ///     Angles of the right and the left wheel, rad, where they have encoders.
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (5,)
    #[pyo3(signature = (q, p_d, dp_d = None, ddp_d = None, *, wheels = None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn update_measured<'py>(
        &mut self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        p_d: &Bound<'py, PyAny>,
        dp_d: Option<&Bound<'py, PyAny>>,
        ddp_d: Option<&Bound<'py, PyAny>>,
        wheels: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (measured, reference) = (measurement(q, wheels)?, reference(p_d, dp_d, ddp_d)?);
        let output = self.stack.update_measured(&mut self.state, &measured, &reference);
        let output = output.map_err(|error| errors::refused(&error))?;
        let torque = of_torque(&output.torque);
        self.last = Some(output);
        Ok(vector(py, torque))
    }

    /// Forgets everything that was learned and integrated.
    fn reset(&mut self) {
        self.state = self.stack.initial_state();
        self.last = None;
    }

    /// Outcomes of the last update: a dict of bools ``saturated``, ``near_singular``, ``speed_limited``, ``joint_limited``,
    /// ``beyond_joint_limit``; all false before the first.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        outcomes(py, &self.last.map_or_else(mm_control::Status::default, |output| output.status))
    }

    /// Signals of the last update, a dict of arrays: ``nu``, ``tip``, ``error``, ``nu_c``, ``nu_r``, ``dnu_r``, ``sliding``,
    /// ``equivalent``, ``fuzzy``, ``learned``, ``commanded``; None before the first.
    #[getter]
    fn signals<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some(output) = &self.last else { return Ok(None) };
        let s = &output.signals;
        let table = PyDict::new(py);
        table.set_item("nu", vector(py, of_velocity(&s.nu)))?;
        table.set_item("tip", vector(py, [s.tip.x, s.tip.y, s.tip.z]))?;
        table.set_item("error", vector(py, [s.error.x, s.error.y, s.error.z]))?;
        table.set_item("nu_c", vector(py, of_velocity(&s.nu_c)))?;
        table.set_item("nu_r", vector(py, of_velocity(&s.nu_r)))?;
        table.set_item("dnu_r", vector(py, of_velocity(&s.dnu_r)))?;
        table.set_item("sliding", vector(py, of_velocity(&s.sliding)))?;
        table.set_item("equivalent", vector(py, of_force(&s.equivalent)))?;
        table.set_item("fuzzy", vector(py, of_force(&s.fuzzy)))?;
        table.set_item("learned", vector(py, of_force(&s.learned)))?;
        table.set_item("commanded", vector(py, of_torque(&s.commanded)))?;
        Ok(Some(table))
    }

    /// Name of the law.
    #[getter]
    fn kind(&self) -> &str {
        &self.kind
    }

    /// Time between two updates, s.
    #[getter]
    const fn period_s(&self) -> f64 {
        self.period
    }

    /// The robot that it knows.
    #[getter]
    fn robot(&self) -> Robot {
        self.robot.clone()
    }

    fn __repr__(&self) -> String {
        format!("Controller(kind={:?}, period_s={})", self.kind, self.period)
    }

    /// What a pickle is read with.
    #[staticmethod]
    fn _restored(py: Python<'_>, robot: &Robot, text: String, state: &[u8]) -> PyResult<Self> {
        let mut controller = Self::of(py, robot, text)?;
        controller.state = postcard::from_bytes(state)
            .map_err(|_| PyValueError::new_err("the state of a controller of another version"))?;
        Ok(controller)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let this = slf.borrow();
        let mut room = vec![0; MOST_BYTES];
        let state = postcard::to_slice(&this.state, &mut room)
            .map_err(|error| PyValueError::new_err(format!("the state cannot be written: {error}")))?;
        let arguments = (this.robot.clone(), this.text.clone(), PyBytes::new(py, state));
        (slf.get_type().getattr("_restored")?, arguments).into_pyobject(py)
    }
}
