//! The robot as a tree of frames: the one table behind the URDF and behind `/tf`.

use super::sample::LogSample;
use super::urdf::RobotShape;
use mm_model::Real;

/// Frame that everything is expressed in.
pub(super) const WORLD: &str = "world";
/// Frame of the base: midpoint of the wheel axle projected on the ground, x forward, z up.
pub(super) const BASE: &str = "base_link";
/// Number of joints of the tree, the fixed one at the tip included.
pub(super) const JOINTS: usize = 6;
/// Names of the joints that move, in the order of the torques.
pub(super) const MOVING_JOINTS: [&str; 5] = ["right_wheel", "left_wheel", "joint1", "joint2", "joint3"];

/// A joint: where its child frame stands in the parent frame at angle zero, and what it turns about.
#[derive(Debug, Clone, Copy)]
pub(super) struct Joint {
    pub(super) name: &'static str,
    pub(super) parent: &'static str,
    pub(super) child: &'static str,
    /// Origin of the child frame in the parent frame, m.
    pub(super) origin: [f64; 3],
    /// Unit vector that the joint turns about; zero for a fixed joint.
    pub(super) axis: [f64; 3],
}

/// Pose of a child frame in its parent frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Transform {
    pub(super) parent: &'static str,
    pub(super) child: &'static str,
    pub(super) translation: [f64; 3],
    /// Unit quaternion, x, y, z, w.
    pub(super) rotation: [f64; 4],
}

/// The joints of a robot. The moving ones come first, in the order of [`MOVING_JOINTS`].
///
/// Links 2 and 3 lie along x of their frames, and pitch turns about -y, so that a positive angle raises them.
/// Wheels turn about y, so that a positive angle rolls forward.
pub(super) fn joints(shape: &RobotShape) -> [Joint; JOINTS] {
    let half_track = shape.track_width_m / 2.0;
    let [a1, a2, a3] = shape.link_lengths_m;
    let joint = |name, parent, child, origin, axis| Joint { name, parent, child, origin, axis };
    let roll = [0.0, 1.0, 0.0];
    let yaw = [0.0, 0.0, 1.0];
    let pitch = [0.0, -1.0, 0.0];
    [
        joint("right_wheel", BASE, "right_wheel_link", [0.0, -half_track, shape.wheel_radius_m], roll),
        joint("left_wheel", BASE, "left_wheel_link", [0.0, half_track, shape.wheel_radius_m], roll),
        joint("joint1", BASE, "link1", [shape.arm_offset_m, 0.0, shape.mount_height_m], yaw),
        joint("joint2", "link1", "link2", [0.0, 0.0, a1], pitch),
        joint("joint3", "link2", "link3", [a2, 0.0, 0.0], pitch),
        joint("tip_joint", "link3", "tip", [a3, 0.0, 0.0], [0.0; 3]),
    ]
}

/// Poses of all frames at one instant: the base in the world, then one for each joint.
pub(super) fn transforms(joints: &[Joint; JOINTS], sample: &LogSample) -> [Transform; JOINTS + 1] {
    let [right, left] = sample.wheel_angles;
    let [q1, q2, q3] = sample.joints;
    let turn = |joint: &Joint, angle| Transform {
        parent: joint.parent,
        child: joint.child,
        translation: joint.origin,
        rotation: quaternion(joint.axis, angle),
    };
    let [right_wheel, left_wheel, joint1, joint2, joint3, tip] = joints;
    [
        Transform {
            parent: WORLD,
            child: BASE,
            translation: [sample.x, sample.y, 0.0],
            rotation: quaternion([0.0, 0.0, 1.0], sample.heading),
        },
        turn(right_wheel, right),
        turn(left_wheel, left),
        turn(joint1, q1),
        turn(joint2, q2),
        turn(joint3, q3),
        turn(tip, 0.0),
    ]
}

/// Quaternion (x, y, z, w) of a turn by `angle` about `axis`, a unit vector.
pub(super) fn quaternion(axis: [f64; 3], angle: f64) -> [f64; 4] {
    let (sin, cos) = Real::sin_cos(angle / 2.0);
    [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
}

#[cfg(test)]
mod tests;
