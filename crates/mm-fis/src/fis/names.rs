//! The names of methods and shapes in a `.fis` file.

use mm_control::fuzzy::{Aggregation, And, Implication, MembershipFunction as Mf, Or};

use super::scan::Number;
use crate::read::{Piece, Report, nearest};
use crate::{Defuzzification, Kind};

/// A name, whether it is the one that a message lists, and what it means.
type Names<T> = [(&'static str, bool, T)];

pub(super) const KINDS: [(&str, bool, Kind); 4] = [
    ("mamdani", true, Kind::Mamdani),
    ("sugeno", true, Kind::Sugeno),
    ("takagi-sugeno", false, Kind::Sugeno),
    ("tsk", false, Kind::Sugeno),
];

pub(super) const ANDS: [(&str, bool, And); 3] =
    [("min", true, And::Min), ("prod", true, And::Prod), ("algebraic_product", false, And::Prod)];

pub(super) const ORS: [(&str, bool, Or); 3] =
    [("max", true, Or::Max), ("probor", true, Or::Probor), ("algebraic_sum", false, Or::Probor)];

pub(super) const IMPLICATIONS: [(&str, bool, Implication); 3] = [
    ("min", true, Implication::Min),
    ("prod", true, Implication::Prod),
    ("algebraic_product", false, Implication::Prod),
];

/// Scaling an output set to a height of 1, which is what a normalized sum does, moves no defuzzified value.
pub(super) const AGGREGATIONS: [(&str, bool, Aggregation); 5] = [
    ("max", true, Aggregation::Max),
    ("sum", true, Aggregation::Sum),
    ("probor", true, Aggregation::Probor),
    ("algebraic_sum", false, Aggregation::Probor),
    ("normalized_sum", false, Aggregation::Sum),
];

pub(super) const MAMDANI_DEFUZZIFICATIONS: [(&str, bool, Defuzzification); 5] = [
    ("centroid", true, Defuzzification::Centroid),
    ("bisector", true, Defuzzification::Bisector),
    ("mom", true, Defuzzification::MeanOfMaximum),
    ("som", true, Defuzzification::SmallestOfMaximum),
    ("lom", true, Defuzzification::LargestOfMaximum),
];

pub(super) const SUGENO_DEFUZZIFICATIONS: [(&str, bool, Defuzzification); 2] =
    [("wtaver", true, Defuzzification::WeightedAverage), ("wtsum", true, Defuzzification::WeightedSum)];

/// Looks a name up, case ignored; an unknown one is reported with those that are known.
pub(super) fn look_up<T: Copy>(
    (text, place): (&str, Piece<'_>),
    what: &str,
    names: &Names<T>,
    report: &mut Report,
) -> Option<T> {
    let found = names.iter().find(|(name, ..)| name.eq_ignore_ascii_case(text.trim()));
    if found.is_none() {
        let listed: Vec<&str> =
            names.iter().filter(|(_, listed, _)| *listed).map(|(name, ..)| *name).collect();
        report.add_unknown(place, &format!("unknown {what}"), &listed);
    }
    found.map(|(.., meaning)| *meaning)
}

/// A shape of membership function.
pub(crate) struct Form {
    pub(crate) name: &'static str,
    /// Its parameters, as a message names them.
    parameters: &'static [&'static str],
    /// Whether they have to ascend.
    ascending: bool,
    /// Those that must not be 0.
    widths: &'static [usize],
    make: fn(&[f64]) -> Option<Mf<f64>>,
}

/// A form whose parameters are those of the shape, in their order.
macro_rules! form {
    ($name:literal, $parameters:expr, $ascending:expr, $widths:expr, $shape:path) => {
        Form {
            name: $name,
            parameters: &$parameters,
            ascending: $ascending,
            widths: &$widths,
            make: |numbers| numbers.try_into().ok().map($shape),
        }
    };
}

/// Every shape: first those of MATLAB, then two of fuzzylite that are the same as others.
pub(crate) const FORMS: [Form; 15] = [
    form!("trimf", ["a", "b", "c"], true, [], Mf::Triangle),
    form!("trapmf", ["a", "b", "c", "d"], true, [], Mf::Trapezoid),
    form!("linsmf", ["a", "b"], true, [], Mf::LinearS),
    form!("linzmf", ["a", "b"], true, [], Mf::LinearZ),
    form!("gaussmf", ["sigma", "c"], false, [0], Mf::Gaussian),
    form!("gauss2mf", ["sigma1", "c1", "sigma2", "c2"], false, [0, 2], Mf::Gaussian2),
    form!("gbellmf", ["a", "b", "c"], false, [0], Mf::Bell),
    form!("sigmf", ["a", "c"], false, [], Mf::Sigmoid),
    form!("dsigmf", ["a1", "c1", "a2", "c2"], false, [], Mf::SigmoidDifference),
    form!("psigmf", ["a1", "c1", "a2", "c2"], false, [], Mf::SigmoidProduct),
    form!("smf", ["a", "b"], false, [], Mf::S),
    form!("zmf", ["a", "b"], false, [], Mf::Z),
    form!("pimf", ["a", "b", "c", "d"], false, [], Mf::Pi),
    Form {
        name: "rampmf",
        parameters: &["start", "end"],
        ascending: false,
        widths: &[],
        make: |numbers| match *numbers {
            [start, end] if start < end => Some(Mf::LinearS([start, end])),
            [start, end] if start > end => Some(Mf::LinearZ([end, start])),
            _ => None,
        },
    },
    Form {
        name: "rectmf",
        parameters: &["a", "b"],
        ascending: true,
        widths: &[],
        make: |numbers| match *numbers {
            [a, b] => Some(Mf::Trapezoid([a, a, b, b])),
            _ => None,
        },
    },
];

/// Finds a shape by its name, case ignored, and reports an unknown one.
pub(super) fn form((text, place): (&str, Piece<'_>), report: &mut Report) -> Option<&'static Form> {
    let found = FORMS.iter().find(|form| form.name.eq_ignore_ascii_case(text.trim()));
    if found.is_none() {
        let known: Vec<&str> = FORMS.iter().map(|form| form.name).collect();
        let near =
            nearest(text, ["constant", "linear"]).filter(|near| near.eq_ignore_ascii_case(text.trim()));
        match near {
            Some(name) => report.add_expected(
                place,
                format!("`{name}` of a Sugeno output"),
                "a membership function such as `trimf`",
            ),
            None => report.add_unknown(place, "unknown membership function", &known),
        }
    }
    found
}

impl Form {
    /// Makes the shape of numbers; `list` is where they stand as a whole.
    pub(crate) fn make(
        &self,
        numbers: &[Number<'_>],
        list: Piece<'_>,
        report: &mut Report,
    ) -> Option<Mf<f64>> {
        let name = self.name;
        if numbers.len() != self.parameters.len() {
            let names = self.parameters.join(" ");
            let expected = format!("{}: `[{names}]`", count(self.parameters.len(), "number"));
            report.add_expected(list, format!("`{name}` with {}", count(numbers.len(), "number")), expected);
            return None;
        }
        if self.ascending {
            let fault = numbers.windows(2).zip(self.parameters.windows(2)).find_map(|(pair, names)| {
                let ([before, after], [left, right]) = (pair, names) else { return None };
                (before.value > after.value).then_some((after.place, left, right, before.value))
            });
            if let Some((place, left, right, before)) = fault {
                let message = format!("`{name}` falls from {before} to {}", place.text);
                report.add_expected(place, message, format!("{left} <= {right}"));
                return None;
            }
        }
        for (number, parameter) in
            self.widths.iter().filter_map(|&at| Some((numbers.get(at)?, self.parameters.get(at)?)))
        {
            if number.value.abs() <= 0.0 {
                report.add(number.place, format!("`{parameter}` of `{name}` is 0: the term has no width"));
                return None;
            }
        }
        let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
        let made = (self.make)(&values);
        if made.is_none() {
            report.add(list, format!("`{name}` starts where it ends"));
        }
        made
    }
}

/// `1 number`, `2 numbers`.
pub(crate) fn count(number: usize, what: &str) -> String {
    if number == 1 { format!("1 {what}") } else { format!("{number} {what}s") }
}
