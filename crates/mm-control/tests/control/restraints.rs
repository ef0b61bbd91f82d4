//! The outer loop where it is restrained: the correction at its largest speed, channels at their bounds, the base held.
//!
//! Laws: (1) the correction is K e up to its largest speed and points the same way with that length beyond; (2) no joint rate leaves
//! gamma (hi - q) and -gamma (q - lo), no forward speed that of the robot's limits; the free channels make the solution of least
//! weighted norm for what the held ones leave, less what they fall short of, so that where enough is left the tip still gets
//! the velocity asked for; where nothing is exceeded the law is the ordinary one, bit for bit; nu_c does not jump when a channel comes
//! to its bound; (3) with the base held nu_c leaves it at rest, and released it has its weight by beta; (4) in all of this dnu_c
//! is the derivative of nu_c along the motion.
//!
//! Reference: central differences along the exact arc, extrapolated twice; the conditions of the minimum as one linear system, held
//! channels' columns left out, solved anew for every channel held, what is left as a quotient of determinants; beta in closed form.
//!
//! Tolerance: 1e-6 of |dnu_c| for the differences, of which they leave 3e-8; rounding times their condition for the minima;
//! 1e-12 for bounds. Where several channels are at their bounds the order in which they are held decides, and nu_c
//! may jump: the test counts those changes and asks for none at the first channel.

use crate::common::motion::{Path, arc, extrapolated, random_params, vector};
use crate::common::random::Random;
use mm_control::{ControlStack, Gains, Input, LawKind, OuterOutput, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Real, Robot, RobotParams, Velocity};
use nalgebra::{SMatrix, SVector, Vector3};

type Stack = ControlStack<f64, 3>;
type Params = OuterParams<f64, 3>;

#[expect(clippy::expect_used, reason = "a test that cannot build its stack has failed")]
fn stack(robot: &Robot<f64, 3>, outer: Params, period: f64) -> Stack {
    let gains = Gains::for_robot(robot, LawKind::Bsmc, period);
    ControlStack::try_new(
        *robot,
        LawKind::Bsmc,
        StackParams { period, outer, gains, estimator: mm_control::Estimator::None },
    )
    .expect("the random gains are allowed")
}

fn evaluate(
    stack: &Stack,
    (q, nu): (&Configuration<f64, 3>, &Velocity<f64, 3>),
    reference: &Reference<f64>,
    update: u32,
) -> OuterOutput<f64, 3> {
    let robot = stack.robot();
    stack.outer().evaluate(robot, (q, &robot.sines(q)), nu, reference, update)
}

/// What the channels are held to: lower and upper bounds, none for the yaw rate.
fn bounds(stack: &Stack, q: &Configuration<f64, 3>) -> [(f64, f64); 5] {
    let limits = &stack.robot().params().limits;
    let gamma = stack.outer().params().joint_limit_rate;
    let mut all = [(-limits.speed, limits.speed); 5];
    all[1] = (f64::NEG_INFINITY, f64::INFINITY);
    for (bound, (q, (lo, hi))) in all[2..].iter_mut().zip(q.joints.iter().zip(limits.joints)) {
        *bound = (gamma * (lo - q), gamma * (hi - q));
    }
    all
}

/// A case in which channels are likely to be held: a random robot within its joint limits, a small gamma.
fn tight(draw: &mut Random) -> (Stack, Configuration<f64, 3>) {
    let robot = draw.robot();
    let mut q = draw.configuration();
    for (joint, (lo, hi)) in q.joints.iter_mut().zip(robot.params().limits.joints) {
        *joint = lo + (hi - lo) * draw.between(0.02, 0.98);
    }
    let ratio = draw.between(0.2, 0.8);
    let mut params = random_params(draw, robot.manipulability(&q), ratio);
    params.joint_limit_rate = draw.between(0.3, 3.0);
    // The push off the limits is of the second order at its margin: differences lose theirs there.
    params.joint_limit_gain = 0.0;
    (stack(&robot, params, 1e-3), q)
}

/// Which channels are at a bound, as a mark each.
fn held(stack: &Stack, q: &Configuration<f64, 3>, nu_c: &SVector<f64, 5>) -> [bool; 5] {
    let bounds = bounds(stack, q);
    core::array::from_fn(|i| {
        let (lo, hi) = bounds[i];
        (nu_c[i] - lo).abs() < 1e-10 || (nu_c[i] - hi).abs() < 1e-10
    })
}

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

