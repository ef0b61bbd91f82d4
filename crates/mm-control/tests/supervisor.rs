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

const PERIOD: f64 = 1e-3;

type Stack = SupervisedStack<f64, 3>;
type State = SupervisedState<f64, 3>;

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

#[test]
fn good_inputs_give_the_bits_of_the_stack() {
    let (stack, alone) = (supervised(), plain(Estimator::None));
    let (mut state, mut sines, mut twin) =
        (stack.initial_state(), stack.initial_state(), alone.initial_state());
    for k in 0..500 {
        let wanted = alone.update(&mut twin, &input(k)).unwrap();
        let command = stack.update(&mut state, exact(), &input(k));
        assert_eq!(command.output, Some(wanted), "update {k}");
        assert_eq!((command.torque, command.brake), (wanted.torque, false), "update {k}");
        let given = robot().sines(&input(k).q);
        let command = stack.update_with_sines(&mut sines, exact(), &input(k), &given);
        assert_eq!(command.output, Some(wanted), "update {k} with sines");
    }
    assert_eq!(state, sines, "both ways remember the same");
}

type Spoil = fn(&mut Input<f64, 3>, &mut Timing<f64>);

#[test]
fn each_fault_is_found_as_what_it_is() {
    let cases: [(&str, Findings, Spoil); 25] = [
        ("nan heading", Findings::STATE_NOT_FINITE, |i, _| i.q.heading = f64::NAN),
        ("nan joint", Findings::STATE_NOT_FINITE, |i, _| i.q.joints[2] = f64::NAN),
        ("infinite x", Findings::STATE_NOT_FINITE, |i, _| i.q.x = f64::INFINITY),
        ("nan rate", Findings::STATE_NOT_FINITE, |i, _| i.nu.joints[0] = f64::NAN),
        ("infinite speed", Findings::STATE_NOT_FINITE, |i, _| i.nu.forward = f64::NEG_INFINITY),
        ("far", Findings::STATE_RANGE.and(Findings::STATE_RATE), |i, _| i.q.y = -10_001.0),
        ("joint", Findings::STATE_RANGE.and(Findings::STATE_RATE), |i, _| i.q.joints[1] = -0.35 - 0.51),
        ("speed", Findings::STATE_RANGE.and(Findings::STATE_RATE), |i, _| i.nu.forward = 8.1),
        ("x jumps", Findings::STATE_RATE, |i, _| i.q.x += 8.0 * 0.0015 + 0.005 * 1.01),
        ("heading jumps", Findings::STATE_RATE, |i, _| i.q.heading -= 20.0 * 0.0015 + 0.005 * 1.05),
        ("joint jumps", Findings::STATE_RATE, |i, _| i.q.joints[0] += 0.036),
        ("rate jumps", Findings::STATE_RATE, |i, _| i.nu.forward += 0.5),
        ("old", Findings::STALE, |_, t| t.age = 2.02 * PERIOD),
        ("from the future", Findings::STALE, |_, t| t.age = -2.02 * PERIOD),
        ("nan age", Findings::STALE, |_, t| t.age = f64::NAN),
        ("nan reference", Findings::REFERENCE, |i, _| i.reference.position.z = f64::NAN),
        ("infinite velocity", Findings::REFERENCE, |i, _| i.reference.velocity.x = f64::INFINITY),
        ("nan acceleration", Findings::REFERENCE, |i, _| i.reference.acceleration.y = f64::NAN),
        ("fast reference", Findings::REFERENCE, |i, _| i.reference.velocity.y = 8.1),
        ("hard reference", Findings::REFERENCE, |i, _| i.reference.acceleration.x = -1010.0),
        ("reference jumps", Findings::REFERENCE, |i, _| i.reference.position.x += 1.02),
        ("early", Findings::EARLY, |_, t| t.elapsed = 0.49 * PERIOD),
        ("backwards", Findings::EARLY, |_, t| t.elapsed = -PERIOD),
        ("nan clock", Findings::EARLY, |_, t| t.elapsed = f64::NAN),
        ("late", Findings::LATE, |_, t| t.elapsed = 4.6 * PERIOD),
    ];
    let stack = supervised();
    for (name, wanted, spoil) in cases {
        let (mut state, k) = running(&stack);
        let (mut spoilt, mut timing) = (input(k), exact());
        spoil(&mut spoilt, &mut timing);
        let before = state;
        let command = stack.update(&mut state, timing, &spoilt);
        assert_eq!(command.findings, wanted, "{name}");
        let mode = if wanted == Findings::LATE { Mode::Stop } else { Mode::Hold };
        assert_eq!((command.mode, command.output), (mode, None), "{name}");
        assert!(within_limits(&command.torque), "{name}");
        // A held torque is the last one, and one good input later all is as if nothing had been.
        if mode == Mode::Hold {
            let mut twin = before;
            let last = stack.update(&mut twin, exact(), &input(k - 1));
            assert!(last.mode == Mode::Run || last.findings.contains(Findings::STATE_RATE), "{name}");
            let next = stack.update(&mut state, exact(), &input(k + 1));
            assert_eq!((next.mode, next.findings), (Mode::Run, Findings::NONE), "{name}, the next");
        }
    }
}

