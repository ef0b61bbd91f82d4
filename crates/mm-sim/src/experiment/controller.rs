//! The control stack of a scenario: defaults that follow the robot, overridden by what the file gives.

use mm_control::laws::Misprints;
use mm_control::{ControlStack, Gains, LawKind, OuterParams, SetupError, StackParams};
use mm_model::{Force, Robot, Velocity};
use nalgebra::Vector3;

use super::law_kind;
use crate::scenario::{self, Loaded, ScenarioError};

/// The control stack: defaults that follow the robot, overridden by what the file gives.
pub(super) fn stack(loaded: &Loaded, robot: Robot<f64, 3>) -> Result<ControlStack<f64, 3>, ScenarioError> {
    let (kind, params) = params(loaded, &robot)?;
    let delay = loaded.file.controller.estimator.delay_s;
    let stack = match super::fuzzy::term(loaded, kind)? {
        Some(term) => ControlStack::with_fuzzy(robot, kind, term, params),
        None => ControlStack::try_new(robot, kind, params),
    };
    stack.and_then(|stack| stack.with_delay(delay)).map_err(|error| refused(loaded, &error))
}

/// The law of a scenario and its parameters.
pub(super) fn params(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
) -> Result<(LawKind, StackParams<f64, 3>), ScenarioError> {
    let file = &loaded.file;
    let period = file.simulation.control_period_s;
    let kind = law_kind(file.controller.kind).unwrap_or(LawKind::Bfsmc);
    let given = &file.controller.gains;
    let mut gains = match given.switching_gain {
        None => Gains::for_robot(robot, kind, period),
        Some(k) => Gains::with_switching(robot, kind, period, Force::from_channels(k.into_iter())),
    };
    let force = |raw: Option<[f64; 5]>, default| {
        raw.map_or(default, |values| Force::from_channels(values.into_iter()))
    };
    let velocity = |raw: Option<[f64; 5]>, default| {
        raw.map_or(default, |values| Velocity::from_channels(values.into_iter()))
    };
    gains.boundary_layer = velocity(given.boundary_layer, gains.boundary_layer);
    gains.fuzzy = force(given.fuzzy_gain, gains.fuzzy);
    gains.fuzzy_scale = velocity(given.fuzzy_scale, gains.fuzzy_scale);
    gains.observer_bandwidth = given.observer_bandwidth_1_s.unwrap_or(gains.observer_bandwidth);
    gains.learning_limit = force(given.learning_limit, gains.learning_limit);
    gains.reaching_margin = force(given.reaching_margin, gains.reaching_margin);
    let each = |raw: Option<scenario::PerChannel>, default| velocity(raw.map(|raw| raw.expand()), default);
    gains.damping = each(given.damping_gain_1_s, gains.damping);
    gains.stiffness = each(given.stiffness_gain_1_s2, gains.stiffness);
    gains.integral = each(given.integral_gain_1_s3, gains.integral);
    gains.acceptable_position = velocity(given.acceptable_position, gains.acceptable_position);
    gains.acceptable_velocity = velocity(given.acceptable_velocity, gains.acceptable_velocity);
    gains.acceptable_force = force(given.acceptable_force, gains.acceptable_force);
    gains.body_adaptation = given.body_adaptation_gain_1_j.unwrap_or(gains.body_adaptation);
    gains.body_factor = given.body_factor.map_or(gains.body_factor, |[least, most]| (least, most));
    gains.force_adaptation = given.force_adaptation_gain_1_s2.unwrap_or(gains.force_adaptation);
    gains.twisting = force(given.twisting_gain, gains.twisting);
    let scenario::Misprints { sign, channels } = given.misprints;
    gains.misprints = Misprints { sign, channels };
    gains.twisting_rate = force(given.twisting_rate_gain, gains.twisting_rate);
    let outer = outer(robot, &file.controller.outer);
    let estimator = super::hardware::estimator(loaded)?;
    Ok((kind, StackParams { period, outer, gains, estimator }))
}

/// Parameters that do not work together, at their place in the file.
fn refused(loaded: &Loaded, error: &SetupError) -> ScenarioError {
    let key = match error {
        SetupError::Param(error) => {
            let name = error.parameter();
            let outer = OUTER.contains(&name) || name.starts_with("base_") || name.contains("_rad");
            let part = match name {
                "cutoff_hz" | "delay_s" => "estimator",
                _ if outer => "outer",
                _ => "gains",
            };
            format!("controller.{part}.{name}")
        }
        _ => "controller.gains".to_owned(),
    };
    loaded.problem(&key, error.to_string(), "gains that the law can work with")
}

/// Parameters of the outer loop; besides these, those with an angle in their unit.
const OUTER: [&str; 8] = [
    "position_gain_1_s",
    "sliding_gain_1_s",
    "posture_gain_1_s",
    "weights",
    "damping_max",
    "manipulability_threshold",
    "correction_speed_limit_m_s",
    "joint_limit_rate_1_s",
];

fn outer(robot: &Robot<f64, 3>, raw: &scenario::Outer) -> OuterParams<f64, 3> {
    let mut outer = OuterParams::for_robot(robot);
    if let Some(gain) = raw.position_gain_1_s {
        outer.position_gain = Vector3::from(gain.expand());
    }
    if let Some(gain) = raw.sliding_gain_1_s {
        outer.sliding_gain = Velocity::from_channels(gain.expand().into_iter());
    }
    if let Some(weights) = raw.weights {
        outer.weights = Velocity::from_channels(weights.into_iter());
    }
    let set = |field: &mut f64, value: Option<f64>| *field = value.unwrap_or(*field);
    set(&mut outer.posture_gain, raw.posture_gain_1_s);
    set(&mut outer.joint_limit_gain, raw.joint_limit_gain_rad_s);
    set(&mut outer.joint_limit_margin, raw.joint_limit_margin_rad);
    set(&mut outer.manipulability_gain, raw.manipulability_gain_rad_s);
    set(&mut outer.manipulability_threshold, raw.manipulability_threshold);
    set(&mut outer.damping_max, raw.damping_max);
    set(&mut outer.correction_speed_limit, raw.correction_speed_limit_m_s);
    set(&mut outer.joint_limit_rate, raw.joint_limit_rate_1_s);
    outer.base_hold = raw.base_hold_s;
    outer.base_release = raw.base_release_s;
    outer.minimum_norm = raw.minimum_norm;
    outer
}
