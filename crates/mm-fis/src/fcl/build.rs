//! From what an FCL text says to a system.

use std::collections::HashMap;

use mm_control::fuzzy::{Aggregation, And, Implication, Or};

use super::block::{Block, Operators};
use super::describe::Described;
use super::expand::Algebra;
use super::names::{Accumulation, Method};
use super::range;
use crate::coverage::unfired;
use crate::read::{Piece, Report};
use crate::{Defuzzification, Kind, Rule, Shape, System, Variable};

/// Rules that a system may have after brackets are taken apart.
const MAX_RULES: usize = 20_000;

/// Makes the system; what it does not do as the text says goes to `report` or, where it can be used, to `notes`.
pub(super) fn system(block: &Block<'_>, report: &mut Report, notes: &mut Report) -> Option<System> {
    let start = Piece::new("", 0);
    for (variables, what, section) in
        [(&block.inputs, "input", "FUZZIFY"), (&block.outputs, "output", "DEFUZZIFY")]
    {
        if variables.is_empty() {
            report.add(start, format!("no {what}s"));
        }
        for variable in variables {
            if !variable.described {
                report.add_expected(
                    variable.name,
                    format!("{} has no terms", variable.name.shown()),
                    format!("a {section} block"),
                );
            } else if variable.terms.is_empty() && !variable.broken {
                report.add(variable.name, format!("{} has no terms", variable.name.shown()));
            }
        }
    }
    if block.rules.is_empty() && report.is_empty() {
        report.add(start, "no rules");
    }
    if !report.is_empty() {
        return None;
    }
    let (kind, defuzzification) = defuzzification(&block.outputs, report, notes)?;
    let accumulation = accumulation(block, kind, report, notes)?;
    let (and, or) = operators(&block.operators, notes);
    let aggregation = match (kind, accumulation) {
        (Kind::Sugeno, _) => Aggregation::Sum,
        (Kind::Mamdani, Some((accumulation, place))) => {
            let aggregation = accumulation.aggregation();
            if aggregation.is_none() {
                report.add_expected(
                    place,
                    "ACCU : BSUM, which the engine does not have",
                    "`MAX`, `NSUM` or `PROBOR`",
                );
            }
            aggregation?
        }
        (Kind::Mamdani, None) => Aggregation::Max,
    };
    let algebra = Algebra { and, or, largest: kind == Kind::Mamdani && aggregation == Aggregation::Max };
    let rules = rules(block, algebra, report)?;
    if kind == Kind::Sugeno {
        shared_singletons(block, accumulation, report)?;
    }
    let inputs = variables(&block.inputs, range::of_input, report)?;
    let outputs =
        variables(&block.outputs, |variable, report| range::of_output(variable, kind, report), report)?;
    let implication = block.operators.activation.map_or(Implication::Min, |said| said.0);
    let name = block.name.clone();
    let system =
        System { name, kind, and, or, implication, aggregation, defuzzification, inputs, outputs, rules };
    self::outputs(block, &system, notes);
    Some(system)
}

