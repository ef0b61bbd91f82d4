//! What a run shows while it goes on, and what it gives at its end.

use mm_control::supervisor::Findings;
use mm_control::{ControlError, ControlStack, Output, Reference, SupervisedStack};
use mm_model::{Force, Torque};
use nalgebra::Vector3;

use super::Clock;
use super::guard::SupervisorReport;
use crate::metrics::Metrics;
use crate::monitors::{Lyapunov, MonitorReport};
use crate::plant::PlantState;

/// One logged instant.
#[derive(Debug, Clone, Copy)]
pub struct Sample<'a> {
    /// Time, s.
    pub t: f64,
    /// True state.
    pub state: &'a PlantState,
    /// True tip, m.
    pub tip: Vector3<f64>,
    /// Reference.
    pub reference: &'a Reference<f64>,
    /// Torque at the plant's input.
    pub torque: &'a Torque<f64, 3>,
    /// Disturbance as a generalized force.
    pub external: Force<f64, 3>,
    /// Switching gain that the reaching condition asks for, what the controller's own limit cuts off counted as an external
    /// force; zero for a law without a switching gain.
    pub required_gain: Force<f64, 3>,
    /// Lyapunov function of the sliding mode; zero for an imposed motion.
    pub lyapunov: Lyapunov,
    /// Square of the true manipulability.
    pub manipulability_squared: f64,
    /// Whether the controller or an actuator limited a torque.
    pub saturated: bool,
    /// The controller's outcomes and signals; none for an imposed motion.
    pub output: Option<&'a Output<f64, 3>>,
}

/// Takes the samples of a run, and may end it.
pub trait Recorder {
    /// What can go wrong in taking a sample.
    type Error;
    /// Takes a sample; `false` asks to stop here.
    ///
    /// # Errors
    /// The recorder's own.
    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error>;

    /// Whether to go on; asked every [`ASK_EVERY`] ticks, however seldom samples are taken.
    fn goes_on(&mut self) -> bool {
        true
    }

    /// Another controller for the rest of the run, asked for after every sample: how somebody who watches turns the gains.
    fn retuned(&mut self) -> Option<Box<Retuned>> {
        None
    }
}

/// A controller that takes over from another of its kind, with what that one remembers.
#[derive(Debug, Clone)]
pub struct Retuned {
    /// The stack: the law, the robot and the period of the one before, other gains.
    pub stack: ControlStack<f64, 3>,
    /// The same under a supervisor, for a loop that has one.
    pub supervised: Option<SupervisedStack<f64, 3>>,
}

/// Ticks after which a recorder is asked whether to go on: some milliseconds of wall time.
pub const ASK_EVERY: u64 = 4096;

/// A recorder that keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoRecorder;

impl Recorder for NoRecorder {
    type Error = core::convert::Infallible;
    fn record(&mut self, _sample: &Sample<'_>) -> Result<bool, Self::Error> {
        Ok(true)
    }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ending {
    /// The whole duration was simulated.
    Finished,
    /// The recorder asked to stop.
    Stopped {
        /// When, s.
        t: f64,
    },
    /// The loop ran away.
    Diverged {
        /// When, s.
        t: f64,
        /// Which state, in words.
        state: &'static str,
        /// Its value.
        value: f64,
    },
    /// The supervisor gave the robot up: no torque, brakes on; a simulated robot has none.
    Faulted {
        /// When, s.
        t: f64,
        /// What was wrong with the last input.
        findings: Findings,
    },
    /// The controller refused its input.
    Refused {
        /// When, s.
        t: f64,
        /// Why.
        error: ControlError,
    },
}

/// What a run gives.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// Metrics over the ticks simulated.
    pub metrics: Metrics,
    /// What the monitors saw; none for an imposed motion.
    pub monitors: Option<MonitorReport>,
    /// What the supervisor did; none without one.
    pub supervisor: Option<SupervisorReport>,
    /// Digest of the trajectory: XXH3-128 in hexadecimal digits.
    pub digest: String,
    /// How it ended.
    pub ending: Ending,
    /// First time at which a joint was outside its limits, s.
    pub joint_limit_crossed_at: Option<f64>,
    /// State after the last step.
    pub last: PlantState,
}

impl RunResult {
    /// Time simulated, s: the whole duration, or up to where the run ended.
    #[must_use]
    pub fn simulated_s(&self, clock: &Clock) -> f64 {
        match self.ending {
            Ending::Finished => clock.duration(),
            Ending::Stopped { t }
            | Ending::Diverged { t, .. }
            | Ending::Faulted { t, .. }
            | Ending::Refused { t, .. } => t,
        }
    }
}
