//! Controllers and plants that are written in Python.

use mm_control::{Input, Measurement, Output, Signals, Status};
use mm_model::{Force, Robot, Torque, Velocity};
use mm_sim::plant::PlantState;
use mm_sim::simulation::{Controller, Ending};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::arrays::{
    Rows, configuration, of_configuration, of_torque, of_velocity, torque, vector, velocity,
};
use crate::errors::ControlError;

/// What Python computes: `C` the torque, `P` the motion of the robot.
pub(crate) struct Outside<'a, const C: bool, const P: bool> {
    controller: Option<&'a Py<PyAny>>,
    plant: Option<&'a Py<PyAny>>,
    robot: &'a Robot<f64, 3>,
    /// What Python raised.
    pub(crate) raised: Option<PyErr>,
}

impl<'a, const C: bool, const P: bool> Outside<'a, C, P> {
    pub(crate) const fn new(
        controller: Option<&'a Py<PyAny>>,
        plant: Option<&'a Py<PyAny>>,
        robot: &'a Robot<f64, 3>,
    ) -> Self {
        Self { controller, plant, robot, raised: None }
    }

    fn stopped<T>(&mut self, t: f64, result: PyResult<T>) -> Result<T, Ending> {
        result.map_err(|error| {
            self.raised = Some(error);
            Ending::Stopped { t }
        })
    }
}

/// Checks numbers that Python returned.
fn finite<const W: usize>(numbers: [f64; W], what: &str, t: f64) -> PyResult<[f64; W]> {
    if numbers.iter().all(|number| number.is_finite()) {
        Ok(numbers)
    } else {
        Err(ControlError::new_err(format!("{what} is not finite at t = {t} s: {numbers:?}")))
    }
}

fn torque_of(function: &Py<PyAny>, t: f64, input: &Input<f64, 3>) -> PyResult<Torque<f64, 3>> {
    Python::attach(|py| {
        let r = &input.reference;
        let [p, dp, ddp] = [r.position, r.velocity, r.acceleration].map(|v| vector(py, [v.x, v.y, v.z]));
        let (q, nu) = (vector(py, of_configuration(&input.q)), vector(py, of_velocity(&input.nu)));
        let tau = function.call1(py, (t, q, nu, p, dp, ddp))?;
        let tau = Rows::<5>::of(tau.bind(py), "the controller's torque")?.one("the controller's torque")?;
        finite(tau, "the controller's torque", t).map(|tau| torque(&tau))
    })
}

fn moved(
    function: &Py<PyAny>,
    (t, period): (f64, f64),
    state: &PlantState,
    tau: &Torque<f64, 3>,
) -> PyResult<PlantState> {
    Python::attach(|py| {
        let (q, nu) = (vector(py, of_configuration(&state.q)), vector(py, of_velocity(&state.nu)));
        let result = function.call1(py, (t, q, nu, vector(py, of_torque(tau)), period))?;
        let (q, nu): (Bound<'_, PyAny>, Bound<'_, PyAny>) = result
            .extract(py)
            .map_err(|_| PyValueError::new_err("the plant has to return (q, nu) after the period"))?;
        let q = Rows::<6>::of(&q, "the plant's q")?.one("the plant's q")?;
        let nu = Rows::<5>::of(&nu, "the plant's nu")?.one("the plant's nu")?;
        let (q, nu) = (finite(q, "the plant's q", t)?, finite(nu, "the plant's nu", t)?);
        let (q, nu) = (configuration(&q), velocity(&nu));
        // What wheel encoders would have seen, by the trapezoidal rule.
        let travel = state.travel + 0.5 * period * (state.nu.forward + nu.forward);
        Ok(PlantState { q, nu, travel, yaw_slip: state.yaw_slip })
    })
}

impl<const C: bool, const P: bool> Controller for Outside<'_, C, P> {
    const ELSEWHERE: bool = C;
    const MOVES: bool = P;

    fn update(
        &mut self,
        t: f64,
        input: &Input<f64, 3>,
        _measured: Option<Measurement<f64, 3>>,
    ) -> Result<Output<f64, 3>, Ending> {
        let Some(function) = self.controller else { return Err(Ending::Stopped { t }) };
        let commanded = self.stopped(t, torque_of(function, t, input))?;
        let (torque, saturated) = self.robot.limit_torque(&commanded);
        let tip = self.robot.tip_position(&input.q);
        let signals = Signals {
            nu: input.nu,
            tip,
            error: tip - input.reference.position,
            nu_c: Velocity::zero(),
            nu_r: Velocity::zero(),
            dnu_r: Velocity::zero(),
            sliding: Velocity::zero(),
            equivalent: Force::zero(),
            fuzzy: Force::zero(),
            learned: Force::zero(),
            commanded,
            manipulability_squared: 0.0,
            damping_squared: 0.0,
        };
        Ok(Output { torque, status: Status { saturated, ..Status::default() }, signals })
    }

    fn advance(
        &mut self,
        at: (f64, f64),
        state: &PlantState,
        torque: &Torque<f64, 3>,
    ) -> Result<PlantState, Ending> {
        let Some(function) = self.plant else { return Err(Ending::Stopped { t: at.0 }) };
        let state = moved(function, at, state, torque);
        self.stopped(at.0, state)
    }
}
