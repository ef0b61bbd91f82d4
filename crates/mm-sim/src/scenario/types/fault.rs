//! `[[fault]]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// What is corrupted between the sensors and the controller, or in its clock; several act in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fault {
    /// What is corrupted.
    pub on: FaultTarget,
    /// How.
    pub kind: FaultKind,
    /// One number of the target instead of all: the first is 0.
    #[schemars(range(max = 10))]
    pub channel: Option<u32>,
    /// When it starts.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub from_s: f64,
    /// When it ends. Default: with the run.
    #[schemars(with = "Option<Positive>")]
    pub to_s: Option<f64>,
    /// Size on positions of the base (`state`, `pose`) or of the reference, for the kinds `offset`, `spike` and `noise`.
    pub amplitude_m: Option<f64>,
    /// Size on the heading and the joints.
    pub amplitude_rad: Option<f64>,
    /// Size on the forward speed (`state`, `velocity`).
    pub amplitude_m_s: Option<f64>,
    /// Size on the yaw rate and the joint rates.
    pub amplitude_rad_s: Option<f64>,
    /// Size on `clock` and `age`.
    pub amplitude_s: Option<f64>,
    /// Factor of the kind `scale`.
    pub factor: Option<f64>,
    /// Control periods of the kind `delay`.
    #[schemars(range(min = 1, max = 1000))]
    pub delay_periods: Option<u32>,
    /// Time from one `spike` to the next. Default: 0.1.
    #[schemars(with = "Option<Positive>")]
    pub every_s: Option<f64>,
}

/// What a fault corrupts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaultTarget {
    /// All that is measured: x, y, heading, joints 1 to 3, forward speed, yaw rate, joint rates 1 to 3.
    State,
    /// The measured x, y and heading of the base.
    Pose,
    /// The measured joint angles.
    Joints,
    /// The measured forward speed, yaw rate and joint rates.
    Velocity,
    /// The reference: position, velocity and acceleration, channels x, y and z; an amplitude acts on the position.
    Reference,
    /// The time since the last update, as the supervisor is told; and whether updates come at all.
    Clock,
    /// The age of the input, as the supervisor is told.
    Age,
}

/// How a fault corrupts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FaultKind {
    /// Not a number.
    Nan,
    /// Infinite.
    Infinite,
    /// The amplitude is added.
    Offset,
    /// The amplitude is added for one period, every `every_s`.
    Spike,
    /// Seeded normal noise with the amplitude as standard deviation.
    Noise,
    /// Multiplied by `factor`.
    Scale,
    /// Stays what it was when the fault began.
    Stuck,
    /// Comes `delay_periods` late, without saying so.
    Delay,
    /// On `clock`: no input comes, and the controller knows.
    Drop,
    /// On `clock`: every input comes twice.
    Duplicate,
    /// On `clock`: the controller does not run at all.
    Stall,
}
