//! What the rules say, and where none says anything.

use std::collections::HashMap;

use mm_control::fuzzy::{Aggregation, Connective};

use super::cells::{Cell, FAINT, set_of};
use super::gaps;
use super::words::{Short, Span, list};
use super::{Finding, FindingKind as Kind};
use crate::{Defuzzification, Kind as SystemKind, Rule, System, Variable};

/// Rules up to which each is compared with each.
const MOST_COMPARED: usize = 2000;
/// Regions that a finding lists.
const MOST_REGIONS: usize = 1000;

/// Findings about rules; what could not be looked at goes to `skipped`.
pub(super) fn find(system: &System, axes: &[Vec<Cell>], skipped: &mut Vec<String>) -> Vec<Finding> {
    let mut found = Vec::new();
    for (number, rule) in (1..).zip(&system.rules) {
        found.extend(unreachable(system, axes, (number, rule)));
        if rule.outputs.iter().all(|&index| index == 0) {
            let message = format!("{} concludes nothing", title(system, number, rule));
            found.push(Finding::new(Kind::RuleWithoutEffect, message).rules(vec![number]));
        }
    }
    found.extend(same_condition(system));
    if system.rules.len() <= MOST_COMPARED {
        found.extend(dominated(system));
    } else {
        skipped.push(format!("rules that add nothing to others: there are more than {MOST_COMPARED} rules"));
    }
    for (output, variable) in system.outputs.iter().enumerate() {
        let is_used = |rule: &Rule| rule.outputs.get(output).is_some_and(|&index| index != 0);
        if !system.rules.iter().any(is_used) {
            continue;
        }
        match gaps::of_output(system, axes, output) {
            None => skipped.push(format!(
                "inputs for which no rule fires for output `{}`: too many combinations of terms",
                variable.name
            )),
            Some(regions) if regions.is_empty() => {}
            Some(regions) => found.push(unfired(system, (output, variable), regions)),
        }
    }
    found
}

/// A rule in words: `rule 3 (service is good)`.
fn title(system: &System, number: usize, rule: &Rule) -> String {
    let condition = condition(system, rule);
    if condition.is_empty() { format!("rule {number}") } else { format!("rule {number} (if {condition})") }
}

fn condition(system: &System, rule: &Rule) -> String {
    let joint = match rule.connective {
        Connective::And => " and ",
        Connective::Or => " or ",
    };
    let parts = system.inputs.iter().zip(&rule.inputs).filter_map(|(input, index)| clause(input, *index));
    parts.collect::<Vec<_>>().join(joint)
}

/// `x is not small`, or nothing.
fn clause(variable: &Variable, index: i16) -> Option<String> {
    let term = variable.terms.get(usize::from(index.unsigned_abs()).checked_sub(1)?)?;
    Some(format!("{} is {}{}", variable.name, if index < 0 { "not " } else { "" }, term.name))
}

fn unreachable(system: &System, axes: &[Vec<Cell>], (number, rule): (usize, &Rule)) -> Option<Finding> {
    let can_hold = |(cells, index): (&Vec<Cell>, &i16)| cells.iter().any(|cell| cell.satisfies(*index));
    let mut asked = axes.iter().zip(&rule.inputs).filter(|(_, index)| **index != 0);
    let reason = if rule.weight <= 0.0 {
        "its weight is 0".to_owned()
    } else {
        let never = |(input, (cells, index)): (&Variable, (&Vec<Cell>, &i16))| {
            (*index != 0 && !can_hold((cells, index))).then(|| clause(input, *index)).flatten()
        };
        match rule.connective {
            Connective::And => {
                let mut pairs = system.inputs.iter().zip(axes.iter().zip(&rule.inputs));
                format!("\"{}\" holds nowhere in its range", pairs.find_map(never)?)
            }
            Connective::Or if rule.inputs.iter().all(|&index| index == 0) => {
                "it has no condition, joined by or".to_owned()
            }
            Connective::Or if asked.any(can_hold) => return None,
            Connective::Or => "none of its clauses holds anywhere in the ranges".to_owned(),
        }
    };
    let message = format!("{} never fires: {reason}", title(system, number, rule));
    Some(Finding::new(Kind::UnreachableRule, message).rules(vec![number]))
}

/// The terms of a condition, and whether they are joined by or.
type Condition = (Vec<i16>, bool);

/// The condition of a rule; a single clause has no connective.
fn key(rule: &Rule) -> Condition {
    let clauses = rule.inputs.iter().filter(|&&index| index != 0).count();
    (rule.inputs.clone(), clauses != 1 && rule.connective == Connective::Or)
}

