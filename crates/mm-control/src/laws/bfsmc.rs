//! `bfsmc`: the default law, a continuous fuzzy sliding mode that learns what disturbs it.

use mm_model::{Force, Real, Velocity};

use super::{Gains, channel_zip};
use crate::SetupError;
use crate::fuzzy::{FuzzySystem, Mamdani, SMOOTH, Surface};

/// Knots of the tabulated fuzzy surface.
const KNOTS: usize = 65;

/// The continuous law f = k_f phi(s / scale) - d_hat, with phi a fuzzy surface and d_hat a learned disturbance.
///
/// phi is a Mamdani system (by default [`SMOOTH`]) tabulated at construction: odd, monotone, continuous, through zero, with
/// s phi(s) < 0. d_hat is the momentum observer of [`crate::MomentumObserver`]: d_hat' = L (d - d_hat), with d everything that
/// the nominal model does not know: disturbances, wrong masses, unmodelled friction.
///
/// Stability. Write d_err = d - d_hat. With the equivalent control, M s' + C s = k_f phi(s/scale) + d_err. Take
/// V = s'M s/2 + d_err'd_err/(2 kappa). Property 3 removes C, and with |d'| <= delta,
///
/// ```text
/// V' <= -sum sigma_i s_i^2 + |s| |d_err| - (L/kappa) |d_err|^2 + (delta/kappa) |d_err|
/// ```
/// where sigma_i > 0 bounds the surface from below by a line, k_f |phi(s_i/scale)| >= sigma_i |s_i|, as long as
/// |s_i| <= s_max,i: sigma_i = k_f |phi(1)| / s_max,i once s_max,i >= scale_i. For kappa < 4 L min sigma the quadratic form is
/// negative definite: s and d_err end in a ball whose radius falls as delta/L, and s = 0 is reached for a constant d.
/// The set is left by no trajectory that starts with k_f |phi(1)| above |d_err|, which is the reaching condition that the
/// monitors report. Projecting d_hat on its bound |d_hat_i| <= limit_i moves it towards every admissible d and
/// leaves V' as it is; while a torque is limited d_hat is held, so that it learns no saturation.
///
/// Sampled with period dt: the surface's slope times dt has to stay below 2 lambda_min(M), L dt below 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bfsmc<T, const N: usize> {
    gain: Force<T, N>,
    per_scale: Velocity<T, N>,
    surface: Surface<T, KNOTS>,
}

impl<T: Real, const N: usize> Bfsmc<T, N> {
    pub(super) fn try_new(gains: &Gains<T, N>) -> Result<Self, SetupError> {
        Self::with_rules(gains, &SMOOTH.cast::<T>().engine()?)
    }

    /// The law with a rule base of the user's own. Its input range is what `s / scale` is clamped to.
    ///
    /// # Errors
    /// A gain, or a rule base that cannot be tabulated.
    pub fn with_rules(gains: &Gains<T, N>, rules: &Mamdani<'_, T>) -> Result<Self, SetupError> {
        gains.check()?;
        Ok(Self {
            gain: gains.fuzzy,
            per_scale: gains.fuzzy_scale.map(|scale| T::ONE / scale),
            surface: Surface::from_engine(rules)?,
        })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> Force<T, N> {
        let scaled = s.zip(self.per_scale, |s, w| s * w);
        channel_zip(&scaled, &self.gain, |x, k| k * self.surface.evaluate(x))
    }

    /// Force at the weaker edge of the surface.
    pub(super) fn authority(&self) -> Force<T, N> {
        let (lo, hi) = self.surface.input_range();
        let edge = self.surface.evaluate(lo).abs().min(self.surface.evaluate(hi).abs());
        self.gain.map(|gain| gain * edge)
    }
}
