//! The supervisor input by input: each finding, each way out of each mode, each parameter.
//!
//! Laws: (1) each finding is found by an input that has exactly that fault, at the limit that its parameter gives, and by no other; (2) good
//! inputs give the bits of the stack alone; (3) Run, Hold, Stop, Fault follow each other as documented, with the counts of the
//! parameters; (4) a stop that ends begins with nothing learned; (5) a reset is a new state; (6) a parameter that cannot work is refused by
//! its name.
//!
//! Reference: the documentation of the parameters, with the limits computed here.
//!
//! Tolerance: none; inputs are placed 1 % beside a limit.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use mm_control::supervisor::{Findings, Mode};
use mm_control::{
    Command, ControlStack, Estimator, Gains, Input, LawKind, Measurement, OuterParams, Reference, SetupError,
    StackParams, SupervisedStack, SupervisedState, SupervisorParams, Timing, WheelAngles,
};
use mm_model::{Configuration, Mechanism, ParamError, Real, Robot, RobotParams, Torque, Velocity};
use nalgebra::Vector3;

mod findings;

mod repetition;
mod setups;
mod transitions;

const PERIOD: f64 = 1e-3;

type Stack = SupervisedStack<f64, 3>;
type State = SupervisedState<f64, 3>;
type Spoil = fn(&mut Input<f64, 3>, &mut Timing<f64>);

fn robot() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn plain(estimator: Estimator<f64>) -> ControlStack<f64, 3> {
    let gains = Gains::for_robot(&robot(), LawKind::Bfsmc, PERIOD);
    let params = StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator };
    ControlStack::try_new(robot(), LawKind::Bfsmc, params).unwrap()
}

fn params() -> SupervisorParams<f64, 3> {
    SupervisorParams::for_robot(&robot(), PERIOD)
}

fn supervised() -> Stack {
    SupervisedStack::try_new(plain(Estimator::None), params()).unwrap()
}

/// A robot that drives slowly along x with its arm moving, the reference ahead of its tip: the input of update `k`.
fn input(k: u32) -> Input<f64, 3> {
    let t = f64::from(k) * PERIOD;
    let rest = robot().params().rest_posture;
    let nu = Velocity { forward: 0.2, yaw_rate: 0.1, joints: [0.1, -0.2, 0.3] };
    let heading = 0.1 * t;
    let q = Configuration {
        x: 2.0 * Real::sin_cos(heading).0,
        y: 2.0 * (1.0 - Real::sin_cos(heading).1),
        heading,
        joints: [rest[0] + 0.1 * t, rest[1] - 0.2 * t, rest[2] + 0.3 * t],
    };
    let start = robot().tip_position(&Configuration { joints: rest, ..Configuration::zero() });
    let velocity = Vector3::new(0.2, 0.01, 0.0);
    let reference = Reference { position: start + velocity * t, velocity, acceleration: Vector3::zeros() };
    Input { q, nu, reference }
}

fn exact() -> Timing<f64> {
    Timing::exact(PERIOD)
}

/// A stack in Run after ten good updates, and the number of the next.
fn running(stack: &Stack) -> (State, u32) {
    let mut state = stack.initial_state();
    for k in 0..10 {
        let command = stack.update(&mut state, exact(), &input(k));
        assert_eq!((command.mode, command.findings), (Mode::Run, Findings::NONE), "update {k}");
    }
    (state, 10)
}

fn within_limits(torque: &Torque<f64, 3>) -> bool {
    torque.is_finite() && !robot().limit_torque(torque).1
}

/// Modes of a run of updates.
fn modes(stack: &Stack, state: &mut State, from: u32, count: u32, spoil: Spoil) -> Vec<Mode> {
    let update = |k| {
        let (mut spoilt, mut timing) = (input(k), exact());
        spoil(&mut spoilt, &mut timing);
        stack.update(state, timing, &spoilt).mode
    };
    (from..from + count).map(update).collect()
}
