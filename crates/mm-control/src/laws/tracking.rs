//! What an inner law sees at an update, and what it gives back.

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use super::RobustForce;

/// The tracking problem at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Tracking<'a, T: Real, const N: usize>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The robot that the controller believes in.
    pub robot: &'a Robot<T, N>,
    /// Its posture: sines and cosines of the arm.
    pub posture: &'a <Robot<T, N> as Mechanism<T, N>>::Posture,
    /// Its inertia in that posture.
    pub inertia: &'a <Robot<T, N> as Mechanism<T, N>>::Inertia,
    /// Measured or estimated velocity.
    pub nu: &'a Velocity<T, N>,
    /// nu_c', what the outer loop asks for.
    pub dnu_c: &'a Velocity<T, N>,
    /// nu - nu_c.
    pub lag: Velocity<T, N>,
    /// integral(nu - nu_c).
    pub lag_integral: &'a Velocity<T, N>,
    /// nu_r = nu_c - c integral(nu - nu_c).
    pub nu_r: Velocity<T, N>,
    /// Its rate.
    pub dnu_r: Velocity<T, N>,
    /// s = nu - nu_r.
    pub sliding: Velocity<T, N>,
    /// Friction at nu.
    pub friction: Force<T, N>,
    /// Gravity and friction.
    pub load: Force<T, N>,
    /// Time between two updates, s.
    pub period: T,
}

impl<T: Real, const N: usize> Tracking<'_, T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The equivalent control M nu_r' + C nu_r + g + friction.
    #[must_use]
    #[inline(always)]
    pub fn equivalent(&self) -> Force<T, N> {
        let Self { robot, inertia, nu, nu_r, dnu_r, .. } = self;
        robot.mass_product(inertia, dnu_r).plus(robot.coriolis_product(inertia, nu, nu_r)).plus(self.load)
    }

    /// The equivalent control with a force of s on top.
    #[must_use]
    #[inline(always)]
    pub fn switching(&self, robust: RobustForce<T, N>) -> Drive<T, N> {
        let equivalent = self.equivalent();
        Drive {
            force: equivalent.plus(robust.total),
            equivalent,
            fuzzy: robust.fuzzy,
            learned: None,
            memory: None,
        }
    }
}

/// The force that a law applies, in parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive<T, const N: usize> {
    /// Generalized force, before a momentum observer's part and the limits.
    pub force: Force<T, N>,
    /// The part that takes the model as true; the rest opposes s.
    pub equivalent: Force<T, N>,
    /// The share of a fuzzy system.
    pub fuzzy: Force<T, N>,
    /// The disturbance that the law itself has learned, part of `force` with the other sign.
    pub learned: Option<Force<T, N>>,
    /// What the law remembers if no torque is limited; none for a law without memory.
    pub memory: Option<LawMemory<T, N>>,
}

/// What a law remembers between updates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub enum LawMemory<T, const N: usize> {
    /// Nothing yet.
    None,
    /// The integral of integral(nu - nu_c), of `pid`.
    Integral(Velocity<T, N>),
    /// The integrated force v of `super-twisting`.
    Force(Force<T, N>),
    /// The estimates of `backstepping-adaptive`: factors on the bodies' inertias, and a force.
    Estimates {
        /// Factor on the base.
        base: T,
        /// Factors on the links.
        #[cfg_attr(feature = "serde", serde(with = "mm_model::array"))]
        links: [T; N],
        /// d_hat.
        force: Force<T, N>,
    },
}

impl<T: Real, const N: usize> Drive<T, N> {
    /// A force that takes the model as true, of a law without memory.
    #[must_use]
    pub fn of_model(force: Force<T, N>) -> Self {
        Self { force, equivalent: force, fuzzy: Force::zero(), learned: None, memory: None }
    }
}

impl<T: Real, const N: usize> LawMemory<T, N> {
    /// Whether nothing in it is infinite or NaN.
    #[must_use]
    #[inline]
    pub fn is_finite(&self) -> bool {
        match self {
            Self::None => true,
            Self::Integral(value) => value.is_finite(),
            Self::Force(value) => value.is_finite(),
            Self::Estimates { base, links, force } => {
                let rest = Force { forward: *base, yaw: T::ZERO, joints: *links };
                rest.is_finite() && force.is_finite()
            }
        }
    }
}
