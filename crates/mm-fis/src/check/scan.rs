//! Outputs along one input: where they jump and where they turn.

use super::cells::{breakpoints, is_tailed, set_of};
use super::probe::Probe;
use super::{Jump, Run};
use crate::Variable;

/// Distance to the side of a place at which an output is looked at, in the range.
const SIDE: f64 = 1e-12;
/// The same in the place's own size: some of its smallest steps.
const SIDE_OF_PLACE: f64 = 2e-15;
/// Distance up to which a value beside a breakpoint has to last, in the range, and the part of the way to the next breakpoint.
const LASTING: f64 = 1e-5;
const PART_OF_WAY: f64 = 0.01;
/// Part of an output's range by which it may depart from what it is on the way to a breakpoint, and the same in changes on that way.
const DEPARTURE: f64 = 1e-5;
const CHANGES: f64 = 8.0;
/// Halvings of an interval to find a jump.
const HALVINGS: u32 = 60;
/// Steps of the search for a turning point.
const GOLDEN_STEPS: u32 = 60;
/// Part of the output's range within which it counts as level.
const LEVEL: f64 = 1e-9;

/// A place along the input.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    x: f64,
    /// Where it counts as: for the sides of a breakpoint, there.
    at: f64,
    is_breakpoint: bool,
    /// For the side of a breakpoint: the step to further places on that side, over which its value has to last; else 0.
    lasting: f64,
}

impl Place {
    /// The value of the input.
    pub(super) const fn x(self) -> f64 {
        self.x
    }
}

/// Where an input is looked at: everywhere alike, at every breakpoint, and to both sides of it.
pub(super) fn places(input: &Variable, parts: u32) -> Vec<Place> {
    let (lo, hi) = input.range;
    let mut all: Vec<Place> = (0..=parts)
        .map(|k| lo + (hi - lo) * (f64::from(k) / f64::from(parts)))
        .map(|x| Place { x, at: x, is_breakpoint: false, lasting: 0.0 })
        .collect();
    let mut own: Vec<f64> = input.terms.iter().filter_map(set_of).flat_map(breakpoints).collect();
    own.extend([lo, hi]);
    own.retain(|at| *at >= lo && *at <= hi);
    own.sort_by(f64::total_cmp);
    own.dedup_by(|next, kept| next <= kept);
    let footed = |at: f64| {
        let sets = input.terms.iter().filter_map(set_of).filter(|set| !is_tailed(set));
        sets.flat_map(breakpoints).any(|other| (other - at).abs() <= 0.0)
    };
    for (number, &at) in own.iter().enumerate() {
        let side = side(at, input.range);
        all.push(Place { x: at, at, is_breakpoint: true, lasting: 0.0 });
        let (before, after) = (number.checked_sub(1).and_then(|before| own.get(before)), own.get(number + 1));
        for (sign, next) in [(-1.0, before), (1.0, after)] {
            let Some(next) = next else { continue };
            let lasting = (LASTING * (hi - lo)).min(PART_OF_WAY * (next - at).abs());
            // Rounding is seen only far from the side itself.
            let lasting = if footed(at) && lasting > 1e4 * side { sign * lasting } else { 0.0 };
            all.push(Place { x: at + sign * side, at, is_breakpoint: false, lasting });
        }
    }
    all.retain(|place| place.x >= lo && place.x <= hi);
    all.sort_by(|a, b| a.x.total_cmp(&b.x).then(b.is_breakpoint.cmp(&a.is_breakpoint)));
    all.dedup_by(|next, kept| next.x <= kept.x);
    all
}

fn side(at: f64, (lo, hi): (f64, f64)) -> f64 {
    (SIDE * (hi - lo)).max(SIDE_OF_PLACE * at.abs())
}

/// The outputs along one input, the others held.
pub(super) struct Scan<'a> {
    base: Vec<f64>,
    axis: usize,
    range: (f64, f64),
    places: &'a [Place],
    /// For each place all outputs.
    values: Vec<Vec<f64>>,
}

impl<'a> Scan<'a> {
    pub(super) fn new(
        probe: &mut Probe<'_>,
        base: &[f64],
        (axis, range): (usize, (f64, f64)),
        places: &'a [Place],
    ) -> Self {
        let mut scan = Self { base: base.to_vec(), axis, range, places, values: Vec::new() };
        scan.values = places.iter().map(|place| scan.lasting(probe, *place)).collect();
        scan
    }

