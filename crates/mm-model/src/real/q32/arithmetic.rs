//! Sums, differences, products, and what becomes of them outside the range.
//!
//! The three special words are chosen so that a sum with one of them, or of two of them, cannot land among the finite words:
//! in units of 2^60, finite words are those in [-1, 1), infinity is 4, minus infinity -6, no number -7, and every sum of
//! two of these, modulo 16, is outside [-1, 1). One comparison of the result therefore finds an overflow and a special
//! operand alike. A difference looks at the subtrahend as well, a product at both factors.

use core::cmp::Ordering;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use super::wide::{small_product, wide, wide_mixed, wide_signed};
use super::{Q32, divide};

/// Half the range of finite upper words.
const UPPER: u32 = 1 << 28;

/// An upper word's distance from the least finite one: below `2 UPPER` for the finite.
#[inline(always)]
const fn above_least(upper: i32) -> u32 {
    upper.cast_unsigned().wrapping_add(UPPER)
}

#[inline(always)]
const fn upper_word(raw: i64) -> i32 {
    (raw >> 32) as i32
}

impl Q32 {
    /// Whether this is a number in the range.
    #[inline(always)]
    pub(super) const fn in_range(self) -> bool {
        above_least(upper_word(self.raw)) < 2 * UPPER
    }

    /// Whether this is no number.
    #[inline(always)]
    pub(super) const fn is_nan(self) -> bool {
        upper_word(self.raw) == upper_word(Self::NAN.raw)
    }

    /// Infinity of the sign of `raw`.
    #[inline(always)]
    pub(super) const fn infinite(negative: bool) -> Self {
        if negative { Self::NEG_INFINITY } else { Self::INFINITY }
    }

    /// -1, 0 or 1; NaN has none and gives 0.
    const fn signum(self) -> i64 {
        if self.is_nan() { 0 } else { self.raw.signum() }
    }

    /// A sum outside the range, or with an operand outside it.
    #[cold]
    #[inline(never)]
    fn sum_outside(self, other: Self) -> Self {
        match (self.in_range(), other.in_range()) {
            (true, true) => Self::infinite(self.raw < 0),
            (false, true) => self,
            (true, false) => other,
            (false, false) if self == other => self,
            (false, false) => Self::NAN,
        }
    }

    /// A difference outside the range, or with an operand outside it.
    #[cold]
    #[inline(never)]
    fn difference_outside(self, other: Self) -> Self {
        // The least number has no opposite, but is of no account beside an infinity.
        if other.in_range() && !self.in_range() { self } else { self.sum_outside(-other) }
    }

    /// A product with a factor outside the range: zero times infinity is no number.
    #[cold]
    #[inline(never)]
    fn product_outside(self, other: Self) -> Self {
        match self.signum() * other.signum() {
            0 => Self::NAN,
            sign => Self::infinite(sign < 0),
        }
    }

    /// The product of factors up to 2^13, which cannot leave the range.
    #[inline(always)]
    fn product(self, other: Self) -> Self {
        const SMALL: u32 = 1 << 13;
        let above = |raw: i64| upper_word(raw).cast_unsigned().wrapping_add(SMALL);
        if above(self.raw) | above(other.raw) >= 2 * SMALL {
            return self.any_product(other);
        }
        Self { raw: small_product(self.raw, other.raw) }
    }

    /// The product of any two factors.
    #[cold]
    #[inline(never)]
    fn any_product(self, other: Self) -> Self {
        let (a, b) = (upper_word(self.raw), upper_word(other.raw));
        if above_least(a) | above_least(b) >= 2 * UPPER {
            return self.product_outside(other);
        }
        let (low_a, low_b) = (self.raw as u32, other.raw as u32);
        // Of the four partial products, the lowest counts with its upper word, rounded.
        let lowest = wide(low_a, low_b).wrapping_add(1 << 31) >> 32;
        let middle =
            wide_mixed(a, low_b).wrapping_add(wide_mixed(b, low_a)).wrapping_add(lowest.cast_signed());
        let top = wide_signed(a, b).wrapping_add(middle >> 32);
        let result = Self { raw: (top << 32) | (middle & 0xFFFF_FFFF) };
        // Whether the upper word holds all of `top`, and is finite.
        if i64::from(top as i32) == top && result.in_range() { result } else { Self::infinite(top < 0) }
    }

