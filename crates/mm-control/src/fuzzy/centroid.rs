//! The exact centroid of clipped trapezoids joined by their maximum.
//!
//! The output set is swept outward from the middle of its range, once towards each end. On the way every set is
//! a line between two of its breakpoints; the piece from the present position to the next breakpoint, or to the
//! next crossing of the line on top by a steeper one, contributes its area and moment in closed form. Both
//! sweeps do the same operations in the same order on mirrored sets, all their terms are non-negative, and only
//! the last step subtracts: a mirrored output gives exactly the opposite centroid.

use super::MembershipFunction;
use mm_model::Real;

/// A trapezoid cut off at `height`, in coordinates measured from the middle of the output range.
#[derive(Debug, Clone, Copy)]
pub(super) struct ClippedSet<T> {
    /// Feet and ends of the plateau, ascending.
    corners: [T; 4],
    height: T,
    /// Slope of the rising side and magnitude of the slope of the falling side; 0 where a side is vertical.
    rise: T,
    fall: T,
}

/// The line that a set follows to the right of a position, and where it ends.
#[derive(Clone, Copy)]
struct Line<T> {
    value: T,
    slope: T,
    end: T,
}

impl<T: Real> ClippedSet<T> {
    /// The set that is nowhere above zero.
    pub(super) const EMPTY: Self =
        Self { corners: [T::ZERO; 4], height: T::ZERO, rise: T::ZERO, fall: T::ZERO };

    /// Cuts `term` off at `height` in (0, 1] and measures it from `middle`.
    pub(super) fn new(term: &MembershipFunction<T>, height: T, middle: T) -> Self {
        let [a, b, c, d] = term.breakpoints().map(|p| p - middle);
        let (rise, b) = side(a, b, height);
        let (fall, minus_c) = side(-d, -c, height);
        Self { corners: [a, b, -minus_c, d], height, rise, fall }
    }

    fn mirrored(&self) -> Self {
        let [a, b, c, d] = self.corners;
        Self { corners: [-d, -c, -b, -a], height: self.height, rise: self.fall, fall: self.rise }
    }

    /// The line followed just right of `t`; a set that has ended stays at zero up to `last`.
    #[inline]
    fn line_after(&self, t: T, last: T) -> Line<T> {
        let [a, b, c, d] = self.corners;
        if t < a {
            Line { value: T::ZERO, slope: T::ZERO, end: a }
        } else if t < b {
            Line { value: ((t - a) * self.rise).min(self.height), slope: self.rise, end: b }
        } else if t < c {
            Line { value: self.height, slope: T::ZERO, end: c }
        } else if t < d {
            Line { value: ((d - t) * self.fall).min(self.height), slope: -self.fall, end: d }
        } else {
            Line { value: T::ZERO, slope: T::ZERO, end: last }
        }
    }
}

/// Slope of a side rising from `foot` towards degree 1 at `shoulder`, and where it reaches `height`.
///
/// A side too narrow for a finite slope is taken as vertical.
fn side<T: Real>(foot: T, shoulder: T, height: T) -> (T, T) {
    let width = shoulder - foot;
    let slope = T::ONE / width;
    if width > T::ZERO && slope.is_finite() { (slope, foot + height * width) } else { (T::ZERO, foot) }
}

/// Centroid of the maximum of `sets` over `[-half, half]`, or `None` where there is no area.
///
/// Cost: at most `4 n + 1` breakpoints and `n - 1` crossings between two of them for `n` sets, `O(n)` each.
pub(super) fn centroid<T: Real>(sets: &mut [ClippedSet<T>], half: T) -> Option<T> {
    let (area_right, moment_right) = sweep(sets, half);
    for set in &mut *sets {
        *set = set.mirrored();
    }
    let (area_left, moment_left) = sweep(sets, half);
    let centroid = (moment_right - moment_left) / (area_right + area_left);
    centroid.is_finite().then_some(centroid)
}

/// Area and first moment of the maximum of `sets` over `[0, last]`.
fn sweep<T: Real>(sets: &[ClippedSet<T>], last: T) -> (T, T) {
    let (mut area, mut six_moments) = (T::ZERO, T::ZERO);
    // Before the first foot and after the last one there is nothing to add.
    let (first, last) = sets.iter().fold((last, T::ZERO), |(first, end), set| {
        let [foot, .., far_foot] = set.corners;
        (first.min(foot), end.max(far_foot.min(last)))
    });
    let mut t = first.max(T::ZERO);
    let most_pieces = (4 * sets.len() + 1) * sets.len();
    for _ in 0..most_pieces {
        let Some((top, next)) = piece_after(sets, t, last) else { break };
        let width = next - t;
        let (from, to) = (top.value, (top.value + top.slope * width).max(T::ZERO));
        area += width * (from + to);
        let both = from + to;
        six_moments += width * (t * (from + both) + next * (both + to));
        t = next;
    }
    (T::HALF * area, six_moments / (T::TWO + T::TWO + T::TWO))
}

/// The line on top just right of `t` and the position up to which it stays there; `None` from `last` on.
fn piece_after<T: Real>(sets: &[ClippedSet<T>], t: T, last: T) -> Option<(Line<T>, T)> {
    if t >= last {
        return None;
    }
    let mut top = Line { value: T::ZERO, slope: T::ZERO, end: last };
    let mut stop = last;
    let mut steepest = T::ZERO;
    for set in sets {
        let line = set.line_after(t, last);
        stop = stop.min(line.end);
        steepest = steepest.max(line.slope);
        if line.value > top.value || (line.value >= top.value && line.slope > top.slope) {
            top = line;
        }
    }
    if top.slope >= steepest {
        return Some((top, stop));
    }
    // Each pass that starts again has moved to a steeper line, so there are at most as many as sets.
    'passes: for _ in sets {
        let mut next = stop;
        for set in sets {
            let line = set.line_after(t, last);
            if line.slope > top.slope {
                let crossing = t + (top.value - line.value) / (line.slope - top.slope);
                if crossing <= t {
                    // Too close for the position to move: the steeper line is on top already.
                    top = line;
                    continue 'passes;
                }
                next = next.min(crossing);
            }
        }
        return Some((top, next));
    }
    Some((top, stop))
}
