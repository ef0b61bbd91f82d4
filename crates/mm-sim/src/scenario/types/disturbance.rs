//! `[[disturbance]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// A torque, a force or a slip that acts on the plant unknown to the controller.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Disturbance {
    /// Where it acts.
    pub on: DisturbanceTarget,
    /// Torque, for a wheel or joint, where it is required.
    pub amplitude_n_m: Option<f64>,
    /// Force, for the target `tip`, where it is required.
    pub amplitude_n: Option<f64>,
    /// Speed of the slip, for the targets `slip-forward` and `slip-sideways`, where it is required.
    pub amplitude_m_s: Option<f64>,
    /// Rate of the slip, for the target `slip-yaw`, where it is required.
    pub amplitude_rad_s: Option<f64>,
    /// Direction of the force in the world frame, of any length but zero; required for the target `tip`.
    pub direction: Option<[f64; 3]>,
    /// When it starts.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub from_s: f64,
    /// When it ends. Default: with the run.
    #[schemars(with = "Option<Positive>")]
    pub to_s: Option<f64>,
    /// The course over time and its own keys.
    #[serde(flatten)]
    pub shape: Shape,
}

/// Where a disturbance acts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum DisturbanceTarget {
    /// The first joint, yaw.
    Joint1,
    /// The second joint, shoulder.
    Joint2,
    /// The third joint, elbow.
    Joint3,
    /// Every joint alike.
    Joints,
    /// The right wheel.
    Right,
    /// The left wheel.
    Left,
    /// The tip of the arm, as a force.
    Tip,
    /// The contact of the wheels: the base slips along its heading, unseen by the wheels' encoders.
    SlipForward,
    /// The base slips to its left.
    SlipSideways,
    /// The base turns counter-clockwise, unseen by the wheels' encoders.
    SlipYaw,
}

/// The course of a disturbance over time; zero before `from_s` and after `to_s`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(tag = "shape", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Shape {
    /// The amplitude from `from_s` on.
    Step,
    /// The amplitude between `from_s` and `to_s`.
    Pulse,
    /// Amplitude times sin(w t + phase), where t is the scenario's time, not the time since `from_s`.
    Sine {
        /// The angular frequency w.
        #[schemars(with = "Positive")]
        frequency_rad_s: f64,
        /// The phase at time zero.
        #[serde(default)]
        phase_rad: f64,
    },
    /// Seeded random values between minus and plus the amplitude.
    Noise {
        /// How long each value is held.
        #[serde(default = "default_hold")]
        #[schemars(with = "Positive")]
        hold_s: f64,
    },
}

const fn default_hold() -> f64 {
    0.01
}
