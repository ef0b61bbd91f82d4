//! Rules as they are written.

use super::describe::Described;
use super::function::MAX_DEPTH;
use super::names::find;
use super::parser::Parser;
use crate::read::{Piece, Report};

/// How conditions are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Join {
    And,
    Or,
}

/// What a rule asks of its inputs.
#[derive(Debug, Clone)]
pub(super) enum Condition<'a> {
    /// An input is a term, counted from 1, negative for NOT.
    Is { input: usize, term: i16, place: Piece<'a> },
    /// Several conditions at once.
    Joined { join: Join, parts: Vec<Self>, place: Piece<'a> },
    /// The opposite.
    Not { inside: Box<Self>, place: Piece<'a> },
}

/// What a rule says of an output.
#[derive(Debug, Clone, Copy)]
pub(super) struct Conclusion<'a> {
    pub(super) output: usize,
    pub(super) term: i16,
    pub(super) place: Piece<'a>,
}

/// A rule as it was read.
#[derive(Debug)]
pub(super) struct Parsed<'a> {
    pub(super) condition: Condition<'a>,
    pub(super) conclusions: Vec<Conclusion<'a>>,
    pub(super) weight: f64,
}

/// Words that modify a term elsewhere.
const HEDGES: [&str; 7] = ["very", "extremely", "somewhat", "seldom", "more_or_less", "slightly", "plus"];

/// Reads `1 : IF a IS b THEN c IS d WITH 0.5;`, the word `RULE` being taken.
pub(super) fn rule<'a>(
    parser: &mut Parser<'a>,
    inputs: &[Described<'a>],
    outputs: &[Described<'a>],
    report: &mut Report,
) -> Option<Parsed<'a>> {
    // A name or a number; some leave it out.
    if !parser.at(":") {
        let _ = parser.advance();
    }
    parser.expect(":", report)?;
    parser.expect("IF", report)?;
    let condition = condition(parser, inputs, 0, report)?;
    parser.expect("THEN", report)?;
    let mut conclusions: Vec<Conclusion<'a>> = Vec::new();
    loop {
        let (output, term, place) = is(parser, outputs, "output", report)?;
        if conclusions.iter().any(|known| known.output == output) {
            report.add(place, "a rule that concludes one output twice");
            return None;
        }
        conclusions.push(Conclusion { output, term, place });
        if !parser.takes(",") && !parser.takes("AND") {
            break;
        }
    }
    let mut weight = 1.0;
    if parser.takes("WITH") {
        let number = parser.number(report)?;
        if !(0.0..=1.0).contains(&number.value) {
            report.add_expected(
                number.place,
                format!("a weight of {}", number.place.text),
                "a number from 0 to 1",
            );
            return None;
        }
        weight = number.value;
    }
    // fuzzylite ends a rule with its line.
    if !parser.at_any(&["RULE", "END_RULEBLOCK"]) {
        parser.expect(";", report)?;
    }
    Some(Parsed { condition, conclusions, weight })
}

/// AND binds before OR; an OR before an AND needs brackets, since not all tools read it so.
fn condition<'a>(
    parser: &mut Parser<'a>,
    inputs: &[Described<'a>],
    depth: usize,
    report: &mut Report,
) -> Option<Condition<'a>> {
    let start = parser.place().start;
    if depth > MAX_DEPTH {
        report.add(parser.place(), format!("conditions nested more than {MAX_DEPTH} deep"));
        return None;
    }
    let mut ands = vec![unit(parser, inputs, depth, report)?];
    while parser.takes("AND") {
        ands.push(unit(parser, inputs, depth, report)?);
    }
    let mut ors = vec![joined(Join::And, ands, parser.since(start))];
    while parser.takes("OR") {
        ors.push(unit(parser, inputs, depth, report)?);
        if parser.at("AND") {
            let message = "AND behind OR without brackets, which tools read in two ways";
            report.add_expected(parser.place(), message, "`(a OR b) AND c` or `a OR (b AND c)`");
            return None;
        }
    }
    Some(joined(Join::Or, ors, parser.since(start)))
}

/// Joins conditions; one alone stays what it is.
pub(super) fn joined<'a>(join: Join, mut parts: Vec<Condition<'a>>, place: Piece<'a>) -> Condition<'a> {
    match parts.pop() {
        Some(only) if parts.is_empty() => only,
        last => {
            parts.extend(last);
            Condition::Joined { join, parts, place }
        }
    }
}

fn unit<'a>(
    parser: &mut Parser<'a>,
    inputs: &[Described<'a>],
    depth: usize,
    report: &mut Report,
) -> Option<Condition<'a>> {
    let place = parser.place();
    if parser.takes("NOT") {
        if depth > MAX_DEPTH {
            report.add(place, format!("conditions nested more than {MAX_DEPTH} deep"));
            return None;
        }
        let inside = Box::new(unit(parser, inputs, depth + 1, report)?);
        return Some(Condition::Not { inside, place });
    }
    if parser.takes("(") {
        let inside = condition(parser, inputs, depth + 1, report)?;
        parser.expect(")", report)?;
        return Some(inside);
    }
    let (input, term, place) = is(parser, inputs, "input", report)?;
    Some(Condition::Is { input, term, place })
}

/// Reads `name IS [NOT] term`.
fn is<'a>(
    parser: &mut Parser<'a>,
    variables: &[Described<'a>],
    what: &str,
    report: &mut Report,
) -> Option<(usize, i16, Piece<'a>)> {
    let name = parser.name(&format!("the name of an {what}"), report)?;
    let names: Vec<_> = variables.iter().map(|variable| variable.name).collect();
    let Some((at, variable)) = find(&names, name).and_then(|at| Some((at, variables.get(at)?))) else {
        let known: Vec<&str> = names.iter().map(|name| name.text).collect();
        report.add_unknown(name, &format!("unknown {what}"), &known);
        return None;
    };
    parser.expect("IS", report)?;
    let negative = parser.takes("NOT");
    let word = parser.name("the name of a term", report)?;
    let terms: Vec<_> = variable.terms.iter().map(|term| term.name).collect();
    let Some(term) = find(&terms, word) else {
        // Where its terms could not be read, nobody knows which there are.
        if variable.broken || !variable.described {
            return None;
        }
        let hedge = HEDGES.iter().any(|hedge| hedge.eq_ignore_ascii_case(word.text));
        if hedge && !parser.at_any(&["AND", "OR", "THEN", ")"]) {
            let message = format!("the hedge {}: hedges are not supported", word.shown());
            report.add_expected(word, message, "the name of a term");
        } else {
            let known: Vec<&str> = terms.iter().map(|term| term.text).collect();
            report.add_unknown(word, &format!("unknown term of {}:", name.shown()), &known);
        }
        return None;
    };
    let Ok(index) = i16::try_from(term + 1) else {
        report.add(word, format!("more than {} terms", i16::MAX));
        return None;
    };
    let place = Piece::new(name.text, name.start);
    let place = if word.start > place.start { parser.since(place.start) } else { place };
    Some((at, if negative { -index } else { index }, place))
}
