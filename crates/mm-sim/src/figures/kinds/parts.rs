//! Curves and panels that the kinds are made of.

use super::{Group, Run, Stroke};
use crate::figures::page::{Axis, Curve, Graph, Panel};
use crate::figures::recording::Recording;

pub(super) type Panels = (usize, Vec<Panel>);

pub(super) const SIDES: [&str; 3] = ["x", "y", "z"];

/// Name and stroke of a run's curve: of what it shows for a run alone, of its law among several.
pub(super) fn identity(runs: &[Run<'_>], run: Run<'_>, alone: &str) -> (String, Stroke) {
    if runs.len() > 1 {
        let number = runs.iter().position(|other| other.name == run.name).unwrap_or_default();
        (run.name.to_owned(), Stroke::of_run(run.name, number))
    } else {
        (alone.to_owned(), Stroke::only(run.name))
    }
}

pub(super) fn curve(runs: &[Run<'_>], run: Run<'_>, alone: &str, group: Group, number: usize) -> Curve<2> {
    let (name, stroke) = identity(runs, run, alone);
    Curve { name, stroke, points: timed(run.data, run.data.column(group, number)) }
}

pub(super) fn virtual_curve(run: Run<'_>, number: usize) -> Curve<2> {
    let points = timed(run.data, run.data.column(Group::Virtual, number));
    Curve { name: "virtual velocity".to_owned(), stroke: Stroke::DESIRED, points }
}

/// The reference, which all runs of an experiment share.
pub(super) fn desired(runs: &[Run<'_>], group: Group, side: usize) -> Option<Curve<2>> {
    let run = runs.first()?;
    let points = timed(run.data, run.data.column(group, side));
    Some(Curve { name: desired_name(run.data).to_owned(), stroke: Stroke::DESIRED, points })
}

pub(super) const fn desired_name(data: &Recording) -> &'static str {
    if data.is_imposed() { "closed form" } else { "desired" }
}

pub(super) fn timed(data: &Recording, values: &[f64]) -> Vec<[f64; 2]> {
    data.time().iter().zip(values).map(|(t, value)| [*t, *value]).collect()
}

pub(super) fn with_values(mut curve: Curve<2>, change: impl Fn(f64) -> f64) -> Curve<2> {
    for [_, value] in &mut curve.points {
        *value = change(*value);
    }
    curve
}

pub(super) fn time_axis() -> Axis {
    Axis::new("time (s)")
}

pub(super) fn graph(title: &str, label: &str, curves: Vec<Curve<2>>) -> Panel {
    let (x, y) = (time_axis(), Axis::new(label));
    Panel::Graph(Graph { title: title.to_owned(), x, y, is_map: false, curves })
}

/// A panel of a grid with a column for each run and one scale in each row.
pub(super) fn in_grid(
    (column, runs): (usize, &[Run<'_>]),
    label: &str,
    covers: Option<(f64, f64)>,
    curves: Vec<Curve<2>>,
) -> Panel {
    let title = if runs.len() > 1 { runs.get(column).map_or("", |run| run.name) } else { "" };
    let y = Axis { covers, ..Axis::new(label) };
    Panel::Graph(Graph { title: title.to_owned(), x: time_axis(), y, is_map: false, curves })
}

pub(super) fn map(title: &str, curves: Vec<Curve<2>>) -> Panel {
    let (x, y) = (Axis::new("x (m)"), Axis::new("y (m)"));
    Panel::Graph(Graph { title: title.to_owned(), x, y, is_map: true, curves })
}
