//! `/control`: the fields of our own flat message, each named once.
//!
//! Schema and encoding are both made from the tables below, so they cannot disagree. The message is flat because
//! viewers plot a scalar of a known name with one click, and an element of an array with several.

use super::sample::LogSample;

/// A number of the message.
pub(super) struct Number {
    /// Field name, unit included.
    pub(super) name: &'static str,
    /// Comment in the schema.
    pub(super) comment: &'static str,
    /// Its value in a sample.
    pub(super) value: fn(&LogSample) -> f64,
}

/// A flag of the message.
pub(super) struct Flag {
    /// Field name.
    pub(super) name: &'static str,
    /// Comment in the schema.
    pub(super) comment: &'static str,
    /// Its value in a sample.
    pub(super) value: fn(&LogSample) -> bool,
}

const fn number(name: &'static str, comment: &'static str, value: fn(&LogSample) -> f64) -> Number {
    Number { name, comment, value }
}

const fn flag(name: &'static str, comment: &'static str, value: fn(&LogSample) -> bool) -> Flag {
    Flag { name, comment, value }
}

/// The numbers, in the order they are written after the header.
pub(super) static NUMBERS: [Number; 75] = [
    number("t_s", "time of the scenario", |s| s.t_s),
    number("x_m", "midpoint of the wheel axle", |s| s.x),
    number("y_m", "midpoint of the wheel axle", |s| s.y),
    number("heading_rad", "heading of the base", |s| s.heading),
    number("joint1_rad", "arm yaw", |s| s.joints[0]),
    number("joint2_rad", "shoulder pitch, positive raises the link", |s| s.joints[1]),
    number("joint3_rad", "elbow pitch, relative to link 2", |s| s.joints[2]),
    number("forward_m_s", "forward speed", |s| s.forward),
    number("yaw_rate_rad_s", "yaw rate of the base", |s| s.yaw_rate),
    number("joint1_rate_rad_s", "rate of joint 1", |s| s.joint_rates[0]),
    number("joint2_rate_rad_s", "rate of joint 2", |s| s.joint_rates[1]),
    number("joint3_rate_rad_s", "rate of joint 3", |s| s.joint_rates[2]),
    number("wheel_right_rad", "angle the right wheel has turned through, positive forward", |s| {
        s.wheel_angles[0]
    }),
    number("wheel_left_rad", "angle the left wheel has turned through, positive forward", |s| {
        s.wheel_angles[1]
    }),
    number("reference_x_m", "desired position of the tip", |s| s.p_d[0]),
    number("reference_y_m", "desired position of the tip", |s| s.p_d[1]),
    number("reference_z_m", "desired position of the tip", |s| s.p_d[2]),
    number("reference_dx_m_s", "desired velocity of the tip", |s| s.dp_d[0]),
    number("reference_dy_m_s", "desired velocity of the tip", |s| s.dp_d[1]),
    number("reference_dz_m_s", "desired velocity of the tip", |s| s.dp_d[2]),
    number("tip_x_m", "position of the tip", |s| s.tip[0]),
    number("tip_y_m", "position of the tip", |s| s.tip[1]),
    number("tip_z_m", "position of the tip", |s| s.tip[2]),
    number("error_x_m", "actual minus desired", |s| s.error[0]),
    number("error_y_m", "actual minus desired", |s| s.error[1]),
    number("error_z_m", "actual minus desired", |s| s.error[2]),
    number("virtual_forward_m_s", "velocity the outer loop asks for: forward", |s| s.nu_c[0]),
    number("virtual_yaw_rate_rad_s", "velocity the outer loop asks for: yaw rate", |s| s.nu_c[1]),
    number("virtual_joint1_rad_s", "velocity the outer loop asks for: joint 1", |s| s.nu_c[2]),
    number("virtual_joint2_rad_s", "velocity the outer loop asks for: joint 2", |s| s.nu_c[3]),
    number("virtual_joint3_rad_s", "velocity the outer loop asks for: joint 3", |s| s.nu_c[4]),
    number("estimated_forward_m_s", "velocity the controller works with: forward", |s| s.estimated[0]),
    number("estimated_yaw_rate_rad_s", "velocity the controller works with: yaw rate", |s| s.estimated[1]),
    number("estimated_joint1_rad_s", "velocity the controller works with: joint 1", |s| s.estimated[2]),
    number("estimated_joint2_rad_s", "velocity the controller works with: joint 2", |s| s.estimated[3]),
    number("estimated_joint3_rad_s", "velocity the controller works with: joint 3", |s| s.estimated[4]),
    number("sliding_forward_m_s", "sliding variable: forward", |s| s.sliding[0]),
    number("sliding_yaw_rate_rad_s", "sliding variable: yaw rate", |s| s.sliding[1]),
    number("sliding_joint1_rad_s", "sliding variable: joint 1", |s| s.sliding[2]),
    number("sliding_joint2_rad_s", "sliding variable: joint 2", |s| s.sliding[3]),
    number("sliding_joint3_rad_s", "sliding variable: joint 3", |s| s.sliding[4]),
    number("torque_commanded_right_n_m", "commanded by the controller: right wheel", |s| {
        s.torque_commanded[0]
    }),
    number("torque_commanded_left_n_m", "commanded by the controller: left wheel", |s| s.torque_commanded[1]),
    number("torque_commanded_joint1_n_m", "commanded by the controller: joint 1", |s| s.torque_commanded[2]),
    number("torque_commanded_joint2_n_m", "commanded by the controller: joint 2", |s| s.torque_commanded[3]),
    number("torque_commanded_joint3_n_m", "commanded by the controller: joint 3", |s| s.torque_commanded[4]),
    number("torque_applied_right_n_m", "at the input of the plant: right wheel", |s| s.torque_applied[0]),
    number("torque_applied_left_n_m", "at the input of the plant: left wheel", |s| s.torque_applied[1]),
    number("torque_applied_joint1_n_m", "at the input of the plant: joint 1", |s| s.torque_applied[2]),
    number("torque_applied_joint2_n_m", "at the input of the plant: joint 2", |s| s.torque_applied[3]),
    number("torque_applied_joint3_n_m", "at the input of the plant: joint 3", |s| s.torque_applied[4]),
    number("disturbance_right_n_m", "disturbance torque: right wheel", |s| s.disturbance[0]),
    number("disturbance_left_n_m", "disturbance torque: left wheel", |s| s.disturbance[1]),
    number("disturbance_joint1_n_m", "disturbance torque: joint 1", |s| s.disturbance[2]),
    number("disturbance_joint2_n_m", "disturbance torque: joint 2", |s| s.disturbance[3]),
    number("disturbance_joint3_n_m", "disturbance torque: joint 3", |s| s.disturbance[4]),
    number("fuzzy_forward_n", "fuzzy part of the generalized force: along forward", |s| s.fuzzy[0]),
    number("fuzzy_yaw_n_m", "fuzzy part of the generalized force: about the vertical", |s| s.fuzzy[1]),
    number("fuzzy_joint1_n_m", "fuzzy part of the generalized force: joint 1", |s| s.fuzzy[2]),
    number("fuzzy_joint2_n_m", "fuzzy part of the generalized force: joint 2", |s| s.fuzzy[3]),
    number("fuzzy_joint3_n_m", "fuzzy part of the generalized force: joint 3", |s| s.fuzzy[4]),
    number("learned_forward_n", "learned part of the generalized force: along forward", |s| s.learned[0]),
    number("learned_yaw_n_m", "learned part of the generalized force: about the vertical", |s| s.learned[1]),
    number("learned_joint1_n_m", "learned part of the generalized force: joint 1", |s| s.learned[2]),
    number("learned_joint2_n_m", "learned part of the generalized force: joint 2", |s| s.learned[3]),
    number("learned_joint3_n_m", "learned part of the generalized force: joint 3", |s| s.learned[4]),
    number("manipulability", "square root of det(J transpose(J))", |s| s.manipulability),
    number("damping", "damping of the pseudo-inverse", |s| s.damping),
    number(
        "reaching_bound_forward_n",
        "smallest switching gain that reaches, 0 for a law without one: along forward",
        |s| s.reaching_bound[0],
    ),
    number(
        "reaching_bound_yaw_n_m",
        "smallest switching gain that reaches, 0 for a law without one: about the vertical",
        |s| s.reaching_bound[1],
    ),
    number(
        "reaching_bound_joint1_n_m",
        "smallest switching gain that reaches, 0 for a law without one: joint 1",
        |s| s.reaching_bound[2],
    ),
    number(
        "reaching_bound_joint2_n_m",
        "smallest switching gain that reaches, 0 for a law without one: joint 2",
        |s| s.reaching_bound[3],
    ),
    number(
        "reaching_bound_joint3_n_m",
        "smallest switching gain that reaches, 0 for a law without one: joint 3",
        |s| s.reaching_bound[4],
    ),
    number("lyapunov_j", "V = s'Ms/2 with the true inertia", |s| s.lyapunov),
    number("lyapunov_rate_w", "its rate along the true motion, but for an estimator's error and slip", |s| {
        s.lyapunov_rate
    }),
];

