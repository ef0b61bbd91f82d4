//! From a checked scenario file to a loop that runs.

mod controller;
mod disturbances;
mod faults;
mod fuzzy;
mod hardware;
mod initial;
mod link;
mod robot;
mod trajectory;

pub use link::setup;
use mm_control::{ControlStack, LawKind, SupervisedStack};
use mm_model::Robot;
use nalgebra::Vector3;

use crate::imposed::Imposed;
use crate::plant::Plant;
use crate::scenario::{self, ControllerKind, Loaded, Motion, ScenarioError};
use crate::simulation::{Clock, Recorder, RunResult, Simulation};
use crate::trajectory::Trajectory;

/// A scenario ready to run.
#[derive(Debug, Clone)]
#[expect(clippy::large_enum_variant, reason = "a process holds a handful of them")]
pub enum Experiment {
    /// A controller tracks a trajectory.
    Closed(Simulation),
    /// Velocities are imposed, without a controller.
    Open(Imposed),
}

impl Experiment {
    /// Builds what the scenario describes.
    ///
    /// # Errors
    /// What only building shows: parameters that no robot has, gains that do not work, a trajectory out of reach; each at its
    /// place in the file.
    pub fn build(loaded: &Loaded) -> Result<Self, ScenarioError> {
        let file = &loaded.file;
        let params = robot::params(loaded)?;
        let nominal = robot::checked(loaded, params)?;
        let mut actual = robot::scaled(params.with_mass_scaled(file.plant.mass_scale), &file.plant.scale);
        actual.friction = robot::friction(&file.plant.friction);
        let payload = hardware::payload(loaded, actual)?;
        let actual = robot::checked(loaded, actual)?;
        let clock = clock(&file.simulation);
        if file.simulation.duration_s / file.simulation.plant_step_s > MOST_STEPS {
            let message = format!("a run of {} s would never end", file.simulation.duration_s);
            let expected = format!("at most {MOST_STEPS:e} plant steps");
            return Err(loaded.problem("simulation.duration_s", message, expected));
        }
        let mut plant = Plant::new(actual, disturbances::disturbances(file), file.simulation.plant_step_s);
        if let Some(payload) = payload {
            plant = plant.with_payload(payload);
        }
        if let Motion::Velocities { segment } = &file.trajectory.motion {
            if file.controller.kind != ControllerKind::None {
                let message = "imposed velocities leave a controller nothing to do";
                return Err(loaded.problem("controller.kind", message, "`kind = \"none\"`"));
            }
            initial::refuse_offset(loaded)?;
            hardware::refuse(loaded)?;
            let start = initial::given(loaded, &nominal);
            return Ok(Self::Open(Imposed::build(loaded, segment, (plant, clock), start)?));
        }
        let (reference, initial) = initial::with_trajectory(loaded, &nominal, trajectory::path(loaded)?)?;
        let stack = controller::stack(loaded, nominal)?;
        trajectory::check_heights(loaded, &actual, &reference, &clock)?;
        let hardware = hardware::hardware(file, stack.estimates());
        let guard = faults::guard(loaded, &stack)?;
        Ok(Self::Closed(Simulation { stack, plant, trajectory: reference, initial, clock, hardware, guard }))
    }

    /// Runs it.
    ///
    /// # Errors
    /// Those of the recorder.
    pub fn run<R: Recorder>(&self, recorder: &mut R) -> Result<RunResult, R::Error> {
        match self {
            Self::Closed(simulation) => simulation.run(recorder),
            Self::Open(imposed) => imposed.run(recorder),
        }
    }

    /// What a user should know of its reference, over the time simulated: how long it was beyond the arm's reach in height, and
    /// that a motion through points takes longer than the run.
    #[must_use]
    pub fn reference_warnings(&self, simulated_s: f64) -> Vec<String> {
        match self {
            Self::Closed(simulation) => {
                let robot = simulation.plant.robot();
                trajectory::warnings(robot, &simulation.trajectory, &simulation.clock, simulated_s)
            }
            Self::Open(_) => Vec::new(),
        }
    }

