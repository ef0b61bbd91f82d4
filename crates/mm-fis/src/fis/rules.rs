//! The section `[Rules]`.

use mm_control::fuzzy::Connective;

use super::lines::without_comment;
use super::names::count;
use super::scan::{Number, Scanner, number};
use super::variable::Read;
use crate::read::{Piece, Report};
use crate::{Kind, Rule};

/// What rules may refer to.
pub(super) struct Variables<'a> {
    pub(super) kind: Option<Kind>,
    pub(super) inputs: Vec<Read<'a>>,
    pub(super) outputs: Vec<Read<'a>>,
}

/// Reads a line such as `1 -2, 3 (0.5) : 2`.
pub(super) fn rule(line: Piece<'_>, variables: &Variables<'_>, report: &mut Report) -> Option<Rule> {
    let line = without_comment(line);
    let mut scanner = Scanner::new(line);
    let (indices, commas) = indices(&mut scanner, report)?;
    let (inputs, outputs) = (variables.inputs.len(), variables.outputs.len());
    let expected = || {
        let (inputs, outputs) = (count(inputs, "input"), count(outputs, "output"));
        format!("one for each of {inputs} and {outputs}, as in `1 2, 1 (1) : 1`")
    };
    if indices.len() != inputs + outputs {
        report.add_expected(line, format!("a rule with {}", count(indices.len(), "term")), expected());
        return None;
    }
    if let [comma] = *commas
        && comma != inputs
    {
        let (comma, inputs) = (count(comma, "term"), count(inputs, "input"));
        report.add(line, format!("a comma after {comma}, but there are {inputs}"));
        return None;
    }
    let weight = weight(&mut scanner, report)?;
    let connective = connective(&mut scanner, report)?;
    scanner.finish(report)?;
    let (left, right) = indices.split_at_checked(inputs)?;
    let checked = |indices: &[Number<'_>], reads: &[Read<'_>], report: &mut Report| -> Option<Vec<i16>> {
        indices.iter().zip(reads).map(|(index, read)| self::index(*index, read, report)).collect()
    };
    let (left_terms, right_terms) =
        (checked(left, &variables.inputs, report)?, checked(right, &variables.outputs, report)?);
    if variables.kind == Some(Kind::Sugeno)
        && let Some(negative) = right.iter().find(|index| index.value < 0.0)
    {
        report
            .add(negative.place, format!("NOT {}: a Sugeno output has no complement", negative.value.abs()));
        return None;
    }
    Some(Rule { inputs: left_terms, outputs: right_terms, weight, connective })
}

/// The indices up to the weight, and before which of them there was a comma.
fn indices<'a>(scanner: &mut Scanner<'a>, report: &mut Report) -> Option<(Vec<Number<'a>>, Vec<usize>)> {
    let (mut indices, mut commas) = (Vec::new(), Vec::new());
    loop {
        if scanner.is_done() || scanner.rest().text.starts_with(['(', ':']) {
            return Some((indices, commas));
        }
        if !indices.is_empty() && scanner.takes(',') {
            commas.push(indices.len());
        }
        let word = scanner.part(|c| !c.is_whitespace() && !",():".contains(c));
        if word.is_empty() {
            report.add_expected(scanner.rest(), scanner.found(), "the number of a term");
            return None;
        }
        indices.push(number(word, report)?);
    }
}

fn weight(scanner: &mut Scanner<'_>, report: &mut Report) -> Option<f64> {
    if !scanner.takes('(') {
        report.add_expected(scanner.rest(), scanner.found(), "the weight, as in `(1)`");
        return None;
    }
    let word = scanner.part(|c| !c.is_whitespace() && !"():,".contains(c));
    let weight = number(word, report)?;
    if !(0.0..=1.0).contains(&weight.value) {
        report.add_expected(word, format!("a weight of {}", word.text), "a number from 0 to 1");
        return None;
    }
    if !scanner.takes(')') {
        report.add_expected(scanner.rest(), scanner.found(), "`)`");
        return None;
    }
    Some(weight.value)
}

fn connective(scanner: &mut Scanner<'_>, report: &mut Report) -> Option<Connective> {
    if !scanner.takes(':') {
        report.add_expected(scanner.rest(), scanner.found(), "`: 1` for AND or `: 2` for OR");
        return None;
    }
    let word = scanner.part(|c| !c.is_whitespace());
    match word.text {
        "1" => Some(Connective::And),
        "2" => Some(Connective::Or),
        _ => {
            report.add_found(word, "`1` for AND or `2` for OR");
            None
        }
    }
}

#[expect(clippy::float_cmp, clippy::cast_possible_truncation, reason = "whole numbers within 16 bits")]
fn index(index: Number<'_>, read: &Read<'_>, report: &mut Report) -> Option<i16> {
    let Number { value, place } = index;
    if value.trunc() != value {
        let message = format!("the hedge of {}: hedges such as `very` are not supported", place.shown());
        report.add_expected(place, message, "a whole number");
        return None;
    }
    let largest = read.terms.min(i16::MAX as usize);
    if value.abs() > largest as f64 {
        let terms = count(read.terms, "membership function");
        report.add(place, format!("term {} does not exist: {} has {terms}", place.text, read.header.text));
        return None;
    }
    Some(value as i16)
}
