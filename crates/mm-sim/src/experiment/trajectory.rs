//! The reference path of a scenario.

use std::sync::Arc;

use mm_model::Robot;
use nalgebra::Vector3;

use crate::scenario::{self, Loaded, Motion, ScenarioError};
use crate::simulation::Clock;
use crate::trajectory::{Joined, Limits, MIN_DISTANCE, Path, Stop, Trajectory, WaypointError, Waypoints};

/// The path that the file describes; none where it holds the start or imposes velocities.
pub(super) fn path(loaded: &Loaded) -> Result<Option<Path>, ScenarioError> {
    let vector = |v: [f64; 3]| Vector3::from(v);
    Ok(Some(match &loaded.file.trajectory.motion {
        Motion::Square { smoothing_s } if *smoothing_s > 0.0 => Path::SmoothSquare { window: *smoothing_s },
        Motion::Square { .. } => Path::Square,
        Motion::Sinusoid => Path::Sinusoid,
        Motion::Spiral => Path::Spiral,
        Motion::Step { from_m, by_m, at_s } => {
            Path::Step { from: vector(*from_m), by: vector(*by_m), at: *at_s }
        }
        Motion::Line { from_m, velocity_m_s } => {
            Path::Line { from: vector(*from_m), velocity: vector(*velocity_m_s) }
        }
        Motion::Circle { center_m, radius_m, speed_m_s, start_angle_rad } => Path::Circle {
            center: vector(*center_m),
            radius: *radius_m,
            rate: speed_m_s / radius_m,
            start: *start_angle_rad,
        },
        Motion::Hold { point_m } => return Ok(point_m.map(|point| Path::Hold(vector(point)))),
        Motion::Waypoints { points_m, path, speed_m_s, acceleration_m_s2, jerk_m_s3, .. } => {
            let points: Vec<Vector3<f64>> = points_m.iter().flatten().copied().map(Vector3::from).collect();
            let joined = match path {
                scenario::WaypointPath::Spline => Joined::Spline,
                scenario::WaypointPath::Lines => Joined::Lines,
            };
            let limits = Limits { speed: *speed_m_s, acceleration: *acceleration_m_s2, jerk: *jerk_m_s3 };
            let motion = Waypoints::try_new(&points, joined, limits);
            Path::Waypoints(Arc::new(motion.map_err(|error| refused(loaded, error))?))
        }
        Motion::Velocities { .. } => return Ok(None),
    }))
}

/// The place of what makes no motion through points.
fn refused(loaded: &Loaded, error: WaypointError) -> ScenarioError {
    let (key, expected) = match error {
        WaypointError::Same(index) => {
            (format!("trajectory.points_m.{index}"), format!("another point, {MIN_DISTANCE} m away or more"))
        }
        WaypointError::NonFinite(index) => {
            (format!("trajectory.points_m.{index}"), "finite numbers".to_owned())
        }
        WaypointError::Limit("speed") => ("trajectory.speed_m_s".to_owned(), "a number above 0".to_owned()),
        WaypointError::Limit("jerk") => ("trajectory.jerk_m_s3".to_owned(), "a number above 0".to_owned()),
        WaypointError::Limit(_) => ("trajectory.acceleration_m_s2".to_owned(), "a number above 0".to_owned()),
        _ => (
            "trajectory.points_m".to_owned(),
            "at least 2 points, and limits in proportion to them".to_owned(),
        ),
    };
    loaded.problem(&key, error.to_string(), expected)
}

/// How the reference comes to rest; it does not unless a ramp is given.
pub(super) fn stop(file: &scenario::ScenarioFile) -> Option<Stop> {
    let ramp = file.trajectory.stop_ramp_s;
    let at = file.trajectory.stop_at_s.unwrap_or(file.simulation.duration_s);
    (ramp > 0.0).then_some(Stop { at, ramp })
}

