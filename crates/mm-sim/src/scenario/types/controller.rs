//! `[controller]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::hardware::Estimator;
use super::{NonNegative, Positive};

/// The control law and its gains.
///
/// Channels are in the order of the quasi-velocities: forward speed, yaw rate, joints 1 to 3.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Controller {
    /// The control law.
    #[serde(default)]
    pub kind: ControllerKind,
    /// The outer loop, the same for all laws of a comparison.
    #[serde(default)]
    pub outer: Outer,
    /// The gains of the inner loop; those a law does not use have no effect on it.
    #[serde(default)]
    pub gains: Gains,
    /// How configuration and velocity are found from what the sensors read.
    #[serde(default)]
    pub estimator: Estimator,
}

/// The control law.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum ControllerKind {
    /// Backstepping and sliding mode with the sign function, the thesis's baseline (4.30).
    Bsmc,
    /// The same with a boundary layer instead of the sign.
    BsmcSat,
    /// The baseline plus the fuzzy system of Appendix C, literally.
    BfsmcThesis,
    /// Backstepping and fuzzy sliding mode, continuous and learning.
    #[default]
    Bfsmc,
    /// No law: the velocities are imposed and the metrics are the difference from the analytic motion.
    None,
}

/// The outer loop: kinematic backstepping (4.1) to (4.13) with the null space of the arm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Outer {
    /// Gain K on the position error: one number, or one for each of x, y, z. Default: 18.
    pub position_gain_1_s: Option<PerAxis>,
    /// Gain c on the integral of the velocity error: one number, or one a channel. Default: 20.
    pub sliding_gain_1_s: Option<PerChannel>,
    /// Weights of the pseudo-inverse, one a channel: a higher weight moves the channel less. Default: 1 each.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub weights: Option<[f64; 5]>,
    /// Pull of the null space towards the rest posture. Default: 1.
    #[schemars(with = "Option<NonNegative>")]
    pub posture_gain_1_s: Option<f64>,
    /// Push of the null space away from the joint limits. Default: 2.
    #[schemars(with = "Option<NonNegative>")]
    pub joint_limit_gain_rad_s: Option<f64>,
    /// Distance from a joint limit at which the push begins, at most half a joint's range. Default: 0.1, at most a quarter of it.
    #[schemars(with = "Option<Positive>")]
    pub joint_limit_margin_rad: Option<f64>,
    /// Pull of the null space towards higher manipulability. Default: 0.01.
    #[schemars(with = "Option<NonNegative>")]
    pub manipulability_gain_rad_s: Option<f64>,
    /// Damping of the pseudo-inverse at a singularity. Default: 0.1.
    #[schemars(with = "Option<NonNegative>")]
    pub damping_max: Option<f64>,
    /// Manipulability below which the damping begins. Default: 0.1, at most 22 % of that of the rest posture.
    #[schemars(with = "Option<Positive>")]
    pub manipulability_threshold: Option<f64>,
    /// The plain pseudo-inverse (3.62): no weights, damping or null space.
    #[serde(default)]
    pub minimum_norm: bool,
}

/// The gains of the inner loop, one a channel; the first is a force in N, the others are torques in N m.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gains {
    /// Switching gain (4.30): N, then N m. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub switching_gain: Option<[f64; 5]>,
    /// Half width of the boundary layer: m/s, then rad/s. Default: see the law.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub boundary_layer: Option<[f64; 5]>,
    /// Gain on the output of the fuzzy system: N, then N m. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub fuzzy_gain: Option<[f64; 5]>,
    /// Sliding variable that the fuzzy system sees as 1: m/s, then rad/s. Default: see the law.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub fuzzy_scale: Option<[f64; 5]>,
    /// Bandwidth of the disturbance observer; 0 learns nothing. Default: see the law.
    #[schemars(with = "Option<NonNegative>")]
    pub observer_bandwidth_1_s: Option<f64>,
    /// Largest learned disturbance: N, then N m. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub learning_limit: Option<[f64; 5]>,
    /// Margin eta of the reaching condition: N, then N m. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub reaching_margin: Option<[f64; 5]>,
}

/// One number for all three axes, or one for each of x, y, z.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum PerAxis {
    /// The same for all.
    Same(#[schemars(with = "Positive")] f64),
    /// One each.
    Each(#[schemars(with = "[Positive; 3]")] [f64; 3]),
}

impl PerAxis {
    /// Returns the three numbers.
    #[must_use]
    pub const fn expand(self) -> [f64; 3] {
        match self {
            Self::Same(value) => [value; 3],
            Self::Each(values) => values,
        }
    }
}

/// One number for all five channels, or one for each.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum PerChannel {
    /// The same for all.
    Same(#[schemars(with = "NonNegative")] f64),
    /// One each.
    Each(#[schemars(with = "[NonNegative; 5]")] [f64; 5]),
}

impl PerChannel {
    /// Returns the five numbers.
    #[must_use]
    pub const fn expand(self) -> [f64; 5] {
        match self {
            Self::Same(value) => [value; 5],
            Self::Each(values) => values,
        }
    }
}
