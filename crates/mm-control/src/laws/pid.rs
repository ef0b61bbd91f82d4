//! `pid`: joints by PID, the base by PID after partial feedback linearization.

use mm_model::{Force, Mechanism, ParamError, Real, Robot, Velocity};

use super::{Drive, EffectiveInertia, Gains, InnerLaw, LawMemory, Tracking};

/// PID with lag = nu - nu_c as the rate of the controlled error x = integral(lag):
///
/// ```text
/// a = nu_c' - Kd lag - Kp x - Ki integral(x)
/// base:    f_b = M_bb a_b + (C nu)_b + friction_b       partial feedback linearization: the arm's acceleration is left out
/// joints:  f_i = m_i (a_i - nu_c,i')                   m_i the effective inertia at the rest posture
/// ```
/// The joints know neither gravity nor coupling: their integral has to find the load, and until it has, the arm sags.
///
/// Stability: each channel alone, with its own inertia, has the polynomial p^3 + Kd p^2 + Kp p + Ki, stable for Kd Kp > Ki > 0
/// (Routh, Hurwitz). For the coupled robot that is no proof: gravity and coupling are disturbances, met by gain.
///
/// Uses the gains `damping` (Kd), `stiffness` (Kp) and `integral` (Ki).
///
/// # Source
/// M. W. Spong, Partial feedback linearization of underactuated mechanical systems, IROS 1994 (linearizing a subset of the coordinates);
/// R. Kelly, PID control of robot manipulators, Control of Robot Manipulators in Joint Space (2005), chapter 9.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pid<T, const N: usize> {
    proportional: Velocity<T, N>,
    integral: Velocity<T, N>,
    derivative: Velocity<T, N>,
    inertia: Force<T, N>,
}

impl<T: Real, const N: usize> Pid<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The law for a robot, with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(robot: &Robot<T, N>, gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        let EffectiveInertia(inertia) = EffectiveInertia::of(robot);
        Ok(Self {
            proportional: gains.stiffness,
            integral: gains.integral,
            derivative: gains.damping,
            inertia,
        })
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for Pid<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, memory: &LawMemory<T, N>) -> Drive<T, N> {
        let Tracking { robot, inertia, nu, .. } = at;
        let sum = if let LawMemory::Integral(sum) = memory { *sum } else { Velocity::zero() };
        let product = |a: Velocity<T, N>, b: Velocity<T, N>| a.zip(b, |a, b| a * b);
        let back = product(self.derivative, at.lag)
            .plus(product(self.proportional, *at.lag_integral))
            .plus(product(self.integral, sum));
        let wanted = Velocity { joints: [T::ZERO; N], ..at.dnu_c.minus(back) };
        let base = robot.mass_product(inertia, &wanted).plus(robot.coriolis_product(inertia, nu, nu));
        let mut force = Force {
            forward: base.forward + at.friction.forward,
            yaw: base.yaw + at.friction.yaw,
            joints: self.inertia.joints,
        };
        for (joint, back) in force.joints.iter_mut().zip(back.joints) {
            *joint *= -back;
        }
        let memory = LawMemory::Integral(sum.plus(at.lag_integral.scaled(at.period)));
        Drive { memory: Some(memory), ..Drive::of_model(force) }
    }
}
