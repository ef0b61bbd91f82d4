//! The base held at the start and released.

use super::held_channels::least_norm;
use super::{Params, evaluate, stack};
use crate::common::motion::{Path, arc, extrapolated, random_params, vector};
use crate::common::random::Random;
use mm_control::{ControlStack, Gains, Input, LawKind, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Real, Robot, RobotParams, Velocity};
use nalgebra::{SVector, Vector3};

/// beta of the release in closed form: 0 until `hold`, 1 from `hold` + `release` on.
fn beta(t: f64, hold: f64, release: f64) -> f64 {
    let u = ((t - hold) / release).clamp(0.0, 1.0);
    u * u * (3.0 - 2.0 * u)
}

#[test]
fn the_base_is_held_and_released() {
    const PERIOD: f64 = 1e-3;
    let mut draw = Random::seeded(17);
    for case in 0..300 {
        let robot = draw.robot();
        let q = draw.configuration();
        let ratio = draw.between(0.01, 0.03);
        let mut params = random_params(&mut draw, robot.manipulability(&q), ratio);
        (params.base_hold, params.base_release) = (0.5, 0.25);
        (params.joint_limit_gain, params.damping_max) = (0.0, 0.0);
        let stack = stack(&robot, params, PERIOD);
        let free = self::stack(&robot, Params { base_hold: 0.0, base_release: 0.0, ..params }, PERIOD);
        assert_eq!(free.outer().held_updates(), 0, "nothing to count");
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let u = reference.velocity
            - params.position_gain.component_mul(&(robot.tip_position(&q) - reference.position));
        let j = robot.jacobian(&q).to_matrix();
        for update in [0, 1, 499, 500, 501, 600, 700, 749, 750, 751, 5000] {
            let out = evaluate(&stack, (&q, &nu), &reference, update);
            let share = beta(f64::from(update) * PERIOD, 0.5, 0.25);
            if share <= 0.0 {
                assert_eq!(
                    (out.nu_c.forward, out.nu_c.yaw_rate, out.dnu_c.forward, out.dnu_c.yaw_rate),
                    (0.0, 0.0, 0.0, 0.0),
                    "case {case}, update {update}: the base moves"
                );
            }
            let mut weights = vector(&params.weights).map(|w| 1.0 / w);
            (weights[0], weights[1]) = (weights[0] * share, weights[1] * share);
            let mut z = SVector::<f64, 5>::zeros();
            for i in 0..3 {
                z[2 + i] = params.posture_gain * (robot.params().rest_posture[i] - q.joints[i]);
            }
            let expected = least_norm(&j, (&weights, &z), &u, 0.0);
            let off = (vector(&out.nu_c) - expected).norm() / expected.norm();
            assert!(off < 1e-6, "case {case}, update {update}: off by {off:e}");
            if share >= 1.0 {
                let ordinary = evaluate(&free, (&q, &nu), &reference, 0);
                let off =
                    (vector(&out.dnu_c) - vector(&ordinary.dnu_c)).norm() / vector(&ordinary.dnu_c).norm();
                assert!(off < 1e-9, "case {case}, update {update}: the free law differs by {off:e}");
            }
        }
    }
}

#[test]
fn the_rate_is_the_derivative_while_the_base_is_released() {
    // Differences of whole updates: 4, 2 and 1 of them.
    const PERIOD: f64 = 2e-4;
    let mut draw = Random::seeded(18);
    let (mut checked, mut damped, mut worst) = (0, 0, 0.0_f64);
    for case in 0..600 {
        let robot = draw.robot();
        let q = draw.configuration();
        let ratio = draw.between(0.05, 0.5);
        let mut params = random_params(&mut draw, robot.manipulability(&q), ratio);
        (params.base_hold, params.base_release) = (0.2, 0.4);
        (params.joint_limit_gain, params.manipulability_gain) = (0.0, 0.0);
        let stack = stack(&robot, params, PERIOD);
        let nu = draw.velocity();
        let path = Path::random(&mut draw, robot.tip_position(&q));
        // In the middle of the hold or of the release, which begins at update 1000.
        let middle = if case % 3 == 0 { 100 + case } else { 1100 + 3 * case };
        let at = |t: f64| {
            let (update, _) = Real::split_index(f64::from(middle) + t / PERIOD + 0.5);
            let update = u32::try_from(update).unwrap_or(0);
            evaluate(&stack, (&arc(&q, &nu, t), &nu), &path.at(t), update)
        };
        let steps = [-4.0, -2.0, -1.0, 1.0, 2.0, 4.0];
        if steps.iter().any(|&n| (at(n * PERIOD).damping_squared > 0.0) != (at(0.0).damping_squared > 0.0)) {
            continue;
        }
        let expected = extrapolated(|t| vector(&at(t).nu_c), 4.0 * PERIOD);
        let off = (vector(&at(0.0).dnu_c) - expected).norm() / expected.norm();
        if off > 1e-6 {
            println!("case {case}: off by {off:e}, {}", at(0.0).damping_squared);
        }
        (checked, worst) = (checked + 1, worst.max(off));
        damped += u32::from(at(0.0).damping_squared > 0.0);
    }
    println!("{checked} checked, {damped} damped, worst {worst:.1e}");
    assert!(checked > 500 && damped > 50 && worst < 1e-5, "{checked}, {damped}, {worst:e}");
}

