//! The report of a reproduction: its figures, its table, and every experiment to be replayed.

use maud::{Markup, PreEscaped, html};

use super::metrics::{Column, table};
use super::payload::Group;
use super::shell::{Page, Part};
use super::thesis;
use crate::VERSION;
use crate::number::short;
use crate::reproduce::{Report, Row};

/// The page of a reproduction, as HTML: the pictures of its figures in their order, and a group for each experiment.
pub(crate) fn of_reproduction(report: &Report, pictures: &[String], groups: &[Group]) -> String {
    let before = vec![
        Part { id: "results", title: "The thesis's numbers beside ours", body: results(report) },
        Part { id: "table-5-2", title: "Table 5.2", body: table_5_2(report) },
        Part { id: "figures", title: "Figures", body: figures(report, pictures) },
    ];
    let after = vec![
        Part { id: "metrics", title: "Metrics", body: metrics(report) },
        Part { id: "origin", title: "Versions and digests", body: origin(report) },
    ];
    let runs = report.runs.iter();
    let said = runs.flat_map(|run| {
        let missed = run.missed.iter().map(|miss| format!("[expect] missed: {miss}"));
        let all = run.warnings.iter().cloned().chain(missed);
        all.map(|text| format!("{} with {}: {text}", run.experiment, run.controller)).collect::<Vec<_>>()
    });
    Page {
        title: "The thesis's experiments run again",
        subtitle: format!("{} runs, {} figures, mmsim {VERSION}", report.runs.len(), report.figures.len()),
        groups,
        notices: said.collect(),
        before,
        after,
    }
    .to_html()
}

/// The experiments of the report, each once, in order, with their sections.
fn experiments(report: &Report) -> Vec<(&'static str, &'static str)> {
    let mut all: Vec<_> = report.runs.iter().map(|run| (run.section, run.experiment)).collect();
    all.dedup();
    all
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), short)
}

fn results(report: &Report) -> Markup {
    let rows = |experiment: &'static str| report.table.iter().filter(move |row| row.experiment == experiment);
    let line = |row: &Row| {
        html! { tr {
            th scope="row" { (row.quantity) }
            td.text { @if row.controller != "none" { (row.controller) } }
            td { (number(row.thesis)) }
            td { (number(row.ours)) }
            td { (number(row.ratio)) }
            td.unit { (row.unit) }
            td.text { (row.note.unwrap_or_default()) }
        } }
    };
    html! {
        div.wide tabindex="0" role="region" aria-label="The thesis's numbers beside ours" { table {
            thead { tr { @for title in ["quantity", "law", "thesis", "ours", "ours / thesis", "unit", "note"] { th scope="col" { (title) } } } }
            @for (section, experiment) in experiments(report) {
                tbody {
                    tr.part { th scope="rowgroup" colspan="7" { (section) " " (experiment) } }
                    @for row in rows(experiment) { (line(row)) }
                }
            }
        } }
    }
}

/// Runs of an experiment with their metrics, as the tables take them.
fn metrics_of(report: &Report, experiment: &str) -> Vec<(&'static str, Option<serde_json::Value>)> {
    let runs = report.runs.iter().filter(|run| run.experiment == experiment);
    let value =
        |run: &crate::reproduce::RunReport| serde_json::to_value(run.metrics).ok().filter(|_| run.finished);
    runs.map(|run| (run.controller, value(run))).collect()
}

fn table_5_2(report: &Report) -> Markup {
    let owned = metrics_of(report, "square-compare");
    let columns: Vec<Column<'_>> = owned.iter().map(|(name, metrics)| (*name, metrics.as_ref())).collect();
    html! { @if let Some(table) = thesis::beside("square-compare", &columns) { (table) } }
}

fn figures(report: &Report, pictures: &[String]) -> Markup {
    html! {
        div.pictures {
            @for (figure, svg) in report.figures.iter().zip(pictures) {
                @let name = format!("figure-{}", figure.figure);
                figure.picture.broad[is_broad(svg)] id=(name) {
                    (PreEscaped(svg))
                    figcaption {
                        @if figure.figure.starts_with(|c: char| c.is_ascii_digit()) { "Counterpart of figure " (figure.figure) ": " }
                        (figure.caption)
                    }
                }
            }
        }
    }
}

/// Whether a picture needs the whole width of the page to be read.
fn is_broad(svg: &str) -> bool {
    let width = svg.split_once("width=\"").and_then(|(_, rest)| rest.split_once('"'));
    width.and_then(|(width, _)| width.parse::<f64>().ok()).is_some_and(|width| width > 800.0)
}

fn metrics(report: &Report) -> Markup {
    html! {
        @for (section, experiment) in experiments(report) {
            @let owned = metrics_of(report, experiment);
            @let columns: Vec<Column<'_>> = owned.iter().map(|(name, metrics)| (*name, metrics.as_ref())).collect();
            details { summary { (section) " " (experiment) } (table(&columns)) }
        }
    }
}

fn origin(report: &Report) -> Markup {
    html! {
        div.wide tabindex="0" role="region" aria-label="Versions and digests" { table {
            caption { "The digest is XXH3-128 over state and torques at every control period. All of mmsim " (VERSION) "." }
            thead { tr { @for title in ["experiment", "section", "scenario", "controller", "ended", "digest", "data"] { th scope="col" { (title) } } } }
            tbody { @for run in &report.runs {
                tr {
                    th scope="row" { (run.experiment) }
                    td { (run.section) }
                    td { (run.scenario) }
                    td { (run.controller) }
                    td { @if run.finished { "finished" } @else { "failed" } }
                    td.digest { (run.digest) }
                    td { (run.data) }
                }
            } }
        } }
    }
}
