//! `mmsim fis check`: what is wrong with a fuzzy system that runs.

use std::fmt::Write as _;

use clap::Args;
use mm_fis::check::{Finding, Jump, Reach, Report, Run, Severity};
use mm_fis::{Kind, System};
use serde_json::{Map, Value, json};

use super::super::{Exit, complain, print};
use super::file::{self, Loaded};
use super::{FileArg, counted};

/// What `check` takes.
#[derive(Debug, Clone, Args)]
pub(in super::super) struct CheckArgs {
    #[command(flatten)]
    file: FileArg,
    /// Print one object, with all numbers in full.
    #[arg(long)]
    json: bool,
    /// Exit with 1 where there is a warning.
    #[arg(long)]
    strict: bool,
}

/// Checks.
pub(super) fn check(args: &CheckArgs) -> Exit {
    let loaded = match file::load(&args.file.file) {
        Ok(loaded) => loaded,
        Err(exit) => return exit,
    };
    let report = match mm_fis::check::check(&loaded.system) {
        Ok(report) => report,
        Err(error) => {
            complain(&format_args!("error: {}: {error}", loaded.name));
            return Exit::Usage;
        }
    };
    let shown = if args.json {
        print(&as_json(&loaded, &report).to_string())
    } else {
        print(&as_text(&loaded, &report))
    };
    let is_flawed = args.strict && report.count(Severity::Warning) > 0;
    shown.max(if is_flawed { Exit::Failed } else { Exit::Done })
}

const fn kind(system: &System) -> &'static str {
    match system.kind {
        Kind::Mamdani => "Mamdani",
        Kind::Sugeno => "Sugeno",
    }
}

fn as_text(Loaded { name, system, .. }: &Loaded, report: &Report) -> String {
    let mut out = format!(
        "{name}: {}, {}, {}, {}, {}\n",
        if system.name.is_empty() { "no name" } else { &system.name },
        kind(system),
        counted(system.inputs.len(), "input"),
        counted(system.outputs.len(), "output"),
        counted(system.rules.len(), "rule")
    );
    for reach in &report.outputs {
        let _ = writeln!(out, "{reach}");
    }
    if report.is_sampled {
        out.push_str("the outputs were sampled: small jumps and turns may be missed\n");
    }
    for skipped in &report.skipped {
        let _ = writeln!(out, "not looked at: {skipped}");
    }
    out.push('\n');
    for finding in &report.findings {
        let _ = writeln!(out, "{finding}");
    }
    if report.findings.is_empty() {
        out.push_str("no findings");
    } else {
        let (warnings, notes) = (report.count(Severity::Warning), report.count(Severity::Note));
        let _ = write!(out, "\n{}, {}", counted(warnings, "warning"), counted(notes, "note"));
    }
    out
}

fn as_json(Loaded { name, system, .. }: &Loaded, report: &Report) -> Value {
    json!({
        "schema": "mmsim.fis-check/1",
        "file": name,
        "system": system.name,
        "kind": kind(system).to_lowercase(),
        "inputs": names(&system.inputs),
        "outputs": report.outputs.iter().map(reach).collect::<Vec<_>>(),
        "rules": system.rules.len(),
        "sampled": report.is_sampled,
        "warnings": report.count(Severity::Warning),
        "notes": report.count(Severity::Note),
        "findings": report.findings.iter().map(finding).collect::<Vec<_>>(),
        "not_looked_at": report.skipped,
    })
}

fn names(variables: &[mm_fis::Variable]) -> Vec<&str> {
    variables.iter().map(|variable| variable.name.as_str()).collect()
}

fn reach(reach: &Reach) -> Value {
    json!({ "name": reach.output, "range": pair(&reach.range), "reached": pair(&reach.reached) })
}

fn pair((from, to): &(f64, f64)) -> [f64; 2] {
    [*from, *to]
}

/// A finding; what does not apply is left out.
fn finding(finding: &Finding) -> Value {
    let mut object = Map::new();
    object.insert("severity".into(), finding.severity.name().into());
    object.insert("kind".into(), finding.kind.name().into());
    object.insert("message".into(), finding.message.as_str().into());
    let mut add = |key: &str, values: Vec<Value>| {
        if !values.is_empty() {
            object.insert(key.to_owned(), values.into());
        }
    };
    add("variables", finding.variables.iter().map(|name| name.as_str().into()).collect());
    add("terms", finding.terms.iter().map(|name| name.as_str().into()).collect());
    add("rules", finding.rules.iter().map(|&rule| rule.into()).collect());
    add("intervals", finding.intervals.iter().map(|interval| json!(pair(interval))).collect());
    let region = |region: &Vec<(f64, f64)>| json!(region.iter().map(pair).collect::<Vec<_>>());
    add("regions", finding.regions.iter().map(region).collect());
    add("jumps", finding.jumps.iter().map(jump).collect());
    add("runs", finding.runs.iter().map(run).collect());
    object.into()
}

fn jump(jump: &Jump) -> Value {
    json!({ "inputs": jump.inputs, "left": jump.left, "value": jump.value, "right": jump.right })
}

fn run(run: &Run) -> Value {
    json!({
        "from": run.from, "to": run.to, "from_value": run.from_value, "to_value": run.to_value, "rises": run.rises(),
    })
}