    /// The quotient of finite or special numbers.
    #[inline(never)]
    fn quotient(self, divisor: Self) -> Self {
        if !self.in_range() || !divisor.in_range() {
            // A divisor that has left the range leaves no trust in the quotient, though that would be near zero.
            return if divisor.in_range() && !self.is_nan() {
                Self::infinite((self.raw < 0) != (divisor.raw < 0))
            } else {
                Self::NAN
            };
        }
        let negative = (self.raw < 0) != (divisor.raw < 0);
        match divide::quotient(self.raw.unsigned_abs(), divisor.raw.unsigned_abs()) {
            Some(magnitude) => Self::signed(negative, magnitude),
            None if self.raw == 0 => Self::NAN,
            None => Self::infinite(negative),
        }
    }

    /// A magnitude with a sign; one of 2^60 or more is infinite.
    #[inline]
    pub(super) const fn signed(negative: bool, magnitude: u64) -> Self {
        if magnitude >= 1 << 60 {
            return Self::infinite(negative);
        }
        let raw = magnitude.cast_signed();
        Self { raw: if negative { -raw } else { raw } }
    }
}

impl Add for Q32 {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let sum = Self { raw: self.raw.wrapping_add(other.raw) };
        if sum.in_range() { sum } else { self.sum_outside(other) }
    }
}

impl Sub for Q32 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let difference = Self { raw: self.raw.wrapping_sub(other.raw) };
        let words = above_least(upper_word(difference.raw)) | above_least(upper_word(other.raw));
        if words < 2 * UPPER { difference } else { self.difference_outside(other) }
    }
}

impl Neg for Q32 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let negated = Self { raw: self.raw.wrapping_neg() };
        if negated.in_range() { negated } else { self.negated_outside() }
    }
}

impl Q32 {
    #[cold]
    #[inline(never)]
    const fn negated_outside(self) -> Self {
        if self.is_nan() { Self::NAN } else { Self::infinite(self.raw > 0) }
    }
}

impl Mul for Q32 {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        self.product(other)
    }
}

impl Div for Q32 {
    type Output = Self;
    #[inline]
    fn div(self, divisor: Self) -> Self {
        self.quotient(divisor)
    }
}

impl AddAssign for Q32 {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Q32 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Q32 {
    #[inline(always)]
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl DivAssign for Q32 {
    #[inline]
    fn div_assign(&mut self, divisor: Self) {
        *self = *self / divisor;
    }
}

impl PartialEq for Q32 {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.raw == other.raw && !self.is_nan()
    }
}

/// No number is below all others as a word: only one side of each comparison has to be looked at.
impl PartialOrd for Q32 {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        if self.is_nan() || other.is_nan() { None } else { Some(self.raw.cmp(&other.raw)) }
    }
    #[inline(always)]
    fn lt(&self, other: &Self) -> bool {
        self.raw < other.raw && !self.is_nan()
    }
    #[inline(always)]
    fn le(&self, other: &Self) -> bool {
        self.raw <= other.raw && !self.is_nan()
    }
    #[inline(always)]
    fn gt(&self, other: &Self) -> bool {
        self.raw > other.raw && !other.is_nan()
    }
    #[inline(always)]
    fn ge(&self, other: &Self) -> bool {
        self.raw >= other.raw && !other.is_nan()
    }
}

impl num_traits::Zero for Q32 {
    #[inline(always)]
    fn zero() -> Self {
        Self::from_raw(0)
    }
    #[inline(always)]
    fn is_zero(&self) -> bool {
        self.raw == 0
    }
}

impl num_traits::One for Q32 {
    #[inline(always)]
    fn one() -> Self {
        Self::from_raw(1 << 32)
    }
}