/// Rules of one condition: those that conclude the same, and those that contradict.
fn same_condition(system: &System) -> Vec<Finding> {
    let mut groups: HashMap<Condition, Vec<(usize, &Rule)>> = HashMap::new();
    let mut order = Vec::new();
    for (number, rule) in (1..).zip(&system.rules) {
        let key = key(rule);
        let group = groups.entry(key.clone()).or_default();
        if group.is_empty() {
            order.push(key);
        }
        group.push((number, rule));
    }
    let mut found = Vec::new();
    for group in order.iter().filter_map(|key| groups.get(key)).filter(|group| group.len() > 1) {
        found.extend(duplicates(system, group));
        found.extend(contradictions(system, group));
    }
    found
}

fn duplicates(system: &System, group: &[(usize, &Rule)]) -> Vec<Finding> {
    let mut found = Vec::new();
    for (at, (number, rule)) in group.iter().enumerate() {
        let is_same = |(_, other): &&(usize, &Rule)| other.outputs == rule.outputs;
        if group.iter().take(at).any(|other| is_same(&other)) {
            continue;
        }
        let same: Vec<usize> = group.iter().skip(at).filter(is_same).map(|(number, _)| *number).collect();
        if same.len() > 1 {
            let message = format!("{} say the same: {}", numbers(&same), in_words(system, *number, rule));
            found.push(Finding::new(Kind::DuplicateRules, message).rules(same));
        }
    }
    found
}

/// The rule in full: `if x is small then y is large`.
fn in_words(system: &System, number: usize, rule: &Rule) -> String {
    let condition = condition(system, rule);
    let clauses: Vec<String> = system
        .outputs
        .iter()
        .zip(&rule.outputs)
        .filter_map(|(output, index)| clause(output, *index))
        .collect();
    let conclusion = if clauses.is_empty() { "nothing".to_owned() } else { clauses.join(", ") };
    if condition.is_empty() {
        format!("rule {number} has no condition, and {conclusion}")
    } else {
        format!("if {condition} then {conclusion}")
    }
}

fn numbers(rules: &[usize]) -> String {
    format!("rules {}", list(&rules.iter().map(ToString::to_string).collect::<Vec<_>>(), 12))
}

fn contradictions(system: &System, group: &[(usize, &Rule)]) -> Vec<Finding> {
    let mut found = Vec::new();
    for (at, output) in system.outputs.iter().enumerate() {
        let concluding: Vec<(usize, i16)> = group
            .iter()
            .filter_map(|(number, rule)| Some((*number, *rule.outputs.get(at)?)))
            .filter(|(_, index)| *index != 0)
            .collect();
        let mut terms: Vec<i16> = concluding.iter().map(|(_, index)| *index).collect();
        terms.sort_unstable();
        terms.dedup();
        if terms.len() < 2 {
            continue;
        }
        let rules: Vec<usize> = concluding.iter().map(|(number, _)| *number).collect();
        let words: Vec<String> = terms.iter().filter_map(|index| clause(output, *index)).collect();
        let condition = group.first().map_or_else(String::new, |(_, rule)| condition(system, rule));
        let when = if condition.is_empty() { "always".to_owned() } else { format!("if {condition}") };
        let message = format!("{} contradict each other: {when} then {}", numbers(&rules), list(&words, 8));
        let names: Vec<String> = terms
            .iter()
            .filter_map(|index| usize::from(index.unsigned_abs()).checked_sub(1))
            .filter_map(|term| Some(output.terms.get(term)?.name.clone()))
            .collect();
        found.push(
            Finding::new(Kind::ContradictingRules, message).about(&[&output.name]).terms(names).rules(rules),
        );
    }
    found
}

/// Rules whose conclusions another rule draws from a part of the condition, at least as strongly.
///
/// Only where the strongest rule of a term counts alone: with the maximum as aggregation.
fn dominated(system: &System) -> Vec<Finding> {
    if system.kind != SystemKind::Mamdani || system.aggregation != Aggregation::Max {
        return Vec::new();
    }
    let mut found = Vec::new();
    for (number, rule) in (1..).zip(&system.rules) {
        let stronger = (1..).zip(&system.rules).find(|(_, other)| dominates(other, rule));
        if let Some((by, other)) = stronger {
            let message = format!(
                "{} adds nothing to {}: it concludes the same, from more",
                title(system, number, rule),
                title(system, by, other)
            );
            found.push(Finding::new(Kind::DominatedRule, message).rules(vec![number, by]));
        }
    }
    found
}

