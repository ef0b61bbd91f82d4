//! What a rule engine is made of: variables, rules and operators, borrowed from wherever they are stored.

use super::{FuzzyError, MembershipFunction};
use mm_model::Real;

/// An input, or an output of a Mamdani system: its range and its terms.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable<'a, T> {
    /// Lower and upper end. An input outside is taken at the nearer end; an output is defuzzified over it.
    pub range: (T, T),
    /// The linguistic terms; rules count them from 1.
    pub terms: &'a [MembershipFunction<T>],
}

/// An output of a Sugeno system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SugenoVariable<'a, T> {
    /// Lower and upper end; only its middle matters, the weighted average where no rule fires.
    pub range: (T, T),
    /// The consequents; rules count them from 1.
    pub terms: &'a [Consequent<'a, T>],
}

/// What a Sugeno rule concludes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Consequent<'a, T> {
    /// A number.
    Constant(T),
    /// One factor for each input, then a constant: `k_1 x_1 + ... + k_n x_n + k_0`.
    Linear(&'a [T]),
}

/// One rule: IF the inputs are these terms THEN the outputs are those, as a line `1 -2 0, 3 (0.5) : 1` of a `.fis` file.
///
/// Each list has one number a variable: the term counted from 1, negative for NOT, 0 where the variable plays no part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule<'a, T> {
    /// A term for each input; 0 is "don't care", a negative number negates.
    pub inputs: &'a [i16],
    /// A term for each output; 0 leaves the output alone, a negative number concludes the complement.
    pub outputs: &'a [i16],
    /// Factor on the firing strength, in [0, 1].
    pub weight: T,
    /// How the inputs are joined.
    pub connective: Connective,
}

/// How a rule joins its inputs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Connective {
    /// All of them: a rule without any input term fires fully.
    #[default]
    And,
    /// Any of them: a rule without any input term never fires.
    Or,
}

/// Degree of "a and b".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum And {
    /// The smaller degree.
    #[default]
    Min,
    /// The product.
    Prod,
}

/// Degree of "a or b".
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Or {
    /// The larger degree.
    #[default]
    Max,
    /// The probabilistic sum `a + b - a b`.
    Probor,
}

/// How the firing strength shapes the term that a rule concludes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Implication {
    /// Cuts it off at the strength.
    #[default]
    Min,
    /// Scales it by the strength.
    Prod,
}

/// How the shaped terms of all rules are joined to one output set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Aggregation {
    /// The largest degree.
    #[default]
    Max,
    /// The sum of the degrees, which may exceed 1.
    Sum,
    /// The probabilistic sum.
    Probor,
}

/// The operators of a system; the default is min, max, min, max.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Operators {
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// Implication; a Sugeno system has none.
    pub implication: Implication,
    /// Aggregation; a Sugeno system has none.
    pub aggregation: Aggregation,
}

/// How the output set becomes a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Defuzzifier {
    /// Centroid of the set, exactly: every output term has to be piecewise linear, the aggregation not `Probor`.
    #[default]
    Centroid,
    /// Centroid of samples: `sum(y m) / sum(m)`.
    SampledCentroid(Sampling),
    /// The first sample at which the running sum of the degrees reaches half of the whole.
    Bisector(Sampling),
    /// Mean of the samples of largest degree.
    MeanOfMaximum(Sampling),
    /// The sample of largest degree that is smallest in magnitude; of two, the lower.
    SmallestOfMaximum(Sampling),
    /// The sample of largest degree that is largest in magnitude; of two, the lower.
    LargestOfMaximum(Sampling),
}

/// Where an output set is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sampling {
    /// This many points from end to end of the range, both included, as MATLAB does with 101.
    Ends(u32),
    /// The middles of this many equal parts of the range, as fuzzylite does.
    Midpoints(u32),
}

impl Default for Sampling {
    fn default() -> Self {
        Self::Ends(101)
    }
}

