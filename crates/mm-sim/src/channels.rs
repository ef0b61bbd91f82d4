//! Vectors over the channels as arrays: the two of the base, then the joints.

use mm_model::{Force, Torque, Velocity};

pub(crate) fn torques(t: &Torque<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = t.joints;
    [t.right, t.left, j1, j2, j3]
}

pub(crate) fn velocities(v: &Velocity<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = v.joints;
    [v.forward, v.yaw_rate, j1, j2, j3]
}

pub(crate) fn forces(f: &Force<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = f.joints;
    [f.forward, f.yaw, j1, j2, j3]
}
