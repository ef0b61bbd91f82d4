//! What the terms of the variables say.

use std::collections::HashMap;

use mm_control::fuzzy::MembershipFunction as Set;

use super::cells::{Cell, FAINT, breakpoints, cells, is_tailed, joined, set_of};
use super::words::{Short, Span, by_count, list, names};
use super::{Finding, FindingKind as Kind};
use crate::{Rule, System, Variable};

/// Part of the range by which the centroid of a term has to move for the range to matter to it.
const MOVED: f64 = 1e-6;

/// A variable and how the rules use it.
struct Used<'a> {
    variable: &'a Variable,
    /// `input` or `output`.
    role: &'static str,
    /// Number of rules for each term.
    uses: Vec<usize>,
}

impl Used<'_> {
    fn is_used(&self) -> bool {
        self.uses.iter().any(|&uses| uses > 0)
    }

    fn finding(&self, kind: Kind, message: String) -> Finding {
        Finding::new(kind, message).about(&[&self.variable.name])
    }

    /// `input \`x\``.
    fn title(&self) -> String {
        format!("{} `{}`", self.role, self.variable.name)
    }

    fn name_of(&self, term: usize) -> String {
        self.variable.terms.get(term).map_or_else(String::new, |term| term.name.clone())
    }
}

/// Findings about single terms and variables.
pub(super) fn find(system: &System, axes: &[Vec<Cell>]) -> Vec<Finding> {
    let mut found = Vec::new();
    found.extend(equal_names(&system.inputs, "inputs"));
    found.extend(equal_names(&system.outputs, "outputs"));
    let empty = Vec::new();
    for (at, variable) in system.inputs.iter().enumerate() {
        let used = used(variable, "input", system, |rule| rule.inputs.get(at));
        let cells = axes.get(at).unwrap_or(&empty);
        found.extend(unused(&used, Kind::UnusedInput, "no rule asks for it"));
        found.extend(uncovered(&used, cells));
        found.extend(outside(&used, cells));
        found.extend(beyond(&used));
        found.extend(alike(&used));
    }
    for (at, variable) in system.outputs.iter().enumerate() {
        let used = used(variable, "output", system, |rule| rule.outputs.get(at));
        found.extend(unused(&used, Kind::UnusedOutput, "no rule concludes anything about it"));
        if variable.terms.iter().any(|term| set_of(term).is_some()) {
            found.extend(outside(&used, &cells(variable)));
            found.extend(clipped(&used));
        }
        found.extend(alike(&used));
    }
    found
}

fn used<'a>(
    variable: &'a Variable,
    role: &'static str,
    system: &System,
    index: impl Fn(&Rule) -> Option<&i16>,
) -> Used<'a> {
    let mut uses = vec![0_usize; variable.terms.len()];
    for index in system.rules.iter().filter_map(index) {
        if let Some(count) = usize::from(index.unsigned_abs()).checked_sub(1).and_then(|at| uses.get_mut(at))
        {
            *count = count.saturating_add(1);
        }
    }
    Used { variable, role, uses }
}

fn equal_names(variables: &[Variable], what: &str) -> Vec<Finding> {
    let repeated = repeated(variables.iter().map(|variable| variable.name.as_str()));
    let finding = |name: &String| {
        Finding::new(Kind::DuplicateName, format!("two {what} have the name `{name}`")).about(&[name])
    };
    repeated.iter().map(finding).collect()
}

/// The names that occur more than once, each once.
fn repeated<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut counts: HashMap<&str, usize> = HashMap::new();
    let mut again = Vec::new();
    for name in names {
        let count = counts.entry(name).or_insert(0);
        *count = count.saturating_add(1);
        if *count == 2 {
            again.push(name.to_owned());
        }
    }
    again
}

