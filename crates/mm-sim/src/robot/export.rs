//! A robot as URDF.

use mm_model::RobotParams;

use crate::log::{RobotShape, urdf_with_limits};

/// Gravity that whoever reads a URDF assumes, m/s^2.
const STANDARD_GRAVITY_M_S2: f64 = 9.81;

/// Writes a robot as URDF: boxes and cylinders, masses and inertias, ranges and torques.
///
/// The base's box and the widths are for the eye. The mass of the base is that with its wheels, which have none of their own; its
/// inertia about the vertical stands for all axes.
#[must_use]
pub fn export(params: &RobotParams<f64, 3>) -> String {
    urdf_with_limits(&RobotShape::from(params), &params.limits)
}

/// What of a robot has no place in a URDF, a sentence each.
#[must_use]
pub fn left_out(params: &RobotParams<f64, 3>) -> Vec<String> {
    let mut left = vec![format!("a URDF has no rest posture, here {:?} rad", params.rest_posture)];
    if (params.gravity - STANDARD_GRAVITY_M_S2).abs() > 0.0 {
        left.push(format!("a URDF has no gravity, here {} m/s^2", params.gravity));
    }
    left
}
