//! `bfsmc`: the default law, a continuous fuzzy sliding mode that learns what disturbs it.

use mm_model::{Force, Mechanism, Real, Robot, Velocity};

use super::fuzzy_term::opposes;
use super::{FuzzyTerm, Gains, InnerLaw, RobustForce, SwitchingTerm};
use crate::SetupError;
use crate::fuzzy::{Bundled, FuzzyError};

/// The continuous law f = k_f phi(s / scale) - d_hat, with phi a fuzzy surface and d_hat a learned disturbance.
///
/// phi is a fuzzy system, tabulated at construction unless a [`FuzzyTerm`] says otherwise, that never aids s: s phi(s) <= 0, phi(0) = 0. The default,
/// [`SMOOTH`](crate::fuzzy::SMOOTH), is odd and
/// falls monotonely as well. d_hat comes from a momentum observer with bandwidth L, a projection on |d_hat_i| <= limit_i and
/// anti-windup: the sum of everything that the nominal model does not account for.
///
/// Stability, for a known inertia and an unknown generalized force w with |w'| <= W (disturbances, an unmodelled load).
/// With the equivalent control and Property 3, and d_err = w - d_hat,
///
/// ```text
/// M s' + C s = k_f phi(s/scale) + d_err,   d_err' = w' - L d_err
/// ```
/// Let sigma_i > 0 bound the surface from below by a line, k_f |phi(s_i/scale)| >= sigma_i |s_i| for |s_i| <= s_max,i; for the
/// default sigma_i = k_f |phi(1)| / s_max,i does, once s_max,i >= scale_i. Then V = s'M s/2 + d_err'd_err/(2 kappa) obeys, where |s_i| <= s_max,i,
///
/// ```text
/// V' <= -min(sigma) |s|^2 + |s| |d_err| - (L/kappa) |d_err|^2 + (W/kappa) |d_err|
/// ```
/// whose quadratic part is negative definite for kappa < 4 L min(sigma). So within the largest level set of V that fits
/// between the bounds s_max, (s, d_err) ends in a ball whose radius falls as W/L, and tends to zero exponentially for a constant
/// w. The projection moves d_hat towards every w within the limits and does not add to V'; while a torque is limited
/// the argument rests, d_hat being held so that it learns no saturation.
///
/// With a wrong inertia d_hat depends on the acceleration that it causes itself, and |w'| <= W is an assumption along the trajectory, not one
/// beforehand; the tests run masses that are off by 25 % and 40 %.
///
/// Sampled with period dt: dt times the largest eigenvalue of M^-1 diag(slope) has to stay below 2 (the default gains keep the sum of
/// all its eigenvalues at (2 + N) / 10 in the rest posture), L dt below 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bfsmc<T: 'static, const N: usize, F = FuzzyTerm<T>> {
    gain: Force<T, N>,
    per_scale: Velocity<T, N>,
    term: F,
}

impl<T: Real, const N: usize> Bfsmc<T, N> {
    /// The law with the default surface.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, SetupError>
    where
        T: Bundled,
    {
        Self::with_term(gains, FuzzyTerm::smooth()?)
    }
}

impl<T: Real, const N: usize, F: SwitchingTerm<T>> Bfsmc<T, N, F> {
    /// The law with a fuzzy system of the user's own. Its input range is what `s / scale` is clamped to.
    ///
    /// # Errors
    /// A gain, or a system that aids s somewhere: `rules` out of range.
    pub fn with_term(gains: &Gains<T, N>, term: F) -> Result<Self, SetupError> {
        gains.check()?;
        if !opposes(&term) {
            return Err(FuzzyError::OutOfRange("rules").into());
        }
        Ok(Self { gain: gains.fuzzy, per_scale: gains.fuzzy_scale.map(|scale| T::ONE / scale), term })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> Force<T, N> {
        let scaled = s.zip(self.per_scale, |s, w| s * w);
        self.term.force(&scaled, &self.gain)
    }

    /// Force at the weaker edge of the surface.
    pub(super) fn authority(&self) -> Force<T, N> {
        let (lo, hi) = self.term.input_range();
        let edge = self.term.evaluate(lo).abs().min(self.term.evaluate(hi).abs());
        self.gain.map(|gain| gain * edge)
    }
}

impl<T: Real, const N: usize, F: SwitchingTerm<T>> InnerLaw<T, N> for Bfsmc<T, N, F>
where
    Robot<T, N>: Mechanism<T, N>,
{
    #[inline(always)]
    fn switching_force(&self, s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        let force = self.force(s);
        Some(RobustForce { total: force, fuzzy: force })
    }

    #[inline]
    fn learns(&self) -> bool {
        true
    }
}
