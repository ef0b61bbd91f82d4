//! Mamdani inference over tables that stay where they are.

use super::activation::OutputSet;
use super::firing::{Antecedent, clamped, degree_count, fuzzify, strength_of_one};
use super::tables::{
    Aggregation, Defuzzifier, Inference, MamdaniTables, Rule, Sampling, Variable, check_lengths, check_rules,
};
use super::{FuzzyError, exact, sampled};
use mm_model::Real;

/// Mamdani inference: any number of inputs and outputs, over borrowed tables.
///
/// Equation: rule r fires with `w_r = weight_r * (mu_1(x_1) and mu_2(x_2) ...)`; output j is the centroid (or another
/// [`Defuzzifier`]) of `m(y) = agg_r imp(w_r, mu_rj(y))` over the range of the output.
///
/// The exact centroid integrates every straight piece of `m` in closed form, where `.fis` tools sample it: 101 points
/// move 0.8889, the output of Appendix C just below 0, to 0.8954.
///
/// Convention: every case has a defined result and none is NaN. An input outside its range counts as the nearer end;
/// where no rule fires, or what fires has no area, and for a NaN input, an output is the middle of its range;
/// [`Inference`] says which of it happened. With the exact centroid, a rule base that is its own mirror image gives an
/// odd map: exactly while at most two output terms fire at once, to rounding beyond that.
///
/// Cost: one degree a term, one pass over the rules and one over the firing output terms; the caller's workspace holds
/// [`workspace_len`](Self::workspace_len) numbers, nothing is allocated. `cargo xtask bench-instructions` counts it.
///
/// # Source
/// E. H. Mamdani, S. Assilian, An experiment in linguistic synthesis with a fuzzy logic controller,
/// Int. J. Man-Machine Studies 7 (1975) 1-13. Operators and shapes are those of `.fis` files, version 2.0.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{
///     Connective, Defuzzifier, Mamdani, MamdaniTables, MembershipFunction, Operators, Rule, Variable,
/// };
///
/// // A tip from service and food, both from 0 to 10; it lies in flash.
/// static TIP: MamdaniTables<'static, f32> = MamdaniTables {
///     inputs: &[
///         Variable {
///             range: (0.0, 10.0),
///             terms: &[MembershipFunction::Gaussian([1.5, 0.0]), MembershipFunction::Gaussian([1.5, 10.0])],
///         },
///         Variable { range: (0.0, 10.0), terms: &[MembershipFunction::Trapezoid([0.0, 0.0, 1.0, 3.0])] },
///     ],
///     outputs: &[Variable {
///         range: (0.0, 30.0),
///         terms: &[
///             MembershipFunction::Triangle([0.0, 5.0, 10.0]),
///             MembershipFunction::Triangle([20.0, 25.0, 30.0]),
///         ],
///     }],
///     rules: &[
///         Rule { inputs: &[1, 1], outputs: &[1], weight: 1.0, connective: Connective::Or },
///         Rule { inputs: &[2, -1], outputs: &[2], weight: 1.0, connective: Connective::And },
///     ],
///     operators: Operators {
///         and: mm_control::fuzzy::And::Min,
///         or: mm_control::fuzzy::Or::Max,
///         implication: mm_control::fuzzy::Implication::Min,
///         aggregation: mm_control::fuzzy::Aggregation::Max,
///     },
///     defuzzifier: Defuzzifier::Centroid,
/// };
/// let engine = Mamdani::try_new(&TIP)?;
/// let (mut tip, mut workspace) = ([0.0], [0.0; 8]);
/// let met = engine.infer(&[9.0, 8.0], &mut tip, &mut workspace)?;
/// assert!(!met.clamped && !met.unfired);
/// assert!((tip[0] - 25.0).abs() < 1e-4);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mamdani<'a, T> {
    tables: &'a MamdaniTables<'a, T>,
    degrees: usize,
    strengths: usize,
    /// Whether the rules of a term are merged to their strongest.
    merged: bool,
}

