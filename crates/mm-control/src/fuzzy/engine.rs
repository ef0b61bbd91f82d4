//! Mamdani inference with one input and one output over tables that stay where they are.

use super::centroid::{ClippedSet, centroid};
use super::{FuzzyError, MembershipFunction};
use mm_model::Real;

/// Largest number of output terms an engine takes; it bounds the stack that one evaluation needs.
pub const MAX_OUTPUT_TERMS: usize = 16;

/// A map from one number to one number that a control law can use: a rule engine or a table made from it.
pub trait FuzzySystem<T> {
    /// Output for the input `x`, which is taken at the nearest end of the range where it lies outside; 0 for NaN.
    #[must_use]
    fn evaluate(&self, x: T) -> T;
    /// Lower and upper end of the input range.
    #[must_use]
    fn input_range(&self) -> (T, T);
}

/// One rule: IF the input is term `input` THEN the output is term `output`, with a `weight` in [0, 1].
///
/// The indices count from zero (a `.fis` file counts from one).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule<T> {
    /// Index of the input term.
    pub input: usize,
    /// Index of the output term.
    pub output: usize,
    /// Factor on the firing strength, in [0, 1].
    pub weight: T,
}

/// What a rule engine is made of, borrowed; [`Mamdani::try_new`] checks it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MamdaniTables<'a, T> {
    /// Ends of the input range; an input outside is taken at the nearer end.
    pub input_range: (T, T),
    /// Terms of the input.
    pub input_terms: &'a [MembershipFunction<T>],
    /// Ends of the output range, over which the centroid is taken.
    pub output_range: (T, T),
    /// Terms of the output, at most [`MAX_OUTPUT_TERMS`].
    pub output_terms: &'a [MembershipFunction<T>],
    /// The rules, at least one.
    pub rules: &'a [Rule<T>],
}

/// The same with its arrays inside: `I` input terms, `O` output terms, `R` rules, for constants in flash.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RuleBase<T, const I: usize, const O: usize, const R: usize> {
    /// Ends of the input range.
    pub input_range: (T, T),
    /// Terms of the input.
    pub input_terms: [MembershipFunction<T>; I],
    /// Ends of the output range.
    pub output_range: (T, T),
    /// Terms of the output.
    pub output_terms: [MembershipFunction<T>; O],
    /// The rules.
    pub rules: [Rule<T>; R],
}

impl<T: Real, const I: usize, const O: usize, const R: usize> RuleBase<T, I, O, R> {
    /// Borrows the arrays.
    #[must_use]
    pub fn tables(&self) -> MamdaniTables<'_, T> {
        MamdaniTables {
            input_range: self.input_range,
            input_terms: &self.input_terms,
            output_range: self.output_range,
            output_terms: &self.output_terms,
            rules: &self.rules,
        }
    }

    /// Checks the arrays and makes an engine over them.
    ///
    /// # Errors
    /// As [`Mamdani::try_new`].
    pub fn engine(&self) -> Result<Mamdani<'_, T>, FuzzyError> {
        Mamdani::try_new(self.tables())
    }

    /// The same rule base in another precision, each number rounded to the nearest of it.
    #[must_use]
    pub fn cast<U: Real>(&self) -> RuleBase<U, I, O, R> {
        let to = |x: T| U::from_f64(x.to_f64());
        RuleBase {
            input_range: (to(self.input_range.0), to(self.input_range.1)),
            input_terms: self.input_terms.map(|term| term.cast()),
            output_range: (to(self.output_range.0), to(self.output_range.1)),
            output_terms: self.output_terms.map(|term| term.cast()),
            rules: self.rules.map(|Rule { input, output, weight }| Rule {
                input,
                output,
                weight: to(weight),
            }),
        }
    }
}

/// Mamdani inference of one output from one input: min implication, max aggregation, exact centroid.
///
/// Equation: `w_j = max over the rules of term j of weight mu_in(x)`, then
/// `y = int y m(y) dy / int m(y) dy` with `m(y) = max_j min(w_j, mu_j(y))` over the output range.
/// The integrals are exact: `m` is piecewise linear and every piece is integrated in closed form, where `.fis`
/// tools sample it: 101 points move 0.8889, the output of Appendix C just below 0, to 0.8954.
///
/// Convention: where no rule fires, or what fires has no area, the output is the middle of its range. An input
/// outside the range counts as the nearest end. A rule base that is its own mirror image gives an exactly odd
/// map, and exactly 0 at 0.
///
/// Cost: at most `4 n + 1` breakpoints and `n - 1` crossings between neighbouring ones for `n` firing output
/// terms; no allocation, about 1 KiB of stack in `f64`. `cargo xtask bench-instructions` counts it.
///
/// # Source
/// E. H. Mamdani, S. Assilian, An experiment in linguistic synthesis with a fuzzy logic controller,
/// Int. J. Man-Machine Studies 7 (1975) 1-13. The operators are those of Appendix C of the thesis.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{FuzzySystem, THESIS};
///
/// let engine = THESIS.engine()?;
/// assert_eq!(engine.evaluate(0.0), 0.0);
/// assert!((engine.evaluate(-1.4) - 1.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Mamdani<'a, T> {
    tables: MamdaniTables<'a, T>,
    middle: T,
    half: T,
}

