//! `bsmc-sat`: the sliding mode with a boundary layer.

use mm_model::{Force, Mechanism, ParamError, Real, Robot, Velocity};

use super::{Gains, InnerLaw, RobustForce, channel_zip};

/// The switching law with sign replaced by saturation: f = -k sat(s / phi), sat(x) = x clamped to [-1, 1].
///
/// Stability: outside the layer |s_i| <= phi_i as for [`Bsmc`](super::Bsmc). Inside it the loop is linear with slope k/phi, and a
/// constant disturbance d leaves s = phi d / k: the layer trades chattering for a steady error.
///
/// # Source
/// J.-J. Slotine, W. Li, Applied Nonlinear Control (1991), section 7.2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BsmcSat<T, const N: usize> {
    pub(super) gain: Force<T, N>,
    per_width: Velocity<T, N>,
}

impl<T: Real, const N: usize> BsmcSat<T, N> {
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        Ok(Self { gain: gains.switching, per_width: gains.boundary_layer.map(|width| T::ONE / width) })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> Force<T, N> {
        let scaled = s.zip(self.per_width, |s, w| s * w);
        channel_zip(&scaled, &self.gain, |x, k| -(k * x.clamp_to(-T::ONE, T::ONE)))
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for BsmcSat<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    #[inline(always)]
    fn switching_force(&self, s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        Some(RobustForce::plain(self.force(s)))
    }
}
