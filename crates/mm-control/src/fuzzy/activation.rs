//! The shaped output terms of one output: what the aggregation joins.

use super::MembershipFunction;
use super::tables::{Aggregation, Implication, MamdaniTables, Operators, Rule, Variable};
use mm_model::Real;

/// A term, or its complement, that fired with a strength above zero.
#[derive(Debug, Clone, Copy)]
pub(super) struct Activation<'a, T> {
    pub(super) term: &'a MembershipFunction<T>,
    pub(super) complement: bool,
    pub(super) strength: T,
}

/// Everything that fired for one output.
///
/// With the maximum as aggregation the rules of a term merge to their strongest, and there is a strength a term; otherwise,
/// or where a rule concludes a complement, there is one a rule.
#[derive(Debug, Clone, Copy)]
pub(super) struct OutputSet<'a, T> {
    pub(super) variable: &'a Variable<'a, T>,
    pub(super) operators: Operators,
    rules: &'a [Rule<'a, T>],
    output: usize,
    merged: bool,
    pub(super) strengths: &'a [T],
}

impl<'a, T: Real> OutputSet<'a, T> {
    /// Whether the rules of a term may be merged to their strongest.
    pub(super) fn merges(rules: &[Rule<'_, T>], operators: Operators) -> bool {
        let complement = |rule: &Rule<'_, T>| rule.outputs.iter().any(|&index| index < 0);
        operators.aggregation == Aggregation::Max && !rules.iter().any(complement)
    }

    pub(super) const fn new(
        variable: &'a Variable<'a, T>,
        tables: &MamdaniTables<'a, T>,
        output: usize,
        strengths: (&'a [T], bool),
    ) -> Self {
        let (strengths, merged) = strengths;
        Self { variable, operators: tables.operators, rules: tables.rules, output, merged, strengths }
    }

    /// Whether there is one strength a term, in the order of the terms.
    pub(super) const fn is_merged(&self) -> bool {
        self.merged
    }

    /// The terms that fired.
    pub(super) fn activations(&self) -> impl Iterator<Item = Activation<'a, T>> + Clone + use<'a, T> {
        let Self { variable, rules, output, merged, .. } = *self;
        // Beyond the terms or rules of this output the strengths are zero.
        let named = move |(position, &strength): (usize, &T)| {
            if !(strength > T::ZERO) {
                return None;
            }
            if merged {
                let term = variable.terms.get(position)?;
                return Some(Activation { term, complement: false, strength });
            }
            let index = *rules.get(position)?.outputs.get(output)?;
            let term = variable.terms.get(usize::from(index.unsigned_abs()).checked_sub(1)?)?;
            Some(Activation { term, complement: index < 0, strength })
        };
        self.strengths.iter().enumerate().filter_map(named)
    }

    /// Degree of `y` in the aggregated set.
    pub(super) fn degree(&self, y: T) -> T {
        self.activations().fold(T::ZERO, |m, activation| {
            let own = activation.term.degree(y);
            let own = if activation.complement { T::ONE - own } else { own };
            let shaped = match self.operators.implication {
                Implication::Min => own.min(activation.strength),
                Implication::Prod => own * activation.strength,
            };
            match self.operators.aggregation {
                Aggregation::Max => m.max(shaped),
                Aggregation::Sum => m + shaped,
                Aggregation::Probor => m + shaped - m * shaped,
            }
        })
    }
}
