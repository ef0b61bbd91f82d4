//! A system of one input and one output as a function of a number.

use super::firing::{clamped, strength_of_one};
use super::{FuzzyError, Inference, Mamdani, MamdaniTables, Variable};
use mm_model::Real;

/// A map from one number to one number that a control law can use: a rule engine or a table made from it.
pub trait FuzzySystem<T> {
    /// Output for the input `x`, which is taken at the nearest end of the range where it lies outside; never NaN, for a NaN
    /// what the system gives where no rule fires.
    #[must_use]
    fn evaluate(&self, x: T) -> T;
    /// Lower and upper end of the input range.
    #[must_use]
    fn input_range(&self) -> (T, T);
}

/// A [`Mamdani`] engine of one input and one output that brings its workspace: `WORK` numbers on the stack while it evaluates.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{Curve, FuzzySystem, THESIS};
///
/// let curve = Curve::<f64>::try_new(&THESIS)?;
/// assert_eq!(curve.evaluate(0.0), 0.0);
/// assert!((curve.evaluate(-1.4) - 1.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve<'a, T, const WORK: usize = 16> {
    engine: Mamdani<'a, T>,
    input: Variable<'a, T>,
    output: Variable<'a, T>,
}

impl<'a, T: Real, const WORK: usize> Curve<'a, T, WORK> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// As [`Mamdani::try_new`]; [`FuzzyError::Length`] (`inputs`, `outputs`) unless there is one each, and
    /// [`FuzzyError::TooMany`] (`workspace`) where `WORK` is too small.
    pub fn try_new(tables: &'a MamdaniTables<'a, T>) -> Result<Self, FuzzyError> {
        let engine = Mamdani::try_new(tables)?;
        let [input] = tables.inputs else { return Err(FuzzyError::Length("inputs")) };
        let [output] = tables.outputs else { return Err(FuzzyError::Length("outputs")) };
        if engine.workspace_len() > WORK {
            return Err(FuzzyError::TooMany("workspace"));
        }
        Ok(Self { engine, input: *input, output: *output })
    }

    /// The engine behind it.
    #[must_use]
    pub const fn engine(&self) -> &Mamdani<'a, T> {
        &self.engine
    }
}

impl<T: Real, const WORK: usize> FuzzySystem<T> for Curve<'_, T, WORK> {
    #[inline]
    fn evaluate(&self, x: T) -> T {
        let mut strengths = [T::ZERO; WORK];
        let inferred = clamped(x, self.input.range, &mut Inference::default()).and_then(|x| {
            let terms = self.input.terms;
            self.engine.output(0, &self.output, &mut strengths, |rule| strength_of_one(rule, terms, x))
        });
        let (lo, hi) = self.output.range;
        inferred.unwrap_or(T::HALF * lo + T::HALF * hi)
    }

    fn input_range(&self) -> (T, T) {
        self.input.range
    }
}
