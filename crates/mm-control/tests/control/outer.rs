//! The outer loop against its definition, its derivative and an independent pseudo-inverse, on random robots.
//!
//! Laws: (1) dnu_c is the time derivative of nu_c along the motion with the measured nu, damping and posture task included: the
//! sliding mode needs dnu_c, and whatever is wrong with it acts as a disturbance. (2) Undamped, J nu_c = p_d' - K e, whatever z
//! is: e' = -K e rests on it. (3) nu_c is the solution of least weighted norm, damped where the manipulability is low.
//! (4) Neither nu_c nor dnu_c jumps at the threshold of the damping; nu_c is bounded where J loses rank.
//!
//! Reference: central differences along the exact arc, extrapolated twice (error h^6); the singular value decomposition of
//! nalgebra for the inverse, with damped singular values; (3.62) and (4.1) to (4.13) of the thesis.
//!
//! Tolerance: 1e-7 of |dnu_c| for the differences: steps of 0.2 to 0.8 ms leave 3e-10 of it here, the
//! exact figure being printed.
//! 1e-9 of the norm for the inverses, rounding times a condition number of up to 1e6; others by their reasons.

use crate::common::motion::{Path, arc, extrapolated, random_params, vector};
use crate::common::random::Random;
use mm_control::{ControlStack, Estimator, Gains, LawKind, OuterOutput, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Mechanism, Real, Robot, RobotParams, Velocity};
use nalgebra::{SMatrix, SVector, Vector3};

type Arm = Robot<f64, 3>;
type Params = OuterParams<f64, 3>;

#[expect(clippy::expect_used, reason = "a test that cannot build its stack has failed")]
fn stack(robot: &Arm, outer: Params) -> ControlStack<f64, 3> {
    let gains = Gains::for_robot(robot, LawKind::Bsmc, 1e-3);
    ControlStack::try_new(
        *robot,
        LawKind::Bsmc,
        StackParams { period: 1e-3, outer, gains, estimator: Estimator::None },
    )
    .expect("the random gains are allowed")
}

fn evaluate(
    stack: &ControlStack<f64, 3>,
    q: &Configuration<f64, 3>,
    nu: &Velocity<f64, 3>,
    reference: &Reference<f64>,
) -> OuterOutput<f64, 3> {
    let robot = stack.robot();
    stack.outer().evaluate(robot, (q, &robot.sines(q)), nu, reference, 0)
}

/// Postures of the derivative's cases.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Zone {
    Far,
    Damped,
    Upright,
    JointLimits,
}

impl Zone {
    fn case(self, draw: &mut Random) -> (ControlStack<f64, 3>, Configuration<f64, 3>) {
        let robot = draw.robot();
        let mut q = draw.configuration();
        if self == Self::Upright {
            q.joints[1] = 0.5 * f64::PI + draw.between(-0.15, 0.15);
            q.joints[2] = draw.between(-0.15, 0.15);
        }
        let ratio = draw.between(0.2, 0.8);
        let mut params = random_params(draw, robot.manipulability(&q), ratio);
        match self {
            Self::Damped => params.manipulability_threshold /= 0.1,
            Self::Upright => params.manipulability_threshold = 0.1_f64.max(2.0 * robot.manipulability(&q)),
            Self::JointLimits => {
                for (joint, (lo, hi)) in q.joints.iter_mut().zip(robot.params().limits.joints) {
                    let depth = draw.between(-0.2, 1.0) * params.joint_limit_margin;
                    *joint = if draw.between(0.0, 1.0) < 0.5 { lo + depth } else { hi - depth };
                }
                // Undamped next to a singularity the law changes within less than a step of the differences.
                let threshold = robot.manipulability(&q) * draw.between(0.2, 3.0);
                params.manipulability_threshold = threshold.max(0.1);
            }
            Self::Far => {}
        }
        (stack(&robot, params), q)
    }
}

