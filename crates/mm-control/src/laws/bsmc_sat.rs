//! `bsmc-sat`: the sliding mode with a boundary layer.

use mm_model::{Force, ParamError, Real, Velocity};

use super::{Gains, channel_zip};

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
    pub(super) fn try_new(gains: &Gains<T, N>) -> Result<Self, ParamError> {
        Ok(Self { gain: gains.switching, per_width: gains.boundary_layer.map(|width| T::ONE / width) })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> Force<T, N> {
        let scaled = s.zip(self.per_width, |s, w| s * w);
        channel_zip(&scaled, &self.gain, |x, k| -(k * x.clamp_to(-T::ONE, T::ONE)))
    }
}
