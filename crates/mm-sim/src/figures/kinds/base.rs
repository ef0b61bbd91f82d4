//! The base: path and velocity.

use mm_model::Real;

use super::parts::{Panels, curve, graph, identity, in_grid, map, timed, virtual_curve};
use super::{Group, Run, Stroke};
use crate::figures::axes::extent;
use crate::figures::page::Curve;

pub(super) fn base_velocity(runs: &[Run<'_>]) -> Panels {
    let mut panels = Vec::new();
    for (number, label) in ["forward (m/s)", "yaw rate (rad/s)"].into_iter().enumerate() {
        let both =
            |run: &Run<'_>| [Group::Velocity, Group::Virtual].map(|g| run.data.column(g, number).to_vec());
        let covers = extent(runs.iter().flat_map(both).flatten());
        for (column, run) in runs.iter().enumerate() {
            let actual = curve(runs, *run, "actual", Group::Velocity, number);
            let actual = Curve { stroke: actual.stroke.alone(), ..actual };
            let curves = vec![actual, virtual_curve(*run, number)];
            panels.push(in_grid((column, runs), label, covers, curves));
        }
    }
    (runs.len(), panels)
}

pub(super) fn base_path(runs: &[Run<'_>]) -> Panels {
    let curve = |run: &Run<'_>| {
        let (name, stroke) = identity(runs, *run, "base (axle)");
        Curve { name, stroke, ..base_curve(*run) }
    };
    (1, vec![map("", runs.iter().map(curve).collect())])
}

pub(super) fn base_world_velocity(runs: &[Run<'_>]) -> Panels {
    let panels = [(0, "base x' (m/s)"), (1, "base y' (m/s)")].map(|(side, label)| {
        let curves = runs.iter().map(|run| {
            let headings = run.data.column(Group::Pose, 2).iter();
            let speeds = run.data.column(Group::Velocity, 0).iter();
            let values: Vec<f64> = headings
                .zip(speeds)
                .map(|(heading, speed)| {
                    let (sin, cos) = Real::sin_cos(*heading);
                    speed * if side == 0 { cos } else { sin }
                })
                .collect();
            let (name, stroke) = identity(runs, *run, "base");
            Curve { name, stroke, points: timed(run.data, &values) }
        });
        graph("", label, curves.collect())
    });
    (1, panels.into())
}

pub(super) fn from_above(runs: &[Run<'_>]) -> Panels {
    let mut curves: Vec<Curve<2>> = runs.iter().map(|run| base_curve(*run)).collect();
    for run in runs {
        let (name, stroke) = identity(runs, *run, "tip");
        let points = run.data.points(Group::Tip).into_iter().map(|[x, y, _]| [x, y]).collect();
        curves.push(Curve { name, stroke, points });
    }
    (1, vec![map("", curves)])
}

fn base_curve(run: Run<'_>) -> Curve<2> {
    let points = run.data.points(Group::Pose).into_iter().map(|[x, y, _]| [x, y]).collect();
    Curve { name: "base (axle)".to_owned(), stroke: Stroke::BASE, points }
}
