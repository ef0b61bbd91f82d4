//! `mmsim.Robot`.

use mm_model::{Force, Mechanism as _, Robot as Model};
use mm_sim::disturbance::Disturbances;
use mm_sim::experiment;
use mm_sim::plant::{Plant, PlantState};
use mm_sim::scenario::{self, robot_toml};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PySlice, PyTuple, PyType};

use crate::arrays::{
    configuration, map1, map2, map3, of_configuration, of_torque, of_velocity, torque, velocity,
};
use crate::{errors, json};

type Array<'py> = PyResult<Bound<'py, PyArrayDyn<f64>>>;

/// A scenario with nothing in it but what has to be there: a robot or a controller is read in its place.
pub(crate) const FRAME: &str = "name = \"frame\"\n[trajectory]\nkind = \"hold\"\n";

/// A two-wheel differential-drive base with a yaw-pitch-pitch arm, checked and immutable.
///
/// Configurations are ``q = (x, y, heading, q1, q2, q3)``, velocities ``nu = (forward, yaw_rate, dq1, dq2, dq3)``, torques
/// ``tau = (right, left, tau1, tau2, tau3)``; m, rad, s, kg, N m. Every method takes one state, shape ``(n,)``, or many,
/// ``(k, n)``, and single ones beside many; the rows of the result are those of the many.
///
/// Parameters
/// ----------
/// **fields
///     Keys of ``[robot]`` in a scenario, such as ``base_mass_kg`` or ``link``, a list of dicts; what is not given is that of
///     the thesis's robot.
///
/// Raises
/// ------
/// ScenarioError
///     An unknown key or a parameter that no robot has.
///
/// Examples
/// --------
/// >>> import mmsim
/// >>> robot = mmsim.Robot(base_mass_kg=50.0)
/// >>> robot.mass_matrix([0, 0, 0, 0.1, 1.0, -2.0]).shape
/// (5, 5)
#[pyclass(module = "mmsim", frozen, eq, subclass)]
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Robot {
    pub(crate) model: Model<f64, 3>,
}

impl Robot {
    /// The robot of a text with a `[robot]` table.
    fn read(py: Python<'_>, name: &str, robot: &str, edits: &[String]) -> PyResult<Self> {
        let text = format!("{FRAME}[simulation]\nduration_s = 1.0\n{robot}");
        let model = scenario::from_text(name, &text, edits).and_then(|loaded| experiment::robot(&loaded));
        model.map(|model| Self { model }).map_err(|error| errors::scenario(py, &error))
    }