/// A Mamdani system: what its file says, without the names.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MamdaniTables<'a, T> {
    /// The inputs, at least one.
    pub inputs: &'a [Variable<'a, T>],
    /// The outputs, at least one.
    pub outputs: &'a [Variable<'a, T>],
    /// The rules, at least one.
    pub rules: &'a [Rule<'a, T>],
    /// The operators.
    pub operators: Operators,
    /// How the output set becomes a number.
    pub defuzzifier: Defuzzifier,
}

/// A Sugeno system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SugenoTables<'a, T> {
    /// The inputs, at least one.
    pub inputs: &'a [Variable<'a, T>],
    /// The outputs, at least one.
    pub outputs: &'a [SugenoVariable<'a, T>],
    /// The rules, at least one.
    pub rules: &'a [Rule<'a, T>],
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// How the consequents are joined.
    pub output: SugenoOutput,
}

/// How a Sugeno system joins the consequents of its rules.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SugenoOutput {
    /// `wtaver`: their average, weighted by the firing strengths.
    #[default]
    WeightedAverage,
    /// `wtsum`: their sum, weighted by the firing strengths.
    WeightedSum,
}

/// What an inference met on its way; the outputs are numbers within their ranges whatever this says (a Sugeno output: finite).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[must_use]
pub struct Inference {
    /// Some input was outside its range and was taken at the nearer end.
    pub clamped: bool,
    /// Some input was NaN: every output is the middle of its range.
    pub nan: bool,
    /// For some output no rule fired, or what fired has no area: it is the middle of its range (a weighted sum: 0).
    pub unfired: bool,
}

impl<T: Real> Variable<'_, T> {
    /// Checks range and terms; the names are those of the fields in errors.
    pub(super) fn check(&self, range: &'static str, terms: &'static str) -> Result<(), FuzzyError> {
        check_range(self.range, range)?;
        if self.terms.is_empty() {
            return Err(FuzzyError::Empty(terms));
        }
        self.terms.iter().try_for_each(|term| term.check(terms))
    }
}

/// Checks that a range is finite and has width.
pub(super) fn check_range<T: Real>((lo, hi): (T, T), name: &'static str) -> Result<(), FuzzyError> {
    if !(lo.is_finite() && hi.is_finite() && (hi - lo).is_finite()) {
        return Err(FuzzyError::NonFinite(name));
    }
    if lo >= hi { Err(FuzzyError::Inverted(name)) } else { Ok(()) }
}

/// Checks that a call brings as many inputs and outputs, each given first, as the system has.
#[inline]
pub(super) const fn check_lengths(inputs: (usize, usize), outputs: (usize, usize)) -> Result<(), FuzzyError> {
    if inputs.0 != inputs.1 {
        return Err(FuzzyError::Length("inputs"));
    }
    if outputs.0 != outputs.1 {
        return Err(FuzzyError::Length("outputs"));
    }
    Ok(())
}

/// Checks the rules of a system with the given numbers of terms for each input and each output.
pub(super) fn check_rules<T: Real>(
    rules: &[Rule<'_, T>],
    inputs: impl ExactSizeIterator<Item = usize> + Clone,
    outputs: impl ExactSizeIterator<Item = usize> + Clone,
) -> Result<(), FuzzyError> {
    if rules.is_empty() {
        return Err(FuzzyError::Empty("rules"));
    }
    for rule in rules {
        if !rule.weight.is_finite() {
            return Err(FuzzyError::NonFinite("rules.weight"));
        }
        if rule.weight < T::ZERO || rule.weight > T::ONE {
            return Err(FuzzyError::OutOfRange("rules.weight"));
        }
        check_indices(rule.inputs, inputs.clone(), "rules.inputs")?;
        check_indices(rule.outputs, outputs.clone(), "rules.outputs")?;
    }
    Ok(())
}

fn check_indices(
    indices: &[i16],
    terms: impl ExactSizeIterator<Item = usize>,
    name: &'static str,
) -> Result<(), FuzzyError> {
    if indices.len() != terms.len() {
        return Err(FuzzyError::Length(name));
    }
    let known = |(index, terms): (&i16, usize)| usize::from(index.unsigned_abs()) <= terms;
    if indices.iter().zip(terms).all(known) { Ok(()) } else { Err(FuzzyError::OutOfRange(name)) }
}
