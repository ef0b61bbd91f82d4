//! The parameters that a viewer may change while a run goes on: the gains of the law and those of the outer loop.
//!
//! They have the names of the scenario's keys, and a change goes the way of `--set`: the same checks, the same messages.

use foxglove::websocket::{Parameter, ParameterValue};
use mm_control::{ControlStack, Gains, OuterParams};

/// Where the gains of the law stand in a scenario, and those of the outer loop.
const LAW: &str = "controller.gains";
const OUTER: &str = "controller.outer";

/// All of them, as a stack has them.
pub(super) fn of(stack: &ControlStack<f64, 3>) -> Vec<Parameter> {
    let g: &Gains<f64, 3> = stack.gains();
    let o: &OuterParams<f64, 3> = stack.outer().params();
    let law = |name: &str, values: Vec<f64>| parameter(LAW, name, values);
    let outer = |name: &str, values: Vec<f64>| parameter(OUTER, name, values);
    vec![
        law("switching_gain", g.switching.channels().collect()),
        law("boundary_layer", g.boundary_layer.channels().collect()),
        law("fuzzy_gain", g.fuzzy.channels().collect()),
        law("fuzzy_scale", g.fuzzy_scale.channels().collect()),
        law("observer_bandwidth_1_s", vec![g.observer_bandwidth]),
        law("learning_limit", g.learning_limit.channels().collect()),
        law("damping_gain_1_s", g.damping.channels().collect()),
        law("stiffness_gain_1_s2", g.stiffness.channels().collect()),
        law("integral_gain_1_s3", g.integral.channels().collect()),
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

/// Whether a key is that of a gain.
pub(super) fn is_gain(key: &str) -> bool {
    [LAW, OUTER].iter().any(|table| key.strip_prefix(table).is_some_and(|rest| rest.starts_with('.')))
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
        ParameterValue::Dict(entries) => {
            let entries = entries
                .iter()
                .map(|(key, value)| format!("{} = {}", toml::Value::from(key.as_str()), to_toml(value)));
            format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
