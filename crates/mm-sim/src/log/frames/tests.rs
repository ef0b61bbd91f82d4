//! The published frames put the tip where the closed form of the kinematics puts it.
//!
//! Reference: tip = (x + `l_b` cos h + rho cos(h + q1), y + `l_b` sin h + rho sin(h + q1), `z_mount` + a1 + a2 sin q2 +
//! a3 sin(q2 + q3)) with rho = a2 cos q2 + a3 cos(q2 + q3). Tolerance: 16 eps times the robot's reach plus its
//! distance from the origin, for six rotations and as many additions.

use super::{Transform, joints, transforms};
use crate::log::sample::LogSample;
use crate::log::urdf::{RobotShape, tests::thesis_like};
use mm_model::Real;

/// `v` turned by the quaternion (x, y, z, w): `v + 2 w (u x v) + 2 u x (u x v)`.
fn rotate([x, y, z, w]: [f64; 4], v: [f64; 3]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    };
    let u = [x, y, z];
    let once = cross(u, v);
    let twice = cross(u, once);
    core::array::from_fn(|i| v[i] + 2.0 * (w * once[i] + twice[i]))
}

/// World coordinates of a point given in the frame `frame`, by following parents up to the world.
fn to_world(transforms: &[Transform], frame: &str, point: [f64; 3]) -> [f64; 3] {
    if frame == "world" {
        return point;
    }
    let transform = transforms.iter().find(|t| t.child == frame).expect("every frame has a parent");
    let turned = rotate(transform.rotation, point);
    let parent_point = core::array::from_fn(|i| transform.translation[i] + turned[i]);
    to_world(transforms, transform.parent, parent_point)
}

fn closed_form(shape: &RobotShape, s: &LogSample) -> [f64; 3] {
    let [a1, a2, a3] = shape.link_lengths_m;
    let [q1, q2, q3] = s.joints;
    let (sin_h, cos_h) = Real::sin_cos(s.heading);
    let (sin_psi, cos_psi) = Real::sin_cos(s.heading + q1);
    let (sin_2, cos_2) = Real::sin_cos(q2);
    let (sin_23, cos_23) = Real::sin_cos(q2 + q3);
    let rho = a2 * cos_2 + a3 * cos_23;
    [
        s.x + shape.arm_offset_m * cos_h + rho * cos_psi,
        s.y + shape.arm_offset_m * sin_h + rho * sin_psi,
        shape.mount_height_m + a1 + a2 * sin_2 + a3 * sin_23,
    ]
}

/// A sample whose coordinates run through their ranges without a common period.
fn pose(k: u32) -> LogSample {
    let turn = |ratio: f64, span: f64| span * ((f64::from(k) * ratio).fract() - 0.5);
    LogSample {
        x: turn(0.618_033, 20.0),
        y: turn(0.414_213, 20.0),
        heading: turn(0.732_050, 12.0),
        joints: [turn(0.236_067, 6.0), turn(0.645_751, 6.0), turn(0.302_775, 6.0)],
        wheel_angles: [turn(0.872_983, 900.0), turn(0.123_105, 900.0)],
        ..LogSample::default()
    }
}

#[test]
fn the_frames_reach_the_tip_of_the_closed_form() {
    let shape = RobotShape {
        arm_offset_m: 0.17,
        mount_height_m: 0.31,
        link_lengths_m: [0.4, 0.6, 0.55],
        ..thesis_like()
    };
    let joints = joints(&shape);
    let mut largest = 0.0_f64;
    for k in 0..1_000 {
        let sample = pose(k);
        let tip = to_world(&transforms(&joints, &sample), "tip", [0.0; 3]);
        let expected = closed_form(&shape, &sample);
        for i in 0..3 {
            largest = largest.max((tip[i] - expected[i]).abs());
        }
    }
    assert!(largest < 16.0 * f64::EPSILON * 22.0, "largest difference {largest:e} m");
}

#[test]
fn a_positive_pitch_raises_the_link() {
    let sample = LogSample { joints: [0.0, core::f64::consts::FRAC_PI_2, 0.0], ..LogSample::default() };
    let tip = to_world(&transforms(&joints(&thesis_like()), &sample), "tip", [0.0; 3]);
    assert!((tip[2] - 1.5).abs() < 1e-15, "three links of 0.5 m upright: {tip:?}");
}

#[test]
fn a_wheel_rolls_forward_and_stands_on_the_ground() {
    let sample = LogSample { wheel_angles: [0.1, 0.0], ..LogSample::default() };
    let transforms = transforms(&joints(&thesis_like()), &sample);
    let top = to_world(&transforms, "right_wheel_link", [0.0, 0.0, 0.06]);
    assert!(top[0] > 0.0, "the top of a wheel that rolls forward moves forward: {top:?}");
    let bottom = to_world(&transforms, "left_wheel_link", [0.0, 0.0, -0.06]);
    assert!(bottom[2].abs() < 1e-15, "the wheel touches the ground: {bottom:?}");
    assert!(bottom[1] > 0.0, "the left wheel is on the left: {bottom:?}");
}
