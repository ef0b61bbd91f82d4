//! A function of one input as a table of knots.

use super::curve::Evaluate;
use super::engine::saturated;

/// A part of a surface between two jumps, with knots at equal distances.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Section {
    /// First input that belongs to it.
    pub start: i32,
    /// Index of its first knot, which stands for `start`.
    pub knot: u32,
    /// Distance of its knots: 2^(14 - shift) inputs, with a shift of at most 14.
    pub shift: u32,
}

/// A table of a function of one 16-bit input: linear between knots, exact on either side of a jump.
///
/// Equation: in the section of q, with `u = (q - start) 2^shift`, `i = floor(u / 2^14)` and `f = u mod 2^14`,
/// `y = floor(y_i + (y_(i+1) - y_i) f / 2^14 + 1/2)`.
///
/// Convention: units as for [`Evaluate`]. An odd surface has knots for positive inputs alone, answers 0 with 0 and a negative input with the opposite
/// of the answer to its magnitude. Where there are no knots the output is 0.
///
/// Overflow: u is below 2^31, differences are below 2^16 and products below 2^30; a shift above 14 in tables made by hand wraps,
/// and nothing panics. [`check`](Self::check) finds such.
///
/// Cost: about 30 instructions for one section, 10 more for each halving of a list of them; one multiplication of 32 bits, no division.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::fixed::{Evaluate, Section, Surface1};
///
/// static RAMP: Surface1<'static> = Surface1 {
///     first: Section { start: 0, knot: 0, shift: 0 },
///     others: &[],
///     knots: &[0, 400, 600, 600],
///     odd: true,
/// };
/// assert_eq!([8192, 16384, 24576, -8192].map(|q| RAMP.evaluate(q)), [200, 400, 500, -200]);
/// assert!(RAMP.check());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Surface1<'a> {
    /// The section of the lowest inputs, or of the lowest positive ones.
    pub first: Section,
    /// The others, by ascending start.
    pub others: &'a [Section],
    /// The knots of all sections, one after another; the last one has a neighbour that may have any value.
    pub knots: &'a [i16],
    /// Whether it holds positive inputs alone.
    pub odd: bool,
}

impl Surface1<'_> {
    /// Whether the sections ascend, cover all inputs and find their knots.
    ///
    /// Unless they do, [`evaluate`](Evaluate::evaluate) gives numbers without meaning, but no panic.
    #[must_use]
    pub fn check(&self) -> bool {
        let covers = if self.odd { matches!(self.first.start, 0 | 1) } else { self.first.start == -32768 };
        let last = if self.odd { 32768 } else { 32767 };
        let starts = || core::iter::once(&self.first).chain(self.others);
        let ends =
            self.others.iter().map(|section| section.start.saturating_sub(1)).chain(core::iter::once(last));
        let fits = |(section, end): (&Section, i32)| {
            let steps = end.saturating_sub(section.start);
            let most = u32::try_from(steps).unwrap_or(0) >> 14_u32.saturating_sub(section.shift);
            let index = section.knot.saturating_add(most).saturating_add(1);
            steps >= 0
                && section.shift <= 14
                && usize::try_from(index).is_ok_and(|index| index < self.knots.len())
        };
        covers && starts().zip(ends).all(fits)
    }

    /// Evaluates in the last section that starts at or before the position.
    #[inline(never)]
    fn searched(&self, position: i32, turn: i32) -> i16 {
        let before = self.others.partition_point(|section| section.start <= position);
        let section = before.checked_sub(1).and_then(|last| self.others.get(last)).unwrap_or(&self.first);
        self.interpolated(section, position, turn)
    }

    #[expect(clippy::as_conversions, reason = "an index of 32 bits; usize is no narrower where this runs")]
    #[inline]
    fn interpolated(&self, section: &Section, position: i32, turn: i32) -> i16 {
        // In 2^-14 of a distance. Left of the first section it wraps to beyond all knots.
        let past = position.wrapping_sub(section.start).cast_unsigned().wrapping_shl(section.shift);
        let index = section.knot.wrapping_add(past >> 14) as usize;
        let (Some(&far), Some(&near)) = (self.knots.get(index.wrapping_add(1)), self.knots.get(index)) else {
            return 0;
        };
        let (near, far) = (i32::from(near), i32::from(far));
        // Below 2^16 times 2^14.
        let part = (past & 0x3fff).cast_signed();
        let rise = far.wrapping_sub(near).wrapping_mul(part).wrapping_add(1 << 13) >> 14;
        // Between the knots; the opposite of -32768 saturates.
        let y = near.wrapping_add(rise);
        saturated((y ^ turn).wrapping_sub(turn))
    }
}

impl Evaluate for Surface1<'_> {
    #[inline]
    fn evaluate(&self, q: i16) -> i16 {
        let q = i32::from(q);
        // All ones where the input is to be turned; 16-bit numbers have a negative in 32.
        let turn = if self.odd { q >> 31 } else { 0 };
        let position = (q ^ turn).wrapping_sub(turn);
        if self.others.is_empty() {
            self.interpolated(&self.first, position, turn)
        } else {
            self.searched(position, turn)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Evaluate, Section, Surface1};

    #[test]
    fn a_jump_is_exact_on_either_side_and_at_the_point() {
        let sections =
            [Section { start: 100, knot: 6, shift: 14 }, Section { start: 101, knot: 7, shift: 0 }];
        let knots = [-1000, -1000, -1000, -1000, -1000, -1000, 7, 2000, 2000, 2000, 2000];
        let first = Section { start: -32768, knot: 0, shift: 1 };
        let surface = Surface1 { first, others: &sections, knots: &knots, odd: false };
        assert!(surface.check(), "well made");
        let at = [-32768, 99, 100, 101, 32767].map(|q| surface.evaluate(q));
        assert_eq!(at, [-1000, -1000, 7, 2000, 2000], "below, at and above the jump");
    }

    #[test]
    fn tables_made_badly_are_found_and_do_not_panic() {
        let good = Section { start: 0, knot: 0, shift: 0 };
        let bad = [
            (Section { shift: 40, ..good }, true),
            (Section { knot: u32::MAX, ..good }, true),
            (Section { start: i32::MIN, ..good }, true),
            (Section { start: i32::MAX, ..good }, false),
            (good, false),
        ];
        for (first, odd) in bad {
            let knots = [i16::MIN, i16::MAX, i16::MIN, i16::MAX];
            let surface = Surface1 { first, others: &[], knots: &knots, odd };
            assert!(!surface.check(), "{first:?}");
            for q in i16::MIN..=i16::MAX {
                let _anything = surface.evaluate(q);
            }
        }
    }
}
