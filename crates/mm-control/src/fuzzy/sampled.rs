//! Defuzzification of an output set by samples, as `.fis` tools do it.

use super::activation::OutputSet;
use super::tables::{Defuzzifier, Sampling};
use mm_model::Real;

/// The points at which an output set is sampled.
#[derive(Debug, Clone, Copy)]
struct Points<T> {
    first: T,
    last: T,
    step: T,
    count: u32,
}

impl<T: Real> Points<T> {
    fn new((lo, hi): (T, T), sampling: Sampling) -> Self {
        match sampling {
            Sampling::Ends(count) => {
                let step = (hi - lo) / T::from_u32(count.saturating_sub(1));
                Self { first: lo, last: hi, step, count }
            }
            Sampling::Midpoints(count) => {
                let step = (hi - lo) / T::from_u32(count);
                Self { first: lo + T::HALF * step, last: hi - T::HALF * step, step, count }
            }
        }
    }

    /// The points in ascending order, the last one exactly where it belongs.
    fn iter(self) -> impl Iterator<Item = T> {
        let Self { first, last, step, count } = self;
        (0..count).map(
            move |k| {
                if count.checked_sub(1) == Some(k) { last } else { first + T::from_u32(k) * step }
            },
        )
    }
}

/// The output by samples, within the range, or `None` where nothing fired or the set is zero at every sample.
///
/// Cost: the number of samples times the number of terms that fired; twice that for the bisector.
pub(super) fn defuzzify<T: Real>(set: &OutputSet<'_, T>, defuzzifier: Defuzzifier) -> Option<T> {
    let (lo, hi) = set.variable.range;
    let points = |sampling| Points::new((lo, hi), sampling);
    let output = match defuzzifier {
        Defuzzifier::Centroid => None,
        Defuzzifier::SampledCentroid(sampling) => centroid(set, points(sampling)),
        Defuzzifier::Bisector(sampling) => bisector(set, points(sampling)),
        Defuzzifier::MeanOfMaximum(sampling) => mean_of_maximum(set, points(sampling)),
        Defuzzifier::SmallestOfMaximum(sampling) => {
            extreme_of_maximum(set, points(sampling), |new, old| new < old)
        }
        Defuzzifier::LargestOfMaximum(sampling) => {
            extreme_of_maximum(set, points(sampling), |new, old| new > old)
        }
    };
    output.filter(|y| y.is_finite()).map(|y| y.clamp_to(lo, hi))
}

/// Measured from the middle of the range: where that lies takes no digits away.
fn centroid<T: Real>(set: &OutputSet<'_, T>, points: Points<T>) -> Option<T> {
    let middle = T::HALF * points.first + T::HALF * points.last;
    let (mut area, mut moment) = (T::ZERO, T::ZERO);
    for y in points.iter() {
        let m = set.degree(y);
        area += m;
        moment += m * (y - middle);
    }
    (area > T::ZERO).then(|| middle + moment / area)
}

fn bisector<T: Real>(set: &OutputSet<'_, T>, points: Points<T>) -> Option<T> {
    let whole = points.iter().fold(T::ZERO, |sum, y| sum + set.degree(y));
    if !(whole > T::ZERO) {
        return None;
    }
    let mut sum = T::ZERO;
    points.iter().find(|&y| {
        sum += set.degree(y);
        sum >= T::HALF * whole
    })
}

fn mean_of_maximum<T: Real>(set: &OutputSet<'_, T>, points: Points<T>) -> Option<T> {
    let middle = T::HALF * points.first + T::HALF * points.last;
    let (mut most, mut sum, mut count) = (T::ZERO, T::ZERO, T::ZERO);
    for y in points.iter() {
        let m = set.degree(y);
        if m > most {
            (most, sum, count) = (m, y - middle, T::ONE);
        } else if m >= most {
            sum += y - middle;
            count += T::ONE;
        }
    }
    (most > T::ZERO).then(|| middle + sum / count)
}

fn extreme_of_maximum<T: Real>(
    set: &OutputSet<'_, T>,
    points: Points<T>,
    better: impl Fn(T, T) -> bool,
) -> Option<T> {
    let (mut most, mut best) = (T::ZERO, None);
    for y in points.iter() {
        let m = set.degree(y);
        if m > most {
            (most, best) = (m, Some(y));
        } else if m >= most && best.is_some_and(|best: T| better(y.abs(), best.abs())) {
            best = Some(y);
        }
    }
    best
}
