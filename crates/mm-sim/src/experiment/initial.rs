//! Where the robot stands when the run begins.

use mm_model::{Configuration, InverseKinematics, Real, Robot, Velocity};
use nalgebra::Vector3;

use super::trajectory::stop;
use crate::plant::PlantState;
use crate::scenario::{Loaded, ScenarioError};
use crate::trajectory::{Path, Trajectory};

/// At rest in the given or the rest posture, the base at the given pose or at the origin.
pub(super) fn given(loaded: &Loaded, robot: &Robot<f64, 3>) -> PlantState {
    let initial = &loaded.file.initial;
    let [x, y, heading] = initial.base_pose.unwrap_or([0.0; 3]);
    let joints = initial.joints_rad.unwrap_or(robot.params().rest_posture);
    PlantState {
        q: Configuration { x, y, heading, joints },
        nu: Velocity::zero(),
        travel: 0.0,
        yaw_slip: 0.0,
    }
}

/// The trajectory and the start that goes with it.
///
/// Unless the base's pose is given, the tip starts on the reference in x and y, the heading along which the reference sets
/// out (0 where that has no horizontal part); the height is not matched. A `hold` without a point holds the tip where it starts.
pub(super) fn with_trajectory(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
    path: Option<Path>,
) -> Result<(Trajectory, PlantState), ScenarioError> {
    let start_ramp = loaded.file.trajectory.start_ramp_s;
    let stop = stop(&loaded.file);
    let mut start = given(loaded, robot);
    let Some(path) = path else {
        let path = Path::Hold(robot.tip_position(&start.q));
        return Ok((Trajectory { path, start_ramp, stop }, displaced(loaded, robot, start)?));
    };
    if loaded.file.initial.base_pose.is_none() {
        let at = path.at(0.0);
        let ahead = path.departure();
        let (dx, dy) = (ahead.x, ahead.y);
        let moves = dx * dx + dy * dy > 0.0;
        start.q.heading = if moves { Real::atan2(dy, dx) } else { 0.0 };
        let offset = robot.tip_position(&start.q) - Vector3::new(start.q.x, start.q.y, 0.0);
        start.q.x = at.position.x - offset.x;
        start.q.y = at.position.y - offset.y;
    }
    Ok((Trajectory { path, start_ramp, stop }, displaced(loaded, robot, start)?))
}

/// The start with the tip moved by `initial.offset_m`: the base by x and y, the arm by z.
///
/// Joints 2 and 3 alone raise the tip, at the same distance from the axis of joint 1: of the postures of the inverse kinematics
/// that do so within the joint limits, the nearest to the one before.
fn displaced(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
    mut start: PlantState,
) -> Result<PlantState, ScenarioError> {
    let [dx, dy, dz] = loaded.file.initial.offset_m;
    if dz.abs() > 0.0 {
        let tip = robot.tip_position(&start.q) + Vector3::new(0.0, 0.0, dz);
        let before = start.q.joints;
        let turned = |joints: &[f64; 3]| {
            joints
                .iter()
                .zip(&before)
                .map(|(after, before)| Real::wrap_to_pi(after - before).abs())
                .sum::<f64>()
        };
        let solutions = robot.inverse_kinematics(&start.q, &tip);
        let InverseKinematics::Solutions { branches, .. } = solutions else {
            return Err(unreachable(loaded, dz));
        };
        let within = branches.into_iter().filter(|branch| branch.within_limits).map(|branch| branch.joints);
        let nearest = within.min_by(|a, b| turned(a).total_cmp(&turned(b)));
        start.q.joints = nearest.ok_or_else(|| unreachable(loaded, dz))?;
    }
    start.q.x += dx;
    start.q.y += dy;
    Ok(start)
}

fn unreachable(loaded: &Loaded, dz: f64) -> ScenarioError {
    let message = format!("no posture within the joint limits puts the tip {dz} m above where it starts");
    loaded.problem("initial.offset_m", message, "a start that the arm reaches")
}

/// Refuses a start off the reference for a motion that is its own reference.
pub(super) fn refuse_offset(loaded: &Loaded) -> Result<(), ScenarioError> {
    if loaded.file.initial.offset_m.iter().all(|offset| offset.abs() <= 0.0) {
        return Ok(());
    }
    let message = "imposed velocities have no reference to start off";
    Err(loaded.problem("initial.offset_m", message, "no offset, or a reference"))
}
