//! The sections `[Input1]` and `[Output1]`.

use super::keys::Keys;
use super::lines::{Entry, Section};
use super::names::{count, form};
use super::scan::{Number, Scanner, ends};
use crate::read::{Piece, Report};
use crate::{Shape, Term, Variable};

/// Rules count terms in 16 bits.
const MAX_TERMS: usize = i16::MAX as usize;

/// What a variable may consist of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    Input,
    MamdaniOutput,
    /// With this number of inputs.
    SugenoOutput(usize),
}

/// A section as far as it could be read; how many terms it lists is known in any case.
#[derive(Debug)]
pub(super) struct Read<'a> {
    pub(super) header: Piece<'a>,
    pub(super) terms: usize,
    pub(super) variable: Option<Variable>,
}

/// Reads a section; `name` is the variable's where the section gives none.
pub(super) fn variable<'a>(section: &Section<'a>, role: Role, name: &str, report: &mut Report) -> Read<'a> {
    let keys = Keys::new(section, &["Name", "Range", "NumMFs"], "MF", report);
    let name = if keys.get("Name").is_none() {
        Some(name.to_owned())
    } else {
        keys.text("Name", report).map(|(name, _)| name)
    };
    let range = range(&keys, section.header, report);
    let terms = terms(&keys, role, report);
    let there = keys.numbered.len();
    keys.counts("NumMFs", there, "membership function", report);
    if there == 0 {
        report.add_expected(
            section.header,
            format!("{} without membership functions", section.header.text),
            "`MF1='name':'shape',[parameters]`",
        );
    }
    if there > MAX_TERMS {
        report.add(section.header, format!("{there} membership functions: {MAX_TERMS} are the most"));
    }
    let whole = name.zip(range).zip(terms);
    let variable = whole.map(|((name, range), terms)| Variable { name, range, terms });
    Read { header: section.header, terms: there, variable }
}

fn range(keys: &Keys<'_>, header: Piece<'_>, report: &mut Report) -> Option<(f64, f64)> {
    let Some(entry) = keys.get("Range") else {
        report.add_expected(header, format!("{} without a range", header.text), "`Range=[low high]`");
        return None;
    };
    let mut scanner = Scanner::new(entry.value);
    let numbers = scanner.vector(report)?;
    scanner.finish(report)?;
    let [low, high] = numbers.as_slice() else {
        report.add_expected(entry.value, count(numbers.len(), "number"), "2 numbers: `[low high]`");
        return None;
    };
    check_range((low.value, high.value), high.place, report)
}

/// Checks that a range is one; `place` is where its upper end stands.
pub(crate) fn check_range(
    (low, high): (f64, f64),
    place: Piece<'_>,
    report: &mut Report,
) -> Option<(f64, f64)> {
    if low >= high {
        report.add_expected(
            place,
            format!("a range from {low} to {high}"),
            "a lower end below the upper one",
        );
        return None;
    }
    if !(high - low).is_finite() {
        report.add(place, format!("the range from {low:e} to {high:e} is too wide for a number"));
        return None;
    }
    Some((low, high))
}

fn terms(keys: &Keys<'_>, role: Role, report: &mut Report) -> Option<Vec<Term>> {
    let mut whole = true;
    let mut terms = Vec::new();
    for (position, (number, entry)) in keys.numbered.iter().enumerate() {
        if *number != position + 1 {
            let message = format!("{} without an MF{}", entry.key.shown(), position + 1);
            report.add_expected(entry.key, message, "the numbers from 1 on, without a gap");
            return None;
        }
        match term(*entry, role, report) {
            Some(term) => terms.push(term),
            None => whole = false,
        }
    }
    whole.then_some(terms)
}

/// Reads `'name':'shape',[parameters]`.
fn term(entry: Entry<'_>, role: Role, report: &mut Report) -> Option<Term> {
    let mut scanner = Scanner::new(entry.value);
    let before_colon = |rest: &str| rest.trim_start().starts_with(':');
    let (name, _) = scanner.word(|rest| before_colon(rest) || ends(rest), report)?;
    if !scanner.takes(':') {
        report.add_expected(
            scanner.rest(),
            scanner.found(),
            "`:` and a membership function such as `'trimf',[0 1 2]`",
        );
        return None;
    }
    let before_list = |rest: &str| rest.trim_start().starts_with([',', '[']) || ends(rest);
    let (shape, place) = scanner.word(before_list, report)?;
    // MATLAB writes the comma, others a blank.
    let _ = scanner.takes(',');
    let start = scanner.rest().start;
    let is_open = !matches!(role, Role::SugenoOutput(_)) && shape.trim().eq_ignore_ascii_case("trapmf");
    let numbers = if is_open { scanner.unbounded_vector(report)? } else { scanner.vector(report)? };
    let stop = scanner.rest();
    scanner.finish(report)?;
    let (_, list) = entry.value.split_at(start.saturating_sub(entry.value.start));
    let list = list.split_at(stop.start.saturating_sub(start)).0.trim_end();
    let consequent = match role {
        Role::SugenoOutput(inputs) => Some(inputs),
        Role::Input | Role::MamdaniOutput => None,
    };
    let shape = match consequent {
        None => {
            let (shape, numbers) = without_open_side(&shape, &numbers, report)?;
            Shape::Set(form((shape, place), report)?.make(numbers, list, report)?)
        }
        Some(inputs) => {
            let linear = match shape.trim().to_lowercase().as_str() {
                "constant" => false,
                "linear" => true,
                _ => {
                    report.add_unknown(place, "unknown kind of Sugeno output", &["constant", "linear"]);
                    return None;
                }
            };
            let (needed, what) =
                if linear { (inputs + 1, "one for each input, then a constant") } else { (1, "the value") };
            if numbers.len() != needed {
                let message = format!("{} with {}", place.shown(), count(numbers.len(), "number"));
                report.add_expected(list, message, format!("{}: {what}", count(needed, "number")));
                return None;
            }
            let values: Vec<f64> = numbers.iter().map(|number| number.value).collect();
            match values.first() {
                Some(&value) if !linear => Shape::Constant(value),
                _ => Shape::Linear(values),
            }
        }
    };
    Some(Term { name, shape })
}

/// A trapezoid with an open side, `[-Inf -Inf c d]` or `[a b Inf Inf]`, as the shape that it is; reports other infinite numbers.
fn without_open_side<'a, 'b>(
    shape: &'b str,
    numbers: &'b [Number<'a>],
    report: &mut Report,
) -> Option<(&'b str, &'b [Number<'a>])> {
    let is_below = |number: &Number<'_>| number.value <= f64::NEG_INFINITY;
    let is_above = |number: &Number<'_>| number.value >= f64::INFINITY;
    let (shape, numbers) = match numbers {
        [a, b, finite @ ..] if finite.len() == 2 && is_below(a) && is_below(b) => ("linzmf", finite),
        [finite @ .., c, d] if finite.len() == 2 && is_above(c) && is_above(d) => ("linsmf", finite),
        _ => (shape, numbers),
    };
    match numbers.iter().find(|number| !number.value.is_finite()) {
        Some(number) => {
            report.add_found(number.place, "a finite number, `-Inf -Inf` in front or `Inf Inf` at the end");
            None
        }
        None => Some((shape, numbers)),
    }
}