/// The velocity of least weighted norm for the free channels, those of a weight above 0, the others held to z.
///
/// From the stationary point of |nu - z|_W^2 / 2 + y'(u - J nu) - lambda^2 y'y / 2 in nu and y, solved as one system of eight.
fn least_norm(
    j: &SMatrix<f64, 3, 5>,
    (inverse_weights, z): (&SVector<f64, 5>, &SVector<f64, 5>),
    u: &Vector3<f64>,
    damping_squared: f64,
) -> SVector<f64, 5> {
    let free = SMatrix::<f64, 5, 5>::from_diagonal(&inverse_weights.map(|w| if w > 0.0 { 1.0 } else { 0.0 }));
    let weights =
        SMatrix::<f64, 5, 5>::from_diagonal(&inverse_weights.map(|w| if w > 0.0 { 1.0 / w } else { 1.0 }));
    let j_free = j * free;
    let mut system = SMatrix::<f64, 8, 8>::zeros();
    system.fixed_view_mut::<5, 5>(0, 0).copy_from(&weights);
    system.fixed_view_mut::<5, 3>(0, 5).copy_from(&-j_free.transpose());
    system.fixed_view_mut::<3, 5>(5, 0).copy_from(&j_free);
    system.fixed_view_mut::<3, 3>(5, 5).fill_diagonal(damping_squared);
    let mut right = SVector::<f64, 8>::zeros();
    right.fixed_rows_mut::<3>(5).copy_from(&(u - j * z));
    let solution = system.lu().solve(&right).unwrap_or_else(SVector::zeros);
    z + solution.fixed_rows::<5>(0)
}

/// What the law is asked to do, as dense matrices.
struct Dense {
    j: SMatrix<f64, 3, 5>,
    inverse_weights: SVector<f64, 5>,
    z: SVector<f64, 5>,
    u: Vector3<f64>,
    damping_squared: f64,
    bounds: [(f64, f64); 5],
}

/// The law written out: every step solves all of the system anew; nu_c, which channels were beyond, and whether the others fell short.
fn held_one_by_one(mut law: Dense) -> (SVector<f64, 5>, [bool; 5], bool) {
    let determinant = |j: &SMatrix<f64, 3, 5>, weights: &SVector<f64, 5>, damping: f64| {
        (j * SMatrix::from_diagonal(weights) * j.transpose() + SMatrix::identity() * damping).determinant()
    };
    let beyond = |nu: &SVector<f64, 5>, i: usize| {
        let (lo, hi) = law.bounds[i];
        if nu[i] > hi { (nu[i] - hi, hi) } else { ((nu[i] - lo).min(0.0), lo) }
    };
    let (mut aside, mut marks, mut short) = ([false; 5], [false; 5], false);
    let solved =
        |law: &Dense| least_norm(&law.j, (&law.inverse_weights, &law.z), &law.u, law.damping_squared);
    for _ in 0..2 {
        let nu = solved(&law);
        let excess = |i: usize| if aside[i] { 0.0 } else { beyond(&nu, i).0.abs() };
        let worst = (0..5).max_by(|a, b| excess(*a).total_cmp(&excess(*b))).unwrap_or(0);
        if excess(worst) <= 0.0 {
            break;
        }
        aside[worst] = true;
        let mut without = law.inverse_weights;
        without[worst] = 0.0;
        let left = determinant(&law.j, &without, law.damping_squared)
            / determinant(&law.j, &law.inverse_weights, law.damping_squared);
        short |= left < 0.3;
        if left > 0.1 {
            let (excess, bound) = beyond(&nu, worst);
            let lack = ((0.3 - left) / 0.2).max(0.0);
            law.u -= law.j.column(worst) * (excess * lack * lack);
            (law.inverse_weights, law.z[worst], marks[worst]) = (without, bound, true);
        }
    }
    let mut nu = solved(&law);
    for i in 0..5 {
        let (excess, bound) = beyond(&nu, i);
        if excess != 0.0 {
            (nu[i], marks[i]) = (bound, true);
        }
    }
    (nu, marks, short)
}

