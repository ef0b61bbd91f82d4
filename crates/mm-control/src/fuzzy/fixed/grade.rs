//! Degrees and firing strengths as whole numbers.
//!
//! Two notations. Q30, the fast one: `ONE` is 2^30. Small, for an input where all strengths are tiny and their ratio still decides: 8 bits
//! of exponent above 24 bits of mantissa with its leading bit, so that the order of the words is the order of the values; a
//! mantissa m and an exponent e > 0 mean `m 2^(e - 278)`, and 0 is zero.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "plain operators state their bound; the dev profile checks them all"
)]

use super::term::Term;

/// One in Q30.
pub(super) const ONE: u32 = 1 << 30;

/// A degree or strength in one of the notations.
pub(super) trait Grade: Copy + Ord {
    const ZERO: Self;
    const ONE: Self;
    /// Degree of a term, or of its complement.
    fn degree(term: &Term, position: i32, not: bool) -> Self;
    /// Both.
    fn product(self, other: Self) -> Self;
    /// `a + b - a b`.
    fn either(self, other: Self) -> Self;
    /// A weight in units of 2^-30.
    fn weight(weight: u32) -> Self;
    /// The word that stands for it; words are ordered as the values are.
    fn word(self) -> u32;
}

/// A number from 0 to 1 in units of 2^-30.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Q30(u32);

impl Grade for Q30 {
    const ZERO: Self = Self(0);
    const ONE: Self = Self(ONE);

    #[inline]
    fn degree(term: &Term, position: i32, not: bool) -> Self {
        let degree = term.degree(position);
        // Degrees are at most one.
        Self(if not { ONE - degree } else { degree })
    }

    #[inline]
    fn product(self, other: Self) -> Self {
        Self(product(self.0, other.0))
    }

    #[inline]
    fn either(self, other: Self) -> Self {
        // The sum is at most 2^31, the product at most the smaller of the two.
        Self(self.0 + other.0 - product(self.0, other.0))
    }

    #[inline]
    fn weight(weight: u32) -> Self {
        Self(weight)
    }

    #[inline]
    fn word(self) -> u32 {
        self.0
    }
}

/// The upper word of a product: `floor(a b / 2^32)`. A 32 by 32 bit product fits 64 bits, so nothing overflows.
#[expect(clippy::as_conversions, reason = "a word shifted by a word fits a word")]
#[inline]
pub(super) const fn high(a: u32, b: u32) -> u32 {
    ((a as u64 * b as u64) >> 32) as u32
}

/// Product of two numbers in Q30, rounded; at most `ONE` if both are.
#[expect(
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "at most 2^30 for factors up to 2^30"
)]
#[inline]
pub(super) const fn product(a: u32, b: u32) -> u32 {
    // Below 2^60 + 2^29.
    ((a as u64 * b as u64 + (1 << 29)) >> 30) as u32
}

/// Number in small notation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Small(pub(super) u32);

impl Small {
    /// `number 2^-scale`, cut to 24 bits; what is below 2^-254 becomes 0. For numbers up to 2^scale.
    #[expect(clippy::as_conversions, reason = "24 bits are left after the shift by 40")]
    pub(super) fn new(number: u64, scale: u32) -> Self {
        let lead = number.leading_zeros();
        // At most 255 + 63, and 0 where the value is too small.
        let exponent = 318_u32.saturating_sub(lead).saturating_sub(scale);
        if number == 0 || exponent == 0 {
            return Self::ZERO;
        }
        let mantissa = ((number << lead) >> 40) as u32;
        Self((exponent.min(255) << 24) | mantissa)
    }

    const fn mantissa(self) -> u32 {
        self.0 & 0x00ff_ffff
    }

    pub(super) const fn exponent(self) -> u32 {
        self.0 >> 24
    }

    /// How far the value of the mantissa, as a whole number, has to be moved down.
    const fn scale(self) -> u32 {
        // Exponents end at 255.
        278 - self.exponent()
    }

