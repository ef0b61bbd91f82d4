//! A trapezoid over the steps of an input.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "plain operators state their bound; the dev profile checks them all"
)]

use super::grade::{Grade, ONE, Small, high};

/// Farthest that a corner may lie from the middle of the range, in steps: 8192 half ranges.
const FARTHEST: i32 = 1 << 28;

/// A piecewise-linear term of an input: rises over [a, b], is 1 up to c, falls over [c, d].
///
/// Units: steps of the input, 2^-15 of half its range from the middle; corners may lie outside of it.
///
/// Convention: where corners coincide the side is vertical and the degree there is 1, as in
/// [`MembershipFunction`](crate::fuzzy::MembershipFunction).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Term {
    start: i32,
    width: u32,
    rise: u32,
    top: u32,
    per_rise: u32,
    per_fall: u32,
    rise_shift: u8,
    fall_shift: u8,
}

impl Term {
    /// The term with corners a, b, c, d; each is held to 2^28 in magnitude and to the one before it from below.
    #[must_use]
    pub const fn new([a, b, c, d]: [i32; 4]) -> Self {
        let a = held(a, -FARTHEST);
        let b = held(b, a);
        let c = held(c, b);
        let d = held(d, c);
        // All differences are in 0..=2^29.
        let (rise, fall) = ((b - a).cast_unsigned(), (d - c).cast_unsigned());
        let (per_rise, rise_shift) = reciprocal(rise);
        let (per_fall, fall_shift) = reciprocal(fall);
        Self {
            start: a,
            width: (d - a).cast_unsigned(),
            rise,
            top: (c - a).cast_unsigned(),
            per_rise,
            per_fall,
            rise_shift,
            fall_shift,
        }
    }

    /// The corners a, b, c, d.
    #[must_use]
    pub const fn corners(&self) -> [i32; 4] {
        // What `new` took apart.
        let a = self.start;
        [
            a,
            a.wrapping_add_unsigned(self.rise),
            a.wrapping_add_unsigned(self.top),
            a.wrapping_add_unsigned(self.width),
        ]
    }

    /// Degree of a position in -32768..=32768, in Q30, at most two units below the exact one.
    #[inline]
    pub(super) fn degree(&self, position: i32) -> u32 {
        // Both are below 2^29 in magnitude. Left of the term it wraps to beyond every width.
        let past = (position - self.start).cast_unsigned();
        if past > self.width {
            0
        } else if past < self.rise {
            high(past << (self.rise_shift & 31), self.per_rise)
        } else if past <= self.top {
            ONE
        } else {
            // `past` is at most `width`.
            let left = self.width - past;
            high(left << (self.fall_shift & 31), self.per_fall)
        }
    }

    /// The same, or its complement, in small notation.
    pub(super) fn small_degree(&self, position: i32, complement: bool) -> Small {
        let past = (position - self.start).cast_unsigned();
        let (degree, other) = (Small::ONE, Small::ZERO);
        let (degree, other) = if past > self.width {
            (other, degree)
        } else if past < self.rise {
            let rest = self.rise - past;
            let part = |steps| ratio(steps, self.per_rise, self.rise_shift);
            (part(past), part(rest))
        } else if past <= self.top {
            (degree, other)
        } else {
            let (left, gone) = (self.width - past, past - self.top);
            let part = |steps| ratio(steps, self.per_fall, self.fall_shift);
            (part(left), part(gone))
        };
        if complement { other } else { degree }
    }
}

const fn held(corner: i32, least: i32) -> i32 {
    if corner < least {
        least
    } else if corner > FARTHEST {
        FARTHEST
    } else {
        corner
    }
}

/// `2^62 / (steps 2^shift)`, with the shift that brings `steps` to 32 bits: in 2^30..=2^31. Zero for no steps, which are never asked for.
#[expect(
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "the quotient is at most 2^31, the shift at most 31"
)]
const fn reciprocal(steps: u32) -> (u32, u8) {
    let shift = steps.leading_zeros();
    let scaled = (steps as u64) << shift;
    match (1_u64 << 62).checked_div(scaled) {
        Some(quotient) => (quotient as u32, shift as u8),
        None => (0, 0),
    }
}

/// A part of a side, in small notation.
fn ratio(steps: u32, per: u32, shift: u8) -> Small {
    // Below 2^30 times 2^31; the shift is at most 31.
    let product = u64::from(steps) * u64::from(per);
    Small::new(product, 62 - u32::from(shift))
}

#[cfg(test)]
mod tests {
    use super::{FARTHEST, ONE, Term};

    #[test]
    fn degrees_at_corners_and_between() {
        let term = Term::new([-100, 0, 50, 250]);
        assert_eq!(term.corners(), [-100, 0, 50, 250], "corners");
        for (position, degree) in
            [(-101, 0.0), (-100, 0.0), (-50, 0.5), (0, 1.0), (50, 1.0), (150, 0.5), (250, 0.0), (251, 0.0)]
        {
            let error = f64::from(term.degree(position)) - degree * f64::from(ONE);
            assert!((-2.0..=0.0).contains(&error), "{position}: off by {error} units");
            for complement in [false, true] {
                let exact = if complement { 1.0 - degree } else { degree };
                let small = f64::from(term.small_degree(position, complement).q30()) / f64::from(ONE);
                assert!((small - exact).abs() < 2e-7, "{position}, complement {complement}: {small}");
            }
        }
        let spike = Term::new([7, 7, 7, 7]);
        assert_eq!([6, 7, 8].map(|q| spike.degree(q)), [0, ONE, 0], "a singleton");
    }

    #[test]
    fn disorder_and_distance_are_held_back() {
        assert_eq!(Term::new([5, 3, 9, 1]).corners(), [5, 5, 9, 9], "each at least the one before");
        let far = Term::new([i32::MIN, i32::MAX, i32::MIN, i32::MAX]);
        assert_eq!(far.corners(), [-FARTHEST, FARTHEST, FARTHEST, FARTHEST], "held");
        assert!(far.degree(0).abs_diff(ONE / 2) < 3, "halfway up a long side");
    }
}
