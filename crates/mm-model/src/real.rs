//! The scalar that every formula is written in: one source of elementary functions for host and target.

use core::fmt::{Debug, Display};
use nalgebra::{ClosedAddAssign, ClosedDivAssign, ClosedMulAssign, ClosedSubAssign, Scalar};

mod q32;
mod sin_cos_f32;

pub use q32::Q32;

/// A real number with the elementary functions that the model and the controllers need.
///
/// Implemented for `f64`, by libm, and for `f32`, by libm where it stays in single precision and by a sine and
/// cosine of this crate otherwise; and for [`Q32`], in integers, for cores that have nothing else. The floating-point part is plain IEEE arithmetic in a fixed order, without fused
/// multiply-add, so that a host and a microcontroller give the same bits.
pub trait Real:
    Scalar
    + Copy
    + Debug
    + Display
    + PartialOrd
    + Default
    + ClosedAddAssign
    + ClosedSubAssign
    + ClosedMulAssign
    + ClosedDivAssign
    + core::ops::Neg<Output = Self>
    + num_traits::Zero
    + num_traits::One
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Two.
    const TWO: Self;
    /// One half.
    const HALF: Self;
    /// Half a turn, rounded to this precision.
    const PI: Self;
    /// A whole turn, rounded to this precision.
    const TAU: Self;
    /// Distance from one to the next larger number.
    const EPSILON: Self;

    /// The number of this type nearest to `value`.
    #[must_use]
    fn from_f64(value: f64) -> Self;
    /// The same number in double precision; exact for floating point.
    fn to_f64(self) -> f64;
    /// A count as a number, rounded to the nearest; exact up to 2^24.
    #[must_use]
    fn from_u32(value: u32) -> Self;
    /// Sine and cosine of an angle in radians.
    ///
    /// A NaN or infinite angle gives two NaN.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);
    /// Angle of the point (`x`, `self`) seen from the origin, in (-pi, pi].
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// Angle in [0, pi] whose cosine this is; NaN outside [-1, 1].
    #[must_use]
    fn acos(self) -> Self;
    /// Power of Euler's number.
    #[must_use]
    fn exp(self) -> Self;
    /// This number to a power.
    #[must_use]
    fn powf(self, exponent: Self) -> Self;
    /// Square root, correctly rounded; NaN for a negative number.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Magnitude.
    #[must_use]
    fn abs(self) -> Self;
    /// Largest whole number that is not above this one.
    #[must_use]
    fn floor(self) -> Self;
    /// Whether this is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// Splits a non-negative number into its whole part and the rest in [0, 1), to look up a table.
    ///
    /// The whole part saturates at the largest index; a negative number or a NaN gives the index 0.
    fn split_index(self) -> (usize, Self);

    /// -1, 0 or +1 by the sign of the number, with 0 for both zeros, as (4.30) defines it; 0 for NaN.
    #[must_use]
    #[inline]
    fn sign(self) -> Self {
        if self > Self::ZERO {
            Self::ONE
        } else if self < Self::ZERO {
            -Self::ONE
        } else {
            Self::ZERO
        }
    }

    /// The smaller of two numbers; `other` where the comparison fails.
    #[must_use]
    #[inline]
    fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }

    /// The larger of two numbers; `other` where the comparison fails.
    #[must_use]
    #[inline]
    fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// The nearest number in [`lo`, `hi`]; a NaN stays a NaN.
    #[must_use]
    #[inline]
    fn clamp_to(self, lo: Self, hi: Self) -> Self {
        if self < lo {
            lo
        } else if self > hi {
            hi
        } else {
            self
        }
    }

    /// The same direction in [-pi, pi): `x - 2 pi floor((x + pi) / (2 pi))`, of constant cost.
    #[must_use]
    #[inline]
    fn wrap_to_pi(self) -> Self {
        self - Self::TAU * ((self + Self::PI) / Self::TAU).floor()
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const HALF: Self = 0.5;
    const PI: Self = core::f64::consts::PI;
    const TAU: Self = core::f64::consts::TAU;
    const EPSILON: Self = Self::EPSILON;

    #[inline]
    fn from_f64(value: f64) -> Self {
        value
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
    #[inline]
    fn from_u32(value: u32) -> Self {
        Self::from(value)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn acos(self) -> Self {
        libm::acos(self)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::exp(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    #[inline]
    fn abs(self) -> Self {
        libm::fabs(self)
    }
    #[inline]
    fn floor(self) -> Self {
        libm::floor(self)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the cast saturates, which is what the index is meant to do"
    )]
    #[inline]
    fn split_index(self) -> (usize, Self) {
        let index = self as usize;
        (index, self - index as Self)
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const HALF: Self = 0.5;
    const PI: Self = core::f32::consts::PI;
    const TAU: Self = core::f32::consts::TAU;
    const EPSILON: Self = Self::EPSILON;

    #[expect(clippy::cast_possible_truncation, reason = "rounding to single precision is what this does")]
    #[inline]
    fn from_f64(value: f64) -> Self {
        value as Self
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
    #[expect(clippy::cast_precision_loss, reason = "rounding to single precision is what this does")]
    #[inline]
    fn from_u32(value: u32) -> Self {
        value as Self
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        sin_cos_f32::sin_cos(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2f(self, x)
    }
    #[inline]
    fn acos(self) -> Self {
        libm::acosf(self)
    }
    #[inline]
    fn exp(self) -> Self {
        libm::expf(self)
    }
    #[inline]
    fn powf(self, exponent: Self) -> Self {
        libm::powf(self, exponent)
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }
    #[inline]
    fn abs(self) -> Self {
        libm::fabsf(self)
    }
    #[inline]
    fn floor(self) -> Self {
        libm::floorf(self)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the cast saturates, which is what the index is meant to do"
    )]
    #[inline]
    fn split_index(self) -> (usize, Self) {
        let index = self as usize;
        (index, self - index as Self)
    }
}
