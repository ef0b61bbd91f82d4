//! Area and moment of the maximum of trapezoids, by walking along its outline.
//!
//! The outline is followed outward from the middle of the range, once towards each end. On the way every term is
//! a line between two of its corners; the piece from the present position to the next corner, or to the next crossing
//! of the line on top by a steeper one, contributes its area and moment in closed form. Both walks do
//! the same operations in the same order on mirrored terms, all their terms are non-negative, and only the last step
//! subtracts: a mirrored set gives exactly the opposite moment.

use super::Moments;
use super::shaped::{Line, ShapedTerm};
use mm_model::Real;

/// Area and moment of the maximum of `terms` over `[-half, half]`.
///
/// Cost: at most `4 n + 1` corners and `n - 1` crossings between two of them for `n` terms, `O(n)` each.
pub(super) fn moments<T: Real>(terms: impl Iterator<Item = ShapedTerm<T>> + Clone, half: T) -> Moments<T> {
    let (area_right, moment_right) = sweep(&terms, half);
    let (area_left, moment_left) = sweep(&terms.map(ShapedTerm::mirrored), half);
    Moments { area: area_right + area_left, first: moment_right - moment_left }
}

/// Area and first moment of the maximum of `terms` over `[0, last]`.
fn sweep<T: Real>(terms: &(impl Iterator<Item = ShapedTerm<T>> + Clone), last: T) -> (T, T) {
    let (mut area, mut six_moments) = (T::ZERO, T::ZERO);
    // Before the first foot and after the last one there is nothing to add.
    let (count, first, last) = terms.clone().fold((0_usize, last, T::ZERO), |(count, first, end), term| {
        let (foot, far_foot) = term.feet();
        (count.saturating_add(1), first.min(foot), end.max(far_foot.min(last)))
    });
    let mut t = first.max(T::ZERO);
    let most_pieces = count.saturating_mul(4).saturating_add(1).saturating_mul(count);
    for _ in 0..most_pieces {
        let Some((top, next)) = piece_after(terms, t, last) else { break };
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
fn piece_after<T: Real>(
    terms: &(impl Iterator<Item = ShapedTerm<T>> + Clone),
    t: T,
    last: T,
) -> Option<(Line<T>, T)> {
    if t >= last {
        return None;
    }
    let mut top = Line { value: T::ZERO, slope: T::ZERO, end: last };
    let mut stop = last;
    let mut steepest = T::ZERO;
    for term in terms.clone() {
        let line = term.line_after(t, last);
        stop = stop.min(line.end);
        steepest = steepest.max(line.slope);
        if line.value > top.value || (line.value >= top.value && line.slope > top.slope) {
            top = line;
        }
    }
    if top.slope >= steepest {
        return Some((top, stop));
    }
    // Each pass that starts again has moved to a steeper line, so there are at most as many as terms.
    'passes: for _ in terms.clone() {
        let mut next = stop;
        for term in terms.clone() {
            let line = term.line_after(t, last);
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
