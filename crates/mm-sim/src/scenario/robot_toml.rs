//! A robot as a TOML text that reads back to the same numbers.

use std::fmt::Write as _;

use mm_model::RobotParams;

/// The `[robot]` table of parameters, complete: every field, numbers with the digits that read back to the same bits.
///
/// The friction of the parameters is not in it: a scenario gives that to the plant alone.
#[must_use]
pub fn robot_toml(params: &RobotParams<f64, 3>) -> String {
    format!("[robot]\n{}", fields(params, "robot.link"))
}

/// The same as a file of its own, as `robot.file` names one.
#[must_use]
pub fn robot_file_toml(params: &RobotParams<f64, 3>) -> String {
    fields(params, "link")
}

fn fields(params: &RobotParams<f64, 3>, links: &str) -> String {
    let mut text = String::new();
    let numbers = [
        ("base_mass_kg", params.base_mass),
        ("base_yaw_inertia_kg_m2", params.base_yaw_inertia),
        ("base_com_offset_m", params.base_com_offset),
        ("arm_offset_m", params.arm_offset),
        ("mount_height_m", params.mount_height),
        ("wheel_radius_m", params.wheel_radius),
        ("track_width_m", params.track_width),
        ("gravity_m_s2", params.gravity),
        ("wheel_torque_limit_n_m", params.limits.wheel_torque),
    ];
    for (key, value) in numbers {
        let _ = writeln!(text, "{key} = {value:?}");
    }
    let _ = writeln!(text, "rest_posture_rad = {:?}", params.rest_posture);
    let limits = params.limits.joints.iter().zip(&params.limits.joint_torque);
    for (link, ((lo, hi), torque)) in params.links.iter().zip(limits) {
        let _ = write!(
            text,
            "\n[[{links}]]\nlength_m = {:?}\nmass_kg = {:?}\ncom_m = {:?}\ninertia_kg_m2 = {:?}\n\
             joint_limit_rad = {:?}\ntorque_limit_n_m = {torque:?}\n",
            link.length,
            link.mass,
            link.com,
            [link.axial_inertia, link.pitch_inertia, link.normal_inertia],
            [*lo, *hi],
        );
    }
    text
}