#[test]
fn inputs_just_within_the_limits_pass() {
    let cases: [(&str, Spoil); 8] = [
        ("x jumps", |i, _| i.q.x += 8.0 * 0.0015 + 0.005 * 0.8),
        ("joint jumps", |i, _| i.q.joints[0] += 0.0345),
        ("rate jumps", |i, _| i.nu.forward += 0.3),
        ("old", |_, t| t.age = 1.98 * PERIOD),
        ("fast reference", |i, _| i.reference.velocity.y = 7.9),
        ("reference jumps", |i, _| i.reference.position.x += 0.99),
        ("early", |_, t| t.elapsed = 0.51 * PERIOD),
        ("late", |_, t| t.elapsed = 1.49 * PERIOD),
    ];
    let stack = supervised();
    for (name, spoil) in cases {
        let (mut state, k) = running(&stack);
        let (mut spoilt, mut timing) = (input(k), exact());
        spoil(&mut spoilt, &mut timing);
        let command = stack.update(&mut state, timing, &spoilt);
        assert_eq!((command.mode, command.findings), (Mode::Run, Findings::NONE), "{name}");
    }
}

#[test]
fn a_heading_may_go_round() {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let mut turned = input(k);
    turned.q.heading -= 2.0 * core::f64::consts::TAU;
    let command = stack.update(&mut state, exact(), &turned);
    assert_eq!((command.mode, command.findings), (Mode::Run, Findings::NONE), "the same direction");
}

/// Repeats one input with part of it kept; the number of the first update that is found, and what it was found as.
fn repeated(keep: fn(&Input<f64, 3>, u32) -> Input<f64, 3>, most: u32) -> Option<(u32, Findings)> {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let last = input(k - 1);
    (0..most).find_map(|i| {
        let command = stack.update(&mut state, exact(), &keep(&last, k + i));
        (!command.findings.is_empty()).then_some((i, command.findings))
    })
}

#[test]
fn a_sensor_that_stands_still_is_found_by_the_way_the_robot_goes() {
    // At 0.3 rad/s the fastest joint should have gone 5 mrad after 16.7 updates; where everything stands still the law's push adds to it.
    let all = repeated(|last, k| Input { reference: input(k).reference, ..*last }, 100);
    assert!(matches!(all, Some((8..=17, Findings::STATE_FROZEN))), "everything: {all:?}");
    let one = repeated(
        |last, k| {
            let mut now = input(k);
            now.q.joints[1] = last.q.joints[1];
            now
        },
        100,
    );
    assert!(matches!(one, Some((8..=27, Findings::STATE_FROZEN))), "a joint at 0.2 rad/s: {one:?}");
    let base = repeated(
        |last, k| {
            let mut now = input(k);
            (now.q.x, now.q.y) = (last.q.x, last.q.y);
            now
        },
        100,
    );
    assert!(matches!(base, Some((8..=27, Findings::STATE_FROZEN))), "the base at 0.2 m/s: {base:?}");
}

