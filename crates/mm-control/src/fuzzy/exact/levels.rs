//! Area and moment of the maximum of cut-off trapezoids in a row, by slices between two heights.
//!
//! At height `h` a trapezoid with corners a, b, c, d reaches from `a + h (b - a)` to `d - h (d - c)`. Cut off at `w` it has
//! the area `int_0^w (right - left) dh` and the moment `int_0^w (right^2 - left^2)/2 dh`, both polynomials in `w`. Where two
//! neighbours overlap, the part counted twice is of the same kind, from the left side of the upper to the right
//! side of the lower term, up to the height at which these cross.
//!
//! Terms are taken in the order of the table; a row has all four corners ascending from term to term, no overlap beyond
//! the next firing neighbour, and no sloping side across an end of the range. Everything else is left to the sweep.

use super::Moments;
use crate::fuzzy::MembershipFunction;
use mm_model::Real;

/// Six times the area and moment of what fired over `[middle - half, middle + half]`, or `None` where the terms are no such row.
///
/// Each half is summed from the middle outward, the lower one as its mirror image: a mirrored set gives exactly
/// the opposite moment.
///
/// Cost: about 25 operations for a firing term, 20 and a division for an overlap.
#[inline]
pub(super) fn moments<T: Real>(
    terms: &[MembershipFunction<T>],
    strengths: &[T],
    middle: T,
    half: T,
) -> Option<Moments<T>> {
    let row = terms.iter().zip(strengths);
    let upper = upper_half(row.clone(), half, |term| {
        let corners = term.corners(middle - half, middle + half)?;
        Some(corners.map(|p| p - middle))
    })?;
    let lower = upper_half(row.rev(), half, |term| {
        let [a, b, c, d] = term.corners(middle - half, middle + half)?;
        Some([d, c, b, a].map(|p| middle - p))
    })?;
    // The slices carry twice the area and six times the moment.
    let three = T::ONE + T::TWO;
    Some(Moments { area: three * (upper.area + lower.area), first: upper.first - lower.first })
}

/// The terms with their centre above the middle, and the overlaps that have it there; what is centred, by half.
#[inline]
fn upper_half<'t, T: Real>(
    row: impl Iterator<Item = (&'t MembershipFunction<T>, &'t T)>,
    half: T,
    corners: impl Fn(&MembershipFunction<T>) -> Option<[T; 4]>,
) -> Option<Moments<T>> {
    let mut sum = Moments::NONE;
    let mut before: Option<([T; 4], T)> = None;
    let mut end_before_that = -half;
    for (term, &height) in row {
        if !(height > T::ZERO) {
            continue;
        }
        let own = within(corners(term)?, half)?;
        let [a, b, c, d] = own;
        if let Some(([below_a, below_b, below_c, below_d], below_height)) = before {
            let ordered = below_a <= a && below_b <= b && below_c <= c && below_d <= d;
            if !ordered || end_before_that > a {
                return None;
            }
            let share = share_above(a + below_d);
            if below_d > a && share > T::ZERO {
                let (left, right) = (b - a, below_d - below_c);
                let slant = left + right;
                let top = height.min(below_height).min(overlap_height(below_d - a, slant));
                sum = sum.plus(slice(a, left, below_d, right, top, -share));
            }
            end_before_that = below_d;
        }
        let share = share_above(a + d);
        if share > T::ZERO {
            sum = sum.plus(slice(a, b - a, d, d - c, height, share));
        }
        before = Some((own, height));
    }
    Some(sum)
}

/// Height at which two sides cross that are `gap` apart at the bottom and lean towards each other by `slant`.
#[inline]
fn overlap_height<T: Real>(gap: T, slant: T) -> T {
    if slant > gap { gap / slant } else { T::ONE }
}

/// 1 for what is centred above the middle, one half for what is centred on it.
#[inline]
fn share_above<T: Real>(twice_centre: T) -> T {
    if twice_centre > T::ZERO {
        T::ONE
    } else if twice_centre < T::ZERO {
        T::ZERO
    } else {
        T::HALF
    }
}

/// The corners within the range, or `None` where a sloping side crosses an end of it.
#[inline]
fn within<T: Real>([a, b, c, d]: [T; 4], half: T) -> Option<[T; 4]> {
    if a >= -half && d <= half {
        return Some([a, b, c, d]);
    }
    let (a, b) = if a >= -half {
        (a, b)
    } else if b <= -half {
        (-half, -half)
    } else {
        return None;
    };
    let (c, d) = if d <= half {
        (c, d)
    } else if c >= half {
        (half, half)
    } else {
        return None;
    };
    (b <= half && c >= -half).then_some([a, b, c, d])
}

/// Twice the area and six times the moment between the heights 0 and `top`, from a side at `a` that leans right by `left` a unit
/// of height to one at `d` that leans left by `right`; times `share`.
#[inline]
fn slice<T: Real>(a: T, left: T, d: T, right: T, top: T, share: T) -> Moments<T> {
    let (upper_a, upper_d) = (a + top * left, d - top * right);
    let scale = share * top;
    let area = (d - a) + (upper_d - upper_a);
    let squares = (d * d + upper_d * (d + upper_d)) - (a * a + upper_a * (a + upper_a));
    Moments { area: scale * area, first: scale * squares }
}
