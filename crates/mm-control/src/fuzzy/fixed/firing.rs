//! How strongly each slot fires.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "plain operators state their bound; the dev profile checks them all"
)]

use super::engine::{Rule, Tables};
use super::grade::{Grade, ONE};
use crate::fuzzy::{And, Connective, Or};

/// The inputs of an inference.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample<'s> {
    pub(super) inputs: &'s [i16],
    /// Whether it is evaluated at the opposite point.
    pub(super) turned: bool,
}

impl Sample<'_> {
    /// The position of an input on its range, in -32768..=32768.
    #[inline]
    const fn position(self, input: i16) -> i32 {
        let position = widened(input);
        if self.turned { -position } else { position }
    }
}

#[expect(clippy::as_conversions, reason = "From is not const")]
#[inline]
const fn widened(q: i16) -> i32 {
    q as i32
}

/// Raises `strengths`, those of the slots from number `first` on, to that of the strongest rule for each.
#[inline]
pub(super) fn fire<G: Grade>(tables: &Tables<'_>, sample: Sample<'_>, first: usize, strengths: &mut [u32]) {
    for (terms, &input) in tables.inputs.iter().zip(sample.inputs) {
        let position = sample.position(input);
        for trigger in *terms {
            let degree = G::degree(&trigger.term, position, false);
            if degree == G::ZERO {
                continue;
            }
            for rule in trigger.rules {
                conclude(rule, strength(tables, rule, sample, degree), first, strengths);
            }
        }
    }
    for rule in tables.rest {
        let start = if rule.connective == Connective::And { G::ONE } else { G::ZERO };
        conclude(rule, strength(tables, rule, sample, start), first, strengths);
    }
}

#[inline]
fn conclude<G: Grade>(rule: &Rule<'_>, strength: G, first: usize, strengths: &mut [u32]) {
    match rule.slots {
        &[slot] => raise(strengths, first, slot, strength.word()),
        slots => raise_all(strengths, first, slots, strength.word()),
    }
}

#[inline(never)]
fn raise_all(strengths: &mut [u32], first: usize, slots: &[u16], word: u32) {
    for &slot in slots {
        raise(strengths, first, slot, word);
    }
}

#[inline]
fn raise(strengths: &mut [u32], first: usize, slot: u16, word: u32) {
    // Slots before `first` wrap to beyond every length.
    if let Some(own) = strengths.get_mut(usize::from(slot).wrapping_sub(first)) {
        *own = word.max(*own);
    }
}

#[inline]
fn strength<G: Grade>(tables: &Tables<'_>, rule: &Rule<'_>, sample: Sample<'_>, start: G) -> G {
    if rule.premises.is_empty() && rule.weight == ONE { start } else { joined(tables, rule, sample, start) }
}

/// The premises of a rule joined to `start`, weighted.
#[inline(never)]
fn joined<G: Grade>(tables: &Tables<'_>, rule: &Rule<'_>, sample: Sample<'_>, start: G) -> G {
    let mut joined = start;
    for premise in rule.premises {
        let number = usize::from(premise.input);
        let Some((terms, &input)) = tables.inputs.get(number).zip(sample.inputs.get(number)) else {
            continue;
        };
        let Some(trigger) = terms.get(usize::from(premise.term)) else { continue };
        let degree = G::degree(&trigger.term, sample.position(input), premise.not);
        joined = match (rule.connective, tables.and, tables.or) {
            (Connective::And, And::Min, _) => joined.min(degree),
            (Connective::And, And::Prod, _) => joined.product(degree),
            (Connective::Or, _, Or::Max) => joined.max(degree),
            (Connective::Or, _, Or::Probor) => joined.either(degree),
        };
    }
    joined.product(G::weight(rule.weight))
}
