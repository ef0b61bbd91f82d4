//! A fixed-point scalar for cores without floating-point hardware.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_lossless,
    reason = "words are taken apart, and constant functions have no From"
)]

mod arithmetic;
mod convert;
mod divide;
mod functions;
mod root;
mod turn;
mod wide;

use super::Real;

/// A fixed-point number: a 64-bit word that counts units of 2^-32.
///
/// | | |
/// | --- | --- |
/// | range | -2^28 to 2^28, 2.7e8 |
/// | resolution | 2^-32, 2.3e-10, everywhere |
/// | special | two infinities, and "no number" (NaN) |
///
/// Outside the range, results are infinite with the sign of the exact one, as in floating point, and infinity is not left again: any sum,
/// product or quotient with an infinity is infinite or NaN, any with a NaN is NaN, and so is zero times infinity, the
/// difference of two infinities and every quotient by an infinity, which floating point makes zero. An infinity is above
/// (below) every number in comparisons, a NaN compares with nothing, itself included. So what checks its results for being finite
/// finds an overflow anywhere before them; only comparisons, and what is made of them, and [`exp`](Real::exp) of minus infinity, which is zero, do
/// without it. What floating point makes inexact, this makes coarse: a magnitude below 2^-33 is zero,
/// and there is no negative zero.
///
/// In units of 2^-32, with the results rounded:
///
/// | operation | largest error |
/// | --- | --- |
/// | sum, difference, negation, comparison | exact |
/// | product, quotient, square root, [`from_f64`](Real::from_f64) | 0.5 |
/// | sine, cosine, of up to 2^20 rad | 1.5; beyond it 1 more for each 2^27 rad |
/// | [`wrap_to_pi`](Real::wrap_to_pi) of up to 2^20 rad | 0.8; beyond it the same |
/// | [`atan2`](Real::atan2), [`acos`](Real::acos) | 6, 12 |
/// | [`exp`](Real::exp) | 4, and 4 2^-32 of the result |
/// | [`powf`](Real::powf), whole exponent n up to 64, base up to 1 | n |
///
/// Integer operations only: the bits are the same everywhere, and no floating-point routine is linked. Multiplication takes
/// four products of 32-bit words, division about twenty. Costs of a whole update of the control stack are in
/// `docs/fixed-point.md` of the repository.
///
/// # Examples
/// ```
/// use mm_model::{Q32, Real};
///
/// let third = Q32::ONE / Q32::from_u32(3);
/// assert_eq!(third.to_f64(), (4_294_967_296.0_f64 / 3.0).round() / 4_294_967_296.0);
/// let too_much = Q32::from_f64(1e5) * Q32::from_f64(1e5);
/// assert!(!too_much.is_finite() && too_much > Q32::from_f64(1e8));
/// assert!(!(too_much * Q32::ZERO).is_finite());
/// ```
#[derive(Clone, Copy, Default)]
pub struct Q32 {
    raw: i64,
}

impl Q32 {
    /// Above every number: what a result beyond 2^28 becomes.
    pub const INFINITY: Self = Self { raw: 4 << 60 };
    /// Below every number.
    pub const NEG_INFINITY: Self = Self { raw: -(6 << 60) };
    /// No number.
    pub const NAN: Self = Self { raw: -(7 << 60) };
    /// The largest number.
    pub const MAX: Self = Self { raw: (1 << 60) - 1 };
    /// The least number.
    pub const MIN: Self = Self { raw: -(1 << 60) };

    const PI_RAW: i64 = 13_493_037_705;

    /// The number of so many units of 2^-32; infinite where that is outside the range.
    #[must_use]
    #[inline]
    pub const fn from_raw(raw: i64) -> Self {
        let this = Self { raw };
        if this.in_range() { this } else { Self::infinite(raw < 0) }
    }

    /// How many units of 2^-32 this is; for an infinity or a NaN a word that no number has.
    #[must_use]
    #[inline]
    pub const fn to_raw(self) -> i64 {
        self.raw
    }
}

impl Real for Q32 {
    const ZERO: Self = Self { raw: 0 };
    const ONE: Self = Self { raw: 1 << 32 };
    const TWO: Self = Self { raw: 1 << 33 };
    const HALF: Self = Self { raw: 1 << 31 };
    const PI: Self = Self { raw: Self::PI_RAW };
    const TAU: Self = Self { raw: 26_986_075_409 };
    const EPSILON: Self = Self { raw: 1 };

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self::from_f64(value)
    }
    #[inline]
    fn to_f64(self) -> f64 {
        Self::to_f64(self)
    }
    #[inline]
    fn from_u32(value: u32) -> Self {
        // Beyond the range the upper word would fall among the special ones, or be negative.
        if value >= 1 << 28 { Self::INFINITY } else { Self { raw: i64::from(value) << 32 } }
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        if !self.in_range() {
            return (Self::NAN, Self::NAN);
        }
        let (sin, cos) = turn::sin_cos(self.raw);
        (Self { raw: sin }, Self { raw: cos })
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        functions::atan2(self, x)
    }
    #[inline]
    fn acos(self) -> Self {
        functions::acos(self)
    }
    #[inline]
    fn exp(self) -> Self {
        functions::exp(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        functions::powf(self, exponent)
    }
    #[inline]
    fn sqrt(self) -> Self {
        match self.in_range() {
            true if self.raw >= 0 => Self { raw: root::root(self.raw.cast_unsigned()).cast_signed() },
            false if self.raw >= 0 => self,
            _ => Self::NAN,
        }
    }
    #[inline]
    fn abs(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
    #[inline]
    fn floor(self) -> Self {
        if self.in_range() { Self { raw: self.raw & !0xFFFF_FFFF } } else { self }
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.in_range()
    }
    #[inline]
    fn split_index(self) -> (usize, Self) {
        if self.raw < 0 {
            return (0, self);
        }
        if !self.in_range() {
            return (usize::MAX, Self::NAN);
        }
        ((self.raw >> 32) as usize, Self { raw: self.raw & 0xFFFF_FFFF })
    }
    #[inline]
    fn wrap_to_pi(self) -> Self {
        if self.in_range() { Self { raw: turn::wrapped(self.raw) } } else { Self::NAN }
    }
}

#[cfg(test)]
mod tests;
