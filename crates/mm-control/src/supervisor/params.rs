//! What the supervisor takes for plausible.

use mm_model::{Mechanism, Real, Robot, Velocity};

/// Limits of plausibility, and how long each mode may last. Periods count updates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisorParams<T, const N: usize> {
    /// Largest distance of the base, and of the reference, from the origin along each axis, m.
    pub position: T,
    /// How far beyond its limits a joint may read, rad.
    pub joint_margin: T,
    /// Largest speeds, m/s and rad/s.
    pub speed: Velocity<T, N>,
    /// Largest accelerations, m/s^2 and rad/s^2: how much a measured velocity may change in a period.
    pub acceleration: Velocity<T, N>,
    /// Noise and resolution of a measured position, m and rad.
    pub position_noise: T,
    /// The same of a measured velocity, m/s and rad/s.
    pub velocity_noise: T,
    /// Largest step of the reference in a period besides its velocity, m.
    pub reference_step: T,
    /// Largest age of an input, s.
    pub age: T,
    /// Updates that the last torque is held for.
    pub hold_periods: u32,
    /// Plausible inputs in a row after which a stopped robot runs again; `u32::MAX`: never by itself.
    pub recovery_periods: u32,
    /// Updates without a plausible state after which a stop becomes a fault.
    pub blind_periods: u32,
    /// Rate at which a stop takes the speed away, 1/s.
    pub braking_rate: T,
}

impl<T: Real, const N: usize> SupervisorParams<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Limits that suit a robot and an update period.
    #[must_use]
    pub fn for_robot(robot: &Robot<T, N>, period: T) -> Self {
        let _ = (robot, period);
        let n = T::from_u32;
        let milli = T::ONE / n(1000);
        Self {
            position: n(10_000),
            joint_margin: T::HALF,
            speed: Velocity::splat(n(20)),
            acceleration: Velocity::splat(n(2000)),
            position_noise: n(5) * milli,
            velocity_noise: n(100) * milli,
            reference_step: T::ONE,
            age: n(2) * period,
            hold_periods: 2,
            recovery_periods: 10,
            blind_periods: 500,
            braking_rate: n(20),
        }
    }
}
