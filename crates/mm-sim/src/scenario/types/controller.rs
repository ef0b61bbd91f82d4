//! `[controller]`.

use std::borrow::Cow;
use std::collections::BTreeMap;

use mm_control::LawKind;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::hardware::Estimator;
use super::supervisor::Supervisor;
use super::{NonNegative, Positive};

/// The control law and its gains.
///
/// Channels are in the order of the quasi-velocities: forward speed, yaw rate, joints 1 to 3.
#[derive(Debug, Clone, Default, PartialEq, Deserialize, JsonSchema)]
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
    /// Gains of single laws. The law that runs takes each gain from the first that gives it of `--set`, `gains_for`, `gains_file`
    /// and `gains`: what is meant for one law comes before what is meant for all, the scenario before a file that it names.
    #[serde(default)]
    pub gains_for: GainsFor,
    /// A TOML file with a table for each law, as `mmsim tune` writes it, over `gains`; sought in the folder of the scenario file,
    /// a name given by `--set` from the working directory.
    pub gains_file: Option<String>,
    /// A fuzzy system of one input and one output for the laws `bfsmc` and `bfsmc-thesis`, instead of their own: a `.fis` or
    /// `.fcl` file, sought in the folder of the scenario file, a name given by `--set` from the working directory; or the bundled
    /// `thesis` or `smooth`. The input is s over `gains.fuzzy_scale`, the output is multiplied by `gains.fuzzy_gain`.
    pub fis: Option<String>,
    /// How the fuzzy system of the law is evaluated. Default: `table` for the own system of `bfsmc`, `exact` for that of `bfsmc-thesis` and
    /// for one that `fis` names, `surface` where that has no exact centroid.
    pub fuzzy_engine: Option<FuzzyEngine>,
    /// How configuration and velocity are found from what the sensors read.
    #[serde(default)]
    pub estimator: Estimator,
    /// What checks the inputs of the controller and stops the robot where they fail.
    #[serde(default)]
    pub supervisor: Supervisor,
}

/// How a fuzzy system is evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FuzzyEngine {
    /// By 65 equally spaced knots with straight lines between them, in floating point.
    Table,
    /// By its rules, with the exact centroid.
    Exact,
    /// By its rules, with the centroid of 101 samples, as MATLAB computes it.
    Sampled,
    /// By its rules in integers, input and output of 16 bits.
    Q15,
    /// By a compiled table of integers that keeps jumps, input and output of 16 bits.
    Surface,
}

/// Gains of single laws: a table for each law's name.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct GainsFor(pub BTreeMap<String, Gains>);

impl JsonSchema for GainsFor {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "GainsFor".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let gains = |law: LawKind| {
            let mut gains = generator.subschema_for::<Gains>();
            gains.insert(SAME_KEYS.to_owned(), "controller.gains".into());
            (law.name().to_owned(), gains.to_value())
        };
        let properties: serde_json::Map<_, _> = LawKind::ALL.into_iter().map(gains).collect();
        json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
    }
}

/// Schema keyword of a table whose keys are those of another.
pub(crate) const SAME_KEYS: &str = "x-same-keys-as";

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
    /// Computed torque.
    Ctc,
    /// Joints by PID, the base by PID after partial feedback linearization.
    Pid,
    /// Linear quadratic regulator about the rest posture.
    Lqr,
    /// Sliding modes of base and arm apart, their coupling a disturbance.
    SmcDecentralized,
    /// Adaptive backstepping: factors on the bodies' inertias and a force, learned on line.
    BacksteppingAdaptive,
    /// Super-twisting, a continuous sliding mode of second order.
    SuperTwisting,
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
    /// Largest speed that the correction of the position error asks for. Default: half the speed up to which the model holds, 1.
    #[schemars(with = "Option<Positive>")]
    pub correction_speed_limit_m_s: Option<f64>,
    /// Bound on the joint rates asked for, per distance from the joint limit ahead; 0 sets none, on the base's speed neither. Default: 10.
    #[schemars(with = "Option<NonNegative>")]
    pub joint_limit_rate_1_s: Option<f64>,
    /// Time from the start over which the base is held and the arm alone follows.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub base_hold_s: f64,
    /// Time over which the base is then released smoothly.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub base_release_s: f64,
    /// The plain pseudo-inverse (3.62): no weights, damping, null space or bounds on rates.
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
    /// Gain on the velocity error nu - nu_c (`ctc`, `pid`) or on s (`backstepping-adaptive`): one number, or one a channel. Default:
    /// see the law.
    pub damping_gain_1_s: Option<PerChannel>,
    /// Gain on the integral of the velocity error (`ctc`, `pid`): one number, or one a channel. Default: see the law.
    pub stiffness_gain_1_s2: Option<PerChannel>,
    /// Gain on the integral of that (`pid`): one number, or one a channel. Default: see the law.
    pub integral_gain_1_s3: Option<PerChannel>,
    /// Acceptable integral of the velocity error (`lqr`): m, then rad. Default: see the law.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub acceptable_position: Option<[f64; 5]>,
    /// Acceptable velocity error (`lqr`): m/s, then rad/s. Default: see the law.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub acceptable_velocity: Option<[f64; 5]>,
    /// Acceptable force (`lqr`): N, then N m. Default: see the law.
    #[schemars(with = "Option<[Positive; 5]>")]
    pub acceptable_force: Option<[f64; 5]>,
    /// Adaptation of the bodies' inertias (`backstepping-adaptive`). Default: see the law.
    #[schemars(with = "Option<NonNegative>")]
    pub body_adaptation_gain_1_j: Option<f64>,
    /// Least and largest factor on a body's inertia (`backstepping-adaptive`), around 1. Default: see the law.
    #[schemars(with = "Option<[Positive; 2]>")]
    pub body_factor: Option<[f64; 2]>,
    /// Adaptation of the learned force (`backstepping-adaptive`). Default: see the law.
    #[schemars(with = "Option<NonNegative>")]
    pub force_adaptation_gain_1_s2: Option<f64>,
    /// Gain k1 on the root of s (`super-twisting`): N, then N m, over the root of m/s or rad/s. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub twisting_gain: Option<[f64; 5]>,
    /// Rate k2 of the integrated force (`super-twisting`): N/s, then N m/s. Default: see the law.
    #[schemars(with = "Option<[NonNegative; 5]>")]
    pub twisting_rate_gain: Option<[f64; 5]>,
    /// Misprints of the thesis that `bfsmc-thesis` keeps, to see what they do; read literally, its equations do not fit its proof.
    #[serde(default)]
    pub misprints: Misprints,
}

/// Readings of the printed equations that contradict their proof.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Misprints {
    /// The error of (4.17), desired minus actual, in (4.30) and in the fuzzy system's input: the switching force aids s.
    #[serde(default)]
    pub sign: bool,
    /// The forces of (4.31) and (4.41) act as torques: s_v drives the right wheel, s_omega the left one.
    #[serde(default)]
    pub channels: bool,
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
