//! The report of logs: runs side by side.

use maud::{Markup, html};
use serde_json::Value;

use super::metrics::{Column, in_short, table};
use super::payload::{Group, Run, Signals};
use super::shell::{Page, Part};
use super::thesis;
use crate::log::{self, LogFile, Outcome};
use crate::number::short;

/// The page that shows some logs, as HTML.
#[must_use]
pub fn of_logs(logs: &[LogFile]) -> String {
    let names = names(logs);
    let run = |(log, name): (&LogFile, &String)| {
        Run::new((name, log.says("controller")), &log.urdf, Signals::Log(log))
    };
    let scenarios = scenarios(logs);
    let title = scenarios.join(", ");
    let groups = [Group::new(title.clone(), logs.iter().zip(&names).map(run).collect())];
    let columns: Vec<Column<'_>> = logs
        .iter()
        .zip(&names)
        .map(|(log, name)| (name.as_str(), log.summary.as_ref().and_then(|summary| summary.get("metrics"))))
        .collect();
    let beside = match scenarios.as_slice() {
        [only] if logs.iter().all(is_as_bundled) => thesis::beside(only, &columns),
        _ => None,
    };
    let mut before = vec![Part { id: "summary", title: "Summary", body: summary(logs, &names, &columns) }];
    before.extend(beside.map(|body| Part { id: "thesis", title: "Beside the thesis", body }));
    let after = vec![
        Part { id: "scenario", title: "Scenario", body: texts(logs, &names) },
        Part { id: "origin", title: "Versions and digests", body: origin(logs, &names) },
    ];
    let notices = logs.iter().zip(&names).flat_map(|(log, name)| notices(log, name)).collect();
    let runs =
        if logs.len() == 1 { names.concat() } else { format!("{} runs: {}", logs.len(), names.join(", ")) };
    Page { title: &title, subtitle: runs, groups: &groups, notices, before, after }.to_html()
}

/// Whether a log is of a whole run of its scenario, changed in nothing but the law: what may stand beside the thesis's numbers.
fn is_as_bundled(log: &LogFile) -> bool {
    let edits = log::edits(log.says("edits"));
    log.outcome() == Outcome::Finished.as_str()
        && edits.iter().all(|edit| edit.starts_with("controller.kind="))
}

/// The scenarios of some logs, each once.
fn scenarios(logs: &[LogFile]) -> Vec<&str> {
    let mut all = Vec::new();
    for log in logs {
        let name = log.says("scenario");
        if !all.contains(&name) {
            all.push(name);
        }
    }
    all
}

/// A name for each run: what tells it from the others, its controller if that does.
pub(crate) fn names(logs: &[LogFile]) -> Vec<String> {
    let law = |log: &LogFile| match log.says("controller") {
        "" | "none" => log.says("scenario").to_owned(),
        law => law.to_owned(),
    };
    let with_scenario = |log: &LogFile| format!("{} {}", log.says("scenario"), law(log));
    let file = |log: &LogFile| log.path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let with_seed = |log: &LogFile| format!("{} seed {}", with_scenario(log), log.says("seed"));
    let path = |log: &LogFile| log.path.display().to_string();
    let ways: [&dyn Fn(&LogFile) -> String; 5] = [&law, &with_scenario, &with_seed, &file, &path];
    let named = ways.map(|way| logs.iter().map(way).collect::<Vec<_>>());
    let is_telling = |names: &Vec<String>| {
        names.iter().enumerate().all(|(i, name)| !names.iter().skip(i + 1).any(|other| other == name))
    };
    let numbered = || (1..=logs.len()).map(|number| format!("run {number}")).collect();
    named.into_iter().find(is_telling).unwrap_or_else(numbered)
}

/// What a reader should know of a run.
fn notices(log: &LogFile, name: &str) -> Vec<String> {
    let warned = log.summary.as_ref().and_then(|summary| summary.get("warnings")).and_then(Value::as_array);
    let warned = warned.into_iter().flatten().filter_map(Value::as_str).map(str::to_owned);
    log.warnings.iter().cloned().chain(warned).map(|text| format!("{name}: {text}")).collect()
}

/// Time simulated, s: the summary's, or that of the last sample.
fn simulated_s(log: &LogFile) -> f64 {
    let said = log.summary.as_ref().and_then(|summary| summary.get("simulated_s")).and_then(Value::as_f64);
    said.or_else(|| log.columns.time().last().copied()).unwrap_or_default()
}

fn summary(logs: &[LogFile], names: &[String], columns: &[Column<'_>]) -> Markup {
    html! {
        div.cards {
            @for ((log, name), (_, metrics)) in logs.iter().zip(names).zip(columns) {
                article.card {
                    h3 data-run=(name) { (name) }
                    p { (log.outcome()) ", " (short(simulated_s(log))) " s simulated" }
                    dl { @for (what, value, unit) in in_short(*metrics) { div { dt { (what) } dd { (value) " " small { (unit) } } } } }
                }
            }
        }
        details open[logs.len() > 1] { summary { "All metrics" } (table(columns)) }
    }
}

/// The scenario files, runs with the same text together, with the files that they name.
fn texts(logs: &[LogFile], names: &[String]) -> Markup {
    let mut groups: Vec<(&LogFile, Vec<&str>)> = Vec::new();
    for (log, name) in logs.iter().zip(names) {
        let same = |(other, _): &&mut (&LogFile, Vec<&str>)| {
            other.scenario_text == log.scenario_text && other.files == log.files
        };
        match groups.iter_mut().find(same) {
            Some((_, names)) => names.push(name),
            None => groups.push((log, vec![name])),
        }
    }
    html! {
        @for (log, names) in groups {
            details open[logs.len() == 1] {
                summary { "Scenario file: " (names.join(", ")) }
                pre tabindex="0" { (log.scenario_text) }
            }
            @for (file, text) in &log.files {
                details { summary { (file) } pre tabindex="0" { (text) } }
            }
        }
    }
}

fn origin(logs: &[LogFile], names: &[String]) -> Markup {
    let digest = |log: &LogFile| {
        log.result.as_ref().and_then(|result| result.get("digest")).cloned().unwrap_or_else(|| "-".to_owned())
    };
    let says = |log: &LogFile, key: &str| match log.says(key) {
        "" => "-".to_owned(),
        text => text.to_owned(),
    };
    let edits = |log: &LogFile| match log::edits(log.says("edits")).as_slice() {
        [] => "-".to_owned(),
        edits => edits.join(", "),
    };
    html! {
        div.wide tabindex="0" role="region" aria-label="Versions and digests" { table {
            caption { "The digest is XXH3-128 over state and torques at every control period: two runs with the same one were the same run." }
            thead { tr { @for title in ["run", "scenario", "controller", "seed", "edits", "ended", "mmsim", "samples", "digest", "log"] { th scope="col" { (title) } } } }
            tbody { @for (log, name) in logs.iter().zip(names) {
                tr {
                    th scope="row" { (name) }
                    td { (says(log, "scenario")) }
                    td { (says(log, "controller")) }
                    td { (says(log, "seed")) }
                    td { (edits(log)) }
                    td { (log.outcome()) }
                    td { (says(log, "version")) }
                    td { (log.columns.len()) }
                    td.digest { (digest(log)) }
                    td { (log.path.display().to_string()) }
                }
            } }
        } }
    }
}
