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
/// Terms and overlaps are summed apart: a mirrored set gives exactly the opposite moment while at most two terms fire at once, and
/// beyond that up to rounding.
///
/// Cost: about 25 operations for a firing term, 20 and a division for an overlap.
#[inline]
pub(super) fn moments<T: Real>(
    terms: &[MembershipFunction<T>],
    strengths: &[T],
    middle: T,
    half: T,
) -> Option<Moments<T>> {
    let (mut whole, mut twice) = (Moments::NONE, Moments::NONE);
    let mut before: Option<([T; 4], T)> = None;
    let mut end_before_that = -half;
    for (term, &height) in terms.iter().zip(strengths) {
        if !(height > T::ZERO) {
            continue;
        }
        let corners = term.corners(middle - half, middle + half)?;
        let own = within(corners.map(|p| p - middle), half)?;
        let [a, b, c, d] = own;
        if let Some(([below_a, below_b, below_c, below_d], below_height)) = before {
            let ordered = below_a <= a && below_b <= b && below_c <= c && below_d <= d;
            if !ordered || end_before_that > a {
                return None;
            }
            if below_d > a {
                let (left, right) = (b - a, below_d - below_c);
                let top = height.min(below_height).min(overlap_height(below_d - a, left + right));
                twice = twice.plus(slice(a, left, below_d, right, top));
            }
            end_before_that = below_d;
        }
        whole = whole.plus(slice(a, b - a, d, d - c, height));
        before = Some((own, height));
    }
    // The slices carry twice the area and six times the moment.
    let three = T::ONE + T::TWO;
    Some(Moments { area: three * (whole.area - twice.area), first: whole.first - twice.first })
}

/// Height at which two sides cross that are `gap` apart at the bottom and lean towards each other by `slant`.
#[inline]
fn overlap_height<T: Real>(gap: T, slant: T) -> T {
    if slant > gap { gap / slant } else { T::ONE }
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
/// of height to one at `d` that leans left by `right`.
#[inline]
fn slice<T: Real>(a: T, left: T, d: T, right: T, top: T) -> Moments<T> {
    let (upper_a, upper_d) = (a + top * left, d - top * right);
    let area = (d - a) + (upper_d - upper_a);
    let squares = (d * d + upper_d * (d + upper_d)) - (a * a + upper_a * (a + upper_a));
    Moments { area: top * area, first: top * squares }
}
