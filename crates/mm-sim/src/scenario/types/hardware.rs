//! `[plant.sensors]` and `[plant.actuators]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// What the controller reads, once a control period; without any key it knows the true state, velocity included.
///
/// With any of these keys the velocity is estimated: see `[controller.estimator]`.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sensors {
    /// Bits a turn of the encoders of wheels and joints. Default: exact angles.
    #[schemars(range(min = 4, max = 32))]
    pub bits: Option<u32>,
    /// Bits a turn of the wheels' encoders. Default: `bits`.
    #[schemars(range(min = 4, max = 32))]
    pub wheel_bits: Option<u32>,
    /// Bits a turn of the joints' encoders. Default: `bits`.
    #[schemars(range(min = 4, max = 32))]
    pub joint_bits: Option<u32>,
    /// Whether the controller reads the wheels' encoders; else their speed comes from the measured pose.
    #[serde(default = "default_wheel_encoders")]
    pub wheel_encoders: bool,
    /// Where the measured pose of the base comes from.
    #[serde(default)]
    pub pose_source: PoseSource,
    /// Rounding of the measured x and y; 0 for none.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub position_resolution_m: f64,
    /// Standard deviation of the white noise of the measured x and y, before the rounding.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub position_noise_m: f64,
    /// Rounding of the measured heading; 0 for none.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub heading_resolution_rad: f64,
    /// Standard deviation of the white noise of the measured heading, before the rounding.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub heading_noise_rad: f64,
    /// Control periods from a reading to its use.
    #[serde(default)]
    #[schemars(range(max = 1000))]
    pub delay_periods: u32,
}

impl Default for Sensors {
    fn default() -> Self {
        Self {
            bits: None,
            wheel_bits: None,
            joint_bits: None,
            wheel_encoders: default_wheel_encoders(),
            pose_source: PoseSource::default(),
            position_resolution_m: 0.0,
            position_noise_m: 0.0,
            heading_resolution_rad: 0.0,
            heading_noise_rad: 0.0,
            delay_periods: 0,
        }
    }
}

const fn default_wheel_encoders() -> bool {
    true
}

/// Where the measured pose of the base comes from.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PoseSource {
    /// The true pose, with the noise and the rounding given here.
    #[default]
    True,
    /// Integrated from the wheels' encoders, from the true pose at the start on.
    Odometry,
}

/// What stands between a commanded torque and the plant's input, in this order: delay, limits, lag with rate limit, motor.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Actuators {
    /// Time constant of a first-order lag; 0 for none.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub lag_s: f64,
    /// Largest rate of every torque, N m/s. Default: none.
    #[schemars(with = "Option<Positive>")]
    pub rate_limit_n_m_s: Option<f64>,
    /// Largest torque of each wheel, either way. Default: none but the controller's.
    #[schemars(with = "Option<Positive>")]
    pub wheel_torque_limit_n_m: Option<f64>,
    /// Largest torque of each joint, either way. Default: none but the controller's.
    #[schemars(with = "Option<[Positive; 3]>")]
    pub joint_torque_limit_n_m: Option<[f64; 3]>,
    /// Control periods from a command to its arrival.
    #[serde(default)]
    #[schemars(range(max = 1000))]
    pub delay_periods: u32,
    /// Motors; an axis without one makes the torque that lag and limits leave.
    #[serde(default)]
    pub motor: Motors,
}

/// Motors; an axis without one makes the torque that lag and limits leave.
#[derive(Debug, Clone, PartialEq, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motors {
    /// The motor of each wheel.
    pub wheel: Option<Motor>,
    /// The motors of the joints, from the base to the tip; joints without an entry have none.
    #[serde(default)]
    #[schemars(length(max = 3))]
    pub joint: Vec<Motor>,
}

/// A direct-current motor behind a gear, with a drive that compensates its back-EMF as far as the supply goes.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motor {
    /// Resistance of the armature.
    #[schemars(with = "Positive")]
    pub resistance_ohm: f64,
    /// Inductance of the armature; the current settles with inductance over resistance.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub inductance_h: f64,
    /// Torque at the rotor over the current, which is also the back-EMF over the rotor's rate in V s/rad.
    #[schemars(with = "Positive")]
    pub torque_constant_n_m_a: f64,
    /// Turns of the rotor for one of the axis.
    #[serde(default = "default_gear_ratio")]
    #[schemars(with = "Positive")]
    pub gear_ratio: f64,
    /// Supply voltage.
    #[schemars(with = "Positive")]
    pub supply_v: f64,
    /// Largest current that the drive asks for. Default: none.
    #[schemars(with = "Option<Positive>")]
    pub current_limit_a: Option<f64>,
}

const fn default_gear_ratio() -> f64 {
    1.0
}

/// How configuration and velocity are found from what the sensors read.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Estimator {
    /// The method. Default: `filtered-difference` with `[plant.sensors]`, else `none`.
    pub kind: Option<EstimatorKind>,
    /// Cutoff of the filter, or corner of the observer's poles; below half the control rate.
    #[serde(default = "default_cutoff")]
    #[schemars(with = "Positive")]
    pub cutoff_hz: f64,
    /// Age of a measurement that the controller reckons with: the estimate is carried forward by it.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub delay_s: f64,
}

impl Default for Estimator {
    fn default() -> Self {
        Self { kind: None, cutoff_hz: default_cutoff(), delay_s: 0.0 }
    }
}

const fn default_cutoff() -> f64 {
    60.0
}

/// How the velocity is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum EstimatorKind {
    /// The controller is given the true state; only with sensors that read the truth.
    None,
    /// Differences of the positions through a low-pass of second order.
    FilteredDifference,
    /// An observer with the nominal dynamics.
    Observer,
}
