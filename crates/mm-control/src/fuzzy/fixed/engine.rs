//! Mamdani inference with whole numbers only.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "plain operators state their bound; the dev profile checks them all"
)]

use super::firing::{Sample, fire};
use super::grade::{ONE, Q30};
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
    /// The terms of each input, each with the rules that need it.
    pub inputs: &'a [&'a [Trigger<'a>]],
    /// The rules that no single term sets off: joined by OR, or with negated premises alone.
    pub rest: &'a [Rule<'a>],
    /// What each output is made of: a row of slots.
    pub outputs: &'a [&'a [Slot]],
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// Whether the system is its own mirror image: evaluated on one side and negated on the other, 0 where all inputs are 0.
    pub odd: bool,
}

/// A term of an input, and the rules that fire only if it holds: "IF the input is this term AND ...".
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trigger<'a> {
    /// The term.
    pub term: Term,
    /// The rules, all joined by AND; one that needs several terms is listed under one of them.
    pub rules: &'a [Rule<'a>],
}

/// A rule: what it joins and which slots it fires.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rule<'a> {
    /// What it asks, besides the term it is listed under; nothing is always true under AND and never under OR.
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
    /// The input, counted from 0.
    pub input: u16,
    /// Its term, counted from 0.
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
/// centroid of the tables: 0.87 for Appendix C, 0.84 for the smooth rule base (`cargo test -p mm-control --test control fuzzy_fixed -- --nocapture`),
/// below 0.85 for random systems (`cargo test -p mm-fis --test fis compile_q15`); 0.5 of it is rounding.
///
/// Overflow: none. Each operation has a bound that is stated beside it and that [`try_new`](Self::try_new) checks for tables of any origin. No division but one of 32 by 16 bits for each output; no panic.
///
/// Cost: a comparison for each input term that does not hold, a multiplication for one that does, and only the rules listed under it are
/// looked at; five or six multiplications for each firing slot and overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Engine<'a> {
    tables: &'a Tables<'a>,
    slots: usize,
}

impl<'a> Engine<'a> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// [`FuzzyError::Empty`] without inputs, outputs, terms or slots; [`FuzzyError::OutOfRange`] for a premise or slot that does not exist, a
    /// weight above 2^30, a rule joined by OR under a term, or (`outputs.scale`) a row of slots whose area exceeds 2^29 for one,
    /// 2^33 for all on the scale chosen. That the slots of a row ascend is the compiler's matter: out of order they give another
    /// number, not an overflow.
    pub fn try_new(tables: &'a Tables<'a>) -> Result<Self, FuzzyError> {
        let Tables { inputs, rest, outputs, .. } = tables;
        for (empty, name) in [
            (inputs.is_empty(), "inputs"),
            (outputs.is_empty(), "outputs"),
            (inputs.iter().any(|terms| terms.is_empty()), "inputs.terms"),
            (outputs.iter().any(|slots| slots.is_empty()), "outputs.slots"),
        ] {
            if empty {
                return Err(FuzzyError::Empty(name));
            }
        }
        for row in *outputs {
            row.iter().try_for_each(Slot::check)?;
            let sum = row.iter().fold(0_u64, |sum, slot| sum.saturating_add(slot.area().into()));
            if sum > LARGEST_SUM {
                return Err(FuzzyError::OutOfRange("outputs.scale"));
            }
        }
        let slots = outputs.iter().fold(0_usize, |count, slots| count.saturating_add(slots.len()));
        let triggered = || inputs.iter().copied().flatten().flat_map(|trigger| trigger.rules);
        triggered().chain(*rest).try_for_each(|rule| rule.check(inputs, slots))?;
        if triggered().any(|rule| rule.connective == Connective::Or) {
            return Err(FuzzyError::OutOfRange("rules.connective"));
        }
        Ok(Self { tables, slots })
    }

    /// The tables the engine works on.
    #[must_use]
    pub const fn tables(&self) -> &'a Tables<'a> {
        self.tables
    }

    /// Number of words that the workspace of [`infer`](Self::infer) needs: one for each slot.
    #[must_use]
    pub const fn workspace_len(&self) -> usize {
        self.slots
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
        let strengths = workspace.get_mut(..self.slots).ok_or(FuzzyError::Length("workspace"))?;
        strengths.fill(0);
        self.infer_cleared(inputs, outputs, strengths)
    }

    /// The same with a workspace of zeros.
    #[inline]
    pub(super) fn infer_cleared(
        &self,
        inputs: &[i16],
        outputs: &mut [i16],
        strengths: &mut [u32],
    ) -> Result<(), FuzzyError> {
        let tables = self.tables;
        if inputs.len() != tables.inputs.len() {
            return Err(FuzzyError::Length("inputs"));
        }
        if outputs.len() != tables.outputs.len() {
            return Err(FuzzyError::Length("outputs"));
        }
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
        fire::<Q30>(tables, sample, 0, strengths);
        let mut rest = strengths;
        let mut first = 0_usize;
        for (output, &row) in outputs.iter_mut().zip(tables.outputs) {
            // The callers made the lengths fit.
            let Some((own, tail)) = rest.split_at_mut_checked(row.len()) else { break };
            rest = tail;
            let mut moments = moments(row, own);
            if moments.area < LEAST_AREA {
                moments = slow::moments(tables, sample, (row, first), own);
            }
            first = first.saturating_add(row.len());
            let steps = moments.centroid().unwrap_or(0);
            // At most 2^15 in magnitude.
            let steps = if turned { -steps } else { steps };
            *output = saturated(steps);
        }
        Ok(())
    }
}

impl Rule<'_> {
    fn check(&self, inputs: &[&[Trigger<'_>]], slots: usize) -> Result<(), FuzzyError> {
        if self.weight > ONE {
            return Err(FuzzyError::OutOfRange("rules.weight"));
        }
        let known = |premise: &Premise| {
            inputs
                .get(usize::from(premise.input))
                .is_some_and(|terms| usize::from(premise.term) < terms.len())
        };
        if !self.premises.iter().all(known) {
            return Err(FuzzyError::OutOfRange("rules.premises"));
        }
        let fits = self.slots.iter().all(|&slot| usize::from(slot) < slots);
        if fits { Ok(()) } else { Err(FuzzyError::OutOfRange("rules.slots")) }
    }
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
