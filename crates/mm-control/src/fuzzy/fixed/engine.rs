//! Mamdani inference with whole numbers only.

use super::Sample;
use super::grade::{ONE, either, product};
use super::slot::{Moments, Slot};
use super::slow;
use super::term::Term;
use crate::fuzzy::{And, Connective, FuzzyError, Or};

/// Least area, in a quarter of the scale's units, from which on the fast way is precise enough: 2^-4 of the largest term's.
const LEAST_AREA: u32 = 1 << 22;
/// Largest sum of the areas of an output's slots on their scale.
const LARGEST_SUM: u64 = 1 << 33;

/// A Mamdani system in fixed point, borrowed; the compiler of `mm-fis` makes it from a `.fis` file.
///
/// | part | unit |
/// |---|---|
/// | corners of input terms | 2^-15 of half the range, from its middle; may lie outside |
/// | corners of output terms | the same of the output's range, within it |
/// | weights | 2^-30 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tables<'a> {
    /// The terms of each input.
    pub inputs: &'a [&'a [Term]],
    /// What each output is made of: a row of slots.
    pub outputs: &'a [&'a [Slot]],
    /// The rules.
    pub rules: &'a [Rule<'a>],
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// Whether the system is its own mirror image: evaluated on one side and negated on the other, 0 where all inputs are 0.
    pub odd: bool,
}

/// A rule: which degrees it joins and which slots it fires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule<'a> {
    /// What it asks; nothing is always true under AND and never under OR.
    pub premises: &'a [Premise],
    /// The slots, counted from 0 through all outputs. A slot takes the strongest of the rules that fire it.
    pub slots: &'a [u16],
    /// Factor on the firing strength in units of 2^-30, at most 2^30.
    pub weight: u32,
    /// How the premises are joined.
    pub connective: Connective,
}

/// "The input is this term", or is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Premise {
    /// The term, counted from 0 through all inputs.
    pub term: u16,
    /// Whether it is negated.
    pub not: bool,
}

/// Mamdani inference in fixed point: 16-bit inputs and outputs, whole numbers throughout.
///
/// Equation: as [`Mamdani`](crate::fuzzy::Mamdani) with the exact centroid, over piecewise-linear terms, with implication and aggregation
/// by minimum and maximum over a row of output terms, or by sums. The area below a term cut off at w is
/// `w (A0 - A1 w)`, its moment a polynomial of third degree; where neighbours overlap, what is counted twice is taken away.
///
/// Convention: an input q means `middle + half q / 32768` in the range of the input, an output likewise; +1 comes out as 32767.
/// Where no rule fires, or what fires has no area, an output is 0, the middle of its range. An odd system is evaluated for
/// the sign of its first input that is not 0: the map is exactly odd, but for -32768, which is answered by 32767.
///
/// Precision: degrees and strengths are in Q30; an input at which the firing terms have less than a sixteenth of the largest term's area
/// is evaluated again with strengths on a common exponent, which keeps their ratio. The output is within 2 units of the exact
/// centroid of the tables (checked at all 65,536 inputs for every system of the tests; the largest seen is in `docs`).
///
/// Overflow: none. Each operation is a `wrapping_` or `saturating_` one under a bound that is stated beside it and that
/// [`try_new`](Self::try_new) checks. No division but one of 32 by 16 bits for each output; no panic.
///
/// Cost: about 8 instructions for each term and rule that does not fire, 25 for one that does, 20 to 40 for a firing output term or
/// overlap on a Cortex-M4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Engine<'a> {
    tables: &'a Tables<'a>,
    degrees: usize,
    slots: usize,
}

