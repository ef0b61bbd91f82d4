//! A term as its rule shapes it: cut off or scaled, measured from the middle of the output range.

use crate::fuzzy::activation::Activation;
use crate::fuzzy::tables::Implication;
use mm_model::Real;

/// A trapezoid of some height, in coordinates measured from the middle of the output range.
#[derive(Debug, Clone, Copy)]
pub(super) struct ShapedTerm<T> {
    /// Feet and ends of the plateau, ascending.
    corners: [T; 4],
    height: T,
    /// Slope of the rising side and magnitude of the slope of the falling side; 0 where a side is vertical.
    rise: T,
    fall: T,
}

/// The line that a term follows to the right of a position, and where it ends.
#[derive(Clone, Copy)]
pub(super) struct Line<T> {
    pub(super) value: T,
    pub(super) slope: T,
    pub(super) end: T,
}

impl<T: Real> ShapedTerm<T> {
    /// The trapezoids that an activation makes: one, or for a complement the flanks to both sides of the term.
    pub(super) fn of(
        activation: &Activation<'_, T>,
        implication: Implication,
        middle: T,
        half: T,
    ) -> impl Iterator<Item = Self> + Clone + use<T> {
        let strength = activation.strength;
        let shape = move |corners: [T; 4]| Self::new(corners, strength, implication);
        let corners = activation.term.corners(middle - half, middle + half);
        let (one, two) = match corners.map(|corners| corners.map(|p| p - middle)) {
            None => (None, None),
            Some(corners) if !activation.complement => (Some(shape(corners)), None),
            Some([a, b, c, d]) => {
                let (lo, hi) = ((-half).min(a), half.max(d));
                (Some(shape([lo, lo, a, b])), Some(shape([c, d, hi, hi])))
            }
        };
        one.into_iter().chain(two)
    }

    fn new([a, b, c, d]: [T; 4], strength: T, implication: Implication) -> Self {
        let (height, part) = match implication {
            Implication::Min => (strength, strength),
            Implication::Prod => (strength, T::ONE),
        };
        let (rise, b) = side(a, b, height, part);
        let (fall, minus_c) = side(-d, -c, height, part);
        Self { corners: [a, b, -minus_c, d], height, rise, fall }
    }

    pub(super) fn mirrored(self) -> Self {
        let [a, b, c, d] = self.corners;
        Self { corners: [-d, -c, -b, -a], height: self.height, rise: self.fall, fall: self.rise }
    }

    /// Outer ends.
    pub(super) const fn feet(&self) -> (T, T) {
        let [a, _, _, d] = self.corners;
        (a, d)
    }

    /// The line followed just right of `t`; a term that has ended stays at zero up to `last`.
    #[inline]
    pub(super) fn line_after(&self, t: T, last: T) -> Line<T> {
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

/// Slope of a side that reaches `height` at the given part of the way from `foot` to `shoulder`, and where that is.
///
/// A side too narrow for a finite slope is taken as vertical.
fn side<T: Real>(foot: T, shoulder: T, height: T, part: T) -> (T, T) {
    let width = part * (shoulder - foot);
    let slope = height / width;
    if width > T::ZERO && slope.is_finite() { (slope, foot + width) } else { (T::ZERO, foot) }
}
