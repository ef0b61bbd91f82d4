//! A run at a glance.

use super::parts::{Panels, SIDES, curve, desired, graph, with_values};
use super::{Group, Run};
use crate::figures::page::Curve;

pub(super) fn overview(runs: &[Run<'_>]) -> Panels {
    // Thin, since some laws chatter.
    let curves = |group: Group, number: usize| -> Vec<Curve<2>> {
        let all = runs.iter().map(|run| curve(runs, *run, "actual", group, number));
        all.map(|curve| Curve { stroke: curve.stroke.thin(), ..curve }).collect()
    };
    let mut panels = Vec::new();
    for (side, name) in SIDES.into_iter().enumerate() {
        let mut tip = curves(Group::Tip, side);
        tip.extend(desired(runs, Group::Reference, side));
        panels.push(graph("", &format!("tip {name} (m)"), tip));
        let error = curves(Group::Error, side).into_iter();
        let in_mm = error.map(|curve| with_values(curve, |metres| metres * 1e3)).collect();
        panels.push(graph("", &format!("error {name} (mm)"), in_mm));
        panels.push(graph("", &format!("torque joint {} (N m)", side + 1), curves(Group::Torque, side + 2)));
    }
    panels.push(graph("", "forward (m/s)", curves(Group::Velocity, 0)));
    panels.push(graph("", "yaw rate (rad/s)", curves(Group::Velocity, 1)));
    panels.push(graph("", "manipulability", curves(Group::Manipulability, 0)));
    (3, panels)
}