impl<'a, T: Real> Mamdani<'a, T> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// Naming the field of [`MamdaniTables`] (or `rules.input`, `rules.output`, `rules.weight`):
    /// [`FuzzyError::Empty`] without terms or rules, [`FuzzyError::TooMany`] output terms,
    /// [`FuzzyError::NonFinite`] numbers, [`FuzzyError::Inverted`] ranges or breakpoints, and
    /// [`FuzzyError::OutOfRange`] for the index of a term that does not exist or a weight outside [0, 1].
    pub fn try_new(tables: MamdaniTables<'a, T>) -> Result<Self, FuzzyError> {
        check_variable(tables.input_range, "input_range", tables.input_terms, "input_terms")?;
        check_variable(tables.output_range, "output_range", tables.output_terms, "output_terms")?;
        if tables.output_terms.len() > MAX_OUTPUT_TERMS {
            return Err(FuzzyError::TooMany("output_terms"));
        }
        if tables.rules.is_empty() {
            return Err(FuzzyError::Empty("rules"));
        }
        for rule in tables.rules {
            if rule.input >= tables.input_terms.len() {
                return Err(FuzzyError::OutOfRange("rules.input"));
            }
            if rule.output >= tables.output_terms.len() {
                return Err(FuzzyError::OutOfRange("rules.output"));
            }
            if !rule.weight.is_finite() {
                return Err(FuzzyError::NonFinite("rules.weight"));
            }
            if rule.weight < T::ZERO || rule.weight > T::ONE {
                return Err(FuzzyError::OutOfRange("rules.weight"));
            }
        }
        let (lo, hi) = tables.output_range;
        Ok(Self { tables, middle: T::HALF * lo + T::HALF * hi, half: T::HALF * hi - T::HALF * lo })
    }

    /// The tables the engine works on.
    #[must_use]
    pub const fn tables(&self) -> &MamdaniTables<'a, T> {
        &self.tables
    }

    /// Firing strength of each output term at `x`: the largest weighted degree among its rules, in [0, 1].
    fn firing(&self, x: T) -> [T; MAX_OUTPUT_TERMS] {
        let mut strengths = [T::ZERO; MAX_OUTPUT_TERMS];
        for rule in self.tables.rules {
            let Some(term) = self.tables.input_terms.get(rule.input) else { continue };
            let strength = rule.weight * term.degree(x);
            if let Some(largest) = strengths.get_mut(rule.output) {
                *largest = largest.max(strength);
            }
        }
        strengths
    }

    /// Centroid of the output terms cut off at their firing strengths; the middle of the range without any area.
    fn defuzzify(&self, strengths: &[T; MAX_OUTPUT_TERMS]) -> T {
        let mut sets = [ClippedSet::EMPTY; MAX_OUTPUT_TERMS];
        let mut firing = 0;
        let fired =
            self.tables.output_terms.iter().zip(strengths).filter(|(_, strength)| **strength > T::ZERO);
        for (slot, (term, strength)) in sets.iter_mut().zip(fired) {
            *slot = ClippedSet::new(term, *strength, self.middle);
            firing += 1;
        }
        let offset = sets.get_mut(..firing).and_then(|sets| centroid(sets, self.half));
        let (lo, hi) = self.tables.output_range;
        offset.map_or(self.middle, |offset| (self.middle + offset).clamp_to(lo, hi))
    }
}

impl<T: Real> FuzzySystem<T> for Mamdani<'_, T> {
    fn evaluate(&self, x: T) -> T {
        let (lo, hi) = self.tables.input_range;
        let x = x.clamp_to(lo, hi);
        if x >= lo { self.defuzzify(&self.firing(x)) } else { T::ZERO }
    }

    fn input_range(&self) -> (T, T) {
        self.tables.input_range
    }
}

/// Checks one variable: a range with width and at least one term, every number finite and in order.
fn check_variable<T: Real>(
    (lo, hi): (T, T),
    range: &'static str,
    terms: &[MembershipFunction<T>],
    name: &'static str,
) -> Result<(), FuzzyError> {
    if !(lo.is_finite() && hi.is_finite()) {
        return Err(FuzzyError::NonFinite(range));
    }
    if lo >= hi {
        return Err(FuzzyError::Inverted(range));
    }
    if terms.is_empty() {
        return Err(FuzzyError::Empty(name));
    }
    terms.iter().try_for_each(|term| term.check(name))
}