#[test]
fn a_robot_at_rest_may_repeat_itself() {
    let stack = supervised();
    let mut state = stack.initial_state();
    let mut still = input(0);
    still.nu = Velocity::zero();
    still.reference.velocity = Vector3::zeros();
    for k in 0..2000 {
        // Noise of a velocity to and fro.
        still.nu.joints[0] = if k % 2 == 0 { 0.05 } else { -0.05 };
        let command = stack.update(&mut state, exact(), &still);
        assert_eq!((command.mode, command.findings), (Mode::Run, Findings::NONE), "update {k}");
    }
}

#[test]
fn a_sensor_that_stands_still_at_rest_is_found_by_the_push() {
    // The reference goes away, the state does not follow: the law pushes harder and harder.
    let stack = supervised();
    let mut state = stack.initial_state();
    let mut stuck = input(0);
    stuck.nu = Velocity::zero();
    let found = (0..2000).find_map(|k| {
        stuck.reference = input(k).reference;
        let command = stack.update(&mut state, exact(), &stuck);
        (!command.findings.is_empty()).then_some((k, command.findings))
    });
    assert!(matches!(found, Some((_, Findings::STATE_FROZEN))), "{found:?}");
    // Until it moves again.
    for _ in 0..50 {
        let command = stack.update(&mut state, exact(), &stuck);
        assert_eq!(command.findings, Findings::STATE_FROZEN, "still stuck");
    }
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

#[test]
fn a_hold_ends_in_a_stop_and_a_stop_in_a_run() {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let bad: Spoil = |i, _| i.nu.joints[1] = f64::NAN;
    assert_eq!(
        modes(&stack, &mut state, k, 3, bad),
        [Mode::Hold, Mode::Hold, Mode::Stop],
        "hold_periods = 2"
    );
    // Nine good inputs are not enough, nor are nine more after a bad one.
    assert_eq!(modes(&stack, &mut state, k + 3, 9, |_, _| {}), [Mode::Stop; 9], "nine");
    assert_eq!(modes(&stack, &mut state, k + 12, 1, bad), [Mode::Stop], "a bad one");
    assert_eq!(modes(&stack, &mut state, k + 13, 9, |_, _| {}), [Mode::Stop; 9], "nine again");
    let again = stack.update(&mut state, exact(), &input(k + 22));
    assert_eq!(again.mode, Mode::Run, "the tenth");
    let fresh = plain(Estimator::None);
    let wanted = fresh.update(&mut fresh.initial_state(), &input(k + 22)).unwrap();
    assert_eq!(again.output, Some(wanted), "nothing of before the stop is left");
}

#[test]
fn a_blind_stop_becomes_a_fault_that_only_a_reset_ends() {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let bad: Spoil = |i, _| i.q.x = f64::INFINITY;
    let all = modes(&stack, &mut state, k, 510, bad);
    // Two held, and 500 updates without a state in all.
    assert_eq!(all.iter().position(|mode| *mode == Mode::Fault), Some(500), "blind_periods = 500");
    let after = stack.update(&mut state, exact(), &input(600));
    assert_eq!((after.mode, after.brake), (Mode::Fault, true), "good inputs do not help");
    assert_eq!(after.torque, Torque::zero(), "no torque");
    assert_eq!(stack.missed(&mut state, PERIOD).mode, Mode::Fault, "nor does waiting");
    stack.reset(&mut state);
    assert_eq!(state, stack.initial_state(), "a reset is a new state");
    assert_eq!(stack.update(&mut state, exact(), &input(0)).mode, Mode::Run, "after the reset");
}

#[test]
fn a_stop_that_finds_no_rest_becomes_a_fault() {
    // The state says that the robot moves on and on, whatever the brakes do.
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let no_reference: Spoil = |i, _| i.reference.position.x = f64::NAN;
    let all = modes(&stack, &mut state, k, 5010, no_reference);
    assert_eq!(
        all.iter().position(|mode| *mode == Mode::Fault),
        Some(5002),
        "two held and stop_periods = 5000"
    );
}

#[test]
fn a_stopped_robot_at_rest_waits_with_its_brakes() {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let mut last = None;
    for i in 0..6000 {
        let mut now = input(k);
        now.reference.position.x = f64::NAN;
        now.nu = now.nu.scaled(0.0);
        last = Some(stack.update(&mut state, exact(), &now));
        assert!(last.is_some_and(|command: Command<f64, 3>| within_limits(&command.torque)), "update {i}");
    }
    let last = last.unwrap();
    assert_eq!((last.mode, last.brake), (Mode::Stop, true), "no fault, since it sees and rests");
    // Its weight is held: the shoulder's torque is that of gravity.
    let q = input(k).q;
    let load = robot().gravity(&robot().inertia(&robot().posture(&q.joints)));
    let learned = (last.torque.joints[1] - load.joints[1]).abs();
    assert!(learned < 0.5 * 200.0, "gravity and what was learned: {learned}");
}

#[test]
fn without_any_state_there_is_no_torque() {
    let stack = supervised();
    let mut state = stack.initial_state();
    let mut bad = input(0);
    bad.q.heading = f64::NAN;
    for k in 0..400 {
        let command = stack.update(&mut state, exact(), &bad);
        assert_eq!(command.torque, Torque::zero(), "update {k}: where the arm is nobody knows");
        assert!(!command.findings.is_empty(), "update {k}");
    }
    assert_eq!(state.mode(), Mode::Stop, "and then stopped");
}

#[test]
fn missing_and_late_updates_count_alike() {
    let stack = supervised();
    let (mut state, _) = running(&stack);
    let missed: Vec<_> = (0..3).map(|_| stack.missed(&mut state, PERIOD).mode).collect();
    assert_eq!(missed, [Mode::Hold, Mode::Hold, Mode::Stop], "three missed");
    for (elapsed, mode) in
        [(1.6, Mode::Run), (2.0, Mode::Run), (3.4, Mode::Run), (3.6, Mode::Stop), (1e9, Mode::Stop)]
    {
        let (mut state, k) = running(&stack);
        let timing = Timing { elapsed: elapsed * PERIOD, age: 0.0 };
        let command = stack.update(&mut state, timing, &input(k));
        assert_eq!((command.mode, command.findings), (mode, Findings::LATE), "after {elapsed} periods");
    }
    let (mut state, _) = running(&stack);
    let command = stack.missed(&mut state, f64::NAN);
    assert_eq!((command.mode, command.findings), (Mode::Hold, Findings::MISSED), "a clock that says nothing");
}

#[test]
fn a_duplicate_is_not_executed_and_its_time_is_not_lost() {
    let stack = supervised();
    let (mut state, k) = running(&stack);
    let (mut twin, _) = running(&stack);
    for i in 0..100 {
        let double = stack.update(&mut state, Timing { elapsed: 0.1 * PERIOD, age: 0.0 }, &input(k + i));
        assert_eq!((double.mode, double.findings), (Mode::Hold, Findings::EARLY), "the duplicate {i}");
        let command = stack.update(&mut state, Timing { elapsed: 0.9 * PERIOD, age: 0.0 }, &input(k + i));
        let wanted = stack.update(&mut twin, exact(), &input(k + i));
        assert_eq!(command.output, wanted.output, "update {i}");
    }
    // Duplicates alone are no inputs.
    let modes: Vec<_> =
        (0..3).map(|_| stack.update(&mut state, Timing { elapsed: 0.0, age: 0.0 }, &input(k)).mode).collect();
    assert_eq!(modes, [Mode::Hold, Mode::Hold, Mode::Stop], "a clock that stands");
}

#[test]
fn a_law_that_refuses_is_held_and_then_stopped() {
    // Limits so wide that they let an input through that overflows in the law.
    let wide = 1e200;
    let limits =
        SupervisorParams { speed: Velocity::splat(wide), acceleration: Velocity::splat(wide), ..params() };
    let stack = SupervisedStack::try_new(plain(Estimator::None), limits).unwrap();
    let (mut state, k) = running(&stack);
    let mut modes = Vec::new();
    for i in 0..4 {
        let mut huge = input(k + i);
        huge.nu.joints[0] = 1e190;
        let command = stack.update(&mut state, exact(), &huge);
        let found = if i < 3 { Findings::REFUSED } else { Findings::NONE };
        assert_eq!(command.findings, found, "update {i}: a stop does not ask the law");
        assert!(within_limits(&command.torque), "update {i}");
        modes.push(command.mode);
    }
    assert_eq!(modes, [Mode::Hold, Mode::Hold, Mode::Stop, Mode::Stop], "as any bad input");
}

#[test]
fn measured_positions_are_checked_the_same_way() {
    let estimator = Estimator::FilteredDifference { cutoff_hz: 60.0 };
    let stack = SupervisedStack::try_new(plain(estimator), params()).unwrap();
    let alone = plain(estimator);
    let (mut state, mut twin) = (stack.initial_state(), alone.initial_state());
    let measured = |k: u32| {
        let Input { q, reference, .. } = input(k);
        let rates = robot().wheel_rates(0.2, 0.1);
        let t = f64::from(k) * PERIOD;
        let wheels = WheelAngles { right: rates.right * t, left: rates.left * t };
        (Measurement { q, wheels: Some(wheels) }, reference)
    };
    for k in 0..100 {
        let (measurement, reference) = measured(k);
        let wanted = alone.update_measured(&mut twin, &measurement, &reference).unwrap();
        let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
        assert_eq!((command.output, command.findings), (Some(wanted), Findings::NONE), "update {k}");
    }
    let ready = state;
    type SpoilMeasured = fn(&mut Measurement<f64, 3>);
    let cases: [(Findings, SpoilMeasured); 4] = [
        (Findings::STATE_NOT_FINITE, |m| m.q.x = f64::NAN),
        (Findings::STATE_NOT_FINITE, |m| m.wheels = Some(WheelAngles { right: f64::NAN, left: 0.0 })),
        (Findings::STATE_RATE, |m| m.q.joints[0] += 0.2),
        // A wheel that jumps by most of a turn is seen in the estimated speed alone.
        (Findings::STATE_RANGE.and(Findings::REFUSED), |m| {
            m.wheels = m.wheels.map(|w| WheelAngles { right: w.right + 3.0, left: w.left + 3.0 });
        }),
    ];
    for (wanted, spoil) in cases {
        let mut state = ready;
        let mut modes = Vec::new();
        for k in 100..104 {
            let (mut measurement, reference) = measured(k);
            spoil(&mut measurement);
            let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
            assert!(command.findings.contains(wanted) || k > 100, "found {:?}", command.findings);
            assert!(within_limits(&command.torque), "update {k}");
            modes.push(command.mode);
        }
        assert_eq!(modes[..2], [Mode::Hold, Mode::Hold], "{wanted:?}");
    }
    // A stop goes on estimating, and a good reference ends it.
    let mut state = ready;
    for k in 100..150 {
        let (measurement, mut reference) = measured(k);
        reference.position.x = f64::NAN;
        let command = stack.update_measured(&mut state, exact(), &measurement, &reference);
        assert_eq!(command.findings, Findings::REFERENCE, "update {k}");
    }
    let run: Vec<_> = (150..160)
        .map(|k| {
            let (measurement, reference) = measured(k);
            stack.update_measured(&mut state, exact(), &measurement, &reference)
        })
        .collect();
    assert_eq!(run.iter().position(|command| command.mode == Mode::Run), Some(9), "ten good ones");
    let nu = run.last().and_then(|command| command.output).unwrap().signals.nu;
    assert!((nu.forward - 0.2).abs() < 1e-3, "the estimate did not begin anew: {}", nu.forward);
}

#[test]
fn the_base_alone_is_supervised_too() {
    let thesis = RobotParams::<f64, 3>::thesis();
    let robot = Robot::try_new(RobotParams {
        base_mass: thesis.base_mass,
        base_yaw_inertia: thesis.base_yaw_inertia,
        base_com_offset: 0.0,
        arm_offset: 0.2,
        mount_height: 0.0,
        wheel_radius: thesis.wheel_radius,
        track_width: thesis.track_width,
        gravity: thesis.gravity,
        links: [],
        rest_posture: [],
        friction: mm_model::Friction::none(),
        limits: mm_model::Limits { joints: [], wheel_torque: 60.0, joint_torque: [], speed: 2.0 },
    })
    .unwrap();
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, PERIOD);
    let outer =
        OuterParams { position_gain: Vector3::new(18.0, 18.0, 18.0), ..OuterParams::for_robot(&robot) };
    let params = StackParams { period: PERIOD, outer, gains, estimator: Estimator::None };
    let stack = ControlStack::try_new(robot, LawKind::Bfsmc, params).unwrap();
    let stack = SupervisedStack::try_new(stack, SupervisorParams::for_robot(&robot, PERIOD)).unwrap();
    let mut state = stack.initial_state();
    let q = Configuration { x: 0.0, y: 0.0, heading: 0.0, joints: [] };
    let reference = Reference {
        position: Vector3::new(0.2, 0.0, 0.0),
        velocity: Vector3::zeros(),
        acceleration: Vector3::zeros(),
    };
    let nu = Velocity { forward: 0.5, yaw_rate: 0.0, joints: [] };
    assert_eq!(stack.update(&mut state, exact(), &Input { q, nu, reference }).mode, Mode::Run, "runs");
    for _ in 0..3 {
        stack.missed(&mut state, PERIOD);
    }
    let command = stack.missed(&mut state, PERIOD);
    assert_eq!(command.mode, Mode::Stop, "stops");
    assert!(command.torque.right < 0.0 && command.torque.left < 0.0, "against the motion");
}