/// What no rule uses: a variable as a whole, or some of its terms.
fn unused(used: &Used<'_>, kind: Kind, why: &str) -> Vec<Finding> {
    if !used.is_used() {
        return vec![used.finding(kind, format!("{}: {why}", used.title()))];
    }
    let idle = used.uses.iter().enumerate().filter(|(_, uses)| **uses == 0).map(|(at, _)| used.name_of(at));
    let finding = |name: String| {
        let message = format!("term `{name}` of {} is used by no rule", used.title());
        used.finding(Kind::UnusedTerm, message).terms(vec![name])
    };
    idle.map(finding).collect()
}

fn uncovered(used: &Used<'_>, cells: &[Cell]) -> Option<Finding> {
    let is_open = |cell: &&Cell| !cell.holds.iter().any(|holds| holds[0]);
    let intervals = joined(cells.iter().filter(is_open).map(|cell| (cell.from, cell.to)));
    if intervals.is_empty() || !used.is_used() {
        return None;
    }
    let spans: Vec<String> = intervals.iter().map(|(from, to)| Span(*from, *to).to_string()).collect();
    let is_tailed = used.variable.terms.iter().filter_map(set_of).any(is_tailed);
    let least = if is_tailed { format!(" by {FAINT} or more") } else { String::new() };
    let message = format!("no term of {} holds{least} {}", used.title(), list(&spans, 8));
    let mut finding = used.finding(Kind::UncoveredInput, message);
    finding.intervals = intervals;
    Some(finding)
}

fn outside(used: &Used<'_>, cells: &[Cell]) -> Vec<Finding> {
    let (lo, hi) = used.variable.range;
    let never = |at: &usize| !cells.iter().any(|cell| cell.holds.get(*at).is_some_and(|holds| holds[0]));
    let finding = |at: usize| {
        let name = used.name_of(at);
        let message =
            format!("term `{name}` of {} never holds in [{}, {}]", used.title(), Short(lo), Short(hi));
        used.finding(Kind::TermOutsideRange, message).terms(vec![name])
    };
    (0..used.variable.terms.len()).filter(never).map(finding).collect()
}

/// The feet of a set that has two.
const fn feet(set: &Set<f64>) -> Option<(f64, f64)> {
    match *set {
        Set::Triangle([a, _, d]) | Set::Trapezoid([a, _, _, d]) | Set::Pi([a, _, _, d]) => Some((a, d)),
        _ => None,
    }
}

/// The terms with a foot beyond the range and a part within, and their sets.
fn crossing<'a>(used: &'a Used<'_>) -> impl Iterator<Item = (&'a str, &'a Set<f64>)> {
    let (lo, hi) = used.variable.range;
    used.variable.terms.iter().filter_map(move |term| {
        let set = set_of(term)?;
        let (a, d) = feet(set)?;
        ((a < lo && d > lo) || (d > hi && a < hi)).then_some((term.name.as_str(), set))
    })
}

fn beyond(used: &Used<'_>) -> Option<Finding> {
    let terms: Vec<String> = crossing(used).map(|(name, _)| name.to_owned()).collect();
    if terms.is_empty() {
        return None;
    }
    let (lo, hi) = used.variable.range;
    let message = format!(
        "{} {} of {} {} beyond its range, [{}, {}]",
        by_count(terms.len(), "term", "terms"),
        names(&terms),
        used.title(),
        by_count(terms.len(), "reaches", "reach"),
        Short(lo),
        Short(hi)
    );
    Some(used.finding(Kind::TermBeyondRange, message).terms(terms))
}

fn clipped(used: &Used<'_>) -> Vec<Finding> {
    let (lo, hi) = used.variable.range;
    let finding = |(name, set): (&str, &Set<f64>)| {
        let (a, d) = feet(set)?;
        let (whole, cut) = (centroid(set, a, d)?, centroid(set, a.max(lo), d.min(hi))?);
        if (whole - cut).abs() <= MOVED * (hi - lo) {
            return None;
        }
        let message = format!(
            "the range of {}, [{}, {}], cuts term `{name}` off: its centroid is {} instead of {}",
            used.title(),
            Short(lo),
            Short(hi),
            Short(cut),
            Short(whole)
        );
        Some(used.finding(Kind::ClippedTerm, message).terms(vec![name.to_owned()]))
    };
    crossing(used).filter_map(finding).collect()
}

