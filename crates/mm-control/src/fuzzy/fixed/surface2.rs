//! A function of two inputs as a table of knots.

use super::engine::saturated;

/// A table of a function of two 16-bit inputs, bilinear between knots.
///
/// An input is first rounded to `bits` bits, half a step upwards: to one of 2^bits + 1 points of its range, both ends included. With p and r for
/// these points, counted from the lower end, `i = floor(p / 2^s1)`, `f = p mod 2^s1` and the same with j, g and s2 for r,
/// y is the mean of the four knots around, weighted by f and g, rounded.
///
/// Convention: units as for [`Evaluate`](super::Evaluate). An odd surface has knots where the first input is not negative, answers the opposite of
/// its answer to the opposite point otherwise, and 0 with 0. Where there are no knots the output is 0.
///
/// Overflow: sums are below 2^16 times 2^24 in 64 bits; shifts beyond `bits` in tables made by hand wrap, and nothing panics.
///
/// Cost: three multiplications of 32 by 32 to 64 bits, no division.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::fixed::Surface2;
///
/// let product = Surface2 { bits: 8, shifts: [8, 8], columns: 2, knots: &[32, 0, 0, 32], odd: false };
/// assert_eq!(product.evaluate(-32768, -32768), 32);
/// assert_eq!(product.evaluate(0, 0), 16);
/// assert_eq!(product.evaluate(-32768, 32767), 0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Surface2<'a> {
    /// Bits of an input, 8 to 12.
    pub bits: u32,
    /// Distances of the knots along each input: 2^shift points.
    pub shifts: [u32; 2],
    /// Knots along the second input.
    pub columns: u32,
    /// The knots, row by row; the first input is constant along a row.
    pub knots: &'a [i16],
    /// Whether it holds first inputs from 0 on alone.
    pub odd: bool,
}

impl Surface2<'_> {
    /// Whether there are as many knots as bits and shifts say.
    #[must_use]
    pub fn check(&self) -> bool {
        let Self { bits, shifts: [s1, s2], columns, .. } = *self;
        let rows_range = bits.saturating_sub(u32::from(self.odd));
        let columns_fit = columns == Self::knots_along(bits, s2);
        let count = u64::from(Self::knots_along(rows_range, s1)).saturating_mul(columns.into());
        (8..=12).contains(&bits)
            && s1 <= rows_range
            && s2 <= bits
            && columns_fit
            && u64::try_from(self.knots.len()).is_ok_and(|knots| knots == count)
    }

    const fn knots_along(bits: u32, shift: u32) -> u32 {
        1_u32.wrapping_shl(bits.saturating_sub(shift)).saturating_add(1)
    }

    /// Output for two inputs.
    #[expect(clippy::as_conversions, reason = "an index of 32 bits; usize is no narrower where this runs")]
    #[must_use]
    pub fn evaluate(&self, first: i16, second: i16) -> i16 {
        let Self { bits, shifts: [s1, s2], columns, .. } = *self;
        let (p, r) = (self.rounded(first), self.rounded(second));
        if self.odd && p == 0 && r == 0 {
            return 0;
        }
        let turned = self.odd && (p < 0 || (p == 0 && r < 0));
        // At most 2^11 in magnitude.
        let (p, r) = if turned { (p.wrapping_neg(), r.wrapping_neg()) } else { (p, r) };
        let half = 1_i32.wrapping_shl(bits.wrapping_sub(1));
        let p = if self.odd { p } else { p.wrapping_add(half) };
        let (i, f) = cell(p, s1, bits.wrapping_sub(u32::from(self.odd)));
        let (j, g) = cell(r.wrapping_add(half), s2, bits);
        let index = i.wrapping_mul(columns).wrapping_add(j);
        let pair = |index: u32| self.knots.get(index as usize..).and_then(|knots| knots.first_chunk());
        let (Some(upper), Some(lower)) = (pair(index), pair(index.wrapping_add(columns))) else { return 0 };
        // Below 2^16 times 2^12 each, and times 2^12 together.
        let along = |&[near, far]: &[i16; 2]| {
            let rise = i64::from(far).wrapping_sub(i64::from(near)).wrapping_mul(g.into());
            i64::from(near).wrapping_shl(s2).wrapping_add(rise)
        };
        let (upper, lower) = (along(upper), along(lower));
        let sum = upper.wrapping_shl(s1).wrapping_add(lower.wrapping_sub(upper).wrapping_mul(f.into()));
        let shift = s1.wrapping_add(s2);
        let y = sum.wrapping_add(1_i64.wrapping_shl(shift) >> 1).wrapping_shr(shift);
        // Between the knots; anything else saturates.
        let y = i32::try_from(y).unwrap_or(0);
        saturated(if turned { y.wrapping_neg() } else { y })
    }

    /// The nearest of 2^bits + 1 points, counted from the middle.
    #[inline]
    fn rounded(&self, q: i16) -> i32 {
        let unit = 16_u32.wrapping_sub(self.bits);
        // At most 2^15 + 2^14.
        i32::from(q).wrapping_add(1_i32.wrapping_shl(unit) >> 1).wrapping_shr(unit)
    }
}

/// Index of the cell and place within it, from 0 to all of 2^shift at the far end.
#[inline]
fn cell(position: i32, shift: u32, bits: u32) -> (u32, u32) {
    let position = position.cast_unsigned();
    let last = 1_u32.wrapping_shl(bits.wrapping_sub(shift)).wrapping_sub(1);
    let index = position.wrapping_shr(shift).min(last);
    (index, position.wrapping_sub(index.wrapping_shl(shift)))
}
