//! What enters and leaves an update of the control stack.

use mm_model::{Configuration, Force, Torque, Velocity};
use nalgebra::Vector3;

/// Where the tip should be, and how that moves: position, velocity and acceleration in the world frame.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: mm_model::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Reference<T> {
    /// Position p_d, m.
    #[cfg_attr(feature = "serde", serde(with = "crate::vector"))]
    pub position: Vector3<T>,
    /// Velocity p_d', m/s.
    #[cfg_attr(feature = "serde", serde(with = "crate::vector"))]
    pub velocity: Vector3<T>,
    /// Acceleration p_d'', m/s^2.
    #[cfg_attr(feature = "serde", serde(with = "crate::vector"))]
    pub acceleration: Vector3<T>,
}

/// What enters one update.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: mm_model::Real + serde::Deserialize<'de>"
    ))
)]
pub struct Input<T, const N: usize> {
    /// Configuration of the robot.
    pub q: Configuration<T, N>,
    /// Its quasi-velocities.
    pub nu: Velocity<T, N>,
    /// The reference at this instant.
    pub reference: Reference<T>,
}

/// Numerical outcomes of an update. None of them is an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Status {
    /// A torque was cut to its limit.
    pub saturated: bool,
    /// The manipulability is below its threshold, where the pseudo-inverse is damped if damping is on, or the channels free to move do not
    /// suffice: the tip may fall behind.
    pub near_singular: bool,
    /// The correction of the tip's error was cut to its largest speed, or the base held to the speed up to which the model holds.
    pub speed_limited: bool,
    /// A joint's rate was held to the bound that keeps it within its limits.
    pub joint_limited: bool,
    /// A joint is outside its limits.
    pub beyond_joint_limit: bool,
}

/// The signals of the law, for logs and monitors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signals<T, const N: usize> {
    /// Velocity that the law worked with: the caller's, or the estimated one.
    pub nu: Velocity<T, N>,
    /// Tip by the controller's kinematics, m.
    pub tip: Vector3<T>,
    /// Tip error, actual minus desired, m.
    pub error: Vector3<T>,
    /// Virtual control.
    pub nu_c: Velocity<T, N>,
    /// Reference velocity of the sliding mode, nu_c - c integral(nu - nu_c).
    pub nu_r: Velocity<T, N>,
    /// Its rate.
    pub dnu_r: Velocity<T, N>,
    /// Sliding variable s = nu - nu_r.
    pub sliding: Velocity<T, N>,
    /// The law's force as far as it takes the model as true; the rest opposes s.
    pub equivalent: Force<T, N>,
    /// Force of the fuzzy system.
    pub fuzzy: Force<T, N>,
    /// Learned disturbance.
    pub learned: Force<T, N>,
    /// Torque asked for, before the limits.
    pub commanded: Torque<T, N>,
    /// det(J J').
    pub manipulability_squared: T,
    /// Square of the damping.
    pub damping_squared: T,
}

/// What one update gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Output<T, const N: usize> {
    /// Torque to apply until the next update, within the limits.
    pub torque: Torque<T, N>,
    /// Outcomes.
    pub status: Status,
    /// Signals of the law.
    pub signals: Signals<T, N>,
}
