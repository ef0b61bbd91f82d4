//! The tip: position, velocity, errors, path.

use mm_model::Real;

use super::parts::{Panels, SIDES, curve, desired, desired_name, graph, identity, time_axis, with_values};
use super::{Group, Run, Stroke};
use crate::figures::axes::extent;
use crate::figures::page::{Axis, Curve, Graph, Panel, Space};

/// Length of the beginning that is shown apart, s.
const START_S: f64 = 2.0;

/// Width of the windows in which compared errors are shown by their largest value, s.
const WINDOW_S: f64 = 0.5;

/// Half of what a position's axis spans at least, m: a height that is held should look so, errors have their own panels.
const LEAST_SPAN_M: f64 = 0.05;

/// Error below which a logarithmic axis ends, mm.
const ERROR_FLOOR_MM: f64 = 1e-4;

pub(super) fn position(runs: &[Run<'_>]) -> Panels {
    let several = runs.len() > 1;
    let mut panels = Vec::new();
    for (side, name) in SIDES.into_iter().enumerate() {
        let label = format!("tip {name} (m)");
        let mut curves: Vec<_> = runs.iter().map(|run| curve(runs, *run, "tip", Group::Tip, side)).collect();
        curves.extend(desired(runs, Group::Reference, side));
        let middle = extent(curves.iter().flat_map(|c| c.points.iter().map(|p| p[1])))
            .map(|(low, high)| 0.5 * (low + high));
        let covers = middle.map(|middle| (middle - LEAST_SPAN_M, middle + LEAST_SPAN_M));
        let y = Axis { covers, ..Axis::new(label) };
        let (title, x) = (String::new(), time_axis());
        panels.push(Panel::Graph(Graph { title, x, y, is_map: false, curves }));
        if several {
            panels.push(worst_error(side, runs));
        }
    }
    (if several { 2 } else { 1 }, panels)
}

/// Three views of an error: its beginning, all of it, and all of it by its logarithm.
pub(super) fn errors(side: usize, runs: &[Run<'_>]) -> [Panel; 3] {
    let in_mm = |change: fn(f64) -> f64| -> Vec<Curve<2>> {
        let curves = runs.iter().map(|run| curve(runs, *run, "error", Group::Error, side));
        curves.map(|curve| with_values(curve, |metres| change(metres) * 1e3)).collect()
    };
    let signed = in_mm(|metres| metres);
    let mut start = signed.clone();
    for curve in &mut start {
        curve.points.retain(|[t, _]| *t <= START_S);
    }
    let label = format!("error {} (mm)", SIDES[side]);
    let y = Axis { floor: Some(ERROR_FLOOR_MM), ..Axis::new(format!("|error {}| (mm)", SIDES[side])) };
    let title = |text: String| if side == 0 { text } else { String::new() };
    [
        graph(&title(format!("first {START_S} s")), &label, start),
        graph(&title("whole run".to_owned()), &label, signed),
        Panel::Graph(Graph {
            title: title("whole run, logarithmic".to_owned()),
            x: time_axis(),
            y,
            is_map: false,
            curves: in_mm(Real::abs),
        }),
    ]
}

/// Errors of several runs, by their largest value in each window: chatter of one would hide the others.
fn worst_error(side: usize, runs: &[Run<'_>]) -> Panel {
    let worst = |run: &Run<'_>| {
        let mut windows: Vec<[f64; 2]> = Vec::new();
        for (t, error) in run.data.time().iter().zip(run.data.column(Group::Error, side)) {
            let middle = ((t / WINDOW_S).floor() + 0.5) * WINDOW_S;
            let size = Real::abs(*error) * 1e3;
            match windows.last_mut().filter(|last| last[0] >= middle) {
                Some(last) => last[1] = f64::max(last[1], size),
                None => windows.push([middle, size]),
            }
        }
        let (name, stroke) = identity(runs, *run, "error");
        Curve { name, stroke, points: windows }
    };
    let label = format!("worst |error {}| (mm)", SIDES[side]);
    let y = Axis { floor: Some(ERROR_FLOOR_MM), ..Axis::new(label) };
    let title = if side == 0 { format!("largest error in each {WINDOW_S} s") } else { String::new() };
    let curves = runs.iter().map(worst).collect();
    Panel::Graph(Graph { title, x: time_axis(), y, is_map: false, curves })
}

pub(super) fn path(runs: &[Run<'_>]) -> Panels {
    let mut curves: Vec<Curve<3>> = runs
        .iter()
        .map(|run| {
            let (name, stroke) = identity(runs, *run, "tip");
            Curve { name, stroke, points: run.data.points(Group::Tip) }
        })
        .collect();
    if let Some(run) = runs.first() {
        let name = desired_name(run.data).to_owned();
        curves.push(Curve { name, stroke: Stroke::DESIRED, points: run.data.points(Group::Reference) });
    }
    (1, vec![Panel::Space(Space { title: String::new(), curves })])
}

pub(super) fn tip_velocity(runs: &[Run<'_>]) -> Panels {
    let panel = |side: usize| {
        let mut curves: Vec<_> =
            runs.iter().map(|run| curve(runs, *run, "tip", Group::TipVelocity, side)).collect();
        curves.extend(desired(runs, Group::ReferenceVelocity, side));
        graph("", &format!("tip {}' (m/s)", SIDES[side]), curves)
    };
    (1, (0..3).map(panel).collect())
}