/// The kind of system, and the one way that all outputs are defuzzified in.
fn defuzzification(
    outputs: &[Described<'_>],
    report: &mut Report,
    notes: &mut Report,
) -> Option<(Kind, Defuzzification)> {
    let mut all: Option<(Kind, Defuzzification)> = None;
    for output in outputs {
        let numbers = output.terms.iter().filter(|term| !matches!(term.term.shape, Shape::Set(_))).count();
        let (method, place) = output.method.unwrap_or_else(|| {
            let method = if numbers > 0 { Method::Singletons } else { Method::Gravity };
            let name = if numbers > 0 { "COGS" } else { "COG" };
            notes.add(output.name, format!("{} has no METHOD: {name} is taken", output.name.shown()));
            (method, output.name)
        });
        let singletons = matches!(method, Method::Singletons | Method::SingletonSum);
        let wrong = output.terms.iter().find(|term| matches!(term.term.shape, Shape::Set(_)) == singletons);
        if let Some(wrong) = wrong {
            let (message, expected) = if singletons {
                (
                    "a set, but its METHOD is that of singletons",
                    "a number, as in `TERM low := 5;`, or METHOD : COG",
                )
            } else {
                ("a singleton, but its METHOD is one of sets", "METHOD : COGS, or a set")
            };
            report.add_expected(wrong.place, message, expected);
            return None;
        }
        let kind = if singletons { Kind::Sugeno } else { Kind::Mamdani };
        let this = (kind, one_defuzzification(output, method, place, report)?);
        if all.is_some_and(|all| all != this) {
            report.add(place, "another METHOD than that of the outputs before: a system has one");
            return None;
        }
        all = Some(this);
    }
    all
}

fn one_defuzzification(
    output: &Described<'_>,
    method: Method,
    place: Piece<'_>,
    report: &mut Report,
) -> Option<Defuzzification> {
    let leftmost = match method {
        Method::Gravity => return Some(Defuzzification::Centroid),
        Method::Area => return Some(Defuzzification::Bisector),
        Method::MeanOfMaximum => return Some(Defuzzification::MeanOfMaximum),
        Method::Singletons => return Some(Defuzzification::WeightedAverage),
        Method::SingletonSum => return Some(Defuzzification::WeightedSum),
        Method::Leftmost => true,
        Method::Rightmost => false,
    };
    // The engine's maxima are the smallest and the largest in magnitude.
    let (low, high) = range::of_output(output, Kind::Mamdani, report)?;
    if low < 0.0 && high > 0.0 {
        let message = format!("METHOD : {} over a range with 0 inside", place.text);
        report.add_expected(place, message, "a range on one side of 0: the engine compares magnitudes");
        return None;
    }
    let smallest = leftmost == (low >= 0.0);
    Some(if smallest { Defuzzification::SmallestOfMaximum } else { Defuzzification::LargestOfMaximum })
}

/// The accumulation, which IEC 61131-7 puts into the rule block and fuzzylite into the outputs.
fn accumulation<'a>(
    block: &Block<'a>,
    kind: Kind,
    report: &mut Report,
    notes: &mut Report,
) -> Option<Option<(Accumulation, Piece<'a>)>> {
    let mut all = block.operators.accumulation;
    for said in block.outputs.iter().filter_map(|output| output.accumulation) {
        if all.is_some_and(|all| all.0 != said.0) {
            report.add(said.1, format!("ACCU : {}, but another elsewhere: a system has one", said.1.text));
            return None;
        }
        all = Some(said);
    }
    if all.is_none() && kind == Kind::Mamdani {
        let place = block.outputs.first().map_or(Piece::new("", 0), |output| output.name);
        notes.add(place, "no ACCU: MAX is taken (jFuzzyLogic adds)");
    }
    Some(all)
}

/// AND and OR; where one is said alone, the other is its pair by De Morgan's law.
fn operators(said: &Operators<'_>, notes: &mut Report) -> (And, Or) {
    match (said.and, said.or) {
        (None, None) | (Some((And::Min, _)), None) | (None, Some((Or::Max, _))) => (And::Min, Or::Max),
        (Some((And::Prod, _)), None) | (None, Some((Or::Probor, _))) => (And::Prod, Or::Probor),
        (Some((and, _)), Some((or, place))) => {
            if (and == And::Min) != (or == Or::Max) {
                notes.add(
                    place,
                    "AND and OR are no pair (MIN, MAX or PROD, ASUM): taken as written (jFuzzyLogic takes the last for both)",
                );
            }
            (and, or)
        }
    }
}

