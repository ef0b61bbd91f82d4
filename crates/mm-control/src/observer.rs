//! Momentum observer: what acts on the robot beyond the nominal model.

use mm_model::{Force, Real};

/// State of a [`MomentumObserver`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct ObserverState<T, const N: usize> {
    /// Momentum that the nominal model accounts for, kg m/s and kg m^2/s; none before the first update.
    explained: Option<Force<T, N>>,
    /// Learned disturbance, N and N m.
    learned: Force<T, N>,
}

impl<T: Real, const N: usize> ObserverState<T, N> {
    /// Nothing learned yet.
    pub(crate) fn initial() -> Self {
        Self { explained: None, learned: Force::zero() }
    }

    /// The learned disturbance d_hat, on the side of the applied force, N and N m.
    pub(crate) const fn learned(&self) -> &Force<T, N> {
        &self.learned
    }

    /// Whether nothing in it is infinite or NaN.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        self.learned.is_finite() && self.explained.is_none_or(|momentum| momentum.is_finite())
    }
}

/// Momentum observer with projection and anti-windup.
///
/// With p = M nu, d/dt p = f + C'nu - g - friction + d for the generalized disturbance d. The observer
///
/// ```text
/// d_hat = L (p - integral(f + C'nu - g - friction + d_hat) - p(0))
/// ```
/// is a first-order filter of it, d_hat' = L (d - d_hat), and needs no acceleration. Projection keeps |d_hat_i| <= limit_i; while a torque
/// is limited d_hat is held. Both move the accounted momentum along, so that learning goes on from where it stopped.
///
/// # Source
/// A. De Luca, R. Mattone, Actuator failure detection and isolation using generalized momenta, ICRA 2003.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MomentumObserver<T, const N: usize> {
    pub(crate) bandwidth: T,
    pub(crate) limit: Force<T, N>,
    pub(crate) period: T,
}

impl<T: Real, const N: usize> MomentumObserver<T, N> {
    /// The disturbance learned up to now, given the momentum now; `hold` keeps the last one.
    #[inline]
    pub(crate) fn learn(
        &self,
        state: &ObserverState<T, N>,
        momentum: &Force<T, N>,
        hold: bool,
    ) -> ObserverState<T, N> {
        let learned = match (&state.explained, hold) {
            (Some(explained), false) => momentum.minus(*explained).scaled(self.bandwidth),
            (Some(_), true) => state.learned,
            (None, _) => Force::zero(),
        };
        let learned = learned.zip(self.limit, |d, limit| d.clamp_to(-limit, limit));
        let explained = momentum.minus(learned.scaled(T::ONE / self.bandwidth));
        ObserverState { explained: Some(explained), learned }
    }

    /// Accounts for one period under the force that the model knows of: applied force + C'nu - g - friction.
    #[inline]
    pub(crate) fn account(&self, state: &mut ObserverState<T, N>, known: &Force<T, N>) {
        if let Some(explained) = &mut state.explained {
            *explained = explained.plus(known.plus(state.learned).scaled(self.period));
        }
    }
}
