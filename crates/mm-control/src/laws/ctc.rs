//! `ctc`: computed torque.

use mm_model::{Mechanism, ParamError, Real, Robot, Velocity};

use super::{Drive, Gains, InnerLaw, LawMemory, Tracking};

/// Computed torque on the quasi-velocities: f = M (nu_c' - Kv lag - Ki integral(lag)) + C nu + g + friction, lag = nu - nu_c.
///
/// Stability: with a true model the lag obeys x'' + Kv x' + Ki x = 0 channel by channel, asymptotically stable for Kv, Ki > 0. With
/// a wrong model or a disturbance w the right-hand side is M^-1 w: a constant w leaves no error in nu, since the integral takes it,
/// a sine one of size |M^-1 w| w / (w^2 + Kv w + Ki) roughly; nothing bounds it beforehand. Sampled with period dt: Kv dt below 2, with a
/// margin for the wrong inertia.
///
/// Uses the gains `damping` (Kv) and `stiffness` (Ki).
///
/// # Source
/// J. Y. S. Luh, M. W. Walker, R. P. C. Paul, Resolved-acceleration control of mechanical manipulators, IEEE TAC 25 (1980).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ctc<T, const N: usize> {
    damping: Velocity<T, N>,
    stiffness: Velocity<T, N>,
}

impl<T: Real, const N: usize> Ctc<T, N> {
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        Ok(Self { damping: gains.damping, stiffness: gains.stiffness })
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for Ctc<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, _memory: &LawMemory<T, N>) -> Drive<T, N> {
        let Tracking { robot, inertia, nu, .. } = at;
        let product = |a: Velocity<T, N>, b: Velocity<T, N>| a.zip(b, |a, b| a * b);
        let back = product(self.damping, at.lag).plus(product(self.stiffness, *at.lag_integral));
        let force = robot
            .mass_product(inertia, &at.dnu_c.minus(back))
            .plus(robot.coriolis_product(inertia, nu, nu))
            .plus(at.load);
        Drive::of_model(force)
    }
}