/// Centroid of a set over an interval, by Simpson's rule between breakpoints, which is exact for lines and parabolas.
fn centroid(set: &Set<f64>, from: f64, to: f64) -> Option<f64> {
    let mut places = breakpoints(set);
    places.extend([from, to]);
    places.retain(|x| *x >= from && *x <= to);
    places.sort_by(f64::total_cmp);
    let (mut area, mut moment) = (0.0, 0.0);
    for pair in places.windows(2) {
        let &[a, b] = pair else { continue };
        let middle = 0.5 * a + 0.5 * b;
        let [left, center, right] = [a, middle, b].map(|x| set.degree(x));
        area += (b - a) * (left + 4.0 * center + right);
        moment += (b - a) * (a * left + 4.0 * middle * center + b * right);
    }
    Some(moment / area).filter(|centroid| centroid.is_finite())
}

/// Where a set is largest, within a range.
fn core(set: &Set<f64>, (lo, hi): (f64, f64)) -> (f64, f64) {
    let (from, to) = match *set {
        Set::Triangle([_, b, _]) => (b, b),
        Set::Trapezoid([_, b, c, _]) | Set::Pi([_, b, c, _]) => (b, c),
        Set::LinearS([_, b]) | Set::S([_, b]) => (b, hi),
        Set::LinearZ([a, _]) | Set::Z([a, _]) => (lo, a),
        Set::Gaussian([_, c]) | Set::Bell([_, _, c]) => (c, c),
        Set::Sigmoid([a, c]) => {
            if a >= 0.0 {
                (c, hi)
            } else {
                (lo, c)
            }
        }
        Set::Gaussian2([_, c1, _, c2])
        | Set::SigmoidDifference([_, c1, _, c2])
        | Set::SigmoidProduct([_, c1, _, c2]) => (c1, c2),
    };
    (from.max(lo).min(hi), to.max(lo).min(hi))
}

/// Terms that are out of order, equal, or of one name.
fn alike(used: &Used<'_>) -> Vec<Finding> {
    let variable = used.variable;
    let mut found = Vec::new();
    for name in repeated(variable.terms.iter().map(|term| term.name.as_str())) {
        let message = format!("two terms of {} have the name `{name}`", used.title());
        found.push(used.finding(Kind::DuplicateName, message).terms(vec![name]));
    }
    let sets: Vec<(&str, &Set<f64>)> =
        variable.terms.iter().filter_map(|term| Some((term.name.as_str(), set_of(term)?))).collect();
    for (at, (name, set)) in sets.iter().enumerate() {
        if let Some((earlier, _)) = sets.iter().take(at).find(|(_, other)| other == set) {
            let message = format!("terms `{earlier}` and `{name}` of {} are the same set", used.title());
            let terms = vec![(*earlier).to_owned(), (*name).to_owned()];
            found.push(used.finding(Kind::EqualTerms, message).terms(terms));
        }
    }
    let room = MOVED * (variable.range.1 - variable.range.0);
    let is_below = |set: &Set<f64>, other: &Set<f64>| {
        let (own, others) = (core(set, variable.range), core(other, variable.range));
        own.0 < others.0 - room && own.1 < others.1 - room
    };
    let falling = sets.windows(2).find_map(|pair| match pair {
        [(before, left), (after, right)] if is_below(right, left) => {
            Some(((*before).to_owned(), (*after).to_owned()))
        }
        _ => None,
    });
    if let Some((before, after)) = falling {
        let message = format!(
            "the terms of {} are not in ascending order: `{after}` comes after `{before}`",
            used.title()
        );
        found.push(used.finding(Kind::TermOrder, message).terms(vec![before, after]));
    }
    found
}
