//! `mmsim reproduce`: the experiments of the thesis, their figures, and its numbers beside ours.

use std::fmt::Write as _;

use indicatif::ProgressBar;

use super::run::with_causes;
use super::table::short;
use super::{Exit, ReproduceArgs, complain, interrupt, print, progress};
use crate::reproduce::{Options, Plan, Report, ReproduceError, Row, RunReport, Watch};

/// Runs all experiments and writes their files.
pub(super) fn reproduce(args: &ReproduceArgs) -> Exit {
    let options = Options { jobs: args.jobs.map_or(0, usize::from), sets: args.set.clone() };
    let plan = match Plan::new(&options) {
        Ok(plan) => plan,
        Err(error) => {
            complain(&error);
            return Exit::Usage;
        }
    };
    interrupt::install();
    let progress = Progress(progress::bar(!(args.quiet || args.json), 0, plan.steps() as u64));
    let outcome = plan.run(&args.out, &progress);
    progress.0.finish_and_clear();
    let report = match outcome {
        Ok(report) => report,
        Err(error) => {
            complain(&format_args!("error: {}", with_causes(&error)));
            if matches!(error, ReproduceError::Interrupted) {
                complain(&format_args!("the files written so far to {} are whole", args.out.display()));
            }
            return Exit::Failed;
        }
    };
    let exit = report.runs.iter().map(complain_of).max().unwrap_or(Exit::Done);
    if args.json {
        exit.max(print(&serde_json::to_string(&report).unwrap_or_default()))
    } else if args.quiet {
        exit
    } else {
        exit.max(print(&table(&report)))
    }
}

struct Progress(ProgressBar);

impl Watch for Progress {
    fn goes_on(&self) -> bool {
        !interrupt::asked()
    }

    fn done(&self, what: &str) {
        self.0.set_message(what.to_owned());
        self.0.inc(1);
    }
}

/// Says what a reader should know of a run, and what that means for the exit code.
fn complain_of(run: &RunReport) -> Exit {
    let name = format!("{} with {}", run.experiment, run.controller);
    let failed = usize::from(!run.finished);
    let (warnings, errors) = run.warnings.split_at(run.warnings.len().saturating_sub(failed));
    for warning in warnings {
        complain(&format_args!("warning: {name}: {warning}"));
    }
    for error in errors {
        complain(&format_args!("error: {name}: {error}"));
    }
    for miss in &run.missed {
        complain(&format_args!("error: {name}: [expect] missed: {miss}"));
    }
    match (run.finished, run.missed.is_empty()) {
        (false, _) => Exit::Failed,
        (true, false) => Exit::Missed,
        (true, true) => Exit::Done,
    }
}

/// The table for people, notes below it.
fn table(report: &Report) -> String {
    let mut out = format!("{:24} {:>10} {:>10} {:>10}\n", "", "thesis", "ours", "ratio");
    let mut notes: Vec<&str> = Vec::new();
    let mut heading = "";
    for row in &report.table {
        if row.experiment != heading {
            heading = row.experiment;
            let section =
                report.runs.iter().find(|run| run.experiment == heading).map_or("", |run| run.section);
            let _ = writeln!(out, "\n{section}  {heading}");
        }
        let mark = row.note.map_or_else(String::new, |note| {
            let known = notes.iter().position(|other| *other == note);
            let number = known.unwrap_or_else(|| {
                notes.push(note);
                notes.len() - 1
            });
            format!(" [{}]", number + 1)
        });
        let _ = writeln!(out, "{}{mark}", cells(row));
    }
    out.push('\n');
    for (number, note) in notes.iter().enumerate() {
        let _ = writeln!(out, "{:>4} {note}", format!("[{}]", number + 1));
    }
    let finished = report.runs.iter().filter(|run| run.finished).count();
    let _ = write!(
        out,
        "\n{finished} of {} runs went to their end, {} figures; {} s\nwritten to {}",
        report.runs.len(),
        report.figures.len(),
        short(report.wall_s),
        report.out
    );
    out
}

fn cells(row: &Row) -> String {
    // Rounded first, so that 0.99999999 has the digits of 1.
    let rounded = |value: f64| format!("{value:.3e}").parse().unwrap_or(value);
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| short(rounded(value)));
    let law = if row.controller == "none" { "" } else { row.controller };
    let [thesis, ours, ratio] = [row.thesis, row.ours, row.ratio].map(number);
    format!("  {law:13} {:34} {thesis:>10} {ours:>10} {ratio:>10}  {:6}", row.quantity, row.unit)
}