    /// Its clock.
    #[must_use]
    pub const fn clock(&self) -> &Clock {
        match self {
            Self::Closed(simulation) => &simulation.clock,
            Self::Open(imposed) => &imposed.clock,
        }
    }

    /// Its plant.
    #[must_use]
    pub const fn plant(&self) -> &Plant {
        match self {
            Self::Closed(simulation) => &simulation.plant,
            Self::Open(imposed) => &imposed.plant,
        }
    }

    /// Desired position of the tip at time `t`, m.
    #[must_use]
    pub fn desired(&self, t: f64) -> Vector3<f64> {
        match self {
            Self::Closed(simulation) => simulation.trajectory.at(t).position,
            Self::Open(imposed) => imposed.reference(t).position,
        }
    }
}

/// The robot that a scenario's `[robot]` describes, and that its controller knows.
///
/// # Errors
/// Parameters that no robot has.
pub fn robot(loaded: &Loaded) -> Result<Robot<f64, 3>, ScenarioError> {
    robot::checked(loaded, robot::params(loaded)?)
}

/// The control stack of a scenario.
///
/// # Errors
/// Parameters that no robot has, gains that do not work together.
pub fn stack(loaded: &Loaded) -> Result<ControlStack<f64, 3>, ScenarioError> {
    controller::stack(loaded, robot(loaded)?)
}

/// The control stack of a scenario under its supervisor, whether or not that is on in the scenario.
///
/// # Errors
/// As [`stack`]; limits that do not work.
pub fn supervised(loaded: &Loaded) -> Result<SupervisedStack<f64, 3>, ScenarioError> {
    faults::supervised(loaded, &stack(loaded)?)
}

/// The motion of a scenario's reference, placed in the world.
///
/// # Errors
/// A trajectory that cannot be; velocities that are imposed, which have none.
pub fn reference(loaded: &Loaded) -> Result<Trajectory, ScenarioError> {
    if matches!(loaded.file.trajectory.motion, Motion::Velocities { .. }) {
        return Err(loaded.problem("trajectory.kind", "imposed velocities are no path", "a path of the tip"));
    }
    let (reference, _) = initial::with_trajectory(loaded, &robot(loaded)?, trajectory::path(loaded)?)?;
    Ok(reference)
}

/// Plant steps beyond which a run would take years.
const MOST_STEPS: f64 = 1e13;

/// The law of a controller kind; none for imposed velocities.
#[must_use]
pub const fn law_kind(kind: ControllerKind) -> Option<LawKind> {
    match kind {
        ControllerKind::Bsmc => Some(LawKind::Bsmc),
        ControllerKind::BsmcSat => Some(LawKind::BsmcSat),
        ControllerKind::BfsmcThesis => Some(LawKind::BfsmcThesis),
        ControllerKind::Bfsmc => Some(LawKind::Bfsmc),
        ControllerKind::Ctc => Some(LawKind::Ctc),
        ControllerKind::Pid => Some(LawKind::Pid),
        ControllerKind::Lqr => Some(LawKind::Lqr),
        ControllerKind::SmcDecentralized => Some(LawKind::SmcDecentralized),
        ControllerKind::BacksteppingAdaptive => Some(LawKind::BacksteppingAdaptive),
        ControllerKind::SuperTwisting => Some(LawKind::SuperTwisting),
        ControllerKind::None => None,
    }
}

/// Name of a controller kind in scenarios and on the command line.
#[must_use]
pub fn controller_name(kind: ControllerKind) -> &'static str {
    law_kind(kind).map_or("none", LawKind::name)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the file's checks leave positive ratios; a cast saturates"
)]
fn clock(simulation: &scenario::Simulation) -> Clock {
    let scenario::Simulation { duration_s, plant_step_s, control_period_s: period, log_rate_hz, .. } =
        *simulation;
    Clock {
        period,
        substeps: ((period / plant_step_s).round() as u32).max(1),
        ticks: (duration_s / period).round() as u64,
        log_every: ((1.0 / (log_rate_hz * period)).round() as u64).max(1),
    }
}
