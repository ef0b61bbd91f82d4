//! What frames carry.

use heapless::String;
use mm_control::supervisor::{Findings, Mode, Timing};
use mm_control::{Measurement, Reference};
use mm_model::{Configuration, Torque, Velocity};
use serde::{Deserialize, Serialize};

use crate::{Scalar, Stages};

/// What the controller sees at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar", deserialize = "T: Scalar"))]
pub enum Seen<T> {
    /// Configuration and velocity.
    State {
        /// Configuration.
        q: Configuration<T, 3>,
        /// Quasi-velocities.
        nu: Velocity<T, 3>,
    },
    /// What sensors read; for a stack with an estimator.
    Measured(Measurement<T, 3>),
}

/// One update of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar", deserialize = "T: Scalar"))]
pub struct Tick<T> {
    /// Time as the host sees it: since its update before, and the input's age.
    pub timing: Timing<T>,
    /// What is seen.
    pub seen: Seen<T>,
    /// Where the tip should be.
    pub reference: Reference<T>,
}

/// What the target does until the next tick.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Scalar", deserialize = "T: Scalar"))]
pub struct Command<T> {
    /// Torque, within the robot's limits.
    pub torque: Torque<T, 3>,
    /// What the supervisor does.
    pub mode: Mode,
    /// What was wrong with the input.
    pub findings: Findings,
    /// Whether mechanical brakes shall hold the robot.
    pub brake: bool,
    /// Check sums of the signals, by stage.
    pub stages: Stages,
    /// Ticks of the target's timer that the update took; no part of what has to be equal.
    pub cost: u32,
}

/// Who answers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ready {
    /// Name of the target.
    pub target: String<32>,
    /// Version of the crate `mm-link` in it.
    pub version: String<16>,
    /// Ticks of its timer in a second.
    pub ticks_per_second: u32,
    /// Ticks that a loop of 10,000 instructions takes there.
    pub loop_ticks: u32,
}

/// Why a request was refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Reason {
    /// Its body is not of the form that its header says.
    Malformed,
    /// No setup came before.
    NotSetUp,
    /// It belongs to another session.
    Session,
    /// The setup was of the other precision.
    Precision,
    /// A later one was done already.
    Stale,
    /// Too many before it never came.
    Gap,
    /// The setup does not work; the text says why.
    Setup,
    /// It is nothing that a target is asked.
    Unknown,
}

/// A request that was refused; nothing has changed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refusal {
    /// Why.
    pub reason: Reason,
    /// Why, in words, as far as they fit.
    pub text: String<96>,
}

/// Frames and updates of a target since it was switched on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Counters {
    /// Updates done.
    pub updates: u32,
    /// Updates without an input.
    pub missed: u32,
    /// Requests answered a second time with the first answer.
    pub duplicates: u32,
    /// Requests that came after a later one.
    pub stale: u32,
    /// Frames that were damaged.
    pub corrupt: u32,
    /// Requests refused for another reason.
    pub refused: u32,
}

/// How it is going.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Report {
    /// What was counted.
    pub counters: Counters,
    /// What the supervisor does; none without a setup.
    pub mode: Option<Mode>,
    /// Number of the last tick or reset done.
    pub last: Option<u32>,
}
