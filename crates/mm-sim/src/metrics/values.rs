//! The metrics object of the summary.

use nalgebra::Vector3;
use serde::Serialize;

/// A quantity along x, y and z, and its sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PerAxisSum {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub sum: f64,
}

impl PerAxisSum {
    /// The three numbers and their sum.
    #[must_use]
    pub fn of(v: Vector3<f64>) -> Self {
        Self { x: v.x, y: v.y, z: v.z, sum: v.x + v.y + v.z }
    }
}

/// A quantity along x, y and z, and its Euclidean norm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PerAxisNorm {
    pub x: f64,
    pub y: f64,
    pub z: f64,
    pub norm: f64,
}

/// A quantity of each actuator.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PerTorque {
    pub right: f64,
    pub left: f64,
    pub joints: [f64; 3],
}

/// A quantity of each actuator, and its sum.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PerTorqueSum {
    pub right: f64,
    pub left: f64,
    pub joints: [f64; 3],
    pub sum: f64,
}

/// What a run is judged by. Errors are those of the true tip, actual minus desired, sampled at the control ticks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Metrics {
    /// Integral of t |e| over the run (5.7), m s^2.
    pub itae_m_s2: PerAxisSum,
    /// Integral of |e|, m s.
    pub iae_m_s: PerAxisSum,
    /// Integral of e^2, m^2 s.
    pub ise_m2_s: PerAxisSum,
    /// Root mean square error, m.
    pub rmse_m: PerAxisNorm,
    /// Largest distance of the tip from its reference, m.
    pub max_error_m: f64,
    /// Last time with |e| above 10 mm, s; none if it was never below.
    pub settling_time_s: Option<f64>,
    /// Sum of the torque's changes from tick to tick, per second, N m/s.
    pub torque_tv_n_m_per_s: PerTorqueSum,
    /// Largest torque, N m.
    pub peak_torque_n_m: PerTorque,
    /// Integral of the squared torques, N^2 m^2 s.
    pub effort_n2_m2_s: f64,
    /// Integral of |tau . wheel and joint rates|, J.
    pub energy_j: f64,
    /// Fraction of control periods in which a torque was limited.
    pub saturated_fraction: f64,
    /// Largest forward speed, m/s.
    pub max_speed_m_s: f64,
    /// Smallest manipulability.
    pub min_manipulability: f64,
    /// 99th percentile of |s| by channel after a tenth of the run, to 0.4 %, m/s and rad/s; none if the run ended before.
    pub sliding_band: [Option<f64>; 5],
    /// How often a joint left its limits.
    pub joint_limit_crossings: u64,
    /// Whether the law's gain met the reaching condition (4.44) wherever it was evaluated, torque limits aside; none if nowhere.
    pub reaching_condition_met: Option<bool>,
}
