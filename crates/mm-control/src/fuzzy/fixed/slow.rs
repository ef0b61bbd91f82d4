//! The same inference where all that fires is small: strengths keep their ratio on a common exponent.

use super::engine::{Rule, Tables};
use super::grade::{ONE, Small};
use super::slot::{Moments, Slot};
use super::term::Term;
use crate::fuzzy::{And, Connective, Or};

/// The inputs of an inference.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample<'s> {
    pub(super) inputs: &'s [i16],
    /// Whether it is evaluated at the opposite point.
    pub(super) turned: bool,
}

impl<'s> Sample<'s> {
    /// The positions on the ranges, in -32768..=32768.
    #[inline]
    pub(super) fn positions(self) -> impl Iterator<Item = i32> + use<'s> {
        let turned = self.turned;
        let position = move |&q: &i16| if turned { i32::from(q).wrapping_neg() } else { i32::from(q) };
        self.inputs.iter().map(position)
    }
}

/// Area and moment of a row, whose first slot has the number `first`; its `strengths` are overwritten.
///
/// Cost: everything is computed again from the inputs, about ten times that of the fast way; it is taken where less than a sixteenth of
/// the largest term's area fires, or nothing at all.
#[cold]
#[inline(never)]
pub(super) fn moments(
    tables: &Tables<'_>,
    sample: Sample<'_>,
    (row, first): (&[Slot], usize),
    strengths: &mut [u32],
) -> Moments {
    strengths.fill(0);
    for rule in tables.rules {
        for &slot in rule.slots {
            let own = usize::from(slot).checked_sub(first).and_then(|index| strengths.get_mut(index));
            if let Some(own) = own {
                *own = strength(tables, rule, sample).0.max(*own);
            }
        }
    }
    let firing = row.iter().zip(&*strengths).filter(|(slot, _)| slot.area() > 0);
    let top = firing.map(|(_, &strength)| Small(strength).exponent()).max().unwrap_or(0);
    let Totals { area, .. } = Totals::of(row, strengths, top, 0);
    // 30 bits of area, so that the sums fit as those of the fast way do.
    let shift = 34_u32.saturating_sub(area.leading_zeros());
    Totals::of(row, strengths, top, shift).moments
}

struct Totals {
    area: u64,
    moments: Moments,
}

impl Totals {
    fn of(row: &[Slot], strengths: &[u32], top: u32, shift: u32) -> Self {
        let mut total = Self { area: 0, moments: Moments::default() };
        let mut below = Small::ZERO;
        for (slot, &strength) in row.iter().zip(strengths) {
            let own = Small(strength);
            if !own.is_zero() {
                let (linear, height) = (own.relative_to(top), own.q30());
                // 2^30 times the sum of all areas, 2^33, at most.
                total.area = total.area.wrapping_add(slot.whole_area(linear, height));
                slot.add(&mut total.moments, linear, height, shift);
                let shared = own.min(below).min(Small::new(slot.crossing().into(), 30));
                if !shared.is_zero() {
                    let (linear, height) = (shared.relative_to(top), shared.q30());
                    slot.subtract_shared(&mut total.moments, linear, height, shift);
                }
            }
            below = own;
        }
        total
    }
}

fn strength(tables: &Tables<'_>, rule: &Rule<'_>, sample: Sample<'_>) -> Small {
    let all = rule.connective == Connective::And;
    let mut joined = if all { Small::ONE } else { Small::ZERO };
    for premise in rule.premises {
        let Some((term, position)) = found(tables.inputs, sample, usize::from(premise.term)) else {
            continue;
        };
        let degree = term.small_degree(position, premise.not);
        joined = match (all, tables.and, tables.or) {
            (true, And::Min, _) => joined.min(degree),
            (true, And::Prod, _) => joined.product(degree),
            (false, _, Or::Max) => joined.max(degree),
            (false, _, Or::Probor) => joined.either(degree),
        };
    }
    if rule.weight == ONE { joined } else { joined.product(Small::new(rule.weight.into(), 30)) }
}

/// A term by its number through all inputs, and where its input is.
fn found<'a>(inputs: &[&'a [Term]], sample: Sample<'_>, number: usize) -> Option<(&'a Term, i32)> {
    let mut number = number;
    for (terms, position) in inputs.iter().zip(sample.positions()) {
        match number.checked_sub(terms.len()) {
            None => return terms.get(number).map(|term| (term, position)),
            Some(rest) => number = rest,
        }
    }
    None
}