impl<'a, T: Real> Mamdani<'a, T> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// Naming the field of [`MamdaniTables`] or of its parts: [`FuzzyError::Empty`] without variables, terms or rules,
    /// [`FuzzyError::NonFinite`] numbers, [`FuzzyError::Inverted`] ranges or breakpoints, [`FuzzyError::Length`] for a rule
    /// with another number of variables, [`FuzzyError::OutOfRange`] for the index of a term that does not exist, a weight
    /// outside [0, 1], a width of 0, fewer than 2 samples, or an output range whose square no longer fits the numbers (exact centroid), and [`FuzzyError::Curved`] where the exact centroid is asked of a curved
    /// output term or of the probabilistic sum.
    pub fn try_new(tables: &'a MamdaniTables<'a, T>) -> Result<Self, FuzzyError> {
        let MamdaniTables { inputs, outputs, rules, operators, defuzzifier } = tables;
        if inputs.is_empty() {
            return Err(FuzzyError::Empty("inputs"));
        }
        if outputs.is_empty() {
            return Err(FuzzyError::Empty("outputs"));
        }
        inputs.iter().try_for_each(|input| input.check("inputs.range", "inputs.terms"))?;
        outputs.iter().try_for_each(|output| output.check("outputs.range", "outputs.terms"))?;
        let counts = |variables: &'a [Variable<'a, T>]| variables.iter().map(|variable| variable.terms.len());
        check_rules(rules, counts(inputs), counts(outputs))?;
        match defuzzifier {
            Defuzzifier::Centroid => {
                if operators.aggregation == Aggregation::Probor {
                    return Err(FuzzyError::Curved("operators.aggregation"));
                }
                let straight = |output: &Variable<'_, T>| {
                    let (lo, hi) = output.range;
                    output.terms.iter().all(|term| term.corners(lo, hi).is_some())
                };
                if !outputs.iter().all(straight) {
                    return Err(FuzzyError::Curved("outputs.terms"));
                }
                // Moments are of the order of the square of the range, and what is subtracted from them a rounding error of it, which is
                // that of one where numbers have a fixed point.
                let floating = T::EPSILON * T::EPSILON > T::ZERO;
                let rounding = if floating { T::EPSILON } else { T::ONE };
                let moderate = |output: &Variable<'_, T>| {
                    let (lo, hi) = output.range;
                    let square = (hi - lo) * (hi - lo);
                    (square * T::from_u32(16)).is_finite() && square * T::EPSILON * rounding > T::ZERO
                };
                if !outputs.iter().all(moderate) {
                    return Err(FuzzyError::OutOfRange("outputs.range"));
                }
            }
            Defuzzifier::SampledCentroid(sampling)
            | Defuzzifier::Bisector(sampling)
            | Defuzzifier::MeanOfMaximum(sampling)
            | Defuzzifier::SmallestOfMaximum(sampling)
            | Defuzzifier::LargestOfMaximum(sampling) => match sampling {
                Sampling::Ends(0 | 1) | Sampling::Midpoints(0) => {
                    return Err(FuzzyError::OutOfRange("defuzzifier.points"));
                }
                Sampling::Ends(_) | Sampling::Midpoints(_) => {}
            },
        }
        let merged = OutputSet::merges(rules, *operators);
        let terms = outputs.iter().map(|output| output.terms.len()).max().unwrap_or(0);
        let strengths = if merged { terms } else { rules.len() };
        Ok(Self { tables, degrees: degree_count(inputs), strengths, merged })
    }

    /// The tables the engine works on.
    #[must_use]
    pub const fn tables(&self) -> &'a MamdaniTables<'a, T> {
        self.tables
    }

    /// Number of values that the workspace of [`infer`](Self::infer) needs.
    #[must_use]
    pub const fn workspace_len(&self) -> usize {
        self.degrees.saturating_add(self.strengths)
    }

    /// Infers the outputs from the inputs.
    ///
    /// # Errors
    /// [`FuzzyError::Length`], naming `inputs`, `outputs` or `workspace`; the outputs are then as they were.
    #[inline]
    pub fn infer(
        &self,
        inputs: &[T],
        outputs: &mut [T],
        workspace: &mut [T],
    ) -> Result<Inference, FuzzyError> {
        let tables = self.tables;
        check_lengths((inputs.len(), tables.inputs.len()), (outputs.len(), tables.outputs.len()))?;
        let (degrees, strengths) = workspace
            .split_at_mut_checked(self.degrees)
            .filter(|(_, rest)| rest.len() >= self.strengths)
            .ok_or(FuzzyError::Length("workspace"))?;
        if let ([variable], [x]) = (tables.inputs, inputs) {
            let mut met = Inference::default();
            let x = clamped(*x, variable.range, &mut met);
            self.outputs(outputs, strengths, &mut met, |rule| match x {
                Some(x) => strength_of_one(rule, variable.terms, x),
                None => T::ZERO,
            });
            return Ok(met);
        }
        let mut met = fuzzify(tables.inputs, inputs, degrees)?;
        let antecedent = Antecedent { and: tables.operators.and, or: tables.operators.or };
        self.outputs(outputs, strengths, &mut met, |rule| antecedent.strength(rule, tables.inputs, degrees));
        Ok(met)
    }

    /// All outputs, from the firing strengths of the rules.
    #[inline]
    fn outputs(
        &self,
        outputs: &mut [T],
        strengths: &mut [T],
        met: &mut Inference,
        strength: impl Fn(&Rule<'_, T>) -> T,
    ) {
        for (position, (output, variable)) in outputs.iter_mut().zip(self.tables.outputs).enumerate() {
            strengths.fill(T::ZERO);
            let value = if met.nan { None } else { self.output(position, variable, strengths, &strength) };
            met.unfired |= value.is_none();
            let (lo, hi) = variable.range;
            *output = value.unwrap_or(T::HALF * lo + T::HALF * hi);
        }
    }

    /// One output, or `None` where nothing fires; `strengths` comes in as zeros.
    #[inline]
    pub(super) fn output(
        &self,
        position: usize,
        variable: &Variable<'_, T>,
        strengths: &mut [T],
        strength: impl Fn(&Rule<'_, T>) -> T,
    ) -> Option<T> {
        let tables = self.tables;
        for (number, rule) in tables.rules.iter().enumerate() {
            let strength = strength(rule);
            if !(strength > T::ZERO) {
                continue;
            }
            let term = rule.outputs.get(position).map_or(0, |index| usize::from(index.unsigned_abs()));
            // A rule that leaves this output alone has the term 0 and with it no slot.
            let slot = if self.merged || term == 0 { term.wrapping_sub(1) } else { number };
            if let Some(slot) = strengths.get_mut(slot) {
                *slot = slot.max(strength);
            }
        }
        let set = OutputSet::new(variable, tables, position, (strengths, self.merged));
        match tables.defuzzifier {
            Defuzzifier::Centroid => exact::centroid(&set),
            defuzzifier => sampled::defuzzify(&set, defuzzifier),
        }
    }
}
