//! Each finding, by an input that has exactly that fault, and by no other; good inputs give the bits of the stack.

use super::*;

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
