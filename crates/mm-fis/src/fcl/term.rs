//! `TERM` definitions.

use super::function::Function;
use super::names::FORMS;
use super::parser::Parser;
use super::points;
use super::token::{Kind, Token};
use crate::fis::{self, count};
use crate::read::{Piece, Report};
use crate::{Shape, Term};

/// A term as it was read.
#[derive(Debug)]
pub(super) struct Defined<'a> {
    pub(super) name: Piece<'a>,
    /// What stands behind `:=`.
    pub(super) place: Piece<'a>,
    pub(super) term: Term,
    /// From the first to the last of its points, if it is given by points.
    pub(super) points: Option<(f64, f64)>,
}

/// Reads `TERM name := ... ;`, the word `TERM` being taken; `inputs` are those that functions may use.
pub(super) fn term<'a>(
    parser: &mut Parser<'a>,
    inputs: &[Piece<'a>],
    report: &mut Report,
) -> Option<Defined<'a>> {
    let name = parser.name("the name of a term", report)?;
    parser.expect(":=", report)?;
    let start = parser.place().start;
    let mut points = None;
    let shape = shape(parser, inputs, &mut points, report)?;
    let place = parser.since(start);
    parser.expect(";", report)?;
    Some(Defined { name, place, term: Term { name: name.text.to_owned(), shape }, points })
}

fn shape<'a>(
    parser: &mut Parser<'a>,
    inputs: &[Piece<'a>],
    extent: &mut Option<(f64, f64)>,
    report: &mut Report,
) -> Option<Shape> {
    if parser.at_number() {
        return parser.number(report).map(|number| Shape::Constant(number.value));
    }
    if parser.at("(") {
        let mut points = Vec::new();
        while parser.takes("(") {
            let x = parser.number(report)?;
            parser.expect(",", report)?;
            let y = parser.number(report)?;
            parser.expect(")", report)?;
            points.push((x, y));
            // Some write commas between the points.
            let _ = parser.takes(",");
        }
        *extent = points.first().zip(points.last()).map(|(first, last)| (first.0.value, last.0.value));
        return points::shape(&points, report).map(Shape::Set);
    }
    if parser.takes("FUNCTION") {
        return Function { parser, inputs }.sum(0, report).map(Shape::Linear);
    }
    let Some(Token { kind: Kind::Word, piece: word }) = parser.advance() else {
        report.add_expected(parser.since(parser.place().start), "no term", EXPECTED);
        return None;
    };
    let start = parser.place().start;
    let mut numbers = Vec::new();
    // `(a, b)` is not of FCL, but plain.
    let bracketed = parser.takes("(");
    while parser.at_number() {
        numbers.push(parser.number(report)?);
        let _ = bracketed && parser.takes(",");
    }
    if bracketed {
        parser.expect(")", report)?;
    }
    let list = if numbers.is_empty() { word } else { parser.since(start) };
    let lists = |what: &str, needed: usize, report: &mut Report| {
        let message = format!("{} with {}", word.shown(), count(numbers.len(), "number"));
        report.add_expected(list, message, format!("{}: {what}", count(needed, "number")));
    };
    if word.text.eq_ignore_ascii_case("Constant") {
        if let [number] = numbers.as_slice() {
            return Some(Shape::Constant(number.value));
        }
        lists("the value", 1, report);
        return None;
    }
    if word.text.eq_ignore_ascii_case("Linear") {
        if numbers.len() == inputs.len() + 1 {
            return Some(Shape::Linear(numbers.iter().map(|number| number.value).collect()));
        }
        lists("one for each input, then a constant", inputs.len() + 1, report);
        return None;
    }
    let Some(form) = FORMS.iter().find(|form| form.name.eq_ignore_ascii_case(word.text)) else {
        let mut known: Vec<&str> = FORMS.iter().map(|form| form.name).collect();
        known.extend(["FUNCTION", "Constant", "Linear"]);
        report.add_unknown(word, "unknown membership function", &known);
        return None;
    };
    if numbers.len() != form.order.len() {
        lists(&format!("`{} {}`", form.name, form.parameters), form.order.len(), report);
        return None;
    }
    let ordered: Vec<_> = form.order.iter().filter_map(|&at| numbers.get(at).copied()).collect();
    let same = fis::FORMS.iter().find(|same| same.name == form.same)?;
    same.make(&ordered, list, report).map(Shape::Set)
}

const EXPECTED: &str = "points such as `(0, 1) (4, 0)`, a number or a shape such as `TRIAN 0 5 10`";