/// Refuses a trajectory that leaves the heights that some posture within the joint limits reaches.
pub(super) fn check_heights(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
    trajectory: &Trajectory,
    clock: &Clock,
) -> Result<(), ScenarioError> {
    if loaded.file.trajectory.allow_unreachable {
        return Ok(());
    }
    let (low, high) = robot.tip_height_range();
    let beyond = heights(trajectory, clock).find(|(_, height)| is_beyond(*height, (low, high)));
    let Some((t, height)) = beyond else { return Ok(()) };
    let key = match loaded.file.trajectory.motion {
        Motion::Step { .. } => "trajectory.by_m",
        Motion::Line { .. } => "trajectory.velocity_m_s",
        Motion::Circle { .. } => "trajectory.center_m",
        Motion::Hold { .. } => "trajectory.point_m",
        Motion::Waypoints { .. } => &waypoint_beyond(loaded, (low, high)),
        _ => "trajectory.kind",
    };
    let message = format!("at t = {t:.3} s the tip should be {height:.6} m high, which no posture reaches");
    // Rounded inwards: what is printed is within reach, and at the edge differs from what is refused.
    let (low, high) = ((low * 1e6).ceil() / 1e6, (high * 1e6).floor() / 1e6);
    let expected = format!("a height from {low:.6} to {high:.6} m, or `allow_unreachable = true`");
    Err(loaded.problem(key, message, expected))
}

/// What a user should know of a reference over the time simulated.
pub(super) fn warnings(
    robot: &Robot<f64, 3>,
    trajectory: &Trajectory,
    clock: &Clock,
    simulated_s: f64,
) -> Vec<String> {
    let mut all = Vec::new();
    let range = robot.tip_height_range();
    let (mut seen, mut beyond, mut when) = (0_u32, 0_u32, None);
    for (t, height) in heights(trajectory, clock).take_while(|(t, _)| *t <= simulated_s) {
        seen += 1;
        if is_beyond(height, range) {
            beyond += 1;
            let (first, _) = when.unwrap_or((t, t));
            when = Some((first, t));
        }
    }
    if let Some((first, last)) = when {
        let percent = 100.0 * f64::from(beyond) / f64::from(seen);
        all.push(format!(
            "the reference was beyond the arm's reach in height for {percent:.1} % of the run, \
             first at t = {first:.3} s, last at t = {last:.3} s"
        ));
    }
    let run = clock.duration();
    if let Some(motion) = trajectory.motion_duration()
        && motion > run + 1e-9
    {
        all.push(format!(
            "the motion through the way points takes {motion:.3} s; the run ends after {run:.3} s"
        ));
    }
    all
}

/// Times of a run, some ten thousand of them with the last tick, and the heights of the reference there, s and m.
fn heights(trajectory: &Trajectory, clock: &Clock) -> impl Iterator<Item = (f64, f64)> {
    let step = usize::try_from((clock.ticks / 10_000).max(1)).unwrap_or(1);
    let last = clock.ticks.saturating_sub(1);
    let ticks = (0..last).step_by(step).chain((clock.ticks > 0).then_some(last));
    ticks.map(|tick| clock.time(tick)).map(|t| (t, trajectory.at(t).position.z))
}

/// Whether no posture within the joint limits reaches a height, but for rounding.
fn is_beyond(height: f64, (low, high): (f64, f64)) -> bool {
    height < low - 1e-9 || height > high + 1e-9
}

/// The first point out of reach, or all of them where only the curve between them is.
fn waypoint_beyond(loaded: &Loaded, range: (f64, f64)) -> String {
    let all = "trajectory.points_m";
    let Motion::Waypoints { points_m, .. } = &loaded.file.trajectory.motion else { return all.to_owned() };
    let beyond = points_m.iter().flatten().position(|[_, _, z]| is_beyond(*z, range));
    beyond.map_or_else(|| all.to_owned(), |index| format!("{all}.{index}"))
}
