//! Variables: `FUZZIFY`, `DEFUZZIFY` and the items within.

use mm_control::fuzzy::MembershipFunction;

use super::names::{ACCUMULATIONS, Accumulation, METHODS, Method};
use super::parser::Parser;
use super::term::{Defined, term};
use crate::Shape;
use crate::fis::{Number, check_range};
use crate::read::{Piece, Report};

/// Something that was said once, and where.
pub(super) type Said<'a, T> = Option<(T, Piece<'a>)>;

/// A variable, declared and described.
#[derive(Debug)]
pub(super) struct Described<'a> {
    pub(super) name: Piece<'a>,
    pub(super) range: Said<'a, (f64, f64)>,
    /// Whether it has a block of its own.
    pub(super) described: bool,
    /// Whether a term of it could not be read.
    pub(super) broken: bool,
    pub(super) terms: Vec<Defined<'a>>,
    pub(super) method: Said<'a, Method>,
    pub(super) accumulation: Said<'a, Accumulation>,
    /// `NC`, which keeps the last value, is `None`.
    pub(super) default: Said<'a, Option<f64>>,
}

/// Where reading goes on after a problem.
pub(super) const STOPS: [&str; 10] = [
    "VAR_INPUT",
    "VAR_OUTPUT",
    "FUZZIFY",
    "DEFUZZIFY",
    "RULEBLOCK",
    "END_VAR",
    "END_FUZZIFY",
    "END_DEFUZZIFY",
    "END_RULEBLOCK",
    "END_FUNCTION_BLOCK",
];

/// Goes through the items of a block up to its end; after a problem it goes on with the next.
pub(super) fn items<'a>(
    parser: &mut Parser<'a>,
    end: &str,
    report: &mut Report,
    mut item: impl FnMut(&mut Parser<'a>, &mut Report) -> Option<()>,
) -> Option<()> {
    while !parser.takes(end) {
        if parser.peek().is_none() || parser.at_any(&STOPS) {
            report.add_expected(parser.place(), parser.found(), format!("`{end}`"));
            return Some(());
        }
        let from = parser.position();
        if item(parser, report).is_none() {
            parser.recover(&STOPS, from);
        }
    }
    Some(())
}

/// `RANGE := (0 .. 10);`
pub(super) fn range<'a>(
    parser: &mut Parser<'a>,
    said: &mut Said<'a, (f64, f64)>,
    report: &mut Report,
) -> Option<()> {
    let place = parser.place();
    parser.expect("RANGE", report)?;
    parser.expect(":=", report)?;
    let read = interval(parser, report)?;
    parser.expect(";", report)?;
    once("RANGE", said, read.map(|(range, _)| (range, place)), report)
}

pub(super) fn interval<'a>(parser: &mut Parser<'a>, report: &mut Report) -> Option<Said<'a, (f64, f64)>> {
    let start = parser.place().start;
    parser.expect("(", report)?;
    let low = parser.number(report)?;
    parser.expect("..", report)?;
    let high = parser.number(report)?;
    parser.expect(")", report)?;
    let place = parser.since(start);
    Some(check_range((low.value, high.value), high.place, report).map(|range| (range, place)))
}

/// Stores what a text says for the first time.
fn once<'a, T: Copy>(key: &str, said: &mut Said<'a, T>, now: Said<'a, T>, report: &mut Report) -> Option<()> {
    match (*said, now) {
        (Some(_), Some((_, place))) => report.add(place, format!("{key} is there twice")),
        _ => *said = said.or(now),
    }
    Some(())
}

/// `FUZZIFY` and `DEFUZZIFY`; only the latter knows the inputs that its terms may be functions of.
pub(super) fn describe<'a>(
    parser: &mut Parser<'a>,
    variables: &mut [Described<'a>],
    inputs: Option<&[Piece<'a>]>,
    report: &mut Report,
) -> Option<()> {
    let name = parser.name("the name of a variable", report)?;
    let names: Vec<_> = variables.iter().map(|variable| variable.name).collect();
    let Some(variable) = super::names::find(&names, name).and_then(|at| variables.get_mut(at)) else {
        let known: Vec<&str> = names.iter().map(|name| name.text).collect();
        report.add_unknown(name, "undeclared variable", &known);
        return None;
    };
    if variable.described {
        report.add(name, format!("{} is described twice", name.shown()));
        return None;
    }
    variable.described = true;
    let end = if inputs.is_some() { "END_DEFUZZIFY" } else { "END_FUZZIFY" };
    items(parser, end, report, |parser, report| describe_item(parser, variable, inputs, report))
}

fn describe_item<'a>(
    parser: &mut Parser<'a>,
    variable: &mut Described<'a>,
    inputs: Option<&[Piece<'a>]>,
    report: &mut Report,
) -> Option<()> {
    if parser.takes("TERM") {
        let Some(mut defined) = term(parser, inputs.unwrap_or_default(), report) else {
            variable.broken = true;
            return None;
        };
        if variable.terms.iter().any(|known| known.name.text == defined.name.text) {
            report.add(defined.name, format!("the term {} is there twice", defined.name.shown()));
        }
        match defined.term.shape {
            Shape::Constant(value) if inputs.is_none() => {
                defined.term.shape = Shape::Set(MembershipFunction::Triangle([value; 3]));
            }
            Shape::Linear(_) if inputs.is_none() => {
                report.add_expected(defined.place, "a function as the term of an input", "a set");
            }
            _ => {}
        }
        variable.terms.push(defined);
        return Some(());
    }
    if parser.at("RANGE") {
        return range(parser, &mut variable.range, report);
    }
    if inputs.is_none() {
        report.add_unknown(parser.place(), "unknown item of FUZZIFY:", &["TERM", "RANGE"]);
        return None;
    }
    if parser.takes("METHOD") {
        parser.expect(":", report)?;
        let method = parser.choice("METHOD", &METHODS, report)?;
        parser.expect(";", report)?;
        once("METHOD", &mut variable.method, Some(method), report)
    } else if parser.takes("ACCU") {
        parser.expect(":", report)?;
        let accumulation = parser.choice("ACCU", &ACCUMULATIONS, report)?;
        parser.expect(";", report)?;
        once("ACCU", &mut variable.accumulation, Some(accumulation), report)
    } else if parser.takes("DEFAULT") {
        parser.expect(":=", report)?;
        let default = default(parser, report)?;
        parser.expect(";", report)?;
        once("DEFAULT", &mut variable.default, default, report)
    } else {
        let known = ["TERM", "RANGE", "METHOD", "ACCU", "DEFAULT"];
        report.add_unknown(parser.place(), "unknown item of DEFUZZIFY:", &known);
        None
    }
}

/// A number, `NC`, or `nan`, which leaves it open; fuzzylite writes `nan | NC`.
fn default<'a>(parser: &mut Parser<'a>, report: &mut Report) -> Option<Said<'a, Option<f64>>> {
    let place = parser.place();
    let said = if parser.takes("NC") {
        Some((None, place))
    } else if parser.takes("nan") {
        None
    } else {
        let Number { value, place } = parser.number(report)?;
        Some((Some(value), place))
    };
    if !parser.takes("|") {
        return Some(said);
    }
    let place = parser.place();
    parser.expect("NC", report)?;
    Some(Some((None, place)))
}
