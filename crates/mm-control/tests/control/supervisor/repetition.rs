//! A sensor that stands still.

use super::*;

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
