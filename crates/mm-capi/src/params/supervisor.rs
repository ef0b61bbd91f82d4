//! What the supervisor takes for plausible, as a struct of C.

use mm_control::SupervisorParams;
use mm_model::Real;

use super::gains::{rates, velocity};
use crate::MM_CHANNELS;

/// Limits of plausibility, and how long each mode may last. Arrays hold forward, yaw, joint 1, joint 2, joint 3.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Supervisor<T> {
    /// Largest distance of the base, and of the reference, from the origin along each axis, m.
    pub position_m: T,
    /// How far beyond its limits a joint may read, rad.
    pub joint_margin_rad: T,
    /// Largest speeds, m/s and rad/s; the first is the largest of the reference too.
    pub speed: [T; MM_CHANNELS],
    /// Largest accelerations, m/s^2 and rad/s^2: how much a measured velocity may change in a period.
    pub acceleration: [T; MM_CHANNELS],
    /// Noise and resolution of a measured position, m and rad.
    pub position_noise: T,
    /// The same of a measured velocity, m/s and rad/s; below it the robot counts as at rest.
    pub velocity_noise: T,
    /// Largest step of the reference in a period besides its velocity, m.
    pub reference_step_m: T,
    /// Largest acceleration of the reference along each axis, m/s^2.
    pub reference_acceleration_m_s2: T,
    /// Largest age of an input, s.
    pub age_s: T,
    /// Rate at which a stop takes the speed away, 1/s; at most 0.1 per period of it is used.
    pub braking_rate_1_s: T,
    /// Updates that the last torque is held for.
    pub hold_periods: u32,
    /// Plausible inputs in a row after which a stopped robot runs again; UINT32_MAX: never by itself.
    pub recovery_periods: u32,
    /// Updates without a plausible state after which a stop becomes a fault.
    pub blind_periods: u32,
    /// Updates in which a stop has to bring the robot to rest.
    pub stop_periods: u32,
}

impl<T: Real> Supervisor<T> {
    pub(crate) const fn of(self) -> SupervisorParams<T, 3> {
        SupervisorParams {
            position: self.position_m,
            joint_margin: self.joint_margin_rad,
            speed: velocity(self.speed),
            acceleration: velocity(self.acceleration),
            position_noise: self.position_noise,
            velocity_noise: self.velocity_noise,
            reference_step: self.reference_step_m,
            reference_acceleration: self.reference_acceleration_m_s2,
            age: self.age_s,
            hold_periods: self.hold_periods,
            recovery_periods: self.recovery_periods,
            blind_periods: self.blind_periods,
            stop_periods: self.stop_periods,
            braking_rate: self.braking_rate_1_s,
        }
    }
}

impl<T: Real> From<SupervisorParams<T, 3>> for Supervisor<T> {
    fn from(limits: SupervisorParams<T, 3>) -> Self {
        Self {
            position_m: limits.position,
            joint_margin_rad: limits.joint_margin,
            speed: rates(limits.speed),
            acceleration: rates(limits.acceleration),
            position_noise: limits.position_noise,
            velocity_noise: limits.velocity_noise,
            reference_step_m: limits.reference_step,
            reference_acceleration_m_s2: limits.reference_acceleration,
            age_s: limits.age,
            braking_rate_1_s: limits.braking_rate,
            hold_periods: limits.hold_periods,
            recovery_periods: limits.recovery_periods,
            blind_periods: limits.blind_periods,
            stop_periods: limits.stop_periods,
        }
    }
}
