//! When a loop counts as diverged.

use mm_model::Velocity;
use nalgebra::Vector3;

/// The first state that shows that the loop ran away: non-finite, |e| above 10 m, a velocity above 1000.
#[inline]
pub(crate) fn runaway(error: &Vector3<f64>, nu: &Velocity<f64, 3>) -> Option<(&'static str, f64)> {
    let squared = error.x * error.x + error.y * error.y + error.z * error.z;
    let fast = |x: f64| !(x.abs() <= 1000.0);
    let [d1, d2, d3] = nu.joints;
    if squared <= 100.0 && ![nu.forward, nu.yaw_rate, d1, d2, d3].into_iter().any(fast) {
        return None;
    }
    let names = [
        "forward speed (m/s)",
        "yaw rate (rad/s)",
        "rate of joint 1 (rad/s)",
        "rate of joint 2 (rad/s)",
        "rate of joint 3 (rad/s)",
    ];
    let velocity = names.into_iter().zip(nu.channels()).find(|(_, value)| fast(*value));
    Some(velocity.unwrap_or(("distance of the tip from its reference (m)", mm_model::Real::sqrt(squared))))
}
