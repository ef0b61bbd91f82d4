//! The blocks of an FCL text.

use mm_control::fuzzy::{And, Implication, MembershipFunction, Or};

use super::condition::{self, Parsed};
use super::names::{ACCUMULATIONS, ACTIVATIONS, ANDS, Accumulation, METHODS, Method, ORS};
use super::parser::Parser;
use super::term::{Defined, term};
use super::token::Kind;
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

/// What rule blocks say besides rules.
#[derive(Debug, Default)]
pub(super) struct Operators<'a> {
    pub(super) and: Said<'a, And>,
    pub(super) or: Said<'a, Or>,
    pub(super) activation: Said<'a, Implication>,
    pub(super) accumulation: Said<'a, Accumulation>,
}

/// A function block as it was read.
#[derive(Debug, Default)]
pub(super) struct Block<'a> {
    pub(super) name: String,
    pub(super) inputs: Vec<Described<'a>>,
    pub(super) outputs: Vec<Described<'a>>,
    pub(super) operators: Operators<'a>,
    pub(super) rules: Vec<Parsed<'a>>,
}

const BLOCKS: [&str; 5] = ["VAR_INPUT", "VAR_OUTPUT", "FUZZIFY", "DEFUZZIFY", "RULEBLOCK"];
const END: &str = "END_FUNCTION_BLOCK";
/// Where reading goes on after a problem.
const STOPS: [&str; 10] = [
    "VAR_INPUT",
    "VAR_OUTPUT",
    "FUZZIFY",
    "DEFUZZIFY",
    "RULEBLOCK",
    "END_VAR",
    "END_FUZZIFY",
    "END_DEFUZZIFY",
    "END_RULEBLOCK",
    END,
];

/// Reads the text's only function block.
pub(super) fn block<'a>(parser: &mut Parser<'a>, report: &mut Report) -> Option<Block<'a>> {
    let start = parser.place();
    parser.expect("FUNCTION_BLOCK", report)?;
    let mut block = Block::default();
    let name = parser.rest_of_line(start.start, &STOPS);
    block.name = name.map_or_else(String::new, |name| name.text.to_owned());
    while !parser.takes(END) {
        let from = parser.position();
        if parser.peek().is_none() {
            report.add_expected(parser.place(), "found the end of the text", format!("`{END}`"));
            break;
        }
        if one_block(parser, &mut block, report).is_none() {
            let end = parser.position();
            if end == from {
                let _ = parser.advance();
            }
            while parser.peek().is_some() && !parser.at_any(&BLOCKS) && !parser.at(END) {
                let _ = parser.advance();
            }
        }
    }
    if parser.peek().is_some() {
        report.add_expected(parser.place(), parser.found(), "the end: one function block a text is read");
    }
    Some(block)
}

fn one_block<'a>(parser: &mut Parser<'a>, block: &mut Block<'a>, report: &mut Report) -> Option<()> {
    if parser.takes("VAR_INPUT") {
        declarations(parser, &mut block.inputs, report)
    } else if parser.takes("VAR_OUTPUT") {
        declarations(parser, &mut block.outputs, report)
    } else if parser.takes("FUZZIFY") {
        describe(parser, &mut block.inputs, None, report)
    } else if parser.takes("DEFUZZIFY") {
        let inputs: Vec<_> = block.inputs.iter().map(|input| input.name).collect();
        describe(parser, &mut block.outputs, Some(&inputs), report)
    } else if parser.takes("RULEBLOCK") {
        rule_block(parser, block, report)
    } else {
        report.add_unknown(parser.place(), "unknown block", &BLOCKS);
        None
    }
}

/// Goes through the items of a block up to its end; after a problem it goes on with the next.
fn items<'a>(
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

fn declarations<'a>(
    parser: &mut Parser<'a>,
    into: &mut Vec<Described<'a>>,
    report: &mut Report,
) -> Option<()> {
    items(parser, "END_VAR", report, |parser, report| {
        if let Some(last) = into.last_mut()
            && parser.at("RANGE")
        {
            return range(parser, &mut last.range, report);
        }
        let name = parser.name("the name of a variable", report)?;
        parser.expect(":", report)?;
        parser.expect("REAL", report)?;
        let mut said = None;
        if parser.at("(") {
            said = interval(parser, report)?;
        }
        parser.expect(";", report)?;
        if into.iter().any(|known| known.name.text == name.text) {
            report.add(name, format!("{} is declared twice", name.shown()));
            return Some(());
        }
        into.push(Described {
            name,
            range: said,
            described: false,
            broken: false,
            terms: Vec::new(),
            method: None,
            accumulation: None,
            default: None,
        });
        Some(())
    })
}

/// `RANGE := (0 .. 10);`
fn range<'a>(parser: &mut Parser<'a>, said: &mut Said<'a, (f64, f64)>, report: &mut Report) -> Option<()> {
    let place = parser.place();
    parser.expect("RANGE", report)?;
    parser.expect(":=", report)?;
    let read = interval(parser, report)?;
    parser.expect(";", report)?;
    once("RANGE", said, read.map(|(range, _)| (range, place)), report)
}

fn interval<'a>(parser: &mut Parser<'a>, report: &mut Report) -> Option<Said<'a, (f64, f64)>> {
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
fn describe<'a>(
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

fn rule_block<'a>(parser: &mut Parser<'a>, block: &mut Block<'a>, report: &mut Report) -> Option<()> {
    // A name, which fuzzylite leaves out.
    let words = ["AND", "OR", "ACT", "ACCU", "RULE"];
    if parser.peek().is_some_and(|token| token.kind != Kind::Sign)
        && !parser.at_any(&words)
        && !parser.at_any(&STOPS)
    {
        let _ = parser.advance();
    }
    let Block { inputs, outputs, operators, rules, .. } = block;
    items(parser, "END_RULEBLOCK", report, |parser, report| {
        let place = parser.place();
        if parser.takes("RULE") {
            rules.push(condition::rule(parser, inputs, outputs, report)?);
            return Some(());
        }
        let Some(word) = words.iter().find(|word| parser.at(word)) else {
            report.add_unknown(place, "unknown item of RULEBLOCK:", &words);
            return None;
        };
        let _ = parser.advance();
        parser.expect(":", report)?;
        match *word {
            "AND" => same(word, &mut operators.and, parser.choice(word, &ANDS, report)?, report),
            "OR" => same(word, &mut operators.or, parser.choice(word, &ORS, report)?, report),
            "ACT" => {
                same(word, &mut operators.activation, parser.choice(word, &ACTIVATIONS, report)?, report);
            }
            _ => {
                same(word, &mut operators.accumulation, parser.choice(word, &ACCUMULATIONS, report)?, report);
            }
        }
        parser.expect(";", report)
    })
}

/// Several rule blocks are one system only where they agree.
pub(super) fn same<'a, T: Copy + PartialEq>(
    key: &str,
    said: &mut Said<'a, T>,
    now: (T, Piece<'a>),
    report: &mut Report,
) {
    match said {
        Some((before, _)) if *before != now.0 => {
            report.add(now.1, format!("{key} : {}, but another before: a system has one", now.1.text));
        }
        Some(_) => {}
        None => *said = Some(now),
    }
}
