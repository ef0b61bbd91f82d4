//! The share of the base in the motion: none while it is held, then a smooth rise to all of it.

use mm_model::Real;

use super::OuterParams;

/// Factor beta on the inverse weights of the base, and its rate, 1/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BaseShare<T> {
    pub(super) value: T,
    pub(super) rate: T,
}

impl<T: Real> BaseShare<T> {
    /// The base takes its full part.
    pub(super) fn full() -> Self {
        Self { value: T::ONE, rate: T::ZERO }
    }
}

/// When the base is held and released, counted in updates: whole numbers, exact in every precision and free of a clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BaseHold<T> {
    period: T,
    hold: u32,
    /// Updates after which the base is free for good.
    end: u32,
}

impl<T: Real> BaseHold<T> {
    /// Hold and release of the parameters, each to the nearest update.
    pub(super) fn new<const N: usize>(params: &OuterParams<T, N>, period: T) -> Self {
        let updates = |time: T| u32::try_from((time / period + T::HALF).split_index().0).unwrap_or(u32::MAX);
        let hold = updates(params.base_hold);
        Self { period, hold, end: hold.saturating_add(updates(params.base_release)) }
    }

    /// Updates after which the base is free for good; to count farther is of no use.
    #[inline]
    pub(super) const fn updates(&self) -> u32 {
        self.end
    }

    /// beta at an update: 0 during the hold, then u^2 (3 - 2 u) over the release, then 1.
    pub(super) fn share(&self, update: u32) -> BaseShare<T> {
        let (since, whole) = (update.saturating_sub(self.hold), self.end - self.hold);
        if update < self.hold {
            return BaseShare { value: T::ZERO, rate: T::ZERO };
        }
        if since >= whole {
            return BaseShare::full();
        }
        let number = T::from_u32;
        let u = number(since) / number(whole);
        let three = T::TWO + T::ONE;
        let rate = T::TWO * three * u * (T::ONE - u) / (number(whole) * self.period);
        BaseShare { value: u * u * (three - T::TWO * u), rate }
    }
}
