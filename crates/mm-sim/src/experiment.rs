//! From a checked scenario file to a loop that runs.

mod initial;
mod robot;

use mm_control::{ControlStack, Gains, LawKind, OuterParams, SetupError, StackParams};
use mm_model::{Force, Robot, Torque, Velocity};
use nalgebra::Vector3;

use crate::disturbance::{Disturbance, Disturbances, Shape, Target};
use crate::imposed::Imposed;
use crate::plant::Plant;
use crate::random::split_mix;
use crate::scenario::{self, ControllerKind, DisturbanceTarget, Loaded, Motion, ScenarioError};
use crate::simulation::{Clock, Recorder, RunResult, Simulation};
use crate::trajectory::{Path, Trajectory};

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
        let mut actual = params.with_mass_scaled(file.plant.mass_scale);
        actual.friction = robot::friction(&file.plant.friction);
        let actual = robot::checked(loaded, actual)?;
        let clock = clock(&file.simulation);
        if file.simulation.duration_s / file.simulation.plant_step_s > MOST_STEPS {
            let message = format!("a run of {} s would never end", file.simulation.duration_s);
            let expected = format!("at most {MOST_STEPS:e} plant steps");
            return Err(loaded.problem("simulation.duration_s", message, expected));
        }
        let plant = Plant::new(actual, disturbances(file), file.simulation.plant_step_s);
        if let Motion::Velocities { segment } = &file.trajectory.motion {
            if file.controller.kind != ControllerKind::None {
                let message = "imposed velocities leave a controller nothing to do";
                return Err(loaded.problem("controller.kind", message, "`kind = \"none\"`"));
            }
            let start = initial::given(loaded, &nominal);
            return Ok(Self::Open(Imposed::build(loaded, segment, (plant, clock), start)?));
        }
        let (trajectory, initial) = initial::with_trajectory(loaded, &nominal, path(&file.trajectory))?;
        let stack = stack(loaded, nominal)?;
        check_heights(loaded, &actual, &trajectory, &clock)?;
        Ok(Self::Closed(Simulation { stack, plant, trajectory, initial, clock }))
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

fn path(trajectory: &scenario::Trajectory) -> Option<Path> {
    let vector = |v: [f64; 3]| Vector3::from(v);
    Some(match &trajectory.motion {
        Motion::Square => Path::Square,
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
        Motion::Hold { point_m } => Path::Hold(vector((*point_m)?)),
        Motion::Velocities { .. } => return None,
    })
}

fn disturbances(file: &scenario::ScenarioFile) -> Disturbances {
    let all = file.disturbance.iter().zip(1_u64..).map(|(raw, number)| Disturbance {
        target: target(raw),
        shape: match raw.shape {
            scenario::Shape::Sine { frequency_rad_s, phase_rad } => {
                Shape::Sine { frequency: frequency_rad_s, phase: phase_rad }
            }
            scenario::Shape::Noise { hold_s } => {
                Shape::Noise { hold: hold_s, seed: split_mix(file.simulation.seed) ^ number }
            }
            scenario::Shape::Step | scenario::Shape::Pulse => Shape::Constant,
        },
        amplitude: raw.amplitude_n_m.or(raw.amplitude_n).unwrap_or(0.0),
        from: raw.from_s,
        to: raw.to_s.unwrap_or(f64::INFINITY),
    });
    Disturbances::new(all.collect())
}

fn target(raw: &scenario::Disturbance) -> Target {
    let torque = |right, left, joints| Target::Torque(Torque { right, left, joints });
    match raw.on {
        DisturbanceTarget::Right => torque(1.0, 0.0, [0.0; 3]),
        DisturbanceTarget::Left => torque(0.0, 1.0, [0.0; 3]),
        DisturbanceTarget::Joint1 => torque(0.0, 0.0, [1.0, 0.0, 0.0]),
        DisturbanceTarget::Joint2 => torque(0.0, 0.0, [0.0, 1.0, 0.0]),
        DisturbanceTarget::Joint3 => torque(0.0, 0.0, [0.0, 0.0, 1.0]),
        DisturbanceTarget::Joints => torque(0.0, 0.0, [1.0; 3]),
        DisturbanceTarget::Tip => {
            let direction = Vector3::from(raw.direction.unwrap_or([0.0, 0.0, 1.0]));
            let length = mm_model::Real::sqrt(direction.norm_squared());
            Target::Tip(direction / length)
        }
    }
}