#[test]
fn single_precision_holds_and_releases_at_the_same_updates() {
    let params =
        |hold: f64, release: f64| Params { base_hold: hold, base_release: release, ..Params::default() };
    for (hold, release, ticks) in
        [(2.0, 2.0, 4000), (2.0, 0.0, 2000), (0.3, 0.7, 1000), (100.0, 1.0, 101_000)]
    {
        let double = stack(&thesis(), params(hold, release), 1e-3);
        let robot = single_thesis();
        let gains = Gains::for_robot(&robot, LawKind::Bsmc, 1e-3);
        let outer = OuterParams::<f32, 3> {
            base_hold: Real::from_f64(hold),
            base_release: Real::from_f64(release),
            ..OuterParams::default()
        };
        let params = StackParams { period: 1e-3, outer, gains, estimator: mm_control::Estimator::None };
        let single = ControlStack::try_new(robot, LawKind::Bsmc, params).map_err(|error| error.to_string());
        let single = single.unwrap_or_else(|error| panic!("{error}"));
        let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
        let wide = Configuration { joints: thesis().params().rest_posture, ..Configuration::zero() };
        let tip = thesis().tip_position(&wide) + Vector3::new(0.01, 0.02, 0.01);
        let reference =
            Reference { position: tip, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
        let narrow = Reference {
            position: tip.map(Real::from_f64),
            velocity: Vector3::zeros(),
            acceleration: Vector3::zeros(),
        };
        for update in 0..ticks + 3 {
            let a = evaluate(&double, (&wide, &Velocity::zero()), &reference, update).nu_c;
            let at = (&q, &robot.sines(&q));
            let b = single.outer().evaluate(&robot, at, &Velocity::zero(), &narrow, update).nu_c;
            assert_eq!(a.forward == 0.0, b.forward == 0.0, "{hold} s, {release} s, update {update}");
            let off = (a.forward - f64::from(b.forward)).abs();
            assert!(off < 2e-4, "{hold} s, {release} s, update {update}: {a:?} and {b:?}");
        }
    }
}

#[test]
fn updates_are_counted_only_while_the_base_is_held() {
    let robot = thesis();
    let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
    let hold = Vector3::zeros();
    let reference = Reference {
        position: robot.tip_position(&q) + Vector3::new(0.05, 0.02, 0.0),
        velocity: hold,
        acceleration: hold,
    };
    let input = Input { q, nu: Velocity::zero(), reference };
    let params = Params { base_hold: 0.01, base_release: 0.005, ..Params::default() };
    let stack = stack(&robot, params, 1e-3);
    let mut state = stack.initial_state();
    for update in 0..30 {
        let before = state;
        let out = stack.update(&mut state, &input).map(|out| out.signals.nu_c.forward);
        let moves = out.is_ok_and(|forward| forward.abs() > 0.0);
        assert_eq!(moves, update > 10, "update {update}");
        // A refused update does not count.
        let mut refused = before;
        let bad = Input { nu: Velocity::splat(f64::NAN), ..input };
        assert!(stack.update(&mut refused, &bad).is_err() && refused == before, "update {update}");
    }
}

#[test]
fn a_hold_that_is_set_later_counts_from_the_first_update() {
    let robot = thesis();
    let q = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
    let reference = Reference {
        position: robot.tip_position(&q) + Vector3::new(0.05, 0.02, 0.0),
        velocity: Vector3::zeros(),
        acceleration: Vector3::zeros(),
    };
    let input = Input { q, nu: Velocity::zero(), reference };
    let free = stack(&robot, Params::default(), 1e-3);
    let later = stack(&robot, Params { base_hold: 0.02, ..Params::default() }, 1e-3);
    let mut state = free.initial_state();
    for update in 0..25 {
        let mut other = state;
        let moved = later.update(&mut other, &input).is_ok_and(|out| out.signals.nu_c.forward > 0.0);
        assert_eq!(moved, update >= 20, "update {update}");
        assert!(free.update(&mut state, &input).is_ok(), "update {update}");
    }
}

#[expect(clippy::expect_used, reason = "the preset is a robot")]
fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).expect("the preset is a robot")
}

#[expect(clippy::expect_used, reason = "the preset is a robot")]
fn single_thesis() -> Robot<f32, 3> {
    Robot::try_new(RobotParams::thesis()).expect("the preset is a robot")
}