    /// The outputs at a place; at the side of a breakpoint those that last.
    ///
    /// Where all rules fire faintly, their strengths may be mere rounding, as of `1 - mu` at the foot of a smooth `mu`. What the outputs
    /// are there is then no limit: this is taken from further away, along the straight line.
    fn lasting(&self, probe: &mut Probe<'_>, place: Place) -> Vec<f64> {
        let mut values = self.outputs(probe, place.x);
        if place.lasting.abs() <= 0.0 {
            return values;
        }
        let [near, far, farther] =
            [1.0, 2.0, 4.0].map(|steps| self.outputs(probe, place.at + steps * place.lasting));
        let further = near.iter().zip(&far).zip(&farther).zip(probe.widths());
        for (value, (((near, far), farther), width)) in values.iter_mut().zip(further) {
            let limit = 2.0 * near - far;
            let change = (near - far).abs() + (far - farther).abs();
            if (*value - limit).abs() > DEPARTURE * width + CHANGES * change {
                *value = limit;
            }
        }
        values
    }

    /// The inputs at a place along the line.
    pub(super) fn inputs(&self, x: f64) -> Vec<f64> {
        let mut inputs = self.base.clone();
        if let Some(slot) = inputs.get_mut(self.axis) {
            *slot = x;
        }
        inputs
    }

    fn outputs(&self, probe: &mut Probe<'_>, x: f64) -> Vec<f64> {
        probe.at(&self.inputs(x))
    }

    fn one(&self, probe: &mut Probe<'_>, output: usize, x: f64) -> f64 {
        self.outputs(probe, x).get(output).copied().unwrap_or(0.0)
    }

    /// The places and an output there.
    pub(super) fn curve(&self, output: usize) -> Vec<(Place, f64)> {
        let value = |values: &Vec<f64>| values.get(output).copied().unwrap_or(0.0);
        self.places.iter().copied().zip(self.values.iter().map(value)).collect()
    }

    /// The jumps of an output that are larger than a tolerance, in ascending order.
    pub(super) fn jumps(&self, probe: &mut Probe<'_>, output: usize, tolerance: f64) -> Vec<Jump> {
        let mut jumps: Vec<Jump> = Vec::new();
        // Where the step before ended.
        let mut reached = None;
        for pair in self.curve(output).windows(2) {
            let &[from, to] = pair else { continue };
            let Some((left, right)) = self.step(probe, output, tolerance, (from, to)) else { continue };
            // Up to a breakpoint and on from it: one jump.
            let continues = reached == Some(left.0.x);
            reached = Some(right.0.x);
            match jumps.last_mut().filter(|_| continues) {
                Some(jump) => {
                    jump.value = left.1;
                    jump.right = right.1;
                    jump.inputs = self.inputs(left.0.at);
                }
                None => {
                    let value = if right.0.is_breakpoint { right.1 } else { left.1 };
                    let at = if right.0.is_breakpoint { right.0.at } else { left.0.at };
                    jumps.push(Jump { inputs: self.inputs(at), left: left.1, value, right: right.1 });
                }
            }
        }
        jumps
    }

    /// The two sides of a jump between two places, if there is one.
    fn step(
        &self,
        probe: &mut Probe<'_>,
        output: usize,
        tolerance: f64,
        (mut from, mut to): ((Place, f64), (Place, f64)),
    ) -> Option<((Place, f64), (Place, f64))> {
        for _ in 0..HALVINGS {
            if (to.1 - from.1).abs() <= tolerance {
                return None;
            }
            let middle = 0.5 * from.0.x + 0.5 * to.0.x;
            if to.0.x - from.0.x <= 1.5 * side(middle, self.range) {
                break;
            }
            let middle = (
                Place { x: middle, at: middle, is_breakpoint: false, lasting: 0.0 },
                self.one(probe, output, middle),
            );
            if (middle.1 - from.1).abs() >= (to.1 - middle.1).abs() { to = middle } else { from = middle }
        }
        Some((from, to))
    }

    /// The stretches along which an output rises or falls by more than a tolerance, in ascending order.
    pub(super) fn runs(
        &self,
        probe: &mut Probe<'_>,
        output: usize,
        (tolerance, width): (f64, f64),
    ) -> Vec<Run> {
        let curve = self.curve(output);
        let values: Vec<f64> = curve.iter().map(|(_, value)| *value).collect();
        let turns = turns(&values, tolerance, LEVEL * width);
        let ends: Vec<(f64, f64, f64)> = (0..turns.len())
            .filter_map(|number| {
                let turn = turns.get(number)?;
                let place = curve.get(turn.first)?.0;
                let level = values.get(turn.first..=turn.last)?.iter().copied();
                let value = level.reduce(if turn.is_high { f64::max } else { f64::min })?;
                let is_inner = number > 0 && number.saturating_add(1) < turns.len();
                if turn.first != turn.last
                    || !is_inner
                    || place.is_breakpoint
                    || place.x < place.at
                    || place.x > place.at
                {
                    return Some((place.at, curve.get(turn.last)?.0.at, value));
                }
                let before = curve.get(turn.first.checked_sub(1)?)?.0.x;
                let after = curve.get(turn.first.checked_add(1)?)?.0.x;
                let (x, value) =
                    self.extreme(probe, output, turn.is_high, ((before, after), (place.x, value)));
                Some((x, x, value))
            })
            .collect();
        ends.windows(2)
            .filter_map(|pair| match pair {
                [(_, from, from_value), (to, _, to_value)] => {
                    Some(Run { from: *from, to: *to, from_value: *from_value, to_value: *to_value })
                }
                _ => None,
            })
            .collect()
    }