/// Whether `other` concludes all that `rule` does, from a condition that is weaker by itself.
fn dominates(other: &Rule, rule: &Rule) -> bool {
    let concludes = rule.outputs.iter().zip(&other.outputs).all(|(own, others)| *own == 0 || own == others);
    if !concludes || other.weight < rule.weight || rule.weight <= 0.0 || key(other) == key(rule) {
        return false;
    }
    let is_idle = |indices: &[i16]| indices.iter().all(|&index| index == 0);
    if is_idle(&rule.outputs) || (rule.connective == Connective::Or && is_idle(&rule.inputs)) {
        return false;
    }
    let mut pairs = rule.inputs.iter().zip(&other.inputs);
    match (key(rule).1, key(other).1) {
        // Fewer clauses joined by and hold at least as strongly; none holds fully.
        (false, false) => pairs.all(|(own, others)| *others == 0 || own == others),
        // More clauses joined by or do.
        (true, true) => pairs.all(|(own, others)| *own == 0 || own == others),
        // One clause out of several that are joined by or: the or is the stronger.
        (false, true) => pairs.any(|(own, others)| *own != 0 && own == others),
        (true, false) => other.inputs.iter().all(|&index| index == 0),
    }
}

/// Whether some rule fires for an output in the middle of a region, if only by the tail of a term.
fn fires_faintly(system: &System, output: usize, region: &gaps::Region) -> bool {
    let degree = |(variable, ((from, to), index)): (&Variable, (&(f64, f64), &i16))| {
        let term = variable.terms.get(usize::from(index.unsigned_abs()).checked_sub(1)?)?;
        let degree = set_of(term)?.degree(0.5 * from + 0.5 * to);
        Some(if *index < 0 { 1.0 - degree } else { degree })
    };
    let fires = |rule: &Rule| {
        let mut degrees = system.inputs.iter().zip(region.iter().zip(&rule.inputs)).filter_map(degree);
        match rule.connective {
            Connective::And => degrees.all(|degree| degree > 0.0),
            Connective::Or => degrees.any(|degree| degree > 0.0),
        }
    };
    let concludes =
        |rule: &&Rule| rule.weight > 0.0 && rule.outputs.get(output).is_some_and(|&index| index != 0);
    system.rules.iter().filter(concludes).any(fires)
}

fn unfired(system: &System, (number, output): (usize, &Variable), regions: Vec<gaps::Region>) -> Finding {
    let (lo, hi) = output.range;
    let value =
        if system.defuzzification == Defuzzification::WeightedSum { 0.0 } else { 0.5 * lo + 0.5 * hi };
    let is_faint = regions.iter().any(|region| fires_faintly(system, number, region));
    let no_rule =
        if is_faint { format!("no rule fires by {FAINT} or more") } else { "no rule fires".to_owned() };
    let then = if is_faint {
        format!("output `{}` rests on the tails of terms there", output.name)
    } else {
        format!("output `{}` is {} there", output.name, Short(value))
    };
    let [input] = system.inputs.as_slice() else {
        let ranges: Vec<(f64, f64)> = system.inputs.iter().map(|input| input.range).collect();
        let share = gaps::share(&regions, &ranges);
        let example = regions.iter().max_by(|a, b| {
            let of = |region: &&gaps::Region| gaps::share(std::slice::from_ref(*region), &ranges);
            of(a).total_cmp(&of(b))
        });
        let example = example.map_or_else(String::new, |region| in_region(system, region));
        let where_to = if share > 0.0 {
            format!("for {} % of the inputs, for example {example}", Short(100.0 * share))
        } else {
            format!("at some single inputs, for example {example}")
        };
        let message = format!("{no_rule} {where_to}: {then}");
        let mut finding = Finding::new(Kind::NoRuleFires, message).about(&[&output.name]);
        finding.regions = regions.into_iter().take(MOST_REGIONS).collect();
        return finding;
    };
    let intervals = gaps::intervals(&regions);
    let spans: Vec<String> = intervals.iter().map(|(from, to)| Span(*from, *to).to_string()).collect();
    let message = format!("{no_rule} for `{}` {}: {then}", input.name, list(&spans, 8));
    let mut finding = Finding::new(Kind::NoRuleFires, message).about(&[&input.name, &output.name]);
    finding.intervals = intervals;
    finding
}

/// A box of inputs in words, without the inputs that may be anything.
fn in_region(system: &System, region: &gaps::Region) -> String {
    let part = |(input, (from, to)): (&Variable, &(f64, f64))| {
        let is_all = *from <= input.range.0 && *to >= input.range.1;
        (!is_all).then(|| format!("`{}` {}", input.name, Span(*from, *to)))
    };
    let parts: Vec<String> = system.inputs.iter().zip(region).filter_map(part).collect();
    if parts.is_empty() { "all of them".to_owned() } else { parts.join(", ") }
}
