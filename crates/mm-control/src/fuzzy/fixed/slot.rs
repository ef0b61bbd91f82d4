//! What an output term contributes to the centroid, as coefficients of a polynomial in its firing strength.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "plain operators state their bound; the dev profile checks them all"
)]

use super::grade::{ONE, high};
use crate::fuzzy::FuzzyError;

/// One end of an output's range, in steps from its middle.
const END: i32 = 1 << 15;
/// Third part, in Q32.
const THIRD: u32 = 0x5555_5555;

/// A slice between height 0 and some height, between two slanted sides: width, narrowing and where it is.
///
/// With l and r for how far the left side leans right and the right side left within a height of 1, and s for the scale of the output:
/// `area = s (d - a)`, `narrowing = 2 s (l + r)`, `middle = 256 (a + d) / 2`, `skew = 256 (l - r)`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    area: u32,
    narrowing: u32,
    middle: i32,
    skew: i32,
}

/// Area in units of the output's scale, moment in 256 times that; both for a strength in Q30 divided by four.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Moments {
    pub(super) area: u32,
    pub(super) moment: i64,
}

/// An output term that rules conclude, and what it shares with the one before it.
///
/// Equation: cut off at w it has the area `int_0^w (right - left) dh = w (A0 - w A1)`, and about the middle of its foot the moment
/// `(l - r)/2 w^2 ((d - a)/2 - w (l + r)/3)`. Where neighbours overlap, what is counted twice is of the same kind, from the
/// left side of the upper to the right side of the lower term, up to the height where these cross.
///
/// Units: corners in steps of the output, 2^-15 of half its range from the middle, within the range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Slot {
    own: Piece,
    /// Height in Q30 up to which the slot before is overlapped; 0 without overlap.
    crossing: u32,
    shared: Piece,
}

impl Slot {
    /// A term with corners a, b, c, d, cut off at its strength: implication by the minimum.
    ///
    /// `below` are the corners of the slot before it in the row, for the aggregation by the maximum, and `None` for the sum. All slots of an output
    /// have the same `scale`, a power of two that is given by its exponent: the largest with which [`Engine::try_new`]
    /// accepts them is the most precise.
    ///
    /// Corners are held to the range and to the one before.
    ///
    /// [`Engine::try_new`]: super::Engine::try_new
    #[must_use]
    pub const fn cut(corners: [i32; 4], below: Option<[i32; 4]>, scale: u32) -> Self {
        let [a, b, c, d] = ordered(corners);
        let own = Piece::new([a, b, c, d], scale);
        let Some(below) = below else { return Self { own, crossing: 0, shared: Piece::NONE } };
        let [_, _, lower_c, lower_d] = ordered(below);
        if lower_d <= a {
            return Self { own, crossing: 0, shared: Piece::NONE };
        }
        // The sides cross where the gap at the foot is used up by both slants. Differences are at most 2^17.
        let shared = Piece::new([a, b, lower_c, lower_d], scale);
        let gap = (lower_d - a).cast_unsigned();
        let slant = ((b - a) + (lower_d - lower_c)).cast_unsigned();
        let crossing = if slant > gap { ratio(gap, slant) } else { ONE };
        Self { own, crossing, shared }
    }

    /// A term with corners a, b, c, d, scaled by its strength: implication by the product. For the sum, or where no terms overlap.
    ///
    /// `scale` as for [`cut`](Self::cut); at least 1.
    #[must_use]
    pub const fn scaled(corners: [i32; 4], scale: u32) -> Self {
        let [a, b, c, d] = ordered(corners);
        // Twice the area, 2 (d - a) - l - r = (d - a) + (c - b), and six times the moment; all below 2^17 and 3 2^33.
        let twice = (d - a) + (c - b);
        let [a, b, c, d] = [wide(a), wide(b), wide(c), wide(d)];
        let upper = d * d + d * c + c * c;
        let lower = a * a + a * b + b * b;
        let six = upper - lower;
        // 256 six / 6 / (twice / 2), rounded down after adding a half.
        let (part, whole) = (six * 512 + 3 * wide(twice), 6 * wide(twice));
        let middle = match part.checked_div_euclid(whole) {
            Some(middle) => narrow(middle),
            None => 0,
        };
        let area = scaled_up(twice.cast_unsigned(), scale) >> 1;
        let own = Piece { area, narrowing: 0, middle, skew: 0 };
        Self { own, crossing: 0, shared: Piece::NONE }
    }

    /// Area of the whole foot on the scale.
    pub(super) const fn area(&self) -> u32 {
        self.own.area
    }

    /// Checks what the overflow bounds of the engine rest on.
    pub(super) fn check(&self) -> Result<(), FuzzyError> {
        let Self { own, crossing, shared } = self;
        let fits = own.area <= 1 << 29 && own.narrowing <= 2 * own.area && shared.area <= own.area;
        // Up to the crossing a shared piece keeps half of its width.
        let crosses = high(*crossing, shared.narrowing) <= shared.area.div_ceil(2);
        if fits && crosses { Ok(()) } else { Err(FuzzyError::OutOfRange("outputs.scale")) }
    }

    /// Height of this and the slot before it up to which both are counted, in Q30, from their strengths in whichever notation.
    #[inline]
    pub(super) const fn crossing(&self) -> u32 {
        self.crossing
    }

    /// Adds the term cut off at `top`; the linear factor of the polynomial is `linear`, and products lose `shift` bits.
    #[inline]
    pub(super) fn add(&self, sum: &mut Moments, linear: u32, top: u32, shift: u32) {
        let slice = self.own.slice(linear, top, shift);
        // Areas sum up to less than 2^32 and moments to less than 2^58, as `Engine::try_new` checks.
        sum.area += slice.area;
        sum.moment += slice.moment;
    }