    /// The robot as a `[robot]` table.
    pub(crate) fn toml(&self) -> String {
        robot_toml(self.model.params())
    }
}

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (**fields))]
    fn new(py: Python<'_>, fields: Option<&Bound<'_, PyDict>>) -> PyResult<Self> {
        let mut table = String::from("[robot]\n");
        for (key, value) in fields.into_iter().flatten() {
            let key = key.extract::<String>()?;
            table += &format!("{key} = {}\n", json::toml(&value, &key)?);
        }
        Self::read(py, "Robot(...)", &table, &[])
    }

    /// The robot of the thesis: a base of 24 kg, an arm of three links.
    ///
    /// Examples
    /// --------
    /// >>> import mmsim
    /// >>> mmsim.Robot.thesis() == mmsim.Robot()
    /// True
    #[staticmethod]
    fn thesis(py: Python<'_>) -> PyResult<Self> {
        Self::read(py, "Robot.thesis()", "", &[])
    }

    /// The robot of a TOML file, with the keys of ``[robot]`` at its top.
    ///
    /// Parameters
    /// ----------
    /// path : str or os.PathLike
    ///     The file. It has to be complete; offsets, limits, gravity and rest posture have defaults.
    ///
    /// Raises
    /// ------
    /// ScenarioError
    ///     With ``file``, ``line``, ``column`` and ``key``.
    #[staticmethod]
    fn from_toml(py: Python<'_>, path: &Bound<'_, PyAny>) -> PyResult<Self> {
        Self::read(py, "Robot.from_toml(...)", "", &[format!("robot.file={}", json::toml(path, "path")?)])
    }

    /// What a pickle is read with.
    #[staticmethod]
    fn _from_text(py: Python<'_>, text: &str) -> PyResult<Self> {
        Self::read(py, "Robot", text, &[])
    }

    /// The robot as a ``[robot]`` table of TOML, complete, that reads back to the same bits.
    #[pyo3(name = "to_toml")]
    fn py_toml(&self) -> String {
        self.toml()
    }

    /// Mass matrix ``M(q)`` of the reduced dynamics ``M nu' + C nu + g = B tau``.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,) or (k, 6)
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (5, 5) or (k, 5, 5)
    ///     Symmetric and positive definite; kg, kg m and kg m^2.
    fn mass_matrix<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        map1(py, (q, "q"), &[5, 5], |q| {
            let m = self.model.mass_matrix_at(&configuration(q));
            // Column by column: a unit velocity's momentum.
            let mut out = [0.0; 25];
            for (row, out) in out.as_chunks_mut::<5>().0.iter_mut().enumerate() {
                let mut unit = [0.0; 5];
                if let Some(one) = unit.get_mut(row) {
                    *one = 1.0;
                }
                let [f, y, a, b, c] = of_force(&m.product(&velocity(&unit)));
                *out = [f, y, a, b, c];
            }
            out
        })
    }

    /// Matrix ``C(q, nu)`` of Coriolis and centrifugal forces, of the factorization with ``M' - 2 C`` skew-symmetric.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,) or (k, 6)
    /// nu : array_like, shape (5,) or (k, 5)
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (5, 5) or (k, 5, 5)
    fn coriolis_matrix<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        nu: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        map2(py, ((q, "q"), (nu, "nu")), &[5, 5], |q, nu| {
            let (q, nu) = (configuration(q), velocity(nu));
            let columns = self.model.coriolis_columns(&q, &nu);
            let columns: [[f64; 5]; 5] = collected(columns.map(|column| of_force(&column)));
            let mut out = [0.0; 25];
            for (row, out) in out.as_chunks_mut::<5>().0.iter_mut().enumerate() {
                for (out, column) in out.iter_mut().zip(&columns) {
                    *out = column.get(row).copied().unwrap_or(0.0);
                }
            }
            out
        })
    }

    /// Forces of gravity ``g(q)``, shape (5,) or (k, 5); N and N m.
    fn gravity<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        map1(py, (q, "q"), &[5], |q| {
            let inertia = self.model.inertia(&self.model.posture(&configuration(q).joints));
            of_force(&self.model.gravity(&inertia))
        })
    }

    /// ``C(q, nu) nu + g(q)``, shape (5,) or (k, 5); N and N m.
    fn bias<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>, nu: &Bound<'py, PyAny>) -> Array<'py> {
        map2(py, ((q, "q"), (nu, "nu")), &[5], |q, nu| {
            let inertia = self.model.inertia(&self.model.posture(&configuration(q).joints));
            of_force(&self.model.bias(&inertia, &velocity(nu)))
        })
    }

    /// Acceleration ``nu'`` under a torque.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,) or (k, 6)
    /// nu : array_like, shape (5,) or (k, 5)
    /// tau : array_like, shape (5,) or (k, 5)
    ///
    /// Returns
    /// -------
    /// numpy.ndarray, shape (5,) or (k, 5)
    ///     m/s^2 and rad/s^2. Many rows are computed without the interpreter's lock.
    ///
    /// Examples
    /// --------
    /// >>> import numpy as np, mmsim
    /// >>> robot = mmsim.Robot.thesis()
    /// >>> robot.forward_dynamics(np.zeros((1000, 6)), np.zeros(5), np.zeros(5)).shape
    /// (1000, 5)
    fn forward_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        nu: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        map3(py, ((q, "q"), (nu, "nu"), (tau, "tau")), &[5], |q, nu, tau| {
            of_velocity(&self.model.forward_dynamics(
                &configuration(q),
                &velocity(nu),
                &torque(tau),
                &Force::zero(),
            ))
        })
    }

    /// State after a time ``h`` under a constant torque, by one step of the simulator's Runge-Kutta method.
    ///
    /// Parameters
    /// ----------
    /// q : array_like, shape (6,) or (k, 6)
    /// nu : array_like, shape (5,) or (k, 5)
    /// tau : array_like, shape (5,) or (k, 5)
    /// h : float
    ///     s.
    ///
    /// Returns
    /// -------
    /// tuple of numpy.ndarray
    ///     ``q`` and ``nu``; a plant of one's own that is this function has the digest of the simulator's.
    fn step<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        nu: &Bound<'py, PyAny>,
        tau: &Bound<'py, PyAny>,
        h: f64,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
        let plant = Plant::new(self.model, Disturbances::default(), h);
        let both = map3(py, ((q, "q"), (nu, "nu"), (tau, "tau")), &[11], |q, nu, tau| {
            let state = PlantState { q: configuration(q), nu: velocity(nu), travel: 0.0, yaw_slip: 0.0 };
            let after = plant.step(0.0, &state, &plant.sines(&state.q), &torque(tau));
            let ([x, y, heading, a, b, c], [v, w, d, e, f]) =
                (of_configuration(&after.q), of_velocity(&after.nu));
            [x, y, heading, a, b, c, v, w, d, e, f]
        })?;
        let part = |from: isize, to: isize| both.get_item((py.Ellipsis(), PySlice::new(py, from, to, 1)));
        Ok((part(0, 6)?, part(6, 11)?))
    }

    /// Torque that gives an acceleration, shape (5,) or (k, 5); N m.
    fn inverse_dynamics<'py>(
        &self,
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        nu: &Bound<'py, PyAny>,
        dnu: &Bound<'py, PyAny>,
    ) -> Array<'py> {
        map3(py, ((q, "q"), (nu, "nu"), (dnu, "dnu")), &[5], |q, nu, dnu| {
            let force = self.model.inverse_dynamics(&configuration(q), &velocity(nu), &velocity(dnu));
            of_torque(&self.model.torque_of(&force))
        })
    }

    /// Tip of the arm in the world, shape (3,) or (k, 3); m.
    ///
    /// Examples
    /// --------
    /// >>> import mmsim
    /// >>> mmsim.Robot.thesis().tip_position([0, 0, 0, 0, 0, 0]).shape
    /// (3,)
    fn tip_position<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        map1(py, (q, "q"), &[3], |q| self.model.tip_position(&configuration(q)).into())
    }

    /// Jacobian of the tip: its velocity is ``J nu``; shape (3, 5) or (k, 3, 5).
    fn tip_jacobian<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        map1(py, (q, "q"), &[3, 5], |q| {
            let matrix = self.model.jacobian(&configuration(q)).to_matrix().transpose();
            let mut out = [0.0; 15];
            // Column by column of the transpose: row by row.
            out.iter_mut().zip(matrix.iter()).for_each(|(out, value)| *out = *value);
            out
        })
    }

    /// ``sqrt(det(J J'))`` with the whole Jacobian, shape () or (k,).
    fn manipulability<'py>(&self, py: Python<'py>, q: &Bound<'py, PyAny>) -> Array<'py> {
        map1(py, (q, "q"), &[], |q| [self.model.manipulability(&configuration(q))])
    }

    /// All parameters, a dict with the names of ``[robot]``.
    #[getter]
    fn params<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        crate::scenario::parsed_toml(py, &self.toml())?.get_item("robot")
    }

    fn __repr__(&self) -> String {
        let p = self.model.params();
        let links: Vec<String> =
            p.links.iter().map(|link| format!("{} m {} kg", link.length, link.mass)).collect();
        format!("Robot(base {} kg, links {})", p.base_mass, links.join(", "))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let kind: Bound<'py, PyType> = slf.get_type();
        (kind.getattr("_from_text")?, (slf.get().toml(),)).into_pyobject(slf.py())
    }
}

pub(crate) const fn of_force(force: &Force<f64, 3>) -> [f64; 5] {
    let [a, b, c] = force.joints;
    [force.forward, force.yaw, a, b, c]
}

/// The first five of a series; what is missing is zero.
fn collected(mut columns: impl Iterator<Item = [f64; 5]>) -> [[f64; 5]; 5] {
    std::array::from_fn(|_| columns.next().unwrap_or_default())
}