    /// The turning point between two places, by golden section; never worse than the `known` one.
    fn extreme(
        &self,
        probe: &mut Probe<'_>,
        output: usize,
        is_high: bool,
        ((mut from, mut to), mut known): ((f64, f64), (f64, f64)),
    ) -> (f64, f64) {
        const RATIO: f64 = 0.618_033_988_749_894_9;
        let better = |a: f64, b: f64| if is_high { a > b } else { a < b };
        let mut evaluate = |x: f64| self.one(probe, output, x);
        let mut left = to - RATIO * (to - from);
        let mut right = from + RATIO * (to - from);
        let (mut at_left, mut at_right) = (evaluate(left), evaluate(right));
        for _ in 0..GOLDEN_STEPS {
            if better(at_left, at_right) {
                to = right;
                (right, at_right) = (left, at_left);
                left = to - RATIO * (to - from);
                at_left = evaluate(left);
            } else {
                from = left;
                (left, at_left) = (right, at_right);
                right = from + RATIO * (to - from);
                at_right = evaluate(right);
            }
        }
        for (x, value) in [(left, at_left), (right, at_right)] {
            if better(value, known.1) {
                known = (x, value);
            }
        }
        known
    }
}

/// Where values turn, or begin and end to change: the first and the last place at that value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Turn {
    first: usize,
    last: usize,
    is_high: bool,
}

/// Turning points, those by less than a tolerance left out; none where nothing changes by more.
fn turns(values: &[f64], tolerance: f64, level: f64) -> Vec<Turn> {
    let mut found = Vec::new();
    let Some(&first) = values.first() else { return found };
    let mut low = (Turn { first: 0, last: 0, is_high: false }, first);
    let mut high = (Turn { first: 0, last: 0, is_high: true }, first);
    let mut rises = None;
    for (at, &value) in values.iter().enumerate() {
        if rises != Some(false) {
            let excess = value - high.1;
            extend(&mut high, at, (excess, value), level);
        }
        if rises != Some(true) {
            let excess = low.1 - value;
            extend(&mut low, at, (excess, value), level);
        }
        if rises != Some(true) && value - low.1 > tolerance {
            found.push(low.0);
            high = (Turn { first: at, last: at, is_high: true }, value);
            rises = Some(true);
        } else if rises != Some(false) && high.1 - value > tolerance {
            found.push(high.0);
            low = (Turn { first: at, last: at, is_high: false }, value);
            rises = Some(false);
        }
    }
    match rises {
        Some(true) => found.push(high.0),
        Some(false) => found.push(low.0),
        None => {}
    }
    found
}

/// Takes a value into an extreme that it exceeds by `excess`, or reaches again.
fn extend(extreme: &mut (Turn, f64), at: usize, (excess, value): (f64, f64), level: f64) {
    if excess > level {
        extreme.0.first = at;
    }
    if excess > -level {
        extreme.0.last = at;
    }
    if excess > 0.0 {
        extreme.1 = value;
    }
}

#[cfg(test)]
mod tests {
    use super::{Turn, turns};

    /// Law: between two turning points values only rise or only fall, up to the tolerance. Reference: by hand.
    #[test]
    fn turns_by_hand() {
        let of = |values: &[f64]| turns(values, 0.1, 1e-9);
        let turn = |first, last, is_high| Turn { first, last, is_high };
        assert_eq!(of(&[1.0, 1.05, 1.0, 1.02]), [], "level up to the tolerance");
        assert_eq!(of(&[0.0, 1.0, 2.0]), [turn(0, 0, false), turn(2, 2, true)], "rises");
        assert_eq!(of(&[0.0, 0.0, 2.0, 2.0]), [turn(0, 1, false), turn(2, 3, true)], "level at the ends");
        assert_eq!(
            of(&[2.0, 1.0, 1.0, 1.05, 1.0, 3.0]),
            [turn(0, 0, true), turn(1, 4, false), turn(5, 5, true)],
            "falls, waits, rises"
        );
        assert_eq!(of(&[]), [], "nothing");
    }
}