fn rules(block: &Block<'_>, algebra: Algebra, report: &mut Report) -> Option<Vec<Rule>> {
    let mut rules = Vec::new();
    let mut whole = true;
    for parsed in &block.rules {
        let Some(antecedents) = algebra.rules(&parsed.condition, block.inputs.len(), report) else {
            whole = false;
            continue;
        };
        let mut outputs = vec![0; block.outputs.len()];
        for conclusion in &parsed.conclusions {
            if let Some(term) = outputs.get_mut(conclusion.output) {
                *term = conclusion.term;
            }
            let number = block.outputs.get(conclusion.output).and_then(|output| {
                output.terms.get(usize::from(conclusion.term.unsigned_abs()).checked_sub(1)?)
            });
            let set = number.is_some_and(|term| matches!(term.term.shape, Shape::Set(_)));
            if conclusion.term < 0 && !set {
                report.add(conclusion.place, "NOT: a singleton has no complement");
                whole = false;
            }
        }
        for antecedent in antecedents {
            let (inputs, connective) = (antecedent.inputs, antecedent.connective);
            rules.push(Rule { inputs, outputs: outputs.clone(), weight: parsed.weight, connective });
        }
        if rules.len() > MAX_RULES {
            report.add(Piece::new("", 0), format!("more than {MAX_RULES} rules"));
            return None;
        }
    }
    whole.then_some(rules)
}

/// Refuses an accumulation of rules that conclude the same singleton unless it adds: an engine adds.
fn shared_singletons(
    block: &Block<'_>,
    accumulation: Option<(Accumulation, Piece<'_>)>,
    report: &mut Report,
) -> Option<()> {
    let Some((accumulation, place)) = accumulation else { return Some(()) };
    if accumulation == Accumulation::Sum {
        return Some(());
    }
    let mut known: HashMap<(usize, u64), ()> = HashMap::new();
    for conclusion in block.rules.iter().flat_map(|rule| &rule.conclusions) {
        let index = usize::from(conclusion.term.unsigned_abs()).checked_sub(1);
        let term =
            block.outputs.get(conclusion.output).zip(index).and_then(|(output, at)| output.terms.get(at));
        let key = match term.map(|term| &term.term.shape) {
            Some(Shape::Constant(value)) => (value + 0.0).to_bits(),
            _ => u64::from(conclusion.term.unsigned_abs()),
        };
        if known.insert((conclusion.output, key), ()).is_some() {
            let message = format!("ACCU : {} of several rules that conclude one singleton, here", place.text);
            report.add_expected(
                conclusion.place,
                message,
                "ACCU : NSUM, which adds as the engine does, or one rule a singleton",
            );
            return None;
        }
    }
    Some(())
}

fn variables(
    described: &[Described<'_>],
    range: impl Fn(&Described<'_>, &mut Report) -> Option<(f64, f64)>,
    report: &mut Report,
) -> Option<Vec<Variable>> {
    let one = |variable: &Described<'_>| {
        let name = variable.name.text.to_owned();
        let terms = variable.terms.iter().map(|defined| defined.term.clone()).collect();
        range(variable, report).map(|range| Variable { name, range, terms })
    };
    let read: Vec<_> = described.iter().map(one).collect();
    read.into_iter().collect()
}

/// Notes what an output does otherwise: a `DEFAULT` that the engine does not give, since where no rule fires its output is
/// the middle of the range, and a `RANGE` that singletons leave.
fn outputs(block: &Block<'_>, system: &System, notes: &mut Report) {
    for (at, (output, variable)) in block.outputs.iter().zip(&system.outputs).enumerate() {
        if let Some(((low, high), _)) = output.range {
            let outside =
                |shape: &Shape| matches!(shape, Shape::Constant(value) if !(low..=high).contains(value));
            if let Some(defined) = output.terms.iter().find(|defined| outside(&defined.term.shape)) {
                notes.add(
                    defined.place,
                    "a singleton outside its RANGE, to which a Sugeno output is not limited",
                );
            }
        }
        let Some((default, place)) = output.default else { continue };
        let middle = match system.defuzzification {
            Defuzzification::WeightedSum => 0.0,
            _ => 0.5 * variable.range.0 + 0.5 * variable.range.1,
        };
        if default.is_some_and(|default| (default - middle).abs() <= 0.0) {
            continue;
        }
        if let Some(example) = unfired(system, at) {
            let said = if default.is_some() { place.text } else { "NC" };
            notes.add(place, format!("DEFAULT {said} where no rule fires{example}: the output is {middle}, the middle of its range"));
        }
    }
}
