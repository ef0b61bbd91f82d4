//! The workloads that all measurements of this project share: the robot of the thesis at 1 kHz.
//!
//! `cargo xtask bench-instructions` counts instructions with them, `cargo xtask real-time` and `cargo bench -p mm-benches` time them.

/// The code in the README, compiled as documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

use anyhow::Result;
use mm_control::{ControlStack, Estimator, Gains, Input, LawKind, OuterParams, StackParams};
use mm_model::{Configuration, Real, Robot, RobotParams, Torque, Velocity};
use mm_sim::disturbance::Disturbances;
use mm_sim::plant::{Plant, PlantState};
use mm_sim::simulation::{Clock, Recorder, Sample, Simulation};
use mm_sim::trajectory::{Path, Trajectory};

/// Control period and plant step, s.
pub const PERIOD: f64 = 1e-3;

/// Control ticks of the whole square, 98 s.
pub const SQUARE_TICKS: u64 = 98_000;

/// Never: a run with it gives its recorder the first tick only.
const NO_SAMPLES: u64 = u64::MAX;

/// A state with an input, as the dynamics take it.
#[derive(Debug, Clone, Copy)]
pub struct Point<T> {
    /// Configuration; joints within their limits.
    pub q: Configuration<T, 3>,
    /// Velocity.
    pub nu: Velocity<T, 3>,
    /// Torque.
    pub torque: Torque<T, 3>,
    /// Acceleration, for the inverse dynamics.
    pub acceleration: Velocity<T, 3>,
}

/// The robot of the thesis; the optimizer knows nothing of its numbers if the caller passes it through a black box.
///
/// # Errors
/// Never: the preset is a proper robot.
pub fn robot<T: Real>() -> Result<Robot<T, 3>>
where
    Robot<T, 3>: mm_model::Mechanism<T, 3>,
{
    Ok(Robot::try_new(RobotParams::thesis())?)
}

/// 64 points spread evenly over joint limits, headings, velocities and torques, the same in every run.
#[must_use]
pub fn points<T: Real>() -> Vec<Point<T>> {
    many_points(64)
}

/// The same, as many as one likes.
#[must_use]
pub fn many_points<T: Real>(count: usize) -> Vec<Point<T>> {
    let mut numbers = Numbers::new();
    (0..count)
        .map(|_| {
            let mut between = |lo, hi| T::from_f64(numbers.between(lo, hi));
            Point {
                q: Configuration {
                    x: between(-5.0, 5.0),
                    y: between(-5.0, 5.0),
                    heading: between(-3.1, 3.1),
                    joints: [between(-3.1, 3.1), between(-0.35, 1.92), between(-2.79, 2.79)],
                },
                nu: Velocity {
                    forward: between(-1.0, 1.0),
                    yaw_rate: between(-1.0, 1.0),
                    joints: [between(-2.0, 2.0), between(-2.0, 2.0), between(-2.0, 2.0)],
                },
                torque: Torque {
                    right: between(-20.0, 20.0),
                    left: between(-20.0, 20.0),
                    joints: [between(-50.0, 50.0), between(-50.0, 50.0), between(-50.0, 50.0)],
                },
                acceleration: Velocity {
                    forward: between(-2.0, 2.0),
                    yaw_rate: between(-2.0, 2.0),
                    joints: [between(-5.0, 5.0), between(-5.0, 5.0), between(-5.0, 5.0)],
                },
            }
        })
        .collect()
}

/// 64 numbers spread evenly over [`lo`, `hi`), the same in every run.
#[must_use]
pub fn numbers<T: Real>(lo: f64, hi: f64) -> Vec<T> {
    let mut numbers = Numbers::new();
    (0..64).map(|_| T::from_f64(numbers.between(lo, hi))).collect()
}

/// The control stack with its default gains at 1 kHz.
///
/// # Errors
/// Never: the defaults are proper gains.
pub fn stack(kind: LawKind) -> Result<ControlStack<f64, 3>> {
    let robot = robot()?;
    let gains = Gains::for_robot(&robot, kind, PERIOD);
    let params =
        StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None };
    Ok(ControlStack::try_new(robot, kind, params)?)
}

/// The closed loop of the scenario `square`, without a log, over the first `ticks` control periods.
///
/// # Errors
/// Never: the defaults are a proper loop.
pub fn square(kind: LawKind, ticks: u64) -> Result<Simulation> {
    let robot = robot::<f64>()?;
    // The tip stands 0.56 m ahead of the axle and on the start of the path, which leads along y.
    let joints = robot.params().rest_posture;
    let q = Configuration { x: 0.0, y: -0.56, heading: core::f64::consts::FRAC_PI_2, joints };
    Ok(Simulation {
        stack: stack(kind)?,
        plant: Plant::new(robot, Disturbances::default(), PERIOD),
        trajectory: Trajectory { path: Path::Square, start_ramp: 0.0, stop: None },
        initial: PlantState { q, nu: Velocity::zero(), travel: 0.0, yaw_slip: 0.0 },
        clock: Clock { period: PERIOD, substeps: 1, ticks, log_every: NO_SAMPLES },
        hardware: None,
        guard: None,
    })
}

/// One tick of a recorded run: what the controller saw and what the plant got.
#[derive(Debug, Clone, Copy)]
pub struct Recorded {
    /// Input of the controller.
    pub input: Input<f64, 3>,
    /// State of the plant.
    pub state: PlantState,
    /// Torque that the controller answered with.
    pub torque: Torque<f64, 3>,
}

/// The first `ticks` control periods of the square, as they happened.
///
/// # Errors
/// Never: see [`square`].
pub fn recorded(kind: LawKind, ticks: u64) -> Result<Vec<Recorded>> {
    let mut simulation = square(kind, ticks)?;
    simulation.clock.log_every = 1;
    let mut tape = Tape(Vec::new());
    let Ok(_) = simulation.run(&mut tape);
    Ok(tape.0)
}

struct Tape(Vec<Recorded>);

impl Recorder for Tape {
    type Error = core::convert::Infallible;
    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        let PlantState { q, nu, .. } = *sample.state;
        let input = Input { q, nu, reference: *sample.reference };
        self.0.push(Recorded { input, state: *sample.state, torque: *sample.torque });
        Ok(true)
    }
}

/// A small generator of numbers with a fixed seed (splitmix64): the inputs are the same everywhere.
struct Numbers(u64);

impl Numbers {
    const fn new() -> Self {
        Self(0)
    }

    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    fn between(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        lo + (hi - lo) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// Time that this thread has spent on a CPU, ns; Linux knows it, elsewhere it is `None` and the clock on the wall has to do.
#[must_use]
pub fn cpu_time() -> Option<u128> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}
