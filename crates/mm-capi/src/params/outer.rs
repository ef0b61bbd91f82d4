//! Gains of the outer loop, as a struct of C.

use mm_control::OuterParams;
use mm_model::Real;
use nalgebra::Vector3;

use super::gains::{rates, velocity};
use crate::MM_CHANNELS;

/// Gains of the outer loop and of the sliding surface. Arrays of five hold forward, yaw, joint 1, joint 2, joint 3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Outer<T> {
    /// Decay rate of the tip's error along x, y, z, 1/s.
    pub position_gain_1_s: [T; 3],
    /// Gain on the integral of velocity minus virtual control in the sliding variable, 1/s.
    pub sliding_gain_1_s: [T; MM_CHANNELS],
    /// Weight of each quasi-velocity in the pseudo-inverse.
    pub weights: [T; MM_CHANNELS],
    /// Pull towards the rest posture, 1/s.
    pub posture_gain_1_s: T,
    /// Push off a joint limit, rad/s.
    pub joint_limit_gain_rad_s: T,
    /// Distance from a joint limit at which the push begins, rad.
    pub joint_limit_margin_rad: T,
    /// Climb of the manipulability below its threshold, rad^2/s.
    pub manipulability_gain_rad_s: T,
    /// Manipulability below which damping and climb set in.
    pub manipulability_threshold: T,
    /// Largest damping.
    pub damping_max: T,
    /// Largest speed that the correction of the tip's error asks for, m/s.
    pub correction_speed_limit_m_s: T,
    /// Rate at which the joint rates asked for may approach a joint limit, 1/s; 0 sets no bound, on the forward speed neither.
    pub joint_limit_rate_1_s: T,
    /// Time from the first update over which the base is held and the arm alone follows, s.
    pub base_hold_s: T,
    /// Time over which the base's share then rises from 0 to 1, s.
    pub base_release_s: T,
    /// Not 0: plain minimum norm, without posture task, damping, bounds on rates and weights.
    pub minimum_norm: u32,
}

impl<T: Real> Outer<T> {
    pub(crate) fn of(self) -> OuterParams<T, 3> {
        OuterParams {
            position_gain: Vector3::from(self.position_gain_1_s),
            sliding_gain: velocity(self.sliding_gain_1_s),
            weights: velocity(self.weights),
            posture_gain: self.posture_gain_1_s,
            joint_limit_gain: self.joint_limit_gain_rad_s,
            joint_limit_margin: self.joint_limit_margin_rad,
            manipulability_gain: self.manipulability_gain_rad_s,
            manipulability_threshold: self.manipulability_threshold,
            damping_max: self.damping_max,
            correction_speed_limit: self.correction_speed_limit_m_s,
            joint_limit_rate: self.joint_limit_rate_1_s,
            base_hold: self.base_hold_s,
            base_release: self.base_release_s,
            minimum_norm: self.minimum_norm != 0,
        }
    }
}

impl<T: Real> From<OuterParams<T, 3>> for Outer<T> {
    fn from(outer: OuterParams<T, 3>) -> Self {
        Self {
            position_gain_1_s: outer.position_gain.into(),
            sliding_gain_1_s: rates(outer.sliding_gain),
            weights: rates(outer.weights),
            posture_gain_1_s: outer.posture_gain,
            joint_limit_gain_rad_s: outer.joint_limit_gain,
            joint_limit_margin_rad: outer.joint_limit_margin,
            manipulability_gain_rad_s: outer.manipulability_gain,
            manipulability_threshold: outer.manipulability_threshold,
            damping_max: outer.damping_max,
            correction_speed_limit_m_s: outer.correction_speed_limit,
            joint_limit_rate_1_s: outer.joint_limit_rate,
            base_hold_s: outer.base_hold,
            base_release_s: outer.base_release,
            minimum_norm: outer.minimum_norm.into(),
        }
    }
}
