//! What the supervisor takes for plausible, and how long each of its modes may last.

use mm_model::{Mechanism, ParamError, Real, Robot, Velocity, check};

use crate::laws::gains::{EffectiveInertia, force_limits};

/// Limits of plausibility, and how long each mode may last. Periods count updates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct SupervisorParams<T, const N: usize> {
    /// Largest distance of the base, and of the reference, from the origin along each axis, m.
    pub position: T,
    /// How far beyond its limits a joint may read, rad.
    pub joint_margin: T,
    /// Largest speeds, m/s and rad/s; the first is the largest of the reference too.
    pub speed: Velocity<T, N>,
    /// Largest accelerations, m/s^2 and rad/s^2: how much a measured velocity may change in a period.
    pub acceleration: Velocity<T, N>,
    /// Noise and resolution of a measured position, m and rad.
    pub position_noise: T,
    /// The same of a measured velocity, m/s and rad/s; below it the robot counts as at rest.
    pub velocity_noise: T,
    /// Largest step of the reference in a period besides its velocity, m.
    pub reference_step: T,
    /// Largest acceleration of the reference along each axis, m/s^2.
    pub reference_acceleration: T,
    /// Largest age of an input, s.
    pub age: T,
    /// Updates that the last torque is held for.
    pub hold_periods: u32,
    /// Plausible inputs in a row after which a stopped robot runs again; `u32::MAX`: never by itself.
    pub recovery_periods: u32,
    /// Updates without a plausible state after which a stop becomes a fault.
    pub blind_periods: u32,
    /// Updates in which a stop has to bring the robot to rest.
    pub stop_periods: u32,
    /// Rate at which a stop takes the speed away, 1/s; at most 0.1 per period of it is used.
    pub braking_rate: T,
}

impl<T: Real, const N: usize> SupervisorParams<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Limits that suit a robot and an update period.
    ///
    /// | limit | default |
    /// | --- | --- |
    /// | position | 10 km |
    /// | joint margin | 0.5 rad |
    /// | speed | four times the forward speed up to which the model holds; 20 rad/s for yaw and joints |
    /// | acceleration | five times what the largest torque gives the effective inertia at the rest posture |
    /// | noise | 5 mm and 5 mrad; 0.1 m/s and 0.1 rad/s |
    /// | reference | steps of 1 m, 1000 m/s^2 |
    /// | age | two periods |
    /// | hold, recovery | 2 and 10 updates |
    /// | blind, stop | 0.5 s and 5 s, at least 2 updates more than are held |
    /// | braking rate | 20/s |
    #[must_use]
    pub fn for_robot(robot: &Robot<T, N>, period: T) -> Self {
        let n = T::from_u32;
        let milli = T::ONE / n(1000);
        let hold_periods = 2;
        let EffectiveInertia(inertia) = EffectiveInertia::of(robot);
        let acceleration = force_limits(robot).zip(inertia, |force, inertia| n(5) * force / inertia);
        let lasting = |time: T| count((time / period).split_index().0).max(2 * hold_periods);
        Self {
            position: n(10_000),
            joint_margin: T::HALF,
            speed: Velocity { forward: n(4) * robot.params().limits.speed, ..Velocity::splat(n(20)) },
            acceleration: Velocity::from_channels(acceleration.channels()),
            position_noise: n(5) * milli,
            velocity_noise: n(100) * milli,
            reference_step: T::ONE,
            reference_acceleration: n(1000),
            age: n(2) * period,
            hold_periods,
            recovery_periods: 10,
            blind_periods: lasting(T::HALF),
            stop_periods: lasting(n(5)),
            braking_rate: n(20),
        }
    }
}

impl<T: Real, const N: usize> SupervisorParams<T, N> {
    /// Checks every field.
    ///
    /// # Errors
    /// Names the first that is infinite, NaN or of a sign that it cannot have; `hold_periods`, `blind_periods` or `stop_periods`
    /// where a robot would be stopped or given up before it is held.
    pub fn check(&self) -> Result<(), ParamError> {
        check::positive(self.position, "position_m")?;
        check::non_negative(self.joint_margin, "joint_margin_rad")?;
        self.speed.channels().try_for_each(|limit| check::positive(limit, "speed").map(|_| ()))?;
        self.acceleration
            .channels()
            .try_for_each(|limit| check::positive(limit, "acceleration").map(|_| ()))?;
        check::positive(self.position_noise, "position_noise")?;
        check::positive(self.velocity_noise, "velocity_noise")?;
        check::positive(self.reference_step, "reference_step_m")?;
        check::positive(self.reference_acceleration, "reference_acceleration_m_s2")?;
        check::non_negative(self.age, "age_s")?;
        check::positive(self.braking_rate, "braking_rate_1_s")?;
        if self.hold_periods > MOST_HELD {
            return Err(ParamError::OutOfRange("hold_periods"));
        }
        if self.recovery_periods == 0 {
            return Err(ParamError::NonPositive("recovery_periods"));
        }
        if self.blind_periods <= self.hold_periods {
            return Err(ParamError::OutOfRange("blind_periods"));
        }
        if self.stop_periods == 0 {
            return Err(ParamError::NonPositive("stop_periods"));
        }
        Ok(())
    }
}

/// Updates beyond which a torque is no longer held but out of control.
const MOST_HELD: u32 = 100;

/// A number of updates as it is counted.
fn count(updates: usize) -> u32 {
    u32::try_from(updates).unwrap_or(u32::MAX)
}