type SpoilParams = fn(&mut SupervisorParams<f64, 3>);

#[test]
fn parameters_are_refused_by_name() {
    use ParamError::{Negative, NonFinite, NonPositive, OutOfRange};
    let cases: [(ParamError, SpoilParams); 18] = [
        (NonPositive("position_m"), |p| p.position = 0.0),
        (NonFinite("position_m"), |p| p.position = f64::NAN),
        (Negative("joint_margin_rad"), |p| p.joint_margin = -0.1),
        (NonPositive("speed"), |p| p.speed.forward = 0.0),
        (NonFinite("speed"), |p| p.speed.joints[2] = f64::INFINITY),
        (NonPositive("acceleration"), |p| p.acceleration.yaw_rate = -1.0),
        (NonFinite("acceleration"), |p| p.acceleration.joints[0] = f64::NAN),
        (NonPositive("position_noise"), |p| p.position_noise = 0.0),
        (NonPositive("velocity_noise"), |p| p.velocity_noise = -1.0),
        (NonPositive("reference_step_m"), |p| p.reference_step = 0.0),
        (NonPositive("reference_acceleration_m_s2"), |p| p.reference_acceleration = 0.0),
        (Negative("age_s"), |p| p.age = -1e-3),
        (NonFinite("age_s"), |p| p.age = f64::NAN),
        (OutOfRange("hold_periods"), |p| p.hold_periods = 101),
        (NonPositive("recovery_periods"), |p| p.recovery_periods = 0),
        (OutOfRange("blind_periods"), |p| p.blind_periods = p.hold_periods),
        (NonPositive("stop_periods"), |p| p.stop_periods = 0),
        (NonPositive("braking_rate_1_s"), |p| p.braking_rate = 0.0),
    ];
    for (wanted, spoil) in cases {
        let mut spoilt = params();
        spoil(&mut spoilt);
        let error = SupervisedStack::try_new(plain(Estimator::None), spoilt).err();
        assert_eq!(error, Some(SetupError::Param(wanted)), "{wanted}");
    }
}

#[test]
fn a_recovery_may_be_forbidden() {
    let limits = SupervisorParams { recovery_periods: u32::MAX, ..params() };
    let stack = SupervisedStack::try_new(plain(Estimator::None), limits).unwrap();
    let (mut state, k) = running(&stack);
    let bad: Spoil = |i, _| i.reference.velocity.z = f64::NAN;
    modes(&stack, &mut state, k, 3, bad);
    assert_eq!(modes(&stack, &mut state, k + 3, 100, |_, _| {}), [Mode::Stop; 100], "only a reset helps");
}
