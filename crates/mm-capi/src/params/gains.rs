//! Gains of the inner laws, as a struct of C.

use mm_control::Gains as StackGains;
use mm_control::laws::Misprints;
use mm_model::{Force, Real, Velocity};

use crate::MM_CHANNELS;

/// Gains of the inner laws; a law takes the ones that it knows. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Gains<T> {
    /// Switching gain k, N and N m.
    pub switching_gain: [T; MM_CHANNELS],
    /// Half-width of the boundary layer of MM_LAW_BSMC_SAT, m/s and rad/s.
    pub boundary_layer: [T; MM_CHANNELS],
    /// Force at an output of 1 of the fuzzy system, N and N m.
    pub fuzzy_gain: [T; MM_CHANNELS],
    /// Sliding variable that enters the fuzzy system as 1, m/s and rad/s.
    pub fuzzy_scale: [T; MM_CHANNELS],
    /// Bandwidth of the learned disturbance, 1/s; 0 switches learning off.
    pub observer_bandwidth_1_s: T,
    /// Largest learned disturbance, N and N m.
    pub learning_limit: [T; MM_CHANNELS],
    /// Margin asked of the reaching condition, N and N m.
    pub reaching_margin: [T; MM_CHANNELS],
    /// Gain on velocity minus virtual control (MM_LAW_CTC, MM_LAW_PID) or on s (MM_LAW_BACKSTEPPING_ADAPTIVE), 1/s.
    pub damping_gain_1_s: [T; MM_CHANNELS],
    /// Gain on the integral of that, 1/s^2.
    pub stiffness_gain_1_s2: [T; MM_CHANNELS],
    /// Gain on the integral of the integral, of MM_LAW_PID, 1/s^3.
    pub integral_gain_1_s3: [T; MM_CHANNELS],
    /// Acceptable integral of velocity minus virtual control, of MM_LAW_LQR, m and rad.
    pub acceptable_position: [T; MM_CHANNELS],
    /// Acceptable velocity minus virtual control, of MM_LAW_LQR, m/s and rad/s.
    pub acceptable_velocity: [T; MM_CHANNELS],
    /// Acceptable force, of MM_LAW_LQR, N and N m.
    pub acceptable_force: [T; MM_CHANNELS],
    /// Adaptation of the bodies' factors, 1/J.
    pub body_adaptation_gain_1_j: T,
    /// Least and largest factor on a body's inertia.
    pub body_factor: [T; 2],
    /// Adaptation of the learned force, 1/s^2.
    pub force_adaptation_gain_1_s2: T,
    /// k1 of MM_LAW_SUPER_TWISTING, N (m/s)^-1/2 and N m (rad/s)^-1/2.
    pub twisting_gain: [T; MM_CHANNELS],
    /// k2 of MM_LAW_SUPER_TWISTING, N/s and N m/s.
    pub twisting_rate_gain: [T; MM_CHANNELS],
    /// Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted sign of the thesis.
    pub misprint_sign: u32,
    /// Not 0: MM_LAW_BFSMC_THESIS keeps the misprinted channels of the thesis.
    pub misprint_channels: u32,
}

/// A vector of velocities from its channels.
pub(super) const fn velocity<T: Real>([forward, yaw_rate, a, b, c]: [T; MM_CHANNELS]) -> Velocity<T, 3> {
    Velocity { forward, yaw_rate, joints: [a, b, c] }
}

const fn force<T: Real>([forward, yaw, a, b, c]: [T; MM_CHANNELS]) -> Force<T, 3> {
    Force { forward, yaw, joints: [a, b, c] }
}

/// The channels of a vector of velocities.
pub(super) const fn rates<T: Real>(v: Velocity<T, 3>) -> [T; MM_CHANNELS] {
    let [a, b, c] = v.joints;
    [v.forward, v.yaw_rate, a, b, c]
}

const fn forces<T: Real>(f: Force<T, 3>) -> [T; MM_CHANNELS] {
    let [a, b, c] = f.joints;
    [f.forward, f.yaw, a, b, c]
}

impl<T: Real> Gains<T> {
    pub(crate) fn of(self) -> StackGains<T, 3> {
        StackGains {
            switching: force(self.switching_gain),
            boundary_layer: velocity(self.boundary_layer),
            fuzzy: force(self.fuzzy_gain),
            fuzzy_scale: velocity(self.fuzzy_scale),
            observer_bandwidth: self.observer_bandwidth_1_s,
            learning_limit: force(self.learning_limit),
            reaching_margin: force(self.reaching_margin),
            damping: velocity(self.damping_gain_1_s),
            stiffness: velocity(self.stiffness_gain_1_s2),
            integral: velocity(self.integral_gain_1_s3),
            acceptable_position: velocity(self.acceptable_position),
            acceptable_velocity: velocity(self.acceptable_velocity),
            acceptable_force: force(self.acceptable_force),
            body_adaptation: self.body_adaptation_gain_1_j,
            body_factor: self.body_factor.into(),
            force_adaptation: self.force_adaptation_gain_1_s2,
            twisting: force(self.twisting_gain),
            twisting_rate: force(self.twisting_rate_gain),
            misprints: Misprints { sign: self.misprint_sign != 0, channels: self.misprint_channels != 0 },
        }
    }
}

impl<T: Real> From<StackGains<T, 3>> for Gains<T> {
    fn from(gains: StackGains<T, 3>) -> Self {
        Self {
            switching_gain: forces(gains.switching),
            boundary_layer: rates(gains.boundary_layer),
            fuzzy_gain: forces(gains.fuzzy),
            fuzzy_scale: rates(gains.fuzzy_scale),
            observer_bandwidth_1_s: gains.observer_bandwidth,
            learning_limit: forces(gains.learning_limit),
            reaching_margin: forces(gains.reaching_margin),
            damping_gain_1_s: rates(gains.damping),
            stiffness_gain_1_s2: rates(gains.stiffness),
            integral_gain_1_s3: rates(gains.integral),
            acceptable_position: rates(gains.acceptable_position),
            acceptable_velocity: rates(gains.acceptable_velocity),
            acceptable_force: forces(gains.acceptable_force),
            body_adaptation_gain_1_j: gains.body_adaptation,
            body_factor: gains.body_factor.into(),
            force_adaptation_gain_1_s2: gains.force_adaptation,
            twisting_gain: forces(gains.twisting),
            twisting_rate_gain: forces(gains.twisting_rate),
            misprint_sign: gains.misprints.sign.into(),
            misprint_channels: gains.misprints.channels.into(),
        }
    }
}
