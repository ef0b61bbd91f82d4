//! `[sweep]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::NonNegative;
use super::ranges::Share;

/// What `mmsim sweep` varies, as ranges; zero leaves a quantity alone.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sweep {
    /// Each mass, that of the base and of each link, is multiplied by a factor of 1 - this to 1 + this.
    #[schemars(with = "Share")]
    pub mass: f64,
    /// Each inertia likewise: the base's and, all three axes alike, each link's.
    #[schemars(with = "Share")]
    pub inertia: f64,
    /// The distance of each centre of mass from its axle or joint likewise.
    #[schemars(with = "Share")]
    pub com: f64,
    /// Viscous friction of both wheels, from 0 to this, N m s/rad, in place of the scenario's own.
    #[schemars(with = "NonNegative")]
    pub wheel_viscous_n_m_s: f64,
    /// Coulomb friction of both wheels, from 0 to this, in place of the scenario's own.
    #[schemars(with = "NonNegative")]
    pub wheel_coulomb_n_m: f64,
    /// Viscous friction of each joint, from 0 to this, N m s/rad, in place of the scenario's own.
    #[schemars(with = "NonNegative")]
    pub joint_viscous_n_m_s: f64,
    /// Coulomb friction of each joint, from 0 to this, in place of the scenario's own.
    #[schemars(with = "NonNegative")]
    pub joint_coulomb_n_m: f64,
    /// Each joint gets a torque of random shape (step, pulse, sine or noise), times and amplitude, the amplitude up to this.
    #[schemars(with = "NonNegative")]
    pub joint_disturbance_n_m: f64,
    /// The measurements are late by 0 to this many control periods, in place of the scenario's own `plant.sensors.delay_periods`; for
    /// a scenario with an estimator, since without one a delay would bring one in some samples.
    #[schemars(range(max = 1000))]
    pub delay_periods: u32,
    /// The tip starts in a ball of this radius around where it would start.
    #[schemars(with = "NonNegative")]
    pub start_offset_m: f64,
    /// A sample with a greater RMS error counts as a failure. Default: no bound, only a run that ends early fails.
    #[schemars(with = "Option<NonNegative>")]
    pub fail_above_rmse_m: Option<f64>,
}

impl Default for Sweep {
    fn default() -> Self {
        Self {
            mass: 0.4,
            inertia: 0.4,
            com: 0.1,
            wheel_viscous_n_m_s: 0.0,
            wheel_coulomb_n_m: 0.0,
            joint_viscous_n_m_s: 0.0,
            joint_coulomb_n_m: 0.0,
            joint_disturbance_n_m: 15.0,
            delay_periods: 0,
            start_offset_m: 0.05,
            fail_above_rmse_m: None,
        }
    }
}
