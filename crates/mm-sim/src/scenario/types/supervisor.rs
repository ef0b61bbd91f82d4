//! `[controller.supervisor]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// What checks the inputs of the controller and stops the robot where they fail; see `docs/supervisor.md`.
///
/// Periods count updates of the controller; channels are in the order of the quasi-velocities.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Supervisor {
    /// Whether there is one; a run without faults gives the same bits with and without.
    #[serde(default)]
    pub enabled: bool,
    /// Largest distance of base and reference from the origin along each axis. Default: 10,000.
    #[schemars(with = "Option<Positive>")]
    pub position_m: Option<f64>,
    /// How far beyond its limits a joint may read. Default: 0.5.
    #[schemars(with = "Option<NonNegative>")]
    pub joint_margin_rad: Option<f64>,
    /// Largest speeds: m/s, then rad/s; the first is the largest of the reference too. Default: four times the robot's speed limit, 20 rad/s.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub speed: Option<[f64; 5]>,
    /// Largest accelerations: m/s^2, then rad/s^2. Default: five times what the largest torques give at the rest posture.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub acceleration: Option<[f64; 5]>,
    /// Noise and resolution of a measured position, m and rad. Default: 0.005.
    #[schemars(with = "Option<Positive>")]
    pub position_noise: Option<f64>,
    /// Noise of a measured velocity, m/s and rad/s; a robot below it is at rest. Default: 0.1.
    #[schemars(with = "Option<Positive>")]
    pub velocity_noise: Option<f64>,
    /// Largest step of the reference in a period besides its velocity. Default: 1.
    #[schemars(with = "Option<Positive>")]
    pub reference_step_m: Option<f64>,
    /// Largest acceleration of the reference along each axis. Default: 1000.
    #[schemars(with = "Option<Positive>")]
    pub reference_acceleration_m_s2: Option<f64>,
    /// Largest age of an input. Default: two control periods.
    #[schemars(with = "Option<NonNegative>")]
    pub age_s: Option<f64>,
    /// Updates that the last torque is held for. Default: 2.
    #[schemars(range(max = 100))]
    pub hold_periods: Option<u32>,
    /// Plausible inputs in a row after which a stopped robot runs again; 4294967295: never by itself. Default: 10.
    #[schemars(range(min = 1))]
    pub recovery_periods: Option<u32>,
    /// Updates without a plausible state after which a stop becomes a fault; more than `hold_periods`. Default: 0.5 s.
    #[schemars(range(min = 1))]
    pub blind_periods: Option<u32>,
    /// Updates in which a stop has to bring the robot to rest. Default: 5 s.
    #[schemars(range(min = 1))]
    pub stop_periods: Option<u32>,
    /// Rate at which a stop takes the speed away, at most 0.1 per period of it. Default: 20.
    #[schemars(with = "Option<Positive>")]
    pub braking_rate_1_s: Option<f64>,
}
