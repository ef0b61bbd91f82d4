//! What can be shown of a run, or of several runs side by side.

mod actuators;
mod base;
mod overview;
mod parts;
mod tip;

use actuators::{ARM, WHEELS, disturbance, joints, torques};
use base::{base_path, base_velocity, base_world_velocity, from_above};
use overview::overview;
use tip::{errors, path, position, tip_velocity};

use super::page::Page;
use super::recording::{Group, Recording};
use super::style::Stroke;

/// A run to show.
#[derive(Debug, Clone, Copy)]
pub struct Run<'a> {
    /// Its law, or `none`.
    pub name: &'a str,
    /// Its samples.
    pub data: &'a Recording,
}

/// A kind of picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Tip, error, torques and velocity of the base, runs over each other.
    Overview,
    /// Tip and reference along x, y and z; for several runs the errors beside them.
    Position,
    /// Joint angles, and joint rates with the virtual rates that they should follow.
    Joints,
    /// Torques of the joints, a column for each run.
    JointTorques,
    /// Forward speed and yaw rate with the virtual ones, a column for each run.
    BaseVelocity,
    /// Torques of the wheels, a column for each run.
    WheelTorques,
    /// Error of the tip along x, y and z: its beginning, all of it, and its logarithm.
    Errors,
    /// Path of the tip in space.
    Path,
    /// Disturbance torques.
    Disturbance,
    /// Path of the base seen from above.
    BasePath,
    /// Velocity of the base along x and y of the world.
    BaseWorldVelocity,
    /// Velocity of the tip along x, y and z.
    TipVelocity,
    /// Paths of base and tip seen from above.
    FromAbove,
}

impl Kind {
    /// All of them with their names on the command line.
    pub const ALL: [(Self, &'static str); 13] = [
        (Self::Overview, "overview"),
        (Self::Position, "position"),
        (Self::Joints, "joints"),
        (Self::JointTorques, "joint-torques"),
        (Self::BaseVelocity, "base-velocity"),
        (Self::WheelTorques, "wheel-torques"),
        (Self::Errors, "errors"),
        (Self::Path, "path"),
        (Self::Disturbance, "disturbance"),
        (Self::BasePath, "base-path"),
        (Self::BaseWorldVelocity, "base-world-velocity"),
        (Self::TipVelocity, "tip-velocity"),
        (Self::FromAbove, "from-above"),
    ];

    /// The picture of some runs.
    #[must_use]
    pub fn page(self, title: impl Into<String>, runs: &[Run<'_>]) -> Page {
        let (columns, panels) = match self {
            Self::Overview => overview(runs),
            Self::Position => position(runs),
            Self::Joints => joints(runs),
            Self::JointTorques => torques(&ARM, runs),
            Self::WheelTorques => torques(&WHEELS, runs),
            Self::BaseVelocity => base_velocity(runs),
            Self::Errors => (3, (0..3).flat_map(|side| errors(side, runs)).collect()),
            Self::Path => path(runs),
            Self::Disturbance => disturbance(runs),
            Self::BasePath => base_path(runs),
            Self::BaseWorldVelocity => base_world_velocity(runs),
            Self::TipVelocity => tip_velocity(runs),
            Self::FromAbove => from_above(runs),
        };
        Page { title: title.into(), columns, panels }
    }
}
