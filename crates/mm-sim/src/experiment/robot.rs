//! The robot of a scenario: preset or file, and the fields given over it.

use mm_model::{Friction, ParamError, Robot, RobotParams};

use crate::scenario::{self, Loaded, ScenarioError};

/// Parameters of the robot, unchecked.
pub(super) fn params(loaded: &Loaded) -> Result<RobotParams<f64, 3>, ScenarioError> {
    let robot = &loaded.file.robot;
    let fields = &robot.fields;
    if robot.file.is_some() && robot.preset.is_none() {
        demand_complete(loaded)?;
    }
    let mut p = RobotParams::thesis();
    let set = |field: &mut f64, value: Option<f64>| *field = value.unwrap_or(*field);
    set(&mut p.base_mass, fields.base_mass_kg);
    set(&mut p.base_yaw_inertia, fields.base_yaw_inertia_kg_m2);
    set(&mut p.base_com_offset, fields.base_com_offset_m);
    set(&mut p.arm_offset, fields.arm_offset_m);
    set(&mut p.mount_height, fields.mount_height_m);
    set(&mut p.wheel_radius, fields.wheel_radius_m);
    set(&mut p.track_width, fields.track_width_m);
    set(&mut p.gravity, fields.gravity_m_s2);
    set(&mut p.limits.wheel_torque, fields.wheel_torque_limit_n_m);
    p.rest_posture = fields.rest_posture_rad.unwrap_or(p.rest_posture);
    let limits = p.limits.joints.iter_mut().zip(&mut p.limits.joint_torque);
    for ((link, (angle_limit, torque_limit)), raw) in p.links.iter_mut().zip(limits).zip(&fields.link) {
        set(&mut link.length, raw.length_m);
        set(&mut link.mass, raw.mass_kg);
        set(&mut link.com, raw.com_m);
        if let Some([axial, pitch, normal]) = raw.inertia_kg_m2 {
            link.axial_inertia = axial;
            link.pitch_inertia = pitch;
            link.normal_inertia = normal;
        }
        if let Some([lo, hi]) = raw.joint_limit_rad {
            *angle_limit = (lo, hi);
        }
        set(torque_limit, raw.torque_limit_n_m);
    }
    Ok(p)
}

/// A robot file on its own has to say what the robot is; only offsets, limits, gravity and rest posture have defaults.
fn demand_complete(loaded: &Loaded) -> Result<(), ScenarioError> {
    let f = &loaded.file.robot.fields;
    let mut missing: Vec<String> = [
        ("base_mass_kg", f.base_mass_kg.is_none()),
        ("base_yaw_inertia_kg_m2", f.base_yaw_inertia_kg_m2.is_none()),
        ("arm_offset_m", f.arm_offset_m.is_none()),
        ("wheel_radius_m", f.wheel_radius_m.is_none()),
        ("track_width_m", f.track_width_m.is_none()),
    ]
    .into_iter()
    .filter(|(_, lacks)| *lacks)
    .map(|(name, _)| name.to_owned())
    .collect();
    for number in 0..3 {
        match f.link.get(number) {
            None => missing.push(format!("link.{number}")),
            Some(link) => missing.extend(
                [
                    ("length_m", link.length_m.is_none()),
                    ("mass_kg", link.mass_kg.is_none()),
                    ("com_m", link.com_m.is_none()),
                    ("inertia_kg_m2", link.inertia_kg_m2.is_none()),
                ]
                .into_iter()
                .filter(|(_, lacks)| *lacks)
                .map(|(name, _)| format!("link.{number}.{name}")),
            ),
        }
    }
    if missing.is_empty() {
        return Ok(());
    }
    let list = missing.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    Err(loaded.problem(
        "robot.file",
        format!("the robot file leaves open {list}"),
        "these keys in the robot file or in [robot]",
    ))
}

/// The same parameters with the factors that only the plant has.
pub(super) fn scaled(mut p: RobotParams<f64, 3>, scale: &scenario::PlantScale) -> RobotParams<f64, 3> {
    p.base_mass *= scale.base_mass;
    p.base_yaw_inertia *= scale.base_yaw_inertia;
    p.base_com_offset *= scale.base_com;
    let factors = scale.link_mass.iter().zip(&scale.link_inertia).zip(&scale.link_com);
    for (link, ((mass, inertia), com)) in p.links.iter_mut().zip(factors) {
        link.mass *= mass;
        link.axial_inertia *= inertia;
        link.pitch_inertia *= inertia;
        link.normal_inertia *= inertia;
        link.com *= com;
    }
    p
}

/// The robot of checked parameters.
pub(super) fn checked(loaded: &Loaded, params: RobotParams<f64, 3>) -> Result<Robot<f64, 3>, ScenarioError> {
    Robot::try_new(params).map_err(|error: ParamError| {
        let name = error.parameter();
        let key = if ["inertia_kg_m2", "joint_limit_rad", "com_m", "length_m", "mass_kg"].contains(&name) {
            format!("robot.link.0.{name}")
        } else {
            format!("robot.{name}")
        };
        loaded.problem(
            &key,
            error.to_string(),
            "a robot whose every joint moves some inertia in every posture",
        )
    })
}

/// Friction of the plant.
pub(super) const fn friction(raw: &scenario::Friction) -> Friction<f64, 3> {
    Friction {
        wheel_viscous: raw.wheel_viscous_n_m_s,
        wheel_coulomb: raw.wheel_coulomb_n_m,
        joint_viscous: raw.joint_viscous_n_m_s,
        joint_coulomb: raw.joint_coulomb_n_m,
        smoothing: raw.smoothing_rad_s,
    }
}
