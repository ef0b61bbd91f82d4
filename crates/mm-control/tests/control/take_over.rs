//! Other gains while the robot moves: what was learned is neither lost nor multiplied.
//!
//! Laws: (1) a stack with another observer bandwidth, or another mass in its model, that takes over while the observer holds a load gives
//! the torque that the old one would have given, but for what its own model says; the loop stays where it was and learns on; (2) the
//! same observer takes over without a changed bit; (3) a stack that does not learn, and one that takes over from such, starts from nothing learned.
//! Why: the observer stores d_hat as momentum, d_hat/L: read with another L it is another force, ten times as large for a tenth of the bandwidth.
//!
//! Reference: the run of the old stack alone. Plant: the robot of the thesis at rest under a constant force, RK4 at the period of 1 ms.
//!
//! Tolerance: a hundredth of the load where nothing but the observer changes; the tip within 0.1 mm.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its loop has failed the test")]

use crate::common::plant::Plant;
use mm_control::{
    ControlStack, ControlState, Estimator, Gains, Input, LawKind, OuterParams, Output, Reference,
    StackParams, SupervisedStack, SupervisorParams, Timing,
};
use mm_model::{Configuration, Force, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

type Stack = ControlStack<f64, 3>;

const PERIOD: f64 = 1e-3;
/// Of tip and base, m/s.
const SPEED: f64 = 0.3;
/// On the base and on the joints, N and N m.
const LOAD: [f64; 5] = [-30.0, 4.0, 2.0, -12.0, 5.0];

fn load() -> Force<f64, 3> {
    let [forward, yaw, joints @ ..] = LOAD;
    Force { forward, yaw, joints }
}

fn robot(payload: f64) -> Robot<f64, 3> {
    let mut params = RobotParams::thesis();
    params.links[2].mass += payload;
    Robot::try_new(params).unwrap()
}

fn stack(payload: f64, bandwidth: f64) -> Stack {
    let robot = robot(payload);
    let gains = Gains { observer_bandwidth: bandwidth, ..Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD) };
    let params =
        StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None };
    ControlStack::try_new(robot, LawKind::Bfsmc, params).unwrap()
}

/// A loop around the plant under a load, whose tip is to go straight ahead.
struct Loop {
    plant: Plant,
    begin: Vector3<f64>,
}

impl Loop {
    fn new() -> Self {
        let robot = robot(0.0);
        let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
        let nu = Velocity { forward: SPEED, ..Velocity::zero() };
        Self { plant: Plant { robot, q, nu, time: 0.0 }, begin: robot.tip_position(&q) }
    }

    fn input(&self) -> Input<f64, 3> {
        let velocity = Vector3::new(SPEED, 0.0, 0.0);
        let position = self.begin + velocity * self.plant.time;
        let reference = Reference { position, velocity, acceleration: Vector3::zeros() };
        Input { q: self.plant.q, nu: self.plant.nu, reference }
    }

    /// Runs for a number of periods; the largest distance of the tip on the way and the last output.
    fn run(
        &mut self,
        stack: &Stack,
        state: &mut ControlState<f64, 3>,
        periods: u32,
    ) -> (f64, Output<f64, 3>) {
        let mut farthest = 0.0_f64;
        let mut last = None;
        for _ in 0..periods {
            let output = stack.update(state, &self.input()).unwrap();
            self.plant.step(&output.torque, |_| load(), PERIOD);
            farthest = farthest.max(output.signals.error.norm());
            last = Some(output);
        }
        (farthest, last.unwrap())
    }
}

/// The loop after three seconds, in which it has learned the load.
fn settled(stack: &Stack) -> (Loop, ControlState<f64, 3>) {
    let (mut running, mut state) = (Loop::new(), stack.initial_state());
    let (_, output) = running.run(stack, &mut state, 3000);
    assert_learned(&output);
    (running, state)
}

fn assert_learned(output: &Output<f64, 3>) {
    for (learned, load) in output.signals.learned.channels().zip(LOAD) {
        assert!((learned - load).abs() < 0.01 * load.abs(), "{:?}", output.signals.learned);
    }
}

#[test]
fn another_bandwidth_does_not_push() {
    for (from, to) in [(150.0, 15.0), (15.0, 150.0), (150.0, 199.0)] {
        let (old, new) = (stack(0.0, from), stack(0.0, to));
        let (mut running, mut state) = settled(&old);
        let expected = old.update(&mut state.clone(), &running.input()).unwrap().signals.commanded;
        new.take_over(&mut state, &old);
        let given = new.update(&mut state.clone(), &running.input()).unwrap().signals.commanded;
        let gap = given.channels().zip(expected.channels()).map(|(a, b)| (a - b).abs());
        let gap = gap.fold(0.0_f64, f64::max);
        assert!(gap < 0.01 * 12.0, "{from} to {to}: torques {gap} apart");
        let (farthest, output) = running.run(&new, &mut state, 1000);
        assert!(farthest < 1e-4, "{from} to {to}: the tip went {farthest} m away");
        assert_learned(&output);
    }
}

#[test]
fn a_supervised_stack_takes_over_the_same_way() {
    let supervised = |bandwidth| {
        SupervisedStack::try_new(stack(0.0, bandwidth), SupervisorParams::for_robot(&robot(0.0), PERIOD))
            .unwrap()
    };
    let (old, new) = (supervised(150.0), supervised(15.0));
    let mut running = Loop::new();
    let mut state = old.initial_state();
    let timing = Timing { elapsed: PERIOD, age: 0.0 };
    for period in 0..4000 {
        if period == 3000 {
            new.take_over(&mut state, &old);
        }
        let stack = if period < 3000 { &old } else { &new };
        let command = stack.update(&mut state, timing, &running.input());
        let output = command.output.unwrap();
        running.plant.step(&command.torque, |_| load(), PERIOD);
        if period >= 2999 {
            assert_learned(&output);
            assert!(output.signals.error.norm() < 1e-4, "period {period}: {}", output.signals.error.norm());
        }
    }
}

#[test]
fn another_model_keeps_what_was_learned_for_the_first_update() {
    let (old, new) = (stack(0.0, 150.0), stack(5.0, 150.0));
    let (running, mut state) = settled(&old);
    let before = old.update(&mut state.clone(), &running.input()).unwrap();
    new.take_over(&mut state, &old);
    let after = new.update(&mut state, &running.input()).unwrap();
    for (after, before) in after.signals.learned.channels().zip(before.signals.learned.channels()) {
        assert!((after - before).abs() < 1e-6, "{after} instead of {before}");
    }
}

#[test]
fn the_same_observer_takes_over_without_a_changed_bit() {
    let old = stack(0.0, 150.0);
    let (_, mut state) = settled(&old);
    let before = state;
    old.take_over(&mut state, &old);
    assert_eq!(format!("{state:?}"), format!("{before:?}"));
}

#[test]
fn what_does_not_learn_has_learned_nothing() {
    let (learning, other) = (stack(0.0, 150.0), stack(0.0, 0.0));
    let (mut running, mut state) = settled(&learning);
    other.take_over(&mut state, &learning);
    let output = other.update(&mut state, &running.input()).unwrap();
    assert_eq!(output.signals.learned, Force::zero());
    let (_, output) = running.run(&other, &mut state, 100);
    assert_eq!(output.signals.learned, Force::zero());
    learning.take_over(&mut state, &other);
    let output = learning.update(&mut state, &running.input()).unwrap();
    assert_eq!(output.signals.learned, Force::zero(), "it begins where the robot is now");
}
