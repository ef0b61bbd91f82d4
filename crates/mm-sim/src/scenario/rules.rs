//! Rules between keys, which a schema cannot say.

mod fault;

use super::diagnostic::Problem;
use super::tree::{Node, Value};
use super::types::DEFAULT_PERIOD_S;

/// Relative error up to which one period counts as a whole multiple of another.
const MULTIPLE_TOLERANCE: f64 = 1e-9;

/// Returns every broken rule. Values that do not even fit the schema are passed over.
pub(super) fn check(root: &Node) -> Vec<Problem> {
    let mut problems = Vec::new();
    name(root, &mut problems);
    clock(root, &mut problems);
    exclusive(root, &mut problems);
    joint_limits(root, "robot.link", &mut problems);
    segments(root, &mut problems);
    imposed(root, &mut problems);
    waypoints(root, &mut problems);
    ramps(root, &mut problems);
    hardware(root, &mut problems);
    for (index, disturbance) in items(root, "disturbance").iter().enumerate() {
        one_disturbance(disturbance, index, &mut problems);
    }
    fault::check(root, &mut problems);
    range(root, "tune.bounds", &mut problems);
    drawn_delay(root, &mut problems);
    if let Some(expect) = root.find("expect") {
        bounds(expect, "expect", &mut problems);
    }
    problems
}

/// Checks what a robot file alone can break.
pub(super) fn check_robot(root: &Node) -> Vec<Problem> {
    let mut problems = Vec::new();
    joint_limits(root, "link", &mut problems);
    problems
}

fn items<'a>(root: &'a Node, key: &str) -> &'a [Node] {
    root.find(key).map_or(&[], Node::items)
}

fn positive(root: &Node, key: &str) -> Option<f64> {
    root.number(key).filter(|value| *value > 0.0)
}

/// Of the name of a run, which file names are made of: most file systems take 255 bytes, 55 are for controller and endings.
const MAX_NAME_BYTES: usize = 200;

fn name(root: &Node, problems: &mut Vec<Problem>) {
    let Some(node) = root.find("name") else { return };
    let Some(text) = node.as_str() else { return };
    if text.len() > MAX_NAME_BYTES {
        let found = format!("{} bytes long", text.len());
        let expected = format!("at most {MAX_NAME_BYTES} bytes, as file systems count");
        problems.push(Problem::new("name", found, node.place.clone()).expected(expected));
    }
    if text.starts_with('.') || text.contains(|c: char| c == '/' || c == '\\' || c.is_control()) {
        problems.push(
            Problem::new("name", "not a file name", node.place.clone())
                .expected("no `/`, `\\` or control character and no leading dot"),
        );
    }
}

fn clock(root: &Node, problems: &mut Vec<Problem>) {
    // A key that is absent has its default; one that is out of range is reported by the schema.
    let period_or_default = |key: &str| match root.find(key) {
        Some(_) => positive(root, key),
        None => Some(DEFAULT_PERIOD_S),
    };
    let Some(period) = period_or_default("simulation.control_period_s") else { return };
    if let Some(step) = period_or_default("simulation.plant_step_s") {
        let steps = period / step;
        let whole = steps.round();
        if !steps.is_finite() || whole < 1.0 || (steps - whole).abs() > MULTIPLE_TOLERANCE * whole {
            let key = "simulation.plant_step_s";
            problems.push(
                Problem::new(
                    key,
                    format!("found {step}, which does not divide the control period"),
                    root.place_of(key),
                )
                .expected(format!("control_period_s = {period} over a whole number")),
            );
        }
    }
    if let Some(duration) = positive(root, "simulation.duration_s")
        && duration < period * (1.0 - MULTIPLE_TOLERANCE)
    {
        let key = "simulation.duration_s";
        problems.push(
            Problem::new(
                key,
                format!("found {duration}, shorter than one control period"),
                root.place_of(key),
            )
            .expected(format!("at least {period}")),
        );
    }
}

fn exclusive(root: &Node, problems: &mut Vec<Problem>) {
    for (one, other) in [
        ("robot.preset", "robot.file"),
        ("initial.base_pose", "initial.tip"),
        ("trajectory.points_m", "trajectory.file"),
    ] {
        if root.find(one).is_some() && root.find(other).is_some() {
            problems.push(
                Problem::new(other, format!("given together with `{one}`"), root.place_of(other))
                    .expected("only one of the two"),
            );
        }
    }
}

