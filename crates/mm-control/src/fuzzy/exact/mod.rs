//! The exact centroid of an output set whose pieces are straight lines.
//!
//! Two ways lead to the same number. [`levels`] slices the set at the heights of its terms; it is the fast one, for what nearly
//! every rule base looks like: cut-off terms in a row, each overlapping its neighbours. [`sweep`] walks along the outline
//! of the set from corner to corner and takes every arrangement, scaled or summed terms and complements too.

mod levels;
mod shaped;
mod sweep;

use super::activation::OutputSet;
use super::tables::{Aggregation, Implication, Operators};
use mm_model::Real;
use shaped::ShapedTerm;

/// The exact centroid, or `None` where the set has no area.
#[inline]
pub(super) fn centroid<T: Real>(set: &OutputSet<'_, T>) -> Option<T> {
    let (lo, hi) = set.variable.range;
    let (middle, half) = (T::HALF * lo + T::HALF * hi, T::HALF * hi - T::HALF * lo);
    let offset = match set.operators {
        Operators { aggregation: Aggregation::Max, implication: Implication::Min, .. } if set.is_merged() => {
            match levels::moments(set.variable.terms, set.strengths, middle, half) {
                Some(moments) => moments.centroid(),
                None => swept(set, middle, half),
            }
        }
        _ => swept(set, middle, half),
    }?;
    Some((middle + offset).clamp_to(lo, hi))
}

#[inline(never)]
fn swept<T: Real>(set: &OutputSet<'_, T>, middle: T, half: T) -> Option<T> {
    let operators = set.operators;
    let shaped = set
        .activations()
        .flat_map(move |activation| ShapedTerm::of(&activation, operators.implication, middle, half));
    let moments = match operators.aggregation {
        Aggregation::Sum => {
            shaped.fold(Moments::NONE, |sum, term| sum.plus(sweep::moments(core::iter::once(term), half)))
        }
        Aggregation::Max | Aggregation::Probor => sweep::moments(shaped, half),
    };
    moments.centroid()
}

/// Area and first moment about the middle of the range, on a common scale.
#[derive(Debug, Clone, Copy)]
struct Moments<T> {
    area: T,
    first: T,
}

impl<T: Real> Moments<T> {
    const NONE: Self = Self { area: T::ZERO, first: T::ZERO };

    fn plus(self, other: Self) -> Self {
        Self { area: self.area + other.area, first: self.first + other.first }
    }

    fn centroid(self) -> Option<T> {
        let centroid = self.first / self.area;
        (self.area > T::ZERO && centroid.is_finite()).then_some(centroid)
    }
}