/// The control stack: defaults that follow the robot, overridden by what the file gives.
fn stack(loaded: &Loaded, robot: Robot<f64, 3>) -> Result<ControlStack<f64, 3>, ScenarioError> {
    let file = &loaded.file;
    let period = file.simulation.control_period_s;
    let kind = law_kind(file.controller.kind).unwrap_or(LawKind::Bfsmc);
    let given = &file.controller.gains;
    let mut gains = match given.switching_gain {
        None => Gains::for_robot(&robot, kind, period),
        Some(k) => Gains::with_switching(&robot, kind, period, Force::from_channels(k.into_iter())),
    };
    let force = |raw: Option<[f64; 5]>, default| {
        raw.map_or(default, |values| Force::from_channels(values.into_iter()))
    };
    let velocity = |raw: Option<[f64; 5]>, default| {
        raw.map_or(default, |values| Velocity::from_channels(values.into_iter()))
    };
    gains.boundary_layer = velocity(given.boundary_layer, gains.boundary_layer);
    gains.fuzzy = force(given.fuzzy_gain, gains.fuzzy);
    gains.fuzzy_scale = velocity(given.fuzzy_scale, gains.fuzzy_scale);
    gains.observer_bandwidth = given.observer_bandwidth_1_s.unwrap_or(gains.observer_bandwidth);
    gains.learning_limit = force(given.learning_limit, gains.learning_limit);
    gains.reaching_margin = force(given.reaching_margin, gains.reaching_margin);
    let outer = outer(&robot, &file.controller.outer);
    ControlStack::try_new(robot, kind, StackParams { period, outer, gains }).map_err(|error| {
        let key = match error {
            SetupError::Param(error) => {
                let name = error.parameter();
                let outer = name.ends_with("_1_s") && name != "observer_bandwidth_1_s"
                    || ["weights", "damping_max", "manipulability_threshold"].contains(&name)
                    || name.contains("_rad");
                format!("controller.{}.{name}", if outer { "outer" } else { "gains" })
            }
            _ => "controller.gains".to_owned(),
        };
        loaded.problem(&key, error.to_string(), "gains that the law can work with")
    })
}

fn outer(robot: &Robot<f64, 3>, raw: &scenario::Outer) -> OuterParams<f64, 3> {
    let mut outer = OuterParams::for_robot(robot);
    if let Some(gain) = raw.position_gain_1_s {
        outer.position_gain = Vector3::from(gain.expand());
    }
    if let Some(gain) = raw.sliding_gain_1_s {
        outer.sliding_gain = Velocity::from_channels(gain.expand().into_iter());
    }
    if let Some(weights) = raw.weights {
        outer.weights = Velocity::from_channels(weights.into_iter());
    }
    let set = |field: &mut f64, value: Option<f64>| *field = value.unwrap_or(*field);
    set(&mut outer.posture_gain, raw.posture_gain_1_s);
    set(&mut outer.joint_limit_gain, raw.joint_limit_gain_rad_s);
    set(&mut outer.joint_limit_margin, raw.joint_limit_margin_rad);
    set(&mut outer.manipulability_gain, raw.manipulability_gain_rad_s);
    set(&mut outer.manipulability_threshold, raw.manipulability_threshold);
    set(&mut outer.damping_max, raw.damping_max);
    outer.minimum_norm = raw.minimum_norm;
    outer
}

/// Refuses a trajectory that leaves the heights that some posture within the joint limits reaches.
fn check_heights(
    loaded: &Loaded,
    robot: &Robot<f64, 3>,
    trajectory: &Trajectory,
    clock: &Clock,
) -> Result<(), ScenarioError> {
    if loaded.file.trajectory.allow_unreachable {
        return Ok(());
    }
    let (low, high) = robot.tip_height_range();
    let every = (clock.ticks / 10_000).max(1);
    let step = usize::try_from(every).unwrap_or(1);
    for tick in (0..clock.ticks).step_by(step).chain(clock.ticks.checked_sub(1)) {
        let t = clock.time(tick);
        let height = trajectory.at(t).position.z;
        if height < low - 1e-9 || height > high + 1e-9 {
            let key = match loaded.file.trajectory.motion {
                Motion::Step { .. } => "trajectory.by_m",
                Motion::Line { .. } => "trajectory.velocity_m_s",
                Motion::Circle { .. } => "trajectory.center_m",
                Motion::Hold { .. } => "trajectory.point_m",
                _ => "trajectory.kind",
            };
            let message =
                format!("at t = {t:.3} s the tip should be {height:.4} m high, which no posture reaches");
            let expected = format!("a height from {low:.4} to {high:.4} m, or `allow_unreachable = true`");
            return Err(loaded.problem(key, message, expected));
        }
    }
    Ok(())
}