fn joint_limits(root: &Node, links: &str, problems: &mut Vec<Problem>) {
    for (index, link) in items(root, links).iter().enumerate() {
        if let [lo, hi] = items(link, "joint_limit_rad")
            && let (Some(lo), Some(hi)) = (lo.as_number(), hi.as_number())
            && lo >= hi
        {
            let key = format!("{links}.{index}.joint_limit_rad");
            let place = link.place_of("joint_limit_rad");
            problems.push(
                Problem::new(&key, format!("found [{lo}, {hi}]"), place)
                    .expected("[lo, hi] with lo below hi"),
            );
        }
    }
}

/// Two numbers of which the first is to be the smaller.
fn range(root: &Node, key: &str, problems: &mut Vec<Problem>) {
    if let [lo, hi] = items(root, key)
        && let (Some(lo), Some(hi)) = (lo.as_number(), hi.as_number())
        && lo >= hi
    {
        problems.push(
            Problem::new(key, format!("found [{lo}, {hi}]"), root.place_of(key))
                .expected("[lo, hi] with lo below hi"),
        );
    }
}

fn segments(root: &Node, problems: &mut Vec<Problem>) {
    let mut last = 0.0;
    for (index, segment) in items(root, "trajectory.segment").iter().enumerate() {
        let Some(until) = positive(segment, "until_s") else { continue };
        if until <= last {
            let key = format!("trajectory.segment.{index}.until_s");
            problems.push(
                Problem::new(&key, format!("found {until}"), segment.place_of("until_s"))
                    .expected(format!("more than the {last} of the piece before")),
            );
        }
        last = until;
    }
}

fn imposed(root: &Node, problems: &mut Vec<Problem>) {
    let kind = |key: &str| root.find(key).and_then(Node::as_str);
    if kind("controller.kind") == Some("none")
        && let Some(trajectory) = kind("trajectory.kind")
        && trajectory != "velocities"
    {
        let message = format!("found \"none\" with trajectory.kind = \"{trajectory}\"");
        problems.push(
            Problem::new("controller.kind", message, root.place_of("controller.kind"))
                .expected("`none` only with imposed `velocities`"),
        );
    }
}

fn waypoints(root: &Node, problems: &mut Vec<Problem>) {
    let is_waypoints = root.find("trajectory.kind").and_then(Node::as_str) == Some("waypoints");
    if is_waypoints && root.find("trajectory.points_m").or(root.find("trajectory.file")).is_none() {
        let key = "trajectory.points_m";
        problems.push(
            Problem::new(key, "missing key", root.place_of(key)).expected("an array of points, or `file`"),
        );
    }
}

/// A stop needs its ramp and the time for both ramps; a motion that has its own beginning and end takes neither.
fn ramps(root: &Node, problems: &mut Vec<Problem>) {
    let mut report = |key: &str, message: String, expected: String| {
        problems.push(Problem::new(key, message, root.place_of(key)).expected(expected));
    };
    let kind = root.find("trajectory.kind").and_then(Node::as_str);
    if let Some(kind @ ("velocities" | "waypoints")) = kind {
        for key in ["trajectory.start_ramp_s", "trajectory.stop_ramp_s", "trajectory.stop_at_s"] {
            if root.find(key).is_some() {
                let message = format!("no ramp goes with kind = \"{kind}\"");
                report(key, message, "none: the motion has its own beginning and end".to_owned());
            }
        }
        return;
    }
    let ramp = |key: &str| root.number(key).filter(|value| *value >= 0.0).unwrap_or(0.0);
    let (start, stop) = (ramp("trajectory.start_ramp_s"), ramp("trajectory.stop_ramp_s"));
    let at_key = "trajectory.stop_at_s";
    if root.find(at_key).is_some() && stop <= 0.0 {
        report(at_key, "given without `trajectory.stop_ramp_s`".to_owned(), "both or none".to_owned());
        return;
    }
    let (key, at) = match root.find(at_key) {
        Some(_) => (at_key, positive(root, at_key)),
        None => ("trajectory.stop_ramp_s", positive(root, "simulation.duration_s")),
    };
    if let Some(at) = at
        && stop > 0.0
        && at < start + stop
    {
        let message = format!("rest at {at} s leaves no time for ramps of {start} and {stop} s");
        report(key, message, format!("rest at {} s or later", start + stop));
    }
}

