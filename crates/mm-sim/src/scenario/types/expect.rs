//! `[expect]`: the metrics of the summary, each with bounds.

use schemars::JsonSchema;
use serde::Deserialize;

/// Bounds on the metrics of the run, by the keys of `metrics` in the summary. To miss one fails the run as the file stands; of a run with
/// edits it is a warning.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Integral of time times the absolute error (5.7), m s^2.
    #[serde(default)]
    pub itae_m_s2: AxesAndSum,
    /// Integral of the absolute error, m s.
    #[serde(default)]
    pub iae_m_s: AxesAndSum,
    /// Integral of the squared error, m^2 s.
    #[serde(default)]
    pub ise_m2_s: AxesAndSum,
    /// Root of the mean squared error, m.
    #[serde(default)]
    pub rmse_m: AxesAndNorm,
    /// Largest distance of the tip from its reference, m.
    pub max_error_m: Option<Bounds>,
    /// Last time with an error above 0.01 m, s; missed when the error never falls below.
    pub settling_time_s: Option<Bounds>,
    /// Total variation of the applied torques divided by the duration, N m/s.
    #[serde(default)]
    pub torque_tv_n_m_per_s: Totals,
    /// Largest applied torque, N m.
    #[serde(default)]
    pub peak_torque_n_m: Peaks,
    /// Integral of the squared torques, N^2 m^2 s.
    pub effort_n2_m2_s: Option<Bounds>,
    /// Integral of the absolute mechanical power, J.
    pub energy_j: Option<Bounds>,
    /// Share of the control periods in which a torque was limited, 0 to 1.
    pub saturated_fraction: Option<Bounds>,
    /// Highest speed of the base, m/s.
    pub max_speed_m_s: Option<Bounds>,
    /// Lowest manipulability sqrt(det(J J^T)).
    pub min_manipulability: Option<Bounds>,
    /// For each channel the 99th percentile of the sliding variable's size after a tenth of the run.
    #[serde(default)]
    #[schemars(length(max = 5))]
    pub sliding_band: Vec<Bounds>,
    /// How often a joint left its range.
    pub joint_limit_crossings: Option<Bounds>,
    /// Whether the reaching condition held all the time.
    pub reaching_condition_met: Option<bool>,
}

/// Bounds on a number, both inclusive.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// The least value allowed. Default: no bound.
    pub min: Option<f64>,
    /// The greatest value allowed. Default: no bound.
    pub max: Option<f64>,
}

/// Bounds on a metric of the three axes and on its sum.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxesAndSum {
    /// Along x.
    pub x: Option<Bounds>,
    /// Along y.
    pub y: Option<Bounds>,
    /// Along z.
    pub z: Option<Bounds>,
    /// The sum of the three.
    pub sum: Option<Bounds>,
}

/// Bounds on a metric of the three axes and on its Euclidean norm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxesAndNorm {
    /// Along x.
    pub x: Option<Bounds>,
    /// Along y.
    pub y: Option<Bounds>,
    /// Along z.
    pub z: Option<Bounds>,
    /// The norm of the three.
    pub norm: Option<Bounds>,
}

/// Bounds on a metric of the five torques and on its sum.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Totals {
    /// Of the right wheel.
    pub right: Option<Bounds>,
    /// Of the left wheel.
    pub left: Option<Bounds>,
    /// Of the joints from the base to the tip.
    #[serde(default)]
    #[schemars(length(max = 3))]
    pub joints: Vec<Bounds>,
    /// The sum of the five.
    pub sum: Option<Bounds>,
}

/// Bounds on a metric of the five torques.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Peaks {
    /// Of the right wheel.
    pub right: Option<Bounds>,
    /// Of the left wheel.
    pub left: Option<Bounds>,
    /// Of the joints from the base to the tip.
    #[serde(default)]
    #[schemars(length(max = 3))]
    pub joints: Vec<Bounds>,
}