    /// The value in Q30, cut.
    pub(super) fn q30(self) -> u32 {
        (self.mantissa() << 7).checked_shr(255 - self.exponent()).unwrap_or(0)
    }

    /// The mantissa in Q30 on the exponent `top` instead of the own one: below 2^30, and at least 2^29 for `top` itself.
    pub(super) fn relative_to(self, top: u32) -> u32 {
        (self.mantissa() << 6).checked_shr(top.saturating_sub(self.exponent())).unwrap_or(0)
    }
}

impl Grade for Small {
    const ZERO: Self = Self(0);
    const ONE: Self = Self((255 << 24) | (1 << 23));

    fn degree(term: &Term, position: i32, not: bool) -> Self {
        term.small_degree(position, not)
    }

    fn product(self, other: Self) -> Self {
        // Two mantissas make 48 bits, two scales at most 556.
        let product = u64::from(self.mantissa()) * u64::from(other.mantissa());
        Self::new(product, self.scale() + other.scale())
    }

    fn either(self, other: Self) -> Self {
        let (low, high) = if self < other { (self, other) } else { (other, self) };
        // On the exponent of the larger, with 30 more bits: below 2^55.
        let gap = high.exponent() - low.exponent();
        let larger = u64::from(high.mantissa()) << 30;
        let smaller = (u64::from(low.mantissa()) << 30).checked_shr(gap).unwrap_or(0);
        // The part of the smaller one that the larger leaves, rounded down in Q24: below 2^55, shifted by 24 first.
        let rest = u64::from(ONE >> 6).saturating_sub(u64::from(high.q30() >> 6));
        let added = (smaller >> 24) * rest;
        let scale = high.scale() + 30;
        Self::new(larger + added, scale).min(Self::ONE)
    }

    fn weight(weight: u32) -> Self {
        Self::new(weight.into(), 30)
    }

    fn word(self) -> u32 {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::{Grade, ONE, Q30, Small, high, product};

    #[test]
    fn one_is_neutral_and_nothing_exceeds_it() {
        for a in [0, 1, 2, ONE / 3, ONE - 1, ONE] {
            let either = |a, b| Q30(a).either(Q30(b)).word();
            assert_eq!((product(a, ONE), either(a, 0), either(a, ONE)), (a, a, ONE), "{a}");
        }
        assert_eq!(high(u32::MAX, u32::MAX), u32::MAX - 1, "the largest product");
        assert_eq!(Small::ONE.q30(), ONE, "one in both notations");
        assert_eq!(Small::new(1 << 30, 30), Small::ONE, "one from Q30");
    }

    #[test]
    fn small_numbers_keep_their_ratio() {
        let value = |x: Small| f64::from(x.mantissa()) * 2.0_f64.powi(x.exponent().cast_signed() - 278);
        let numbers: [(u32, u32); 6] = [(3, 40), (65_537, 17), (1, 90), (999_999_999, 30), (5, 3), (1, 1)];
        for (n, s) in numbers {
            let (a, x) = (Small::new(n.into(), s), f64::from(n) * 2.0_f64.powi(-s.cast_signed()));
            assert!((value(a) / x - 1.0).abs() < 2.0_f64.powi(-22), "{n} 2^-{s}: {}", value(a));
            for (m, t) in numbers {
                let (b, y) = (Small::new(m.into(), t), f64::from(m) * 2.0_f64.powi(-t.cast_signed()));
                assert!((value(a.product(b)) / (x * y) - 1.0).abs() < 2.0_f64.powi(-20), "{x} times {y}");
                let sum = x + y - x * y;
                assert!((value(a.either(b)) / sum - 1.0).abs() < 2.0_f64.powi(-20), "{x} or {y}");
                assert_eq!(a < b, value(a) < value(b), "order of {x} and {y}");
            }
        }
        assert!(Small::new(1, 300) == Small::ZERO, "far too small");
    }
}
