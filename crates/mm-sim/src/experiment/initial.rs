//! Where the robot stands when the run begins.

use mm_model::{Configuration, Real, Robot, Velocity};
use nalgebra::Vector3;

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
/// Unless the base's pose is given, the tip starts on the reference in x and y, the heading along the reference's velocity
/// (0 where that has no horizontal part); the height is not matched. A `hold` without a point holds the tip where it starts.
pub(super) fn with_trajectory(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
    path: Option<Path>,
) -> Result<(Trajectory, PlantState), ScenarioError> {
    let start_ramp = loaded.file.trajectory.start_ramp_s;
    let mut start = given(loaded, robot);
    let Some(path) = path else {
        let path = Path::Hold(robot.tip_position(&start.q));
        return Ok((Trajectory { path, start_ramp }, start));
    };
    if loaded.file.initial.base_pose.is_none() {
        let at = path.at(0.0);
        let (dx, dy) = (at.velocity.x, at.velocity.y);
        let moves = dx * dx + dy * dy > 0.0;
        start.q.heading = if moves { Real::atan2(dy, dx) } else { 0.0 };
        let offset = robot.tip_position(&start.q) - Vector3::new(start.q.x, start.q.y, 0.0);
        start.q.x = at.position.x - offset.x;
        start.q.y = at.position.y - offset.y;
    }
    Ok((Trajectory { path, start_ramp }, start))
}