impl<'a> Engine<'a> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// [`FuzzyError::Empty`] without inputs, outputs, terms, slots or rules; [`FuzzyError::TooMany`] (`outputs`) for more than 65,535 slots;
    /// [`FuzzyError::OutOfRange`] for a premise or slot that does not exist, a weight above 2^30, or (`outputs.scale`)
    /// a row of slots whose area exceeds 2^29 for one, 2^33 for all on the scale chosen, or that is out of order.
    pub fn try_new(tables: &'a Tables<'a>) -> Result<Self, FuzzyError> {
        let Tables { inputs, outputs, rules, .. } = tables;
        for (empty, name) in [
            (inputs.is_empty(), "inputs"),
            (outputs.is_empty(), "outputs"),
            (rules.is_empty(), "rules"),
            (inputs.iter().any(|terms| terms.is_empty()), "inputs.terms"),
            (outputs.iter().any(|slots| slots.is_empty()), "outputs.slots"),
        ] {
            if empty {
                return Err(FuzzyError::Empty(name));
            }
        }
        let count = |lengths: &mut dyn Iterator<Item = usize>| lengths.fold(0_usize, usize::saturating_add);
        let degrees = count(&mut inputs.iter().map(|terms| terms.len()));
        let slots = count(&mut outputs.iter().map(|slots| slots.len()));
        for row in *outputs {
            row.iter().try_for_each(Slot::check)?;
            let sum = row.iter().fold(0_u64, |sum, slot| sum.saturating_add(slot.area().into()));
            if sum > LARGEST_SUM {
                return Err(FuzzyError::OutOfRange("outputs.scale"));
            }
        }
        for rule in *rules {
            if rule.weight > ONE {
                return Err(FuzzyError::OutOfRange("rules.weight"));
            }
            if !rule.premises.iter().all(|premise| usize::from(premise.term) < degrees) {
                return Err(FuzzyError::OutOfRange("rules.premises"));
            }
            if !rule.slots.iter().all(|&slot| usize::from(slot) < slots) {
                return Err(FuzzyError::OutOfRange("rules.slots"));
            }
        }
        Ok(Self { tables, degrees, slots })
    }

    /// The tables the engine works on.
    #[must_use]
    pub const fn tables(&self) -> &'a Tables<'a> {
        self.tables
    }

    /// Number of words that the workspace of [`infer`](Self::infer) needs: one for each input term and one for each slot.
    #[must_use]
    pub const fn workspace_len(&self) -> usize {
        self.degrees.saturating_add(self.slots)
    }

    /// Infers the outputs from the inputs.
    ///
    /// # Errors
    /// [`FuzzyError::Length`], naming `inputs`, `outputs` or `workspace`; the outputs are then as they were.
    #[inline]
    pub fn infer(
        &self,
        inputs: &[i16],
        outputs: &mut [i16],
        workspace: &mut [u32],
    ) -> Result<(), FuzzyError> {
        let tables = self.tables;
        if inputs.len() != tables.inputs.len() {
            return Err(FuzzyError::Length("inputs"));
        }
        if outputs.len() != tables.outputs.len() {
            return Err(FuzzyError::Length("outputs"));
        }
        let (degrees, rest) =
            workspace.split_at_mut_checked(self.degrees).ok_or(FuzzyError::Length("workspace"))?;
        let strengths = rest.get_mut(..self.slots).ok_or(FuzzyError::Length("workspace"))?;
        let mut turned = false;
        if tables.odd {
            match inputs.iter().find(|&&q| q != 0) {
                Some(&first) => turned = first < 0,
                None => {
                    outputs.fill(0);
                    return Ok(());
                }
            }
        }
        let sample = Sample { inputs, turned };
        fuzzify(tables.inputs, sample, degrees);
        fire(tables, degrees, strengths);
        let mut rest = strengths;
        let mut first_slot = 0_usize;
        for (output, &row) in outputs.iter_mut().zip(tables.outputs) {
            // The lengths were made to fit above.
            let Some((own, tail)) = rest.split_at_mut_checked(row.len()) else { break };
            rest = tail;
            let mut moments = moments(row, own);
            if moments.area < LEAST_AREA {
                moments = slow::moments(tables, sample, (row, first_slot), own);
            }
            first_slot = first_slot.saturating_add(row.len());
            let steps = moments.centroid().unwrap_or(0);
            // At most 2^15 in magnitude.
            let steps = if turned { steps.wrapping_neg() } else { steps };
            *output = saturated(steps);
        }
        Ok(())
    }
}

/// The degree of every term of every input.
#[inline]
fn fuzzify(inputs: &[&[Term]], sample: Sample<'_>, degrees: &mut [u32]) {
    let mut slots = degrees.iter_mut();
    for (terms, position) in inputs.iter().zip(sample.positions()) {
        for (term, degree) in terms.iter().zip(&mut slots) {
            *degree = term.degree(position);
        }
    }
}

/// The strength of every slot: that of the strongest rule that fires it.
#[inline]
fn fire(tables: &Tables<'_>, degrees: &[u32], strengths: &mut [u32]) {
    strengths.fill(0);
    for rule in tables.rules {
        let strength = strength(tables, rule, degrees);
        if strength == 0 {
            continue;
        }
        for &slot in rule.slots {
            if let Some(slot) = strengths.get_mut(usize::from(slot)) {
                *slot = strength.max(*slot);
            }
        }
    }
}

#[inline]
fn strength(tables: &Tables<'_>, rule: &Rule<'_>, degrees: &[u32]) -> u32 {
    let all = rule.connective == Connective::And;
    let mut joined = if all { ONE } else { 0 };
    for premise in rule.premises {
        let degree = degrees.get(usize::from(premise.term)).copied().unwrap_or(0);
        // Degrees are at most one.
        let degree = if premise.not { ONE.wrapping_sub(degree) } else { degree };
        if all {
            if degree == 0 {
                return 0;
            }
            joined = match tables.and {
                And::Min => joined.min(degree),
                And::Prod => product(joined, degree),
            };
        } else {
            joined = match tables.or {
                Or::Max => joined.max(degree),
                Or::Probor => either(joined, degree),
            };
        }
    }
    product(joined, rule.weight)
}

/// Area and moment of a row.
#[inline]
fn moments(row: &[Slot], strengths: &[u32]) -> Moments {
    let mut sum = Moments::default();
    let mut below = 0;
    for (slot, &strength) in row.iter().zip(strengths) {
        if strength != 0 {
            slot.add(&mut sum, strength, strength, 32);
            let top = strength.min(below).min(slot.crossing());
            if top != 0 {
                slot.subtract_shared(&mut sum, top, top, 32);
            }
        }
        below = strength;
    }
    sum
}

/// Nearest number of 16 bits.
#[expect(clippy::as_conversions, clippy::cast_possible_truncation, reason = "held to 16 bits just before")]
#[inline]
pub(super) fn saturated(steps: i32) -> i16 {
    steps.clamp(-32768, 32767) as i16
}
