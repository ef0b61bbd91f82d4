//! The words of FCL.

use mm_control::fuzzy::{Aggregation, And, Implication, Or};

use crate::read::Piece;

/// How an output is defuzzified.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    Gravity,
    Area,
    MeanOfMaximum,
    Leftmost,
    Rightmost,
    Singletons,
    SingletonSum,
}

/// How the conclusions of rules are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Accumulation {
    Max,
    /// Added; a normalized sum moves no defuzzified value either.
    Sum,
    Probor,
    /// `min(1, a + b)`, which only singletons that meet one rule each can do without.
    Bounded,
}

impl Accumulation {
    pub(super) const fn aggregation(self) -> Option<Aggregation> {
        match self {
            Self::Max => Some(Aggregation::Max),
            Self::Sum => Some(Aggregation::Sum),
            Self::Probor => Some(Aggregation::Probor),
            Self::Bounded => None,
        }
    }
}

pub(super) const METHODS: [(&str, bool, Method); 8] = [
    ("COG", true, Method::Gravity),
    ("COA", true, Method::Area),
    ("MM", true, Method::MeanOfMaximum),
    ("LM", true, Method::Leftmost),
    ("RM", true, Method::Rightmost),
    ("COGS", true, Method::Singletons),
    ("COGF", false, Method::Singletons),
    ("COGSS", false, Method::SingletonSum),
];

pub(super) const ANDS: [(&str, bool, And); 2] = [("MIN", true, And::Min), ("PROD", true, And::Prod)];

pub(super) const ORS: [(&str, bool, Or); 3] =
    [("MAX", true, Or::Max), ("ASUM", true, Or::Probor), ("PROBOR", false, Or::Probor)];

pub(super) const ACTIVATIONS: [(&str, bool, Implication); 2] =
    [("MIN", true, Implication::Min), ("PROD", true, Implication::Prod)];

pub(super) const ACCUMULATIONS: [(&str, bool, Accumulation); 6] = [
    ("MAX", true, Accumulation::Max),
    ("NSUM", true, Accumulation::Sum),
    ("SUM", false, Accumulation::Sum),
    ("PROBOR", true, Accumulation::Probor),
    ("ASUM", false, Accumulation::Probor),
    ("BSUM", true, Accumulation::Bounded),
];

/// A shape with its parameters in FCL's order.
pub(super) struct Form {
    pub(super) name: &'static str,
    pub(super) parameters: &'static str,
    /// The same shape of a `.fis` file.
    pub(super) same: &'static str,
    /// Where each of that one's parameters stands here.
    pub(super) order: &'static [usize],
}

macro_rules! form {
    ($name:literal, $parameters:literal, $same:literal, $order:expr) => {
        Form { name: $name, parameters: $parameters, same: $same, order: &$order }
    };
}

/// The shapes of jFuzzyLogic, then those of fuzzylite.
pub(super) const FORMS: [Form; 20] = [
    form!("TRIAN", "a b c", "trimf", [0, 1, 2]),
    form!("TRAPE", "a b c d", "trapmf", [0, 1, 2, 3]),
    form!("GAUSS", "mean sigma", "gaussmf", [1, 0]),
    form!("GAUSS2", "mean1 sigma1 mean2 sigma2", "gauss2mf", [1, 0, 3, 2]),
    form!("GBELL", "a b mean", "gbellmf", [0, 1, 2]),
    form!("SIGM", "gain centre", "sigmf", [0, 1]),
    form!("DSIGM", "gain1 centre1 gain2 centre2", "dsigmf", [0, 1, 2, 3]),
    form!("Triangle", "a b c", "trimf", [0, 1, 2]),
    form!("Trapezoid", "a b c d", "trapmf", [0, 1, 2, 3]),
    form!("Ramp", "start end", "rampmf", [0, 1]),
    form!("Rectangle", "start end", "rectmf", [0, 1]),
    form!("Gaussian", "mean sigma", "gaussmf", [1, 0]),
    form!("GaussianProduct", "mean1 sigma1 mean2 sigma2", "gauss2mf", [1, 0, 3, 2]),
    form!("Bell", "centre width slope", "gbellmf", [1, 2, 0]),
    form!("Sigmoid", "centre slope", "sigmf", [1, 0]),
    form!("SigmoidDifference", "left rising falling right", "dsigmf", [1, 0, 2, 3]),
    form!("SigmoidProduct", "left rising falling right", "psigmf", [1, 0, 2, 3]),
    form!("SShape", "start end", "smf", [0, 1]),
    form!("ZShape", "start end", "zmf", [0, 1]),
    form!("PiShape", "a b c d", "pimf", [0, 1, 2, 3]),
];

/// Where a name is among others: written the same, or else the only one that differs in case alone.
pub(super) fn find(names: &[Piece<'_>], name: Piece<'_>) -> Option<usize> {
    let same = names.iter().position(|other| other.text == name.text);
    same.or_else(|| {
        let mut alike =
            names.iter().enumerate().filter(|(_, other)| other.text.eq_ignore_ascii_case(name.text));
        let first = alike.next().map(|(index, _)| index);
        first.filter(|_| alike.next().is_none())
    })
}
