//! Rules of faults and of the supervisor.

use super::super::diagnostic::Problem;
use super::super::tree::Node;
use super::{items, positive};

/// Keys of sizes, and the targets that have numbers of that unit.
const AMPLITUDES: [(&str, &[&str]); 5] = [
    ("amplitude_m", &["state", "pose", "reference"]),
    ("amplitude_rad", &["state", "pose", "joints"]),
    ("amplitude_m_s", &["state", "velocity"]),
    ("amplitude_rad_s", &["state", "velocity"]),
    ("amplitude_s", &["clock", "age"]),
];

/// Kinds that have a size.
const SIZED: [&str; 3] = ["offset", "spike", "noise"];

/// Reports every broken rule.
pub(super) fn check(root: &Node, problems: &mut Vec<Problem>) {
    let supervisor = "controller.supervisor";
    if let (Some(blind), Some(hold)) = (
        root.number(&format!("{supervisor}.blind_periods")),
        root.number(&format!("{supervisor}.hold_periods")),
    ) && blind <= hold
    {
        let key = format!("{supervisor}.blind_periods");
        problems.push(
            Problem::new(&key, format!("found {blind}"), root.place_of(&key))
                .expected(format!("more than hold_periods = {hold}")),
        );
    }
    let imposed = root.find("controller.kind").and_then(Node::as_str) == Some("none");
    for (index, fault) in items(root, "fault").iter().enumerate() {
        let mut report = |name: &str, message: String, expected: String| {
            let key = format!("fault.{index}.{name}");
            problems.push(Problem::new(&key, message, fault.place_of(name)).expected(expected));
        };
        if imposed {
            report("on", "a fault without a controller".to_owned(), "a law as `controller.kind`".to_owned());
        }
        let from = fault.number("from_s").unwrap_or(0.0);
        if let Some(to) = positive(fault, "to_s")
            && to <= from
        {
            report("to_s", format!("found {to}"), format!("more than from_s = {from}"));
        }
        let word = |name: &str| fault.find(name).and_then(Node::as_str);
        if let (Some(target), Some(kind)) = (word("on"), word("kind")) {
            one(fault, (target, kind), &mut report);
        }
    }
}

type Report<'a> = dyn FnMut(&str, String, String) + 'a;

fn one(fault: &Node, (target, kind): (&str, &str), report: &mut Report<'_>) {
    let is_time = ["clock", "age"].contains(&target);
    if ["drop", "duplicate", "stall"].contains(&kind) && target != "clock" {
        report(
            "kind",
            format!("found \"{kind}\" with on = \"{target}\""),
            "on = \"clock\" with it".to_owned(),
        );
    }
    if kind == "delay" && is_time {
        report(
            "kind",
            format!("found \"delay\" with on = \"{target}\""),
            "what is measured, or `reference`".to_owned(),
        );
    }
    amplitudes(fault, (target, kind), report);
    for (name, own) in [("factor", "scale"), ("delay_periods", "delay"), ("every_s", "spike")] {
        let is_given = fault.find(name).is_some();
        if is_given && kind != own {
            report(name, format!("not a key of kind = \"{kind}\""), format!("kind = \"{own}\" with it"));
        } else if !is_given && kind == own && name != "every_s" {
            report(name, "missing key".to_owned(), format!("a value, since kind = \"{kind}\""));
        }
    }
    let count = match target {
        "state" => 11,
        "velocity" => 5,
        "clock" | "age" => 1,
        _ => 3,
    };
    if let Some(channel) = fault.number("channel")
        && channel >= f64::from(count)
    {
        report("channel", format!("found {channel}"), format!("less than {count}, since on = \"{target}\""));
    }
}

fn amplitudes(fault: &Node, (target, kind): (&str, &str), report: &mut Report<'_>) {
    let mut own = AMPLITUDES.iter().filter(|(_, targets)| targets.contains(&target)).map(|(name, _)| *name);
    let names: Vec<_> = own.by_ref().collect();
    let wanted = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" or ");
    let mut any = false;
    for (name, _) in AMPLITUDES {
        if fault.find(name).is_none() {
            continue;
        }
        any = true;
        if !SIZED.contains(&kind) {
            report(
                name,
                format!("not a key of kind = \"{kind}\""),
                "`offset`, `spike` or `noise` with it".to_owned(),
            );
        } else if !names.contains(&name) {
            report(name, format!("not a key of on = \"{target}\""), wanted.clone());
        }
    }
    if SIZED.contains(&kind) && !any {
        let name = names.first().copied().unwrap_or("amplitude_m");
        report(name, "missing key".to_owned(), format!("{wanted}, since kind = \"{kind}\""));
    }
}