    /// Takes away what it shares with the slot before it up to `top`.
    #[inline]
    pub(super) fn subtract_shared(&self, sum: &mut Moments, linear: u32, top: u32, shift: u32) {
        let slice = self.shared.slice(linear, top, shift);
        sum.area = sum.area.saturating_sub(slice.area);
        // As above.
        sum.moment -= slice.moment;
    }

    /// Area of the term cut off at `top` with all bits of the last product, below 2^60 for a `linear` below 2^30.
    pub(super) fn whole_area(&self, linear: u32, top: u32) -> u64 {
        u64::from(linear) * u64::from(self.own.width(top))
    }
}

impl Piece {
    const NONE: Self = Self { area: 0, narrowing: 0, middle: 0, skew: 0 };

    /// For corners within the range, where only c may be below b.
    const fn new([a, b, c, d]: [i32; 4], scale: u32) -> Self {
        // Sides and widths are at most 2^16, so the sums at most 2^17 and with 256 at most 2^25.
        let (l, r) = (b - a, d - c);
        Self {
            area: scaled_up((d - a).cast_unsigned(), scale),
            narrowing: scaled_up((l + r).cast_unsigned() << 1, scale),
            middle: (a + d) * 128,
            skew: (l - r) * 256,
        }
    }

    /// Mean width up to `top`, at least half of `area`.
    #[inline]
    const fn width(&self, top: u32) -> u32 {
        self.area - high(top, self.narrowing)
    }

    #[inline]
    fn slice(&self, linear: u32, top: u32, shift: u32) -> Moments {
        // A quarter of top times narrowing: at most half of `area`, as `check` has it.
        let lost = high(top, self.narrowing);
        let width = self.area - lost;
        let area = cut_product(linear, width, shift);
        // |middle| <= 2^23, areas below 2^31.
        let mut moment = i64::from(self.middle) * i64::from(area.cast_signed());
        if self.skew != 0 {
            // 4/3 of `lost` is at most 2/3 of `area`.
            let arm = width - high(lost, THIRD);
            let lever = cut_product(linear, high(top, arm), shift);
            // |skew| <= 2^25, levers below 2^29.
            moment += i64::from(self.skew) * i64::from(lever.cast_signed());
        }
        Moments { area, moment }
    }
}

impl Moments {
    /// The centroid in steps from the middle, rounded half away from zero and held to 16 bits; `None` without area.
    ///
    /// The area is cut to 16 bits and the moment to match: one division of 32 by 16 bits, off by less than
    /// 0.5 (the rounding of the quotient) + 0.51 (that of the area, at an end of the range).
    #[expect(
        clippy::as_conversions,
        clippy::cast_possible_truncation,
        reason = "saturated just before, or 32 of 64 bits on purpose"
    )]
    #[inline]
    pub(super) fn centroid(self) -> Option<i32> {
        let lead = self.area.leading_zeros();
        // 2^15..=2^16, rounded: half a unit of 2^-15 at most; an area of 0 gives 0.
        let area = ((self.area.wrapping_shl(lead) >> 15) + 1) >> 1;
        // |moment| <= 2^23 area: at most 2^31 after the shift; anything larger is held to that.
        let moment = self.moment.unsigned_abs() >> 24_u32.saturating_sub(lead);
        let moment = if moment >> 32 == 0 { (moment as u32).min(1 << 31) } else { 1 << 31 };
        // Below 2^31 + 2^15 over at least 2^15.
        let rounded = (moment + (area >> 1)).checked_div(area)?.min(1 << 15).cast_signed();
        Some(if self.moment < 0 { -rounded } else { rounded })
    }
}

/// `a b / 2^shift`, cut to a word: the callers choose the shift so that it fits, 32 or more where they cannot know.
#[expect(clippy::as_conversions, clippy::cast_possible_truncation, reason = "the callers' bound")]
#[inline]
fn cut_product(a: u32, b: u32, shift: u32) -> u32 {
    (u64::from(a) * u64::from(b)).wrapping_shr(shift) as u32
}

/// `number 2^scale`, held to a word.
#[expect(clippy::as_conversions, clippy::cast_possible_truncation, reason = "compared just before")]
const fn scaled_up(number: u32, scale: u32) -> u32 {
    // Up to 2^18 times 2^31.
    let wide = (number as u64) << (if scale < 31 { scale } else { 31 });
    if wide > u32::MAX as u64 { u32::MAX } else { wide as u32 }
}

/// `gap / slant` in Q30, cut, for a gap below the slant.
#[expect(
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "below 2^30 for a fraction below 1"
)]
const fn ratio(gap: u32, slant: u32) -> u32 {
    // Gaps are at most 2^16.
    match ((gap as u64) << 30).checked_div(slant as u64) {
        Some(ratio) => ratio as u32,
        None => 0,
    }
}

#[expect(clippy::as_conversions, reason = "From is not const")]
const fn wide(x: i32) -> i64 {
    x as i64
}

#[expect(
    clippy::as_conversions,
    clippy::cast_possible_truncation,
    reason = "a centroid within the range is below 2^23 + 1"
)]
const fn narrow(x: i64) -> i32 {
    x as i32
}

/// The corners held to the range, each at least the one before.
const fn ordered([a, b, c, d]: [i32; 4]) -> [i32; 4] {
    let a = held(a, -END);
    let b = held(b, a);
    let c = held(c, b);
    [a, b, c, held(d, c)]
}

const fn held(corner: i32, least: i32) -> i32 {
    if corner < least {
        least
    } else if corner > END {
        END
    } else {
        corner
    }
}