/// The flags, after the numbers.
pub(super) static FLAGS: [Flag; 9] = [
    flag("saturated", "a torque was limited", |s| s.saturated),
    flag(
        "near_singular",
        "manipulability below the threshold (damped if damping is on), or the free channels do not suffice",
        |s| s.near_singular,
    ),
    flag("speed_limited", "the outer loop bounded the correction's speed or the base's forward speed", |s| {
        s.speed_limited
    }),
    flag("joint_limited", "a joint's rate was held to the bound that keeps it within its limits", |s| {
        s.joint_limited
    }),
    flag("torque_limited_right", "cut to the limit: right wheel", |s| s.torque_limited[0]),
    flag("torque_limited_left", "cut to the limit: left wheel", |s| s.torque_limited[1]),
    flag("torque_limited_joint1", "cut to the limit: joint 1", |s| s.torque_limited[2]),
    flag("torque_limited_joint2", "cut to the limit: joint 2", |s| s.torque_limited[3]),
    flag("torque_limited_joint3", "cut to the limit: joint 3", |s| s.torque_limited[4]),
];

/// Names of the fields of `/control` after its header: the numbers, then the flags.
pub fn control_field_names() -> impl Iterator<Item = &'static str> {
    NUMBERS.iter().map(|field| field.name).chain(FLAGS.iter().map(|field| field.name))
}

#[cfg(test)]
mod tests {
    use super::control_field_names;
    use std::collections::BTreeSet;

    #[test]
    fn names_are_unique_and_valid_in_a_message_definition() {
        let mut seen = BTreeSet::new();
        for name in control_field_names() {
            assert!(seen.insert(name), "{name} is there twice");
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
            assert!(name.chars().all(plain), "{name} is a lower-case identifier");
            assert!(!name.contains("__") && !name.ends_with('_'), "{name} keeps to the rules of ROS");
        }
    }
}