/// Rules of the payload and the sensors.
fn hardware(root: &Node, problems: &mut Vec<Problem>) {
    let from = root.number("plant.payload_from_s").unwrap_or(0.0);
    if let Some(to) = positive(root, "plant.payload_to_s")
        && to <= from
    {
        let key = "plant.payload_to_s";
        problems.push(
            Problem::new(key, format!("found {to}"), root.place_of(key))
                .expected(format!("more than payload_from_s = {from}")),
        );
    }
    if root.find("plant.sensors.pose_source").and_then(Node::as_str) == Some("odometry") {
        for name in
            ["position_resolution_m", "position_noise_m", "heading_resolution_rad", "heading_noise_rad"]
        {
            let key = format!("plant.sensors.{name}");
            if root.find(&key).is_some() {
                problems.push(
                    Problem::new(&key, "not a key of pose_source = \"odometry\"", root.place_of(&key))
                        .expected("`wheel_bits`, which make the error of an odometry"),
                );
            }
        }
    }
}

/// A delay that is drawn may be none, and sensors without any key need no estimator: samples would be of two kinds.
fn drawn_delay(root: &Node, problems: &mut Vec<Problem>) {
    let key = "sweep.delay_periods";
    let has_sensors = root
        .find("plant.sensors")
        .and_then(Node::as_table)
        .is_some_and(|keys| keys.keys().any(|name| name != "delay_periods"));
    let estimates = match root.find("controller.estimator.kind") {
        Some(kind) => kind.as_str() != Some("none"),
        None => has_sensors,
    };
    if positive(root, key).is_some() && !estimates {
        problems.push(Problem::new(key, "a delay of what no sensor reads", root.place_of(key)).expected(
            "a scenario with another key of `[plant.sensors]`, or with `controller.estimator.kind`",
        ));
    }
}

fn one_disturbance(disturbance: &Node, index: usize, problems: &mut Vec<Problem>) {
    let mut report = |name: &str, message: &str, expected: &str| {
        let key = format!("disturbance.{index}.{name}");
        problems.push(Problem::new(&key, message, disturbance.place_of(name)).expected(expected));
    };
    let from = disturbance.number("from_s").unwrap_or(0.0);
    if let Some(to) = positive(disturbance, "to_s")
        && to <= from
    {
        report("to_s", &format!("found {to}"), &format!("more than from_s = {from}"));
    }
    let Some(target) = disturbance.find("on").and_then(Node::as_str) else { return };
    let own: &[&str] = match target {
        "tip" => &["amplitude_n", "direction"],
        "slip-forward" | "slip-sideways" => &["amplitude_m_s"],
        "slip-yaw" => &["amplitude_rad_s"],
        _ => &["amplitude_n_m"],
    };
    for name in ["amplitude_n_m", "amplitude_n", "direction", "amplitude_m_s", "amplitude_rad_s"] {
        let is_given = disturbance.find(name).is_some();
        let is_own = own.contains(&name);
        if is_given && !is_own {
            let right = own.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" and ");
            report(name, &format!("not a key of on = \"{target}\""), &right);
        } else if !is_given && is_own {
            report(name, "missing key", &format!("a value, since on = \"{target}\""));
        }
    }
    let direction = items(disturbance, "direction");
    if !direction.is_empty()
        && direction.iter().all(|part| part.as_number().is_some_and(|part| part.abs() <= 0.0))
    {
        report("direction", "found no direction", "a part that is not zero");
    }
}

fn bounds(node: &Node, key: &str, problems: &mut Vec<Problem>) {
    if let (Some(min), Some(max)) = (node.number("min"), node.number("max"))
        && min > max
    {
        problems.push(
            Problem::new(key, format!("found min = {min} above max = {max}"), node.place.clone())
                .expected("min not above max"),
        );
    }
    match &node.value {
        Value::Table(table) => {
            for (name, entry) in table {
                bounds(&entry.node, &format!("{key}.{name}"), problems);
            }
        }
        Value::Array(entries) => {
            for (index, entry) in entries.iter().enumerate() {
                bounds(entry, &format!("{key}.{index}"), problems);
            }
        }
        _ => {}
    }
}
