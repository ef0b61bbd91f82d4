//! How strongly each rule fires.

use super::tables::{And, Connective, Or, Rule, Variable};
use super::{FuzzyError, Inference};
use mm_model::Real;

/// Number of degrees that the inputs need: one for each of their terms.
pub(super) fn degree_count<T>(inputs: &[Variable<'_, T>]) -> usize {
    inputs.iter().map(|input| input.terms.len()).sum()
}

/// Writes the degree of every term of every input into `degrees`, in order, and says what it met.
///
/// # Errors
/// [`FuzzyError::Length`] (`inputs`) unless there is one number for each input.
#[inline]
pub(super) fn fuzzify<T: Real>(
    variables: &[Variable<'_, T>],
    inputs: &[T],
    degrees: &mut [T],
) -> Result<Inference, FuzzyError> {
    if inputs.len() != variables.len() {
        return Err(FuzzyError::Length("inputs"));
    }
    let mut met = Inference::default();
    let mut rest = degrees;
    for (variable, &x) in variables.iter().zip(inputs) {
        let (lo, hi) = variable.range;
        let x = if x > hi {
            met.clamped = true;
            hi
        } else if x >= lo {
            x
        } else if x < lo {
            met.clamped = true;
            lo
        } else {
            met.nan = true;
            return Ok(met);
        };
        let Some((own, tail)) = rest.split_at_mut_checked(variable.terms.len()) else {
            return Err(FuzzyError::Length("workspace"));
        };
        for (degree, term) in own.iter_mut().zip(variable.terms) {
            *degree = term.degree(x);
        }
        rest = tail;
    }
    Ok(met)
}

/// The operators of the inputs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Antecedent {
    pub(super) and: And,
    pub(super) or: Or,
}

impl Antecedent {
    /// Firing strength of a rule from the degrees of [`fuzzify`], in [0, 1].
    #[inline]
    pub(super) fn strength<T: Real>(
        self,
        rule: &Rule<'_, T>,
        variables: &[Variable<'_, T>],
        degrees: &[T],
    ) -> T {
        let mut rest = degrees;
        let mut joined: Option<T> = None;
        for (variable, &index) in variables.iter().zip(rule.inputs) {
            let Some((own, tail)) = rest.split_at_checked(variable.terms.len()) else { return T::ZERO };
            rest = tail;
            let Some(position) = usize::from(index.unsigned_abs()).checked_sub(1) else { continue };
            let Some(&degree) = own.get(position) else { return T::ZERO };
            let degree = if index < 0 { T::ONE - degree } else { degree };
            joined = Some(match joined {
                None => degree,
                Some(before) => self.join(rule.connective, before, degree),
            });
        }
        match joined {
            Some(joined) => rule.weight * joined,
            None if rule.connective == Connective::And => rule.weight,
            None => T::ZERO,
        }
    }

    fn join<T: Real>(self, connective: Connective, a: T, b: T) -> T {
        match (connective, self.and, self.or) {
            (Connective::And, And::Min, _) => a.min(b),
            (Connective::And, And::Prod, _) => a * b,
            (Connective::Or, _, Or::Max) => a.max(b),
            (Connective::Or, _, Or::Probor) => a + b - a * b,
        }
    }
}