/// Which pieces of the law hold at a posture: damping, and the push of each joint.
fn pieces(stack: &ControlStack<f64, 3>, q: &Configuration<f64, 3>) -> [bool; 7] {
    let params = stack.outer().params();
    let mut on = [false; 7];
    on[6] = stack.robot().manipulability(q) < params.manipulability_threshold;
    let limits = stack.robot().params().limits.joints;
    for (i, (&joint, (lo, hi))) in q.joints.iter().zip(limits).enumerate() {
        on[2 * i] = joint > hi - params.joint_limit_margin;
        on[2 * i + 1] = joint < lo + params.joint_limit_margin;
    }
    on
}

#[test]
fn the_rate_is_the_derivative_along_the_motion() {
    const STEP: f64 = 8e-4;
    let mut draw = Random::seeded(1);
    for zone in [Zone::Far, Zone::Damped, Zone::Upright, Zone::JointLimits] {
        let (mut checked, mut pushed, mut damped, mut worst) = (0, 0, 0, 0.0_f64);
        for case in 0..1000 {
            let (stack, q) = zone.case(&mut draw);
            let nu = draw.velocity();
            let path = Path::random(&mut draw, stack.robot().tip_position(&q));
            let law = |t: f64| vector(&evaluate(&stack, &arc(&q, &nu, t), &nu, &path.at(t)).nu_c);
            let on = pieces(&stack, &q);
            if [-STEP, STEP].iter().any(|&t| pieces(&stack, &arc(&q, &nu, t)) != on) {
                // The second derivative jumps in between: differences lose their order there. See the test of continuity.
                continue;
            }
            let expected = extrapolated(law, STEP);
            let got = vector(&evaluate(&stack, &q, &nu, &path.at(0.0)).dnu_c);
            let error = (got - expected).norm() / expected.norm();
            worst = worst.max(error);
            assert!(error < 1e-7, "{zone:?}, case {case}: off by {error:e} of {}", expected.norm());
            checked += 1;
            pushed += u32::from(on[..6].contains(&true));
            damped += u32::from(on[6]);
        }
        println!("{zone:?}: {checked} checked, {pushed} near limits, {damped} damped, worst {worst:.1e}");
        assert!(checked > 900, "{zone:?}: only {checked} cases were smooth");
        match zone {
            Zone::Far => assert_eq!(damped, 0, "far from singular postures nothing is damped"),
            Zone::Damped | Zone::Upright => assert_eq!(damped, checked, "{zone:?}: every case is damped"),
            Zone::JointLimits => assert!(pushed > 900, "only {pushed} cases were near a limit"),
        }
    }
}

#[test]
fn undamped_the_tip_gets_the_velocity_asked_for() {
    let mut draw = Random::seeded(2);
    let mut moved = 0.0_f64;
    for case in 0..2000 {
        let (stack, q) = Zone::Far.case(&mut draw);
        let (robot, params) = (stack.robot(), stack.outer().params());
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let out = evaluate(&stack, &q, &nu, &reference);
        let error = robot.tip_position(&q) - reference.position;
        let u = reference.velocity - params.position_gain.component_mul(&error);
        let j = robot.jacobian(&q).to_matrix();
        let scale = j.norm() * vector(&out.nu_c).norm() + u.norm();
        let off = (j * vector(&out.nu_c) - u).norm() / scale;
        assert!(off < 1e-11, "case {case}: the tip's velocity is off by {off:e}");

        // The same without z: what z adds must lie in the null space, and must be there.
        let bare = Params { posture_gain: 0.0, joint_limit_gain: 0.0, manipulability_gain: 0.0, ..*params };
        let task = vector(&out.nu_c) - vector(&evaluate(&self::stack(robot, bare), &q, &nu, &reference).nu_c);
        let off = (j * task).norm() / scale;
        assert!(off < 1e-11, "case {case}: z moves the tip by {off:e}");
        moved = moved.max(task.norm());
    }
    assert!(moved > 0.1, "no posture task moved anything: {moved}");
}

/// W^-1/2 times the pseudo-inverse of J W^-1/2, from its singular values, damped as sigma / (sigma^2 + lambda^2).
fn inverse(j: &SMatrix<f64, 3, 5>, weights: &SVector<f64, 5>, damping_squared: f64) -> SMatrix<f64, 5, 3> {
    let root = SMatrix::<f64, 5, 5>::from_diagonal(&weights.map(|w| 1.0 / w.sqrt()));
    let svd = (j * root).svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return SMatrix::zeros() };
    let inverted = svd.singular_values.map(|s| s / (s * s + damping_squared));
    root * v_t.transpose() * SMatrix::<f64, 3, 3>::from_diagonal(&inverted) * u.transpose()
}

