//! `bsmc`: backstepping with a sliding mode of sign, the baseline of the thesis.

use mm_model::{Force, Mechanism, ParamError, Real, Robot, Velocity};

use super::{Gains, InnerLaw, RobustForce, channel_zip};

/// The switching law of (4.30): f = -k sign(s), sign(0) = 0.
///
/// Stability (4.34 to 4.44): with V = s'M s/2 and k_i at least |uncertainty_i| + |f_ext,i| + eta_i (the bound of (4.44), which
/// forgets the external force, mended) V' <= -sum eta_i |s_i|: s reaches zero in finite time, in continuous time. Sampled
/// with period dt it stays in a band of the order k dt / lambda_min(M) and switches there at every period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bsmc<T, const N: usize> {
    pub(super) gain: Force<T, N>,
}

impl<T: Real, const N: usize> Bsmc<T, N> {
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        Ok(Self { gain: gains.switching })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> Force<T, N> {
        channel_zip(s, &self.gain, |s, k| -(k * s.sign()))
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for Bsmc<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    #[inline(always)]
    fn switching_force(&self, s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        Some(RobustForce::plain(self.force(s)))
    }
}
