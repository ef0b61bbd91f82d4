//! Reads `.fis` files.

mod keys;
mod lines;
mod names;
mod rules;
mod scan;
mod variable;

pub(crate) use names::{FORMS, count};
pub(crate) use scan::{Number, number};
pub(crate) use variable::check_range;

use std::ops::RangeInclusive;

use keys::Keys;
use lines::{Section, Topic, sections};
use names::{
    AGGREGATIONS, ANDS, IMPLICATIONS, KINDS, MAMDANI_DEFUZZIFICATIONS, ORS, SUGENO_DEFUZZIFICATIONS,
};
use rules::{Variables, rule};
use variable::{Read, Role, variable};

use crate::read::{Piece, Report};
use crate::{Defuzzification, Document, Kind, ReadError, Rule, System};
use mm_control::fuzzy::{Aggregation, And, Implication, Or};

const SYSTEM_KEYS: [&str; 11] = [
    "Name",
    "Type",
    "Version",
    "NumInputs",
    "NumOutputs",
    "NumRules",
    "AndMethod",
    "OrMethod",
    "ImpMethod",
    "AggMethod",
    "DefuzzMethod",
];

/// fuzzylite puts its own version.
const FUZZYLITE: RangeInclusive<f64> = 4.0..=9.0;

/// Reads a `.fis` file of version 2.0, as MATLAB, GNU Octave, fuzzylite and people with editors write it.
///
/// Sections and keys in any order and case; values in straight, curly or no quotes, a doubled quote within quotes being one; numbers
/// apart by blanks or commas; lines ended by LF, CR LF or CR; comments from `%`, `#` or `//` on; a byte order mark. Missing
/// methods are as MATLAB sets them: min, max, min, max, centroid, and prod, probor, prod, sum, wtaver of a Sugeno system. A missing
/// count is counted, one that is there is checked.
///
/// Names that stand for others: `algebraic_product` (`prod`), `algebraic_sum` (`probor`), `normalized_sum` (`sum`, since scaling
/// an output set moves no defuzzified value), `rampmf` (`linsmf` or `linzmf`), `rectmf` (`trapmf`).
///
/// Refused with its place: unknown or repeated keys and sections, gaps in numbers, wrong counts, numbers that are none or not
/// finite, breakpoints out of order, widths of 0, variables without terms, no rules, indices of terms that do not exist, weights
/// outside [0, 1], hedges, type-2 systems, operators and shapes that the engine does not have. What is read, an engine takes: the
/// exact centroid of curved output sets is the only thing it may refuse.
///
/// Cost: linear in the text, whatever numbers it holds.
///
/// # Errors
/// [`ReadError`] with every problem of the text.
///
/// # Source
/// MathWorks, Fuzzy Logic Toolbox, `writeFIS`; L. Markowsky, B. Segee, The Octave Fuzzy Logic Toolkit, 2011.
///
/// # Examples
/// ```
/// let error = mm_fis::read_fis("[System]\nType='mamdami'").unwrap_err();
/// let problem = &error.problems()[error.problems().len() - 1];
/// assert_eq!((problem.line(), problem.column(), problem.nearest()), (2, 7, Some("mamdani")));
/// ```
pub fn read_fis(text: &str) -> Result<Document, ReadError> {
    let mut report = Report::new();
    let system = system(text, &mut report);
    let system = report.finish(text, system)?;
    Ok(Document { system, notes: Vec::new() })
}

fn system(text: &str, report: &mut Report) -> Option<System> {
    let sections = sections(text, report);
    // Where a section is missing, counts and rules would only repeat it.
    let whole_text = report.is_empty();
    let Some(header) = sections.iter().find(|section| section.topic == Topic::System) else {
        if report.is_empty() {
            report.add_expected(Piece::new("", 0), "no section `[System]`", "a `.fis` file of version 2.0");
        }
        return None;
    };
    let keys = Keys::new(header, &SYSTEM_KEYS, "", report);
    let head = head(&keys, report);
    let kind = head.as_ref().map(|head| head.kind);
    let inputs =
        numbered(&sections, |topic| if let Topic::Input(n) = topic { Some(n) } else { None }, report);
    let outputs =
        numbered(&sections, |topic| if let Topic::Output(n) = topic { Some(n) } else { None }, report);
    if whole_text {
        keys.counts("NumInputs", inputs.len(), "input section", report);
        keys.counts("NumOutputs", outputs.len(), "output section", report);
    }
    for (there, name) in [(inputs.len(), "[Input1]"), (outputs.len(), "[Output1]")] {
        if there == 0 {
            report.add_expected(header.header, format!("no section `{name}`"), "at least one");
        }
    }
    let role = match kind {
        Some(Kind::Sugeno) => Role::SugenoOutput(inputs.len()),
        _ => Role::MamdaniOutput,
    };
    let inputs = read(&inputs, Role::Input, "input", report);
    // Without a type nobody knows what the terms of an output may be.
    let outputs = if kind.is_some() { read(&outputs, role, "output", report) } else { Vec::new() };
    let mut variables = Variables { kind, inputs, outputs };
    let rules =
        if kind.is_some() && whole_text { rules(&sections, header, &keys, &variables, report) } else { None };
    let whole =
        |reads: &mut Vec<Read<'_>>| reads.drain(..).map(|read| read.variable).collect::<Option<Vec<_>>>();
    let (inputs, outputs) = (whole(&mut variables.inputs)?, whole(&mut variables.outputs)?);
    let Head { name, kind, and, or, implication, aggregation, defuzzification } = head?;
    let rules = rules?;
    Some(System { name, kind, and, or, implication, aggregation, defuzzification, inputs, outputs, rules })
}