#[test]
fn the_inverse_is_the_one_of_least_norm() {
    let mut draw = Random::seeded(3);
    for case in 0..2000 {
        let zone = [Zone::Far, Zone::Damped, Zone::Upright][case % 3];
        let (stack, q) = zone.case(&mut draw);
        let robot = *stack.robot();
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let j = robot.jacobian(&q).to_matrix();
        let plain = zone == Zone::Far && case % 2 == 0;
        let outer = Params {
            posture_gain: 0.0,
            joint_limit_gain: 0.0,
            manipulability_gain: 0.0,
            minimum_norm: plain,
            ..*stack.outer().params()
        };
        let out = evaluate(&self::stack(&robot, outer), &q, &nu, &reference);
        let u = reference.velocity
            - outer.position_gain.component_mul(&(robot.tip_position(&q) - reference.position));
        let w2 = (j * j.transpose()).determinant()
            / (outer.manipulability_threshold * outer.manipulability_threshold);
        let lambda = if plain || w2 > 1.0 { 0.0 } else { outer.damping_max * (1.0 - w2) };
        assert!(
            (out.damping_squared - lambda * lambda).abs() < 1e-9,
            "case {case}: damping {}",
            out.damping_squared
        );
        let weights = if plain { SVector::repeat(1.0) } else { vector(&outer.weights) };
        let expected =
            if plain { svd_pseudo_inverse(&j) } else { inverse(&j, &weights, lambda * lambda) } * u;
        let off = (vector(&out.nu_c) - expected).norm() / expected.norm();
        assert!(off < 1e-9, "{zone:?}, case {case}: off by {off:e} of {}", expected.norm());
    }
}

/// The Moore-Penrose inverse (3.62) as nalgebra forms it.
fn svd_pseudo_inverse(j: &SMatrix<f64, 3, 5>) -> SMatrix<f64, 5, 3> {
    j.svd(true, true).pseudo_inverse(1e-12).unwrap_or_else(|_| SMatrix::zeros())
}

#[test]
fn damping_sets_in_without_a_jump() {
    let mut draw = Random::seeded(4);
    for case in 0..500 {
        let (stack, q) = Zone::Damped.case(&mut draw);
        let robot = *stack.robot();
        // The threshold is put where the arm is, and the arm moved across it by 1e-8 along the gradient.
        let outer = Params { manipulability_threshold: robot.manipulability(&q), ..*stack.outer().params() };
        let stack = self::stack(&robot, outer);
        let slope = robot.manipulability_slope(&robot.posture(&q.joints), &[0.0; 3]).gradient;
        let steepness = slope.iter().map(|g| g * g).sum::<f64>().sqrt();
        let moved = |step: f64| {
            let [q1, q2, q3] = q.joints;
            let [g1, g2, g3] = slope.map(|g| g * step / steepness);
            Configuration { joints: [q1 + g1, q2 + g2, q3 + g3], ..q }
        };
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let [below, above] = [-1e-8, 1e-8].map(|step| evaluate(&stack, &moved(step), &nu, &reference));
        assert!(below.damping_squared > 0.0, "case {case}: no damping below the threshold");
        assert_eq!(above.damping_squared.to_bits(), 0, "case {case}: damping above the threshold");
        for (what, a, b) in [("nu_c", below.nu_c, above.nu_c), ("its rate", below.dnu_c, above.dnu_c)] {
            let jump = (vector(&a) - vector(&b)).norm() / vector(&a).norm();
            assert!(jump < 1e-4, "case {case}: {what} jumps by {jump:e}");
        }
    }
}

/// An arm exactly upright over its yaw axis: J has rank 2.
fn upright(heading: f64, yaw: f64) -> Configuration<f64, 3> {
    Configuration { heading, joints: [yaw, 0.5 * f64::PI, 0.0], ..Configuration::zero() }
}