#[test]
fn held_channels_keep_their_bounds_and_the_others_take_over() {
    let mut draw = Random::seeded(14);
    let mut counts = [0; 6];
    let (mut exact, mut short_of, mut worst) = (0, 0, 0.0_f64);
    for case in 0..4000 {
        let (stack, q) = tight(&mut draw);
        let (robot, params) = (stack.robot(), stack.outer().params());
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let out = evaluate(&stack, (&q, &nu), &reference, 0);
        let nu_c = vector(&out.nu_c);
        let bounds = bounds(&stack, &q);
        for (i, (lo, hi)) in bounds.into_iter().enumerate() {
            let is = nu_c[i];
            assert!(is >= lo - 1e-12 && is <= hi + 1e-12, "case {case}, channel {i}: {is} not in {lo}..{hi}");
        }
        let held = held(&stack, &q, &nu_c);
        assert_eq!(out.joint_limited, held[2..].contains(&true), "case {case}: the status of {held:?}");
        assert_eq!(out.speed_limited, held[0], "case {case}: the status of {held:?}");
        counts[held.iter().filter(|is| **is).count()] += 1;

        // The climb of the manipulability is left to the ordinary law's own test.
        if robot.manipulability(&q) < params.manipulability_threshold {
            continue;
        }
        let mut z = SVector::<f64, 5>::zeros();
        for i in 0..3 {
            z[2 + i] = params.posture_gain * (robot.params().rest_posture[i] - q.joints[i]);
        }
        let u = reference.velocity
            - params.position_gain.component_mul(&(robot.tip_position(&q) - reference.position));
        let inverse_weights = vector(&params.weights).map(|w| 1.0 / w);
        let j = robot.jacobian(&q).to_matrix();
        let (expected, marks, short) =
            held_one_by_one(Dense { j, inverse_weights, z, u, damping_squared: out.damping_squared, bounds });
        let off = (nu_c - expected).norm() / expected.norm();
        // The inverse is updated twice, each time with 2 % of the determinant left at least.
        let size = j.norm_squared() * inverse_weights.max();
        let condition = 1e3 * (size.powi(3) / robot.manipulability(&q).powi(2)).max(1.0);
        assert!(
            off < 1e-15 * condition + 1e-11,
            "case {case}: off by {off:e} with {held:?}, condition {condition:e}"
        );
        assert_eq!((held, out.near_singular), (marks, short), "case {case}");
        worst = worst.max(off);
        if short {
            short_of += 1;
        } else if held.iter().filter(|is| **is).count() < 3 {
            let off = (j * nu_c - u).norm() / (j.norm() * nu_c.norm());
            assert!(off < 1e-9, "case {case}: enough is left, but the tip is off by {off:e}");
            exact += u32::from(held.contains(&true));
        }
    }
    println!("cases by channels held: {counts:?}; exact: {exact}, short: {short_of}, worst {worst:.1e}");
    assert!(counts[..4].iter().all(|&count| count > 100), "{counts:?}");
    assert!(exact > 200 && short_of > 200, "{exact}, {short_of}");
}

#[test]
fn the_rate_is_the_derivative_where_channels_are_held() {
    const STEP: f64 = 2e-4;
    let mut draw = Random::seeded(15);
    let (mut checked, mut short, mut kinks, mut worst) = (0, 0, 0, 0.0_f64);
    for _ in 0..2000 {
        let (stack, q) = tight(&mut draw);
        let nu = draw.velocity();
        let path = Path::random(&mut draw, stack.robot().tip_position(&q));
        let at = |t: f64| evaluate(&stack, (&arc(&q, &nu, t), &nu), &path.at(t), 0);
        let pieces = |t: f64| {
            let out = at(t);
            (held(&stack, &arc(&q, &nu, t), &vector(&out.nu_c)), out.near_singular)
        };
        let now = pieces(0.0);
        if !now.0.contains(&true) || [-STEP, -0.5 * STEP, 0.5 * STEP, STEP].iter().any(|&t| pieces(t) != now)
        {
            continue;
        }
        let [expected, finer] = [1.0, 0.5].map(|f| extrapolated(|t| vector(&at(t).nu_c), STEP * f));
        if (expected - finer).norm() > 3e-7 * finer.norm() {
            // A kink within the step: nothing is left there any more, or another channel becomes the worst.
            kinks += 1;
            continue;
        }
        let off = (vector(&at(0.0).dnu_c) - finer).norm() / finer.norm();
        (checked, short, worst) = (checked + 1, short + u32::from(now.1), worst.max(off));
    }
    println!("{checked} checked, {short} short, {kinks} kinks, worst {worst:.1e}");
    assert!(checked > 1000 && short > 500 && worst < 1e-6, "{checked}, {short}, {worst:e}");
    assert!(kinks < 30, "{kinks} kinks");
}

#[test]
fn nu_c_does_not_jump_when_a_channel_comes_to_its_bound() {
    let mut draw = Random::seeded(16);
    let (mut found, mut first, mut jumps, mut worst) = (0, 0, 0, 0.0_f64);
    for case in 0..1000 {
        let (stack, q) = tight(&mut draw);
        let nu = draw.velocity();
        let path = Path::random(&mut draw, stack.robot().tip_position(&q));
        let at = |t: f64| {
            let q = arc(&q, &nu, t);
            let nu_c = vector(&evaluate(&stack, (&q, &nu), &path.at(t), 0).nu_c);
            (held(&stack, &q, &nu_c), nu_c)
        };
        let (mut a, mut b) = (-0.2, 0.2);
        if at(a).0 == at(b).0 {
            continue;
        }
        // Down to the instant at which a channel comes to its bound or leaves it.
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if at(middle).0 == at(a).0 { a = middle } else { b = middle }
        }
        let (left, right) = (at(a - 1e-9).1, at(b + 1e-9).1);
        let jump = (left - right).norm() / (1.0 + left.norm());
        let count = |held: [bool; 5]| held.into_iter().filter(|is| *is).count();
        if count(at(a).0) + count(at(b).0) == 1 {
            assert!(jump < 1e-5, "case {case}: nu_c jumps by {jump:e} when the first channel is held");
            first += 1;
        }
        jumps += u32::from(jump > 1e-5);
        (found, worst) = (found + 1, worst.max(jump));
    }
    println!(
        "{found} changes, {first} of them to the first channel held, {jumps} with jumps up to {worst:.1e}"
    );
    assert!(first > 50, "only {first} changes from none held");
}

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
