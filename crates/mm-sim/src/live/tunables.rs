//! The parameters that a viewer may change while a run goes on: those gains of the law and of the outer loop that act.
//!
//! They have the names of the scenario's keys, and a change goes the way of `--set`: the same checks, the same messages.

use foxglove::websocket::{Parameter, ParameterValue};
use mm_control::{ControlStack, Gains, OuterParams};

use crate::experiment::{self, controller_name};
use crate::scenario::{Loaded, ScenarioError};

/// Where the gains of the law stand in a scenario, and those of the outer loop.
const LAW: &str = "controller.gains";
const OUTER: &str = "controller.outer";

/// The gains that act in the law of a scenario, as its stack has them: a change of any other would change nothing.
///
/// Not among them: what is a choice and no gain.
pub(super) fn of(scenario: &Loaded, stack: &ControlStack<f64, 3>) -> Vec<Parameter> {
    let mut all = all(stack);
    all.retain(|parameter| {
        let Some(other) = parameter.value.as_ref().map(nudged) else { return false };
        let tried = scenario
            .edited(&[edit(scenario, &parameter.name, &to_toml(&other))])
            .and_then(|loaded| experiment::stack(&loaded));
        // A gain at the end of its range is one all the same.
        tried.map_or(true, |tried| !tried.acts_as(stack))
    });
    all
}

/// The same ones with the values of another stack.
pub(super) fn refreshed(served: &[Parameter], stack: &ControlStack<f64, 3>) -> Vec<Parameter> {
    let mut all = all(stack);
    all.retain(|parameter| served.iter().any(|other| other.name == parameter.name));
    all
}

/// The edit of a scenario that gives a gain a value, whatever file or argument gave it one before.
pub(super) fn edit(scenario: &Loaded, name: &str, value: &str) -> String {
    match name.strip_prefix(LAW) {
        Some(gain) => {
            let law = controller_name(scenario.file.controller.kind);
            format!("controller.gains_for.{law}{gain}={value}")
        }
        None => format!("{name}={value}"),
    }
}

/// Why an edit was refused, with the names that viewers know.
pub(super) fn refusal(scenario: &Loaded, error: &ScenarioError) -> String {
    let law = controller_name(scenario.file.controller.kind);
    error.in_words().replace(&format!("controller.gains_for.{law}"), LAW)
}

fn all(stack: &ControlStack<f64, 3>) -> Vec<Parameter> {
    let g: &Gains<f64, 3> = stack.gains();
    let o: &OuterParams<f64, 3> = stack.outer().params();
    let law = |name: &str, values: Vec<f64>| parameter(LAW, name, values);
    let outer = |name: &str, values: Vec<f64>| parameter(OUTER, name, values);
    vec![
        law("switching_gain", g.switching.channels().collect()),
        law("boundary_layer", g.boundary_layer.channels().collect()),
        law("fuzzy_gain", g.fuzzy.channels().collect()),
        law("fuzzy_scale", g.fuzzy_scale.channels().collect()),
        law("learning_limit", g.learning_limit.channels().collect()),
        law("observer_bandwidth_1_s", vec![g.observer_bandwidth]),
        law("damping_gain_1_s", g.damping.channels().collect()),
        law("stiffness_gain_1_s2", g.stiffness.channels().collect()),
        law("integral_gain_1_s3", g.integral.channels().collect()),
        law("acceptable_position", g.acceptable_position.channels().collect()),
        law("acceptable_velocity", g.acceptable_velocity.channels().collect()),
        law("acceptable_force", g.acceptable_force.channels().collect()),
        law("body_adaptation_gain_1_j", vec![g.body_adaptation]),
        law("force_adaptation_gain_1_s2", vec![g.force_adaptation]),
        law("twisting_gain", g.twisting.channels().collect()),
        law("twisting_rate_gain", g.twisting_rate.channels().collect()),
        outer("position_gain_1_s", o.position_gain.iter().copied().collect()),
        outer("sliding_gain_1_s", o.sliding_gain.channels().collect()),
        outer("weights", o.weights.channels().collect()),
        outer("posture_gain_1_s", vec![o.posture_gain]),
        outer("joint_limit_gain_rad_s", vec![o.joint_limit_gain]),
        outer("joint_limit_margin_rad", vec![o.joint_limit_margin]),
        outer("manipulability_gain_rad_s", vec![o.manipulability_gain]),
        outer("damping_max", vec![o.damping_max]),
        outer("manipulability_threshold", vec![o.manipulability_threshold]),
        outer("correction_speed_limit_m_s", vec![o.correction_speed_limit]),
        outer("joint_limit_rate_1_s", vec![o.joint_limit_rate]),
    ]
}

fn parameter(table: &str, name: &str, values: Vec<f64>) -> Parameter {
    let name = format!("{table}.{name}");
    match values.as_slice() {
        [value] => Parameter::float64(name, *value),
        _ => Parameter::float64_array(name, values),
    }
}

/// A value a little smaller, and not zero.
fn nudged(value: &ParameterValue) -> ParameterValue {
    match value {
        ParameterValue::Float64(number) => ParameterValue::Float64(0.99 * number + 1e-6),
        ParameterValue::Array(values) => ParameterValue::Array(values.iter().map(nudged).collect()),
        other => other.clone(),
    }
}

/// Whether two values are the same number or numbers, but for the last digits, which the protocol's JSON may lose on the way.
pub(super) fn is_same(one: &ParameterValue, other: &ParameterValue) -> bool {
    #[expect(clippy::cast_precision_loss, reason = "whole numbers come from sliders")]
    let number = |value: &ParameterValue| match value {
        ParameterValue::Float64(number) => Some(*number),
        ParameterValue::Integer(number) => Some(*number as f64),
        _ => None,
    };
    match (one, other) {
        (ParameterValue::Array(one), ParameterValue::Array(other)) => {
            one.len() == other.len() && one.iter().zip(other).all(|(one, other)| is_same(one, other))
        }
        _ => number(one)
            .zip(number(other))
            .is_some_and(|(one, other)| (one - other).abs() <= 1e-14 * one.abs().max(other.abs())),
    }
}

/// A value as TOML.
pub(super) fn to_toml(value: &ParameterValue) -> String {
    match value {
        ParameterValue::Integer(number) => number.to_string(),
        ParameterValue::Float64(number) => format!("{number:?}"),
        ParameterValue::Bool(flag) => flag.to_string(),
        ParameterValue::String(text) => toml::Value::from(text.as_str()).to_string(),
        ParameterValue::Array(values) => {
            let values: Vec<String> = values.iter().map(to_toml).collect();
            format!("[{}]", values.join(", "))
        }
        ParameterValue::Dict(_) => "{}".to_owned(), // no gain is one
    }
}