#[test]
fn nu_c_is_bounded_where_the_jacobian_loses_rank() {
    let mut draw = Random::seeded(5);
    for case in 0..500 {
        let robot = draw.robot();
        let q = upright(draw.between(-3.0, 3.0), draw.between(-3.0, 3.0));
        let outer = Params { weights: Velocity::splat(1.0), ..random_params(&mut draw, 0.1, 1.0) };
        let stack = stack(&robot, outer);
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let out = evaluate(&stack, &q, &nu, &reference);
        assert!(
            out.manipulability_squared < 1e-20,
            "case {case}: not singular, {}",
            out.manipulability_squared
        );
        // With W = I: the damped inverse is at most 1/(2 lambda), the projection onto the null space at most 1.
        let u = reference.velocity - outer.position_gain.component_mul(&out.error);
        let pull = robot
            .params()
            .rest_posture
            .iter()
            .zip(q.joints)
            .map(|(rest, q)| outer.posture_gain * (rest - q).abs());
        let push = 3.0 * outer.joint_limit_gain * (1.0 + 6.3 / outer.joint_limit_margin).powi(2);
        let bound = u.norm() / (2.0 * outer.damping_max) + pull.sum::<f64>() + push;
        let size = vector(&out.nu_c).norm();
        assert!(size <= bound, "case {case}: {size} above {bound}");
        // Away from the joint limits the push is none, and the bound is a tight one.
        let free = Params { joint_limit_gain: 0.0, posture_gain: 0.0, ..outer };
        let size = vector(&evaluate(&self::stack(&robot, free), &q, &nu, &reference).nu_c).norm();
        assert!(size <= u.norm() / (2.0 * outer.damping_max) * (1.0 + 1e-9), "case {case}: {size} without z");
        let plain = self::stack(&robot, Params { minimum_norm: true, ..outer });
        let out = evaluate(&plain, &q, &nu, &reference);
        assert!(out.nu_c.is_finite() && out.dnu_c.is_finite(), "case {case}: minimum norm gives {out:?}");
    }
}

#[test]
fn the_climb_raises_the_manipulability() {
    let mut draw = Random::seeded(6);
    for case in 0..1000 {
        let zone = [Zone::Damped, Zone::Upright][case % 2];
        let (stack, q) = zone.case(&mut draw);
        let robot = *stack.robot();
        // For W = I the null-space projection is symmetric and not negative, so that it cannot turn the gradient round.
        let still =
            Params { weights: Velocity::splat(1.0), manipulability_gain: 0.0, ..*stack.outer().params() };
        let climbing = Params { manipulability_gain: 0.02, ..still };
        let (nu, reference) = (draw.velocity(), draw.reference_near(robot.tip_position(&q)));
        let [a, b] =
            [climbing, still].map(|outer| evaluate(&self::stack(&robot, outer), &q, &nu, &reference).nu_c);
        let step = a.minus(b);
        let size = vector(&step).norm();
        assert!(size > 0.0, "case {case}: no climb");
        let h = 1e-5 / size;
        let [after, before] = [h, -h].map(|t| robot.manipulability(&arc(&q, &step, t)).powi(2));
        assert!(after > before, "{zone:?}, case {case}: det falls from {before:e} to {after:e}");
    }
    // Upright, the thesis's robot leaves the singular posture by itself.
    let robot = thesis_robot();
    let stack = stack(&robot, Params::default());
    let mut q = Configuration { joints: [0.0, 1.5, 0.05], ..Configuration::zero() };
    let before = robot.manipulability(&q);
    for _ in 0..1000 {
        let tip = robot.tip_position(&q);
        let hold = Reference { position: tip, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
        let nu = evaluate(&stack, &q, &Velocity::zero(), &hold).nu_c;
        q = arc(&q, &nu, 1e-3);
    }
    let after = robot.manipulability(&q);
    assert!(after > 3.0 * before, "after a second the manipulability is {after}, before it was {before}");
}

#[expect(clippy::expect_used, reason = "the preset is a robot")]
fn thesis_robot() -> Arm {
    Robot::try_new(RobotParams::thesis()).expect("the preset is a robot")
}
