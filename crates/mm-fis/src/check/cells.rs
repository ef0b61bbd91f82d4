//! The range of an input, cut into cells in which the same terms hold.

use mm_control::fuzzy::MembershipFunction as Set;

use crate::{Shape, Variable};

/// Degree below which a term without feet counts as not holding: it never is zero, but fires next to nothing.
pub(super) const FAINT: f64 = 1e-3;

/// Points at which a term without feet is looked at, besides its own.
const LOOKS: u32 = 256;
/// Halvings of an interval in which such a term begins or ends to hold.
const HALVINGS: u32 = 60;

/// A part of the range in which the same terms hold.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cell {
    pub(super) from: f64,
    pub(super) to: f64,
    /// For each term: whether it holds, and whether its complement does.
    pub(super) holds: Vec<[bool; 2]>,
}

impl Cell {
    /// Whether a rule's entry for this input holds; 0 plays no part and is asked of nobody.
    pub(super) fn satisfies(&self, index: i16) -> bool {
        let term = usize::from(index.unsigned_abs()).wrapping_sub(1);
        self.holds.get(term).is_some_and(|holds| holds[usize::from(index < 0)])
    }
}

/// Whether a term falls off without ever being zero.
pub(super) const fn is_tailed(set: &Set<f64>) -> bool {
    matches!(
        set,
        Set::Gaussian(_)
            | Set::Gaussian2(_)
            | Set::Bell(_)
            | Set::Sigmoid(_)
            | Set::SigmoidDifference(_)
            | Set::SigmoidProduct(_)
    )
}

/// The set of a term; none for a number.
pub(super) const fn set_of(term: &crate::Term) -> Option<&Set<f64>> {
    match &term.shape {
        Shape::Set(set) => Some(set),
        Shape::Constant(_) | Shape::Linear(_) => None,
    }
}

fn holds(set: &Set<f64>, x: f64) -> [bool; 2] {
    let degree = set.degree(x);
    if is_tailed(set) { [degree >= FAINT, degree <= 1.0 - FAINT] } else { [degree > 0.0, degree < 1.0] }
}

/// Cuts the range of an input; the cells ascend, and neighbours differ.
///
/// Exact for shapes with feet: between two breakpoints the same terms hold, and each breakpoint is looked at by itself.
pub(super) fn cells(input: &Variable) -> Vec<Cell> {
    let (lo, hi) = input.range;
    let sets: Vec<&Set<f64>> = input.terms.iter().filter_map(set_of).collect();
    // Places by themselves, and places that only part two intervals.
    let mut cuts = vec![(lo, true), (hi, true)];
    for set in &sets {
        if is_tailed(set) {
            cuts.extend(turns(set, input.range).into_iter().map(|x| (x, false)));
        } else {
            cuts.extend(breakpoints(set).into_iter().map(|x| (x, true)));
        }
    }
    cuts.retain(|(x, _)| *x >= lo && *x <= hi);
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
    cuts.dedup_by(|next, kept| next.0 <= kept.0);
    let pattern = |x: f64| sets.iter().map(|set| holds(set, x)).collect::<Vec<_>>();
    let mut cells: Vec<Cell> = Vec::new();
    let mut push = |from: f64, to: f64, holds: Vec<[bool; 2]>| match cells.last_mut() {
        Some(last) if last.holds == holds => last.to = to,
        _ => cells.push(Cell { from, to, holds }),
    };
    for (number, (x, by_itself)) in cuts.iter().enumerate() {
        if *by_itself {
            push(*x, *x, pattern(*x));
        }
        if let Some((next, _)) = cuts.get(number + 1) {
            let middle = 0.5 * x + 0.5 * next;
            // No number is between two neighbouring ones.
            if middle > *x && middle < *next {
                push(*x, *next, pattern(middle));
            }
        }
    }
    cells
}

/// Where a term may turn a corner or jump: its breakpoints, or its centres.
pub(super) fn breakpoints(set: &Set<f64>) -> Vec<f64> {
    match *set {
        Set::Triangle([a, b, c]) => vec![a, b, c],
        Set::Trapezoid(corners) => corners.to_vec(),
        Set::LinearS([a, b]) | Set::LinearZ([a, b]) => vec![a, b],
        // The inflection in the middle, or the step there.
        Set::S([a, b]) | Set::Z([a, b]) => vec![a, 0.5 * a + 0.5 * b, b],
        Set::Pi([a, b, c, d]) => vec![a, 0.5 * a + 0.5 * b, b, c, 0.5 * c + 0.5 * d, d],
        Set::Gaussian([_, c]) | Set::Sigmoid([_, c]) | Set::Bell([_, _, c]) => vec![c],
        Set::Gaussian2([_, c1, _, c2])
        | Set::SigmoidDifference([_, c1, _, c2])
        | Set::SigmoidProduct([_, c1, _, c2]) => vec![c1, c2],
    }
}

/// Characteristic width of a term without feet.
fn widths(set: &Set<f64>) -> Vec<f64> {
    match *set {
        Set::Gaussian([s, _]) => vec![s],
        Set::Gaussian2([s1, _, s2, _]) => vec![s1, s2],
        Set::Bell([a, ..]) => vec![a],
        Set::Sigmoid([a, _]) => vec![1.0 / a],
        Set::SigmoidDifference([a1, _, a2, _]) | Set::SigmoidProduct([a1, _, a2, _]) => {
            vec![1.0 / a1, 1.0 / a2]
        }
        _ => Vec::new(),
    }
}

/// Where a term without feet, or its complement, begins or ceases to hold, by looking at many points and halving.
fn turns(set: &Set<f64>, (lo, hi): (f64, f64)) -> Vec<f64> {
    let mut looks: Vec<f64> =
        (0..=LOOKS).map(|k| lo + (hi - lo) * (f64::from(k) / f64::from(LOOKS))).collect();
    for center in breakpoints(set) {
        looks.push(center);
        for width in widths(set) {
            for factor in [0.02, 0.05, 0.2, 1.0, 2.0, 4.0, 8.0] {
                looks.push(center - factor * width);
                looks.push(center + factor * width);
            }
        }
    }
    looks.retain(|x| *x >= lo && *x <= hi);
    looks.sort_by(f64::total_cmp);
    let mut found = Vec::new();
    for pair in looks.windows(2) {
        let &[mut start, end] = pair else { continue };
        // Term and complement may both turn between two looks.
        while holds(set, start) != holds(set, end) {
            let before = holds(set, start);
            let (mut from, mut to) = (start, end);
            for _ in 0..HALVINGS {
                let middle = 0.5 * from + 0.5 * to;
                if !(middle > from && middle < to) {
                    break;
                }
                if holds(set, middle) == before { from = middle } else { to = middle }
            }
            found.push(to);
            start = to;
        }
    }
    found
}

/// Joins intervals that follow one another.
pub(super) fn joined(intervals: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut all: Vec<(f64, f64)> = Vec::new();
    for (from, to) in intervals {
        match all.last_mut() {
            Some(last) if from <= last.1 => last.1 = to,
            _ => all.push((from, to)),
        }
    }
    all
}
