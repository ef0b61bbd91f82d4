//! Channels at their bounds, against the conditions of the minimum as one linear system.

use super::{bounds, evaluate, held, tight};
use crate::common::motion::{Path, arc, extrapolated, vector};
use crate::common::random::Random;
use nalgebra::{SMatrix, SVector, Vector3};

/// The velocity of least weighted norm for the free channels, those of a weight above 0, the others held to z.
///
/// From the stationary point of |nu - z|_W^2 / 2 + y'(u - J nu) - lambda^2 y'y / 2 in nu and y, solved as one system of eight.
pub(super) fn least_norm(
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
