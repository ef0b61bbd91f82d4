//! The fewest knots of a section, for one power of two after another.

/// What a section is to stay within: for each input of it, the lowest and the highest output allowed, and the exact one.
#[derive(Debug, Clone)]
pub(super) struct Band {
    pub(super) lowest: Vec<i32>,
    pub(super) highest: Vec<i32>,
    pub(super) exact: Vec<f64>,
}

/// Most values that are tried for a knot; with wider bands, every second, third ... one.
const MOST_CANDIDATES: i64 = 96;

/// A value of a knot that the knots before it can reach, and the values that the next one may then have.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    value: i64,
    next: (i64, i64),
}

/// Knots at distances of 2^`shift` whose interpolation, rounded as the evaluation does, stays within the band; multiples of `step`.
///
/// From knot to knot it keeps which values are reachable; the interpolation between two of them is linear in both, so that each input between
/// bounds the second one from both sides, given the first. Whole numbers throughout: what is found here holds exactly.
pub(super) fn knots(band: &Band, shift: u32, step: i32) -> Option<Vec<i16>> {
    let length = band.exact.len();
    let distance = 1_usize << shift;
    let mut stages: Vec<Vec<Candidate>> = Vec::new();
    let mut reachable = all_within(band, 0, step)?;
    for start in (0..length).step_by(distance) {
        let stage: Vec<Candidate> = reachable
            .iter()
            .map(|&value| Candidate { value, next: allowed_next(band, (start, shift), value) })
            .filter(|candidate| candidate.next.0 <= candidate.next.1)
            .collect();
        let lowest = stage.iter().map(|candidate| candidate.next.0).min()?;
        let highest = stage.iter().map(|candidate| candidate.next.1).max()?;
        let end = start + distance;
        let (lowest, highest) = if end < length {
            (lowest.max(band.lowest[end].into()), highest.min(band.highest[end].into()))
        } else {
            (lowest, highest)
        };
        let allowed = |value: &i64| stage.iter().any(|candidate| fits(candidate, *value));
        reachable = multiples(lowest, highest, step).filter(allowed).collect();
        if reachable.is_empty() {
            return None;
        }
        stages.push(stage);
    }
    Some(chosen(band, &stages, &reachable, distance))
}

fn fits(candidate: &Candidate, value: i64) -> bool {
    candidate.next.0 <= value && value <= candidate.next.1
}

/// Walks back from the last knot, taking the values nearest to the exact ones.
fn chosen(band: &Band, stages: &[Vec<Candidate>], reachable: &[i64], distance: usize) -> Vec<i16> {
    let nearest = |values: &mut dyn Iterator<Item = i64>, position: usize| {
        let position = position.min(band.exact.len() - 1);
        let off = |value: &i64| (*value as f64 - band.exact[position]).abs();
        values.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    };
    let mut value = nearest(&mut reachable.iter().copied(), stages.len() * distance);
    let mut knots = vec![value];
    for (number, stage) in stages.iter().enumerate().rev() {
        let mut before =
            stage.iter().filter(|candidate| fits(candidate, value)).map(|candidate| candidate.value);
        value = nearest(&mut before, number * distance);
        knots.push(value);
    }
    // The knot past the last input is needed only where that input lies between two.
    if (band.exact.len() - 1).is_multiple_of(distance) {
        knots.remove(0);
    }
    knots.reverse();
    knots.into_iter().map(|knot| i16::try_from(knot).unwrap_or(0)).collect()
}

/// The values that the next knot may have if the one at `start` has `value`.
fn allowed_next(band: &Band, (start, shift): (usize, u32), value: i64) -> (i64, i64) {
    let distance = 1_i64 << shift;
    let half = distance >> 1;
    let (mut lowest, mut highest) = (-32768, 32767);
    let between = band.lowest.iter().zip(&band.highest).skip(start).zip(0..distance).skip(1);
    for ((&low, &high), part) in between {
        // floor((value (distance - part) + next part + half) / distance) in low..=high
        let own = value * (distance - part) + half;
        lowest = lowest.max(-((own - i64::from(low) * distance).div_euclid(part)));
        highest = highest.min((i64::from(high) * distance + distance - 1 - own).div_euclid(part));
        if lowest > highest {
            break;
        }
    }
    (lowest, highest)
}

fn all_within(band: &Band, position: usize, step: i32) -> Option<Vec<i64>> {
    let values: Vec<i64> =
        multiples(band.lowest[position].into(), band.highest[position].into(), step).collect();
    if values.is_empty() { None } else { Some(values) }
}

/// Multiples of `step` from `lowest` to `highest`, thinned out where there are many.
fn multiples(lowest: i64, highest: i64, step: i32) -> impl Iterator<Item = i64> {
    let step = i64::from(step);
    let (first, last) = (-(-lowest).div_euclid(step), highest.div_euclid(step));
    let stride = (last - first).max(0) / MOST_CANDIDATES + 1;
    (first..=last).step_by(usize::try_from(stride).unwrap_or(1)).map(move |number| number * step)
}
