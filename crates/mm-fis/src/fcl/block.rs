//! The blocks of an FCL text.

use mm_control::fuzzy::{And, Implication, Or};

use super::condition::{self, Parsed};
use super::describe::{Described, STOPS, Said, describe, interval, items, range};
use super::names::{ACCUMULATIONS, ACTIVATIONS, ANDS, Accumulation, ORS};
use super::parser::Parser;
use super::token::Kind;
use crate::read::{Piece, Report};

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
