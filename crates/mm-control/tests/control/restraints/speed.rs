//! The correction at its largest speed.

use super::{Params, evaluate, stack};
use crate::common::motion::{Path, arc, extrapolated, random_params, vector};
use crate::common::random::Random;

#[test]
fn the_correction_keeps_its_direction_and_its_largest_speed() {
    let mut draw = Random::seeded(11);
    let mut limited = 0;
    for case in 0..2000 {
        let robot = draw.robot();
        let q = draw.configuration();
        let mut params = random_params(&mut draw, robot.manipulability(&q), 0.5);
        params.correction_speed_limit = draw.between(0.5, 10.0);
        let most = params.correction_speed_limit;
        let stack = stack(&robot, params, 1e-3);
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let out = evaluate(&stack, (&q, &nu), &reference, 0);
        let correction = params.position_gain.component_mul(&(robot.tip_position(&q) - reference.position));
        let length = correction.norm();
        assert_eq!(out.speed_limited, length > most, "case {case}: {length} with a limit of {most}");
        let expected = reference.velocity - correction * (most / length).min(1.0);
        let j = robot.jacobian(&q).to_matrix();
        let got = j * vector(&out.nu_c);
        let scale = j.norm() * vector(&out.nu_c).norm();
        assert!((got - expected).norm() < 1e-11 * scale, "case {case}: {got} instead of {expected}");
        limited += u32::from(out.speed_limited);
    }
    assert!((500..1500).contains(&limited), "{limited} of 2000 cases were limited");
}

#[test]
fn a_correction_below_the_limit_changes_no_bit() {
    let mut draw = Random::seeded(12);
    for case in 0..500 {
        let robot = draw.robot();
        let q = draw.configuration();
        let free = random_params(&mut draw, robot.manipulability(&q), 0.5);
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let speed = free.position_gain.component_mul(&(robot.tip_position(&q) - reference.position)).norm();
        let limited = Params { correction_speed_limit: speed * 1.001, joint_limit_rate: 1e5, ..free };
        // Gamma large enough that no joint within its limits is held.
        let inside = robot.within_joint_limits(&q.joints);
        let [a, b] =
            [free, limited].map(|params| evaluate(&stack(&robot, params, 1e-3), (&q, &nu), &reference, 0));
        let fast = a.nu_c.forward.abs() > robot.params().limits.speed || !inside;
        assert!(fast || (a.nu_c, a.dnu_c) == (b.nu_c, b.dnu_c), "case {case}: {a:?} and {b:?}");
    }
}

#[test]
fn the_rate_is_the_derivative_where_the_speed_is_limited() {
    const STEP: f64 = 8e-4;
    let mut draw = Random::seeded(13);
    let (mut checked, mut worst) = (0, 0.0_f64);
    for case in 0..500 {
        let robot = draw.robot();
        let q = draw.configuration();
        let mut params = random_params(&mut draw, robot.manipulability(&q), 0.5);
        params.correction_speed_limit = draw.between(0.3, 1.0);
        params.joint_limit_gain = 0.0;
        let stack = stack(&robot, params, 1e-3);
        let nu = draw.velocity();
        let path = Path::random(&mut draw, robot.tip_position(&q));
        let at = |t: f64| evaluate(&stack, (&arc(&q, &nu, t), &nu), &path.at(t), 0);
        // Next to a singularity the law changes within less than a step.
        let smooth = robot.manipulability(&q) > 0.05;
        if !(smooth
            && [-STEP, 0.0, STEP].iter().all(|&t| at(t).speed_limited && at(t).damping_squared <= 0.0))
        {
            continue;
        }
        let expected = extrapolated(|t| vector(&at(t).nu_c), STEP);
        let off = (vector(&at(0.0).dnu_c) - expected).norm() / expected.norm();
        assert!(off < 1e-6, "case {case}: off by {off:e}");
        (checked, worst) = (checked + 1, worst.max(off));
    }
    println!("{checked} checked, worst {worst:.1e}");
    assert!(checked > 300, "only {checked} cases were limited");
}
