//! `[trajectory]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// What the tip of the arm (or, open loop, the whole robot) shall do.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Trajectory {
    /// Time over which the reference is brought up to its speed; 0 starts at once.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub start_ramp_s: f64,
    /// Time over which the reference comes to rest again; 0 does not stop it.
    #[serde(default)]
    #[schemars(with = "NonNegative")]
    pub stop_ramp_s: f64,
    /// When the reference rests, with `stop_ramp_s`. Default: at the end of the run.
    #[schemars(with = "Option<Positive>")]
    pub stop_at_s: Option<f64>,
    /// Runs although the arm cannot reach the reference's height.
    #[serde(default)]
    pub allow_unreachable: bool,
    /// The path and its own keys.
    #[serde(flatten)]
    pub motion: Motion,
}

/// The path and its own keys.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Motion {
    /// The rounded square wave of Appendix B, in the plane z = 0.5 m.
    Square {
        /// Time over which the motion is averaged, from exact constants: its joints are blended to continuous acceleration with
        /// a bounded jerk, 0.2 m/s^3 for 0.5 s and inversely with the time. 0 leaves the printed square with its jumps.
        #[serde(default)]
        #[schemars(with = "NonNegative")]
        smoothing_s: f64,
    },
    /// The three-dimensional sinusoid (5.1) to (5.3).
    Sinusoid,
    /// The three-dimensional spiral (5.4) to (5.6).
    Spiral,
    /// A point that jumps once, with zero derivatives before and after.
    Step {
        /// The point before the step, in the world frame.
        from_m: [f64; 3],
        /// The jump.
        by_m: [f64; 3],
        /// Time of the jump.
        #[schemars(with = "NonNegative")]
        at_s: f64,
    },
    /// A straight line at constant velocity.
    Line {
        /// The point at time zero, in the world frame.
        from_m: [f64; 3],
        /// The velocity, in the world frame.
        velocity_m_s: [f64; 3],
    },
    /// A horizontal circle at constant speed.
    Circle {
        /// The centre, in the world frame.
        center_m: [f64; 3],
        /// The radius.
        #[schemars(with = "Positive")]
        radius_m: f64,
        /// The speed, counter-clockwise positive.
        speed_m_s: f64,
        /// The angle of the point at time zero, from the x axis.
        #[serde(default)]
        start_angle_rad: f64,
    },
    /// A point that rests.
    Hold {
        /// The point, in the world frame. Default: the tip at the start.
        point_m: Option<[f64; 3]>,
    },
    /// Points in the world frame, from rest to rest within limits of the tip's speed, acceleration and jerk; the tip waits at
    /// the last one.
    Waypoints {
        /// The points in order, at least 2 and none twice in a row; excludes `file`.
        #[schemars(length(min = 2))]
        points_m: Option<Vec<[f64; 3]>>,
        /// A CSV file of points under the header `x_m,y_m,z_m`, or a TOML file whose one key is `points_m`, sought in the folder
        /// of the scenario file; a name given by `--set` is sought from the working directory.
        file: Option<String>,
        /// How the points are joined.
        #[serde(default)]
        path: WaypointPath,
        /// Largest speed.
        #[schemars(with = "Positive")]
        speed_m_s: f64,
        /// Largest acceleration, along the path and across it together.
        #[schemars(with = "Positive")]
        acceleration_m_s2: f64,
        /// Largest jerk.
        #[schemars(with = "Positive")]
        jerk_m_s3: f64,
    },
    /// Velocities imposed on the robot, open loop; for the controller kind `none`.
    Velocities {
        /// The velocities, piece by piece; after the last piece the robot rests.
        #[schemars(length(min = 1))]
        segment: Vec<Segment>,
    },
}

/// How points are joined.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, JsonSchema, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum WaypointPath {
    /// One curve with continuous curvature, passed without a stop.
    #[default]
    Spline,
    /// Straight lines, with a stop at each point.
    Lines,
}

/// A file of points.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "what is read from the file goes where `trajectory.points_m` stands")]
pub(in crate::scenario) struct WaypointFile {
    /// The points in order, in the world frame.
    #[schemars(length(min = 2))]
    points_m: Vec<[f64; 3]>,
}

/// Constant velocities until a time.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Segment {
    /// The end of the piece, after the end of the one before.
    #[schemars(with = "Positive")]
    pub until_s: f64,
    /// Forward speed of the base.
    #[serde(default)]
    pub forward_m_s: f64,
    /// Yaw rate of the base, counter-clockwise positive.
    #[serde(default)]
    pub yaw_rate_rad_s: f64,
    /// Rates of the joints from the base to the tip.
    #[serde(default)]
    pub joint_rates_rad_s: [f64; 3],
}
