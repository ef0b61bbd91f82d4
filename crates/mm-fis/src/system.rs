//! A fuzzy system as its file describes it, names included.

use mm_control::fuzzy::{Aggregation, And, Connective, Implication, MembershipFunction, Or};

/// A fuzzy system with its names; [`with_engine`](Self::with_engine) evaluates it.
#[derive(Debug, Clone, PartialEq)]
pub struct System {
    /// Name of the system.
    pub name: String,
    /// What its rules conclude.
    pub kind: Kind,
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// Implication; without effect in a Sugeno system.
    pub implication: Implication,
    /// Aggregation; without effect in a Sugeno system.
    pub aggregation: Aggregation,
    /// How the outputs become numbers.
    pub defuzzification: Defuzzification,
    /// The inputs.
    pub inputs: Vec<Variable>,
    /// The outputs.
    pub outputs: Vec<Variable>,
    /// The rules.
    pub rules: Vec<Rule>,
}

/// What the rules of a system conclude.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Fuzzy sets.
    Mamdani,
    /// Numbers or linear functions.
    Sugeno,
}

/// The defuzzification that a file names; how finely it is sampled is no matter of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Defuzzification {
    /// `centroid`
    Centroid,
    /// `bisector`
    Bisector,
    /// `mom`
    MeanOfMaximum,
    /// `som`
    SmallestOfMaximum,
    /// `lom`
    LargestOfMaximum,
    /// `wtaver`, of a Sugeno system
    WeightedAverage,
    /// `wtsum`, of a Sugeno system
    WeightedSum,
}

/// An input or an output.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name of the variable.
    pub name: String,
    /// Lower and upper end.
    pub range: (f64, f64),
    /// Its terms; rules count them from 1.
    pub terms: Vec<Term>,
}

/// A linguistic term with its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Term {
    /// Name of the term.
    pub name: String,
    /// What it is.
    pub shape: Shape,
}

/// A fuzzy set, or what a Sugeno rule concludes.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A fuzzy set.
    Set(MembershipFunction<f64>),
    /// `constant`, of a Sugeno output.
    Constant(f64),
    /// `linear`, of a Sugeno output: a factor for each input, then a constant.
    Linear(Vec<f64>),
}

/// One rule; see [`mm_control::fuzzy::Rule`] for the indices.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// A term for each input.
    pub inputs: Vec<i16>,
    /// A term for each output.
    pub outputs: Vec<i16>,
    /// Factor on the firing strength.
    pub weight: f64,
    /// How the inputs are joined.
    pub connective: Connective,
}
