//! What a reproduction found, as data.

use serde::Serialize;

use super::claims::{Claim, claims};
use super::measure::Done;
use crate::metrics::Metrics;

/// Name and version of the report's format.
pub const SCHEMA: &str = "mmsim.reproduce/1";

/// All that a reproduction found.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// Name and version of this format.
    pub schema: &'static str,
    /// Folder of the files.
    pub out: String,
    /// Wall time, s.
    pub wall_s: f64,
    /// The runs, in the order of the thesis.
    pub runs: Vec<RunReport>,
    /// The thesis's numbers beside ours.
    pub table: Vec<Row>,
    /// The figures.
    pub figures: Vec<FigureFile>,
}

/// A run.
#[derive(Debug, Clone, Serialize)]
pub struct RunReport {
    /// Name of the experiment.
    pub experiment: &'static str,
    /// Section of the thesis.
    pub section: &'static str,
    /// Bundled scenario.
    pub scenario: &'static str,
    /// Law.
    pub controller: &'static str,
    /// Whether it went to its end.
    pub finished: bool,
    /// Metrics.
    pub metrics: Metrics,
    /// XXH3-128 of the trajectory.
    pub digest: String,
    /// Wall time of the run, s.
    pub wall_s: f64,
    /// Path of its data in the folder.
    pub data: String,
    /// What a reader should know besides the numbers; how it failed is the last of them.
    pub warnings: Vec<String>,
    /// Entries of the scenario's `[expect]` that it missed; judged for the bundled scenario as it stands.
    pub missed: Vec<String>,
}

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Row {
    /// Name of the experiment.
    pub experiment: &'static str,
    /// Law.
    pub controller: &'static str,
    /// What was measured.
    pub quantity: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// The thesis's number; none where it states none.
    pub thesis: Option<f64>,
    /// Ours; none if the run did not go to its end, or the quantity is not defined on it.
    pub ours: Option<f64>,
    /// Ours in the thesis's.
    pub ratio: Option<f64>,
    /// What the two numbers do and do not say.
    pub note: Option<&'static str>,
}

/// A figure that was written.
#[derive(Debug, Clone, Serialize)]
pub struct FigureFile {
    /// Number in the thesis, or the name of an addition.
    pub figure: &'static str,
    /// What it shows.
    pub caption: &'static str,
    /// Path of the picture in the folder.
    pub svg: String,
    /// Paths of its data in the folder.
    pub data: Vec<String>,
}

/// Header of `table.csv`.
pub(super) const TABLE_HEADER: [&str; 8] =
    ["experiment", "controller", "quantity", "unit", "thesis", "ours", "ratio", "note"];
/// Header of `figures.csv`.
pub(super) const FIGURES_HEADER: [&str; 4] = ["figure", "caption", "svg", "data"];

impl Row {
    fn of<'a>(claim: &Claim, find: impl Fn(&str) -> Option<Done<'a>>) -> Self {
        let ours = find(claim.controller).and_then(|run| claim.measure.of(run, &find));
        let ratio = ours.zip(claim.thesis).map(|(ours, thesis)| ours / thesis).filter(|r| r.is_finite());
        let Claim { experiment, controller, quantity, unit, thesis, note, .. } = *claim;
        Self { experiment, controller, quantity, unit, thesis, ours, ratio, note }
    }

    pub(super) fn fields(&self) -> Vec<String> {
        let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:?}"));
        let text = |text: &str| text.to_owned();
        vec![
            text(self.experiment),
            text(self.controller),
            text(self.quantity),
            text(self.unit),
            number(self.thesis),
            number(self.ours),
            number(self.ratio),
            text(self.note.unwrap_or_default()),
        ]
    }
}

impl FigureFile {
    pub(super) fn fields(&self) -> Vec<String> {
        vec![self.figure.to_owned(), self.caption.to_owned(), self.svg.clone(), self.data.join(" ")]
    }
}

/// The table; `ran` says which experiments there were, `find` gives the run of an experiment and a law.
pub(super) fn table<'a>(
    ran: impl Fn(&str) -> bool,
    find: impl Fn(&str, &str) -> Option<Done<'a>>,
) -> Vec<Row> {
    let claims = claims().into_iter().filter(|claim| ran(claim.experiment));
    claims.map(|claim| Row::of(&claim, |law| find(claim.experiment, law))).collect()
}