/// Reads variables; one without a name is called by its number.
fn read<'a>(sections: &[&Section<'a>], role: Role, name: &str, report: &mut Report) -> Vec<Read<'a>> {
    let named = sections.iter().zip(1..);
    named.map(|(section, number)| variable(section, role, &format!("{name}{number}"), report)).collect()
}

/// The section `[System]`, without its counts.
struct Head {
    name: String,
    kind: Kind,
    and: And,
    or: Or,
    implication: Implication,
    aggregation: Aggregation,
    defuzzification: Defuzzification,
}

fn head(keys: &Keys<'_>, report: &mut Report) -> Option<Head> {
    if let Some(version) = keys.number("Version", report)
        && !(version.value >= 1.0 && version.value < 3.0)
        && !FUZZYLITE.contains(&version.value)
    {
        report.add_expected(version.place, format!("version {}", version.place.text), "`2.0`");
    }
    let name = if keys.get("Name").is_some() {
        keys.text("Name", report).map(|(name, _)| name)
    } else {
        Some(String::new())
    };
    let kind = keys.name("Type", "type", &KINDS, Kind::Mamdani, report);
    let sugeno = kind == Some(Kind::Sugeno);
    let (and, or) = if sugeno { (And::Prod, Or::Probor) } else { (And::Min, Or::Max) };
    let (implication, aggregation) =
        if sugeno { (Implication::Prod, Aggregation::Sum) } else { (Implication::Min, Aggregation::Max) };
    let and = keys.name("AndMethod", "AND method", &ANDS, and, report);
    let or = keys.name("OrMethod", "OR method", &ORS, or, report);
    let implication = keys.name("ImpMethod", "implication", &IMPLICATIONS, implication, report);
    let aggregation = keys.name("AggMethod", "aggregation", &AGGREGATIONS, aggregation, report);
    let defuzzification = match kind? {
        Kind::Mamdani => {
            let (names, default) = (&MAMDANI_DEFUZZIFICATIONS, Defuzzification::Centroid);
            keys.name("DefuzzMethod", "defuzzification of a Mamdani system", names, default, report)
        }
        Kind::Sugeno => {
            let (names, default) = (&SUGENO_DEFUZZIFICATIONS, Defuzzification::WeightedAverage);
            keys.name("DefuzzMethod", "defuzzification of a Sugeno system", names, default, report)
        }
    };
    Some(Head {
        name: name?,
        kind: kind?,
        and: and?,
        or: or?,
        implication: implication?,
        aggregation: aggregation?,
        defuzzification: defuzzification?,
    })
}

/// The sections of a kind by their numbers; a gap is reported.
fn numbered<'s, 'a>(
    sections: &'s [Section<'a>],
    number: impl Fn(Topic) -> Option<usize>,
    report: &mut Report,
) -> Vec<&'s Section<'a>> {
    let mut found: Vec<_> =
        sections.iter().filter_map(|section| Some((number(section.topic)?, section))).collect();
    found.sort_by_key(|(number, _)| *number);
    if let Some((position, (_, section))) =
        found.iter().enumerate().find(|(position, (number, _))| *number != position + 1)
    {
        let message = format!("{} without the one before it", section.header.shown());
        report.add_expected(section.header, message, format!("number {}", position + 1));
    }
    found.into_iter().map(|(_, section)| section).collect()
}

fn rules(
    sections: &[Section<'_>],
    system: &Section<'_>,
    keys: &Keys<'_>,
    variables: &Variables<'_>,
    report: &mut Report,
) -> Option<Vec<Rule>> {
    let section = sections.iter().find(|section| section.topic == Topic::Rules);
    let lines = section.map_or(&[][..], |section| &section.lines);
    keys.counts("NumRules", lines.len(), "rule", report);
    if lines.is_empty() {
        let place = section.unwrap_or(system).header;
        report.add_expected(place, "no rules", "at least one rule in `[Rules]`");
        return None;
    }
    let read: Vec<_> = lines.iter().map(|line| rule(*line, variables, report)).collect();
    read.into_iter().collect()
}
