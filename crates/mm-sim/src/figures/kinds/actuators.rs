//! Joints and wheels: angles, rates, torques, and what disturbs them.

use mm_model::Real;

use super::parts::{Panels, curve, graph, in_grid, timed, virtual_curve};
use super::{Group, Run, Stroke};
use crate::figures::axes::extent;
use crate::figures::page::Curve;

/// An actuator: its number among the torques and its name.
pub(super) type Actuator = (usize, &'static str);

pub(super) const WHEELS: [Actuator; 2] = [(0, "right wheel"), (1, "left wheel")];

pub(super) const ARM: [Actuator; 3] = [(2, "joint 1"), (3, "joint 2"), (4, "joint 3")];

pub(super) fn joints(runs: &[Run<'_>]) -> Panels {
    let mut panels = Vec::new();
    for joint in 0..3 {
        let angle = runs.iter().map(|run| curve(runs, *run, "actual", Group::Joints, joint)).collect();
        panels.push(graph("", &format!("joint {} (rad)", joint + 1), angle));
        let mut rates: Vec<_> =
            runs.iter().map(|run| curve(runs, *run, "actual", Group::Velocity, joint + 2)).collect();
        rates.extend(runs.iter().map(|run| virtual_curve(*run, joint + 2)));
        panels.push(graph("", &format!("joint {} rate (rad/s)", joint + 1), rates));
    }
    (2, panels)
}

pub(super) fn torques(actuators: &[Actuator], runs: &[Run<'_>]) -> Panels {
    let mut panels = Vec::new();
    for &(number, name) in actuators {
        let covers =
            extent(runs.iter().flat_map(|run| run.data.column(Group::Torque, number).iter().copied()));
        for (column, run) in runs.iter().enumerate() {
            let only = curve(runs, *run, "torque", Group::Torque, number);
            let only = Curve { stroke: only.stroke.thin(), ..only };
            panels.push(in_grid((column, runs), &format!("{name} (N m)"), covers, vec![only]));
        }
    }
    (runs.len(), panels)
}

/// One panel for each disturbance, those of actuators pushed alike together. All runs of an experiment have the same ones.
pub(super) fn disturbance(runs: &[Run<'_>]) -> Panels {
    let Some(run) = runs.first() else { return (1, Vec::new()) };
    let column = |actuator: &Actuator| run.data.column(Group::Disturbance, actuator.0);
    // What the map to forces and back leaves is rounding.
    let is_pushed = |a: &Actuator| column(a).iter().any(|torque| Real::abs(*torque) > 1e-9);
    let mut groups: Vec<Vec<Actuator>> = Vec::new();
    for actuator in WHEELS.into_iter().chain(ARM).filter(is_pushed) {
        let alike = groups.iter_mut().find(|group| group.first().map(column) == Some(column(&actuator)));
        match alike {
            Some(group) => group.push(actuator),
            None => groups.push(vec![actuator]),
        }
    }
    if groups.is_empty() {
        groups.push(ARM.to_vec());
    }
    let panel = |group: &Vec<Actuator>| {
        let names: Vec<&str> = group.iter().map(|(_, name)| *name).collect();
        let number = group.first().map_or(0, |(number, _)| *number);
        let points = timed(run.data, run.data.column(Group::Disturbance, number));
        let curve = Curve { name: "disturbance".to_owned(), stroke: Stroke::only("none"), points };
        graph(&names.join(", "), "torque (N m)", vec![curve])
    };
    (1, groups.iter().map(panel).collect())
}
