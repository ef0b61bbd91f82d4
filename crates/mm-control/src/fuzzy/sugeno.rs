//! Sugeno inference over tables that stay where they are.

use super::FuzzyError;
use super::firing::{Antecedent, fuzzify};
use super::tables::{
    Consequent, Inference, SugenoOutput, SugenoTables, check_lengths, check_range, check_rules,
};
use mm_model::Real;

/// Takagi-Sugeno-Kang inference: rules conclude numbers or linear functions of the inputs.
///
/// Equation: rule r fires with `w_r` as for [`Mamdani`](super::Mamdani) and concludes `z_r`; the output is `sum(w_r z_r) / sum(w_r)`
/// (weighted average) or `sum(w_r z_r)` (weighted sum).
///
/// Convention: an input outside its range counts as the nearer end, also in a linear consequent. Where no rule fires the
/// weighted average is the middle of the output's range and the weighted sum is 0; for a NaN input, or where the numbers overflow, both
/// are the middle of the range. A negated consequent is refused: a number has no complement.
///
/// # Source
/// T. Takagi, M. Sugeno, Fuzzy identification of systems and its applications to modeling and control, IEEE Trans.
/// Systems, Man and Cybernetics 15 (1985) 116-132.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{
///     And, Connective, Consequent, MembershipFunction, Or, Rule, Sugeno, SugenoOutput, SugenoTables, SugenoVariable,
///     Variable,
/// };
///
/// let tables = SugenoTables {
///     inputs: &[Variable {
///         range: (-1.0, 1.0),
///         terms: &[MembershipFunction::LinearZ([-1.0, 1.0]), MembershipFunction::LinearS([-1.0, 1.0])],
///     }],
///     outputs: &[SugenoVariable {
///         range: (-1.0, 1.0),
///         terms: &[Consequent::Constant(2.0), Consequent::Linear(&[1.0, 3.0])],
///     }],
///     rules: &[
///         Rule { inputs: &[1], outputs: &[1], weight: 1.0, connective: Connective::And },
///         Rule { inputs: &[2], outputs: &[2], weight: 1.0, connective: Connective::And },
///     ],
///     and: And::Prod,
///     or: Or::Probor,
///     output: SugenoOutput::WeightedAverage,
/// };
/// let (mut y, mut workspace) = ([0.0], [0.0; 2]);
/// let _ = Sugeno::try_new(&tables)?.infer(&[0.5], &mut y, &mut workspace)?;
/// assert_eq!(y, [0.25 * 2.0 + 0.75 * 3.5]);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sugeno<'a, T> {
    tables: &'a SugenoTables<'a, T>,
    degrees: usize,
}

impl<'a, T: Real> Sugeno<'a, T> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// As [`Mamdani::try_new`](super::Mamdani::try_new); [`FuzzyError::Length`] (`outputs.terms`) for a linear consequent without one factor for
    /// each input and a constant.
    pub fn try_new(tables: &'a SugenoTables<'a, T>) -> Result<Self, FuzzyError> {
        let SugenoTables { inputs, outputs, rules, .. } = tables;
        if inputs.is_empty() {
            return Err(FuzzyError::Empty("inputs"));
        }
        if outputs.is_empty() {
            return Err(FuzzyError::Empty("outputs"));
        }
        inputs.iter().try_for_each(|input| input.check("inputs.range", "inputs.terms"))?;
        for output in *outputs {
            check_range(output.range, "outputs.range")?;
            if output.terms.is_empty() {
                return Err(FuzzyError::Empty("outputs.terms"));
            }
            for term in output.terms {
                let numbers = match term {
                    Consequent::Constant(value) => core::slice::from_ref(value),
                    Consequent::Linear(factors) if factors.len() == inputs.len().saturating_add(1) => factors,
                    Consequent::Linear(_) => return Err(FuzzyError::Length("outputs.terms")),
                };
                if !numbers.iter().all(|number| number.is_finite()) {
                    return Err(FuzzyError::NonFinite("outputs.terms"));
                }
            }
        }
        let counts = inputs.iter().map(|input| input.terms.len());
        check_rules(rules, counts, outputs.iter().map(|output| output.terms.len()))?;
        if rules.iter().any(|rule| rule.outputs.iter().any(|&index| index < 0)) {
            return Err(FuzzyError::OutOfRange("rules.outputs"));
        }
        let degrees = inputs.iter().map(|input| input.terms.len()).sum();
        Ok(Self { tables, degrees })
    }

    /// The tables the engine works on.
    #[must_use]
    pub const fn tables(&self) -> &'a SugenoTables<'a, T> {
        self.tables
    }

    /// Number of values that the workspace of [`infer`](Self::infer) needs.
    #[must_use]
    pub const fn workspace_len(&self) -> usize {
        self.degrees
    }

    /// Infers the outputs from the inputs.
    ///
    /// # Errors
    /// [`FuzzyError::Length`], naming `inputs`, `outputs` or `workspace`; the outputs are then as they were.
    pub fn infer(
        &self,
        inputs: &[T],
        outputs: &mut [T],
        workspace: &mut [T],
    ) -> Result<Inference, FuzzyError> {
        let tables = self.tables;
        check_lengths((inputs.len(), tables.inputs.len()), (outputs.len(), tables.outputs.len()))?;
        let degrees = workspace.get_mut(..self.degrees).ok_or(FuzzyError::Length("workspace"))?;
        let mut met = fuzzify(tables.inputs, inputs, degrees)?;
        for (position, (output, variable)) in outputs.iter_mut().zip(tables.outputs).enumerate() {
            let (lo, hi) = variable.range;
            let joined = if met.nan { None } else { self.output(position, inputs, degrees) };
            let fired = joined.filter(|&(weight, _)| weight > T::ZERO);
            met.unfired |= fired.is_none();
            let value = match tables.output {
                SugenoOutput::WeightedAverage => fired.map(|(weight, sum)| sum / weight),
                SugenoOutput::WeightedSum => joined.map(|(_, sum)| sum),
            };
            *output = value.filter(|value| value.is_finite()).unwrap_or(T::HALF * lo + T::HALF * hi);
        }
        Ok(met)
    }

    /// Sums of the firing strengths and of the consequents weighted by them, for one output.
    fn output(&self, position: usize, inputs: &[T], degrees: &[T]) -> Option<(T, T)> {
        let SugenoTables { inputs: variables, outputs, rules, and, or, .. } = *self.tables;
        let terms = outputs.get(position)?.terms;
        let antecedent = Antecedent { and, or };
        let (mut weight, mut sum) = (T::ZERO, T::ZERO);
        for rule in rules {
            let Some(term) = rule
                .outputs
                .get(position)
                .and_then(|&index| terms.get(usize::from(index.unsigned_abs()).checked_sub(1)?))
            else {
                continue;
            };
            let strength = antecedent.strength(rule, variables, degrees);
            if !(strength > T::ZERO) {
                continue;
            }
            let value = match term {
                Consequent::Constant(value) => *value,
                Consequent::Linear(factors) => {
                    let constant = factors.last().copied().unwrap_or(T::ZERO);
                    let product = |((factor, variable), x): ((&T, &super::Variable<'_, T>), &T)| {
                        let (lo, hi) = variable.range;
                        *factor * x.clamp_to(lo, hi)
                    };
                    factors
                        .iter()
                        .zip(variables)
                        .zip(inputs)
                        .map(product)
                        .fold(T::ZERO, |sum, part| sum + part)
                        + constant
                }
            };
            weight += strength;
            sum += strength * value;
        }
        Some((weight, sum))
    }
}
