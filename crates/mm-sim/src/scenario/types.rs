//! The keys of a scenario file, as plain data.
//!
//! These types are the one source of the file format: the doc comments, defaults and ranges below become
//! the JSON Schema, the schema drives the checker, and the reference page is generated from it. A key that
//! carries a quantity ends in its unit. Values are in SI units and radians.

mod controller;
mod disturbance;
mod expect;
mod fault;
mod hardware;
mod ranges;
mod robot;
mod supervisor;
mod sweep;
mod trajectory;
mod tune;

use ranges::{NonNegative, Positive};
use schemars::JsonSchema;
use serde::Deserialize;

pub(super) use controller::SAME_KEYS;
pub use controller::{
    Controller, ControllerKind, FuzzyEngine, Gains, GainsFor, Misprints, Outer, PerAxis, PerChannel,
};
pub use disturbance::{Disturbance, DisturbanceTarget, Shape};
pub use expect::{AxesAndNorm, AxesAndSum, Bounds, Expect, Peaks, Totals};
pub use fault::{Fault, FaultKind, FaultTarget};
pub use hardware::{Actuators, Estimator, EstimatorKind, Motor, Motors, PoseSource, Sensors};
pub use robot::{Friction, Link, Plant, PlantScale, Preset, Robot, RobotFields};
pub use supervisor::Supervisor;
pub use sweep::Sweep;
pub(super) use trajectory::WaypointFile;
pub use trajectory::{Motion, Segment, Trajectory, WaypointPath};
pub use tune::Tune;

/// The period of the plant and of the controller when the file names none, in seconds.
pub(super) const DEFAULT_PERIOD_S: f64 = 1e-3;

/// One experiment: a robot, what it shall do, what disturbs it and what is expected of the result.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "mmsim scenario")]
pub struct ScenarioFile {
    /// Name of the run and of its log file: no path separator, no control character, no leading dot.
    #[schemars(length(min = 1, max = 100), extend("pattern" = r"^[^./\\\x00-\x1f][^/\\\x00-\x1f]*$"))]
    pub name: String,
    /// What the scenario shows, in a sentence or two.
    #[serde(default)]
    pub description: String,
    /// Where it comes from, for example a section of the thesis.
    #[serde(default)]
    pub source: String,
    /// A file, or several, that this one continues: tables are merged key by key, everything else here replaces what is there, the
    /// later of several files the earlier. Sought in the folder of the file that names it; else a bundled scenario by its name.
    pub include: Option<Include>,
    /// Clock, integration and randomness.
    pub simulation: Simulation,
    /// The robot that the controller knows. Default: the preset `thesis`.
    #[serde(default)]
    pub robot: Robot,
    /// How the simulated robot differs from the one that the controller knows.
    #[serde(default)]
    pub plant: Plant,
    /// State at time zero; the robot starts at rest.
    #[serde(default)]
    pub initial: Initial,
    /// What the tip of the arm (or, open loop, the whole robot) shall do.
    pub trajectory: Trajectory,
    /// The control law and its gains.
    #[serde(default)]
    pub controller: Controller,
    /// Torques and forces that act on the plant unknown to the controller; they add up.
    #[serde(default)]
    pub disturbance: Vec<Disturbance>,
    /// What is corrupted between the sensors and the controller, or in its clock; several act in the order of the file.
    #[serde(default)]
    pub fault: Vec<Fault>,
    /// Bounds on the metrics of the run, by the keys of `metrics` in the summary. To miss one fails the run as the file stands; of a run with
    /// edits it is a warning.
    #[serde(default)]
    pub expect: Expect,
    /// What `mmsim sweep` varies: each sample draws every quantity anew, uniformly in its range, and leaves alone what has range
    /// zero.
    #[serde(default)]
    pub sweep: Sweep,
    /// Budget and cost of `mmsim tune`, a particle swarm (4.45), (4.46) over factors on groups of the law's default gains.
    ///
    /// The cost of a run is its ITAE sum in m s^2 plus `torque_variation_weight` times its torque variation in N m/s plus
    /// `effort_weight` times its effort in N^2 m^2 s. A run that ends early costs 1e6 and, the earlier it ends, up to as much
    /// again.
    #[serde(default)]
    pub tune: Tune,
}

/// One file, or several.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub enum Include {
    /// One.
    One(String),
    /// Several, of which the later come before the earlier.
    Several(Vec<String>),
}

/// Clock, integration and randomness.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Simulation {
    /// Simulated time; at least one control period.
    #[schemars(with = "Positive")]
    pub duration_s: f64,
    /// Step of the plant's integrator; the control period is a whole multiple of it.
    #[serde(default = "default_period")]
    #[schemars(with = "Positive")]
    pub plant_step_s: f64,
    /// Time between two updates of the controller.
    #[serde(default = "default_period")]
    #[schemars(with = "Positive")]
    pub control_period_s: f64,
    /// How the plant is integrated.
    #[serde(default)]
    pub integrator: Integrator,
    /// Seed of every random number in the run.
    #[serde(default)]
    pub seed: u64,
    /// Records a second in the log; the metrics do not depend on it.
    #[serde(default = "default_log_rate")]
    #[schemars(with = "Positive")]
    pub log_rate_hz: f64,
}

const fn default_period() -> f64 {
    DEFAULT_PERIOD_S
}

const fn default_log_rate() -> f64 {
    100.0
}

/// How the plant is integrated.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Integrator {
    /// Runge-Kutta of fourth order with a fixed step.
    #[default]
    Rk4,
}

/// State at time zero; the robot starts at rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Pose of the base, `[x_m, y_m, heading_rad]`; excludes `tip`.
    pub base_pose: Option<[f64; 3]>,
    /// Joint angles from the base to the tip. Default: the robot's rest posture.
    pub joints_rad: Option<[f64; 3]>,
    /// Places the base by the reference instead of by `base_pose`. Default: `on-reference`, when
    /// `base_pose` is not given.
    pub tip: Option<TipStart>,
    /// Moves the tip away from where it would start, in the world frame: the base by x and y, the arm, bent in its own plane, by z.
    #[serde(default)]
    pub offset_m: [f64; 3],
}

/// Where the tip of the arm is at the start.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum TipStart {
    /// On the reference in x and y, the base heading along the reference's velocity; z is not matched.
    OnReference,
}
