//! The inputs for which no rule fires.

use std::collections::HashMap;
use std::rc::Rc;

use mm_control::fuzzy::Connective;

use super::cells::{Cell, joined};
use crate::{Rule, System};

/// Rules looked at, over all cells, before the search gives up.
const BUDGET: usize = 2_000_000;

/// A box of inputs: an interval for each, from the first.
pub(super) type Region = Vec<Interval>;
type Interval = (f64, f64);

/// What is being searched.
struct Search<'a> {
    axes: &'a [Vec<Cell>],
    ranges: Vec<(f64, f64)>,
    rules: &'a [Rule],
    /// For each rule the last input that plays a part in it, counted from 1; 0 for none.
    last: Vec<usize>,
    known: HashMap<(usize, Vec<usize>), Rc<Vec<Region>>>,
    left: usize,
}

/// The boxes of inputs for which no rule concludes anything about an output; `None` where there are too many combinations to try.
///
/// Whether a rule fires depends only on which of its terms hold, and so only on the cells that the inputs are in.
pub(super) fn of_output(system: &System, axes: &[Vec<Cell>], output: usize) -> Option<Vec<Region>> {
    let concludes =
        |rule: &Rule| rule.weight > 0.0 && rule.outputs.get(output).is_some_and(|&index| index != 0);
    let last =
        |rule: &Rule| rule.inputs.iter().rposition(|&index| index != 0).map_or(0, |at| at.wrapping_add(1));
    let mut search = Search {
        axes,
        ranges: system.inputs.iter().map(|input| input.range).collect(),
        rules: &system.rules,
        last: system.rules.iter().map(last).collect(),
        known: HashMap::new(),
        left: BUDGET,
    };
    let alive: Vec<usize> = (0..system.rules.len())
        .filter(|&number| system.rules.get(number).is_some_and(concludes))
        .filter(|&number| !search.is_dead(number, 0))
        .collect();
    search.boxes(0, alive).map(|regions| regions.to_vec())
}

impl Search<'_> {
    /// Whether nothing of the inputs from `axis` on can make the rule fire; for a rule that has not fired yet.
    fn is_dead(&self, number: usize, axis: usize) -> bool {
        let is_or = self.rules.get(number).is_some_and(|rule| rule.connective == Connective::Or);
        is_or && self.last.get(number).is_some_and(|&last| last <= axis)
    }

    /// The boxes over the inputs from `axis` on, given the rules that may still fire.
    fn boxes(&mut self, axis: usize, alive: Vec<usize>) -> Option<Rc<Vec<Region>>> {
        let fires = |number: &usize| {
            let rule = self.rules.get(*number);
            rule.is_some_and(|rule| rule.connective == Connective::And)
                && self.last.get(*number).is_some_and(|&last| last <= axis)
        };
        if alive.iter().any(fires) {
            return Some(Rc::new(Vec::new()));
        }
        if alive.is_empty() {
            return Some(Rc::new(vec![self.ranges.get(axis..).unwrap_or_default().to_vec()]));
        }
        let key = (axis, alive);
        if let Some(known) = self.known.get(&key) {
            return Some(Rc::clone(known));
        }
        let axes = self.axes;
        let mut parts: Vec<(Interval, Rc<Vec<Region>>)> = Vec::new();
        for cell in axes.get(axis)? {
            self.left = self.left.checked_sub(key.1.len().wrapping_add(1))?;
            let rest = match self.survivors(axis, cell, &key.1) {
                Some(survivors) => self.boxes(axis.wrapping_add(1), survivors)?,
                None => Rc::new(Vec::new()),
            };
            match parts.last_mut() {
                Some((interval, before)) if *before == rest => interval.1 = cell.to,
                _ => parts.push(((cell.from, cell.to), rest)),
            }
        }
        let region = |interval: Interval, rest: &Region| [&[interval], rest.as_slice()].concat();
        let regions = parts
            .iter()
            .flat_map(|(interval, rest)| rest.iter().map(|rest| region(*interval, rest)))
            .collect::<Vec<_>>();
        let regions = Rc::new(regions);
        self.known.insert(key, Rc::clone(&regions));
        Some(regions)
    }

    /// The rules that may still fire when an input is in a cell; `None` where one fires already.
    fn survivors(&self, axis: usize, cell: &Cell, alive: &[usize]) -> Option<Vec<usize>> {
        let mut survivors = Vec::with_capacity(alive.len());
        for &number in alive {
            let Some(rule) = self.rules.get(number) else { continue };
            let index = rule.inputs.get(axis).copied().unwrap_or(0);
            let holds = index != 0 && cell.satisfies(index);
            match rule.connective {
                Connective::And if index == 0 || holds => survivors.push(number),
                Connective::Or if holds => return None,
                Connective::Or if !self.is_dead(number, axis.wrapping_add(1)) => survivors.push(number),
                _ => {}
            }
        }
        Some(survivors)
    }
}

/// Part of the inputs that the regions take, between 0 and 1.
pub(super) fn share(regions: &[Region], ranges: &[(f64, f64)]) -> f64 {
    let part = |region: &Region| {
        let parts = region.iter().zip(ranges).map(|((from, to), (lo, hi))| (to - from) / (hi - lo));
        parts.product::<f64>()
    };
    regions.iter().map(part).sum()
}

/// The intervals of a system of one input.
pub(super) fn intervals(regions: &[Region]) -> Vec<(f64, f64)> {
    joined(regions.iter().filter_map(|region| region.first().copied()))
}
