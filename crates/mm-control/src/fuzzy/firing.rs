//! How strongly each rule fires.

use super::tables::{And, Connective, Or, Rule, Variable};
use super::{FuzzyError, Inference, MembershipFunction};
use mm_model::Real;

/// Number of degrees that the inputs need: one for each of their terms; none for a single input.
pub(super) fn degree_count<T>(inputs: &[Variable<'_, T>]) -> usize {
    if inputs.len() == 1 { 0 } else { inputs.iter().map(|input| input.terms.len()).sum() }
}

/// Takes a number at the nearer end of a range where it is outside; `None` for NaN.
#[inline]
pub(super) fn clamped<T: Real>(x: T, (lo, hi): (T, T), met: &mut Inference) -> Option<T> {
    if x > hi {
        met.clamped = true;
        Some(hi)
    } else if x >= lo {
        Some(x)
    } else if x < lo {
        met.clamped = true;
        Some(lo)
    } else {
        met.nan = true;
        None
    }
}

/// Firing strength of a rule of one input, straight from the term, in [0, 1].
#[inline]
pub(super) fn strength_of_one<T: Real>(rule: &Rule<'_, T>, terms: &[MembershipFunction<T>], x: T) -> T {
    let Some(&index) = rule.inputs.first() else { return T::ZERO };
    let term = usize::try_from(index).ok().and_then(|index| terms.get(index.wrapping_sub(1)));
    let degree = match term {
        Some(term) => term.degree(x),
        None => rare_degree(rule, index, terms, x),
    };
    rule.weight * degree
}

/// The same for what is neither a term nor missing: a term negated, or none at all.
#[inline(never)]
fn rare_degree<T: Real>(rule: &Rule<'_, T>, index: i16, terms: &[MembershipFunction<T>], x: T) -> T {
    match usize::from(index.unsigned_abs()).checked_sub(1).map(|position| terms.get(position)) {
        Some(Some(term)) => T::ONE - term.degree(x),
        None if rule.connective == Connective::And => T::ONE,
        _ => T::ZERO,
    }
}

/// Writes the degree of every term of every input into `degrees`, in order, and says what it met.
///
/// # Errors
/// [`FuzzyError::Length`] (`workspace`) where `degrees` is too short.
#[inline]
pub(super) fn fuzzify<T: Real>(
    variables: &[Variable<'_, T>],
    inputs: &[T],
    degrees: &mut [T],
) -> Result<Inference, FuzzyError> {
    let mut met = Inference::default();
    let mut rest = degrees;
    for (variable, &x) in variables.iter().zip(inputs) {
        let Some(x) = clamped(x, variable.range, &mut met) else { break };
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
