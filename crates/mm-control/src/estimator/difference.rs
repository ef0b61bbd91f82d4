//! Filtered differences: the velocity without a model.

use mm_model::{Real, Velocity};

/// A Butterworth low-pass of second order over the differences of the measured coordinates.
///
/// Equation, for the displacement D since the last measurement, period dt and w = 2 pi cutoff:
///
/// ```text
/// v[k] = b D[k]/dt - a1 v[k-1] - a2 v[k-2],   b = 1 + a1 + a2
/// a1 = -2 exp(-w dt/sqrt 2) cos(w dt/sqrt 2),   a2 = exp(-sqrt 2 w dt)
/// ```
/// The poles are those of w^2/(s^2 + sqrt 2 w s + w^2), mapped exactly by z = exp(s dt); at rest v = D/dt. The lag is sqrt 2/w, and
/// half a period more for the difference.
///
/// White noise of standard deviation sigma in the positions becomes sigma b/dt sqrt(2/((1 - a2)(1 + a2 - a1))) in the velocity: 137/s
/// times sigma at 60 Hz and 1 kHz. One pole would give 342/s and leave the noise almost white at high frequencies, and its jumps from one
/// update to the next are what the torques would follow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct DifferenceFilter<T> {
    a1: T,
    a2: T,
    /// b/dt.
    gain: T,
}

/// The last two velocities.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(super) struct DifferenceState<T, const N: usize> {
    pub(super) velocity: Velocity<T, N>,
    before: Velocity<T, N>,
}

impl<T: Real, const N: usize> DifferenceState<T, N> {
    pub(super) fn at_rest() -> Self {
        Self { velocity: Velocity::zero(), before: Velocity::zero() }
    }
}

impl<T: Real> DifferenceFilter<T> {
    pub(super) fn new(cutoff_hz: T, period: T) -> Self {
        let angle = T::TAU * cutoff_hz * period / T::TWO.sqrt();
        let decay = (-angle).exp();
        let (a1, a2) = (-T::TWO * decay * angle.sin_cos().1, decay * decay);
        Self { a1, a2, gain: (T::ONE + a1 + a2) / period }
    }

    #[inline]
    pub(super) fn next<const N: usize>(
        &self,
        state: &DifferenceState<T, N>,
        moved: &Velocity<T, N>,
    ) -> DifferenceState<T, N> {
        let past = state.velocity.scaled(self.a1).plus(state.before.scaled(self.a2));
        DifferenceState { velocity: moved.scaled(self.gain).minus(past), before: state.velocity }
    }
}
