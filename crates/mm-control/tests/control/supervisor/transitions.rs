//! Run, Hold, Stop, Fault: each way out of each.

use super::*;

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
