//! The laws that other people would use, against slow twins, and what their documentation claims of them.
//!
//! Laws: (1) the commanded torque of each is that of its formula, from dense matrices, tick by tick with its memory; (2) the gains of
//! `lqr` solve the Riccati equation of x'' = M0^-1 f with Bryson's weights; (3) the bodies of a robot add up to the robot, which is what
//! makes the regressor of `backstepping-adaptive` one; (4) its V falls, up to sampling, under a constant force and masses that are off,
//! and its estimates stay within their bounds.
//!
//! Reference: the formulas of the laws' documentation, evaluated with nalgebra's dense 5 x 5 algebra; for (2) the stable subspace of
//! the 20 x 20 Hamiltonian by Newton's iteration for the matrix sign (Roberts, 1980), which shares nothing with the flow.
//!
//! Tolerance: 1e-10 of the sum of the magnitudes of the terms, as in `stack.rs`; 1e-8 for (2), relative to the largest gain.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use crate::common::plant::Plant;
use crate::common::random::Random;
use mm_control::laws::{ChannelMatrix, StateFeedback};
use mm_control::{
    ControlStack, Estimator, Gains, Input, Law, LawKind, OuterParams, Reference, SetupError, StackParams,
};
use mm_model::{Configuration, Force, Mechanism, Robot, RobotParams, Torque, Velocity};
use nalgebra::{SMatrix, SVector, Vector3};

type Vector = SVector<f64, 5>;
type Matrix = SMatrix<f64, 5, 5>;

const PERIOD: f64 = 1e-3;

const BASELINES: [LawKind; 6] = [
    LawKind::Ctc,
    LawKind::Pid,
    LawKind::Lqr,
    LawKind::SmcDecentralized,
    LawKind::BacksteppingAdaptive,
    LawKind::SuperTwisting,
];

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn stack(robot: Robot<f64, 3>, kind: LawKind, gains: Gains<f64, 3>) -> ControlStack<f64, 3> {
    let outer = OuterParams::default();
    let estimator = Estimator::None;
    ControlStack::try_new(robot, kind, StackParams { period: PERIOD, outer, gains, estimator }).unwrap()
}

fn of(channels: impl Iterator<Item = f64>) -> Vector {
    Vector::from_iterator(channels)
}

fn force(v: &Vector) -> Force<f64, 3> {
    Force::from_channels(v.iter().copied())
}

/// M, C and g at a state, dense.
fn dense(
    robot: &Robot<f64, 3>,
    q: &Configuration<f64, 3>,
    nu: &Velocity<f64, 3>,
) -> (Matrix, Matrix, Vector) {
    let blocks = robot.mass_matrix_at(q);
    let mass = Matrix::from_fn(|i, j| match (i < 2, j < 2) {
        (true, true) => blocks.base[(i, j)],
        (true, false) => blocks.coupling[(i, j - 2)],
        (false, true) => blocks.coupling[(j, i - 2)],
        (false, false) => blocks.arm[(i - 2, j - 2)],
    });
    let columns: Vec<Vector> = robot.coriolis_columns(q, nu).map(|c| of(c.channels())).collect();
    let gravity = robot.gravity(&robot.inertia(&robot.posture(&q.joints)));
    (mass, Matrix::from_columns(&columns), of(gravity.channels()))
}

/// One body of a robot, by its parameters: the others weigh next to nothing.
fn nearly_alone(robot: &Robot<f64, 3>, body: usize) -> Robot<f64, 3> {
    let mut params = *robot.params();
    let dust = 1e-12;
    if body != 0 {
        (params.base_mass, params.base_yaw_inertia) = (dust, dust);
    }
    for (_, link) in params.links.iter_mut().enumerate().filter(|(i, _)| i + 1 != body) {
        link.mass = dust;
        (link.axial_inertia, link.pitch_inertia, link.normal_inertia) = (dust, dust, dust);
    }
    Robot::try_new(params).unwrap()
}

/// The memories of all laws, and the formulas.
struct Twin {
    stack: ControlStack<f64, 3>,
    kind: LawKind,
    integral: Vector,
    twice: Vector,
    twisted: Vector,
    factors: [f64; 4],
    learned: Vector,
}

impl Twin {
    fn new(stack: ControlStack<f64, 3>, kind: LawKind) -> Self {
        let zero = Vector::zeros();
        Self { stack, kind, integral: zero, twice: zero, twisted: zero, factors: [1.0; 4], learned: zero }
    }

    /// Force asked for, and the sum of the magnitudes of its terms.
    fn update(&mut self, input: &Input<f64, 3>) -> (Vector, f64) {
        let Input { q, nu: speed, reference } = input;
        let robot = *self.stack.robot();
        let gains = *self.stack.gains();
        let outer = self.stack.outer().evaluate(&robot, (q, &robot.sines(q)), speed, reference, 0);
        let (nu, nu_c) = (of(speed.channels()), of(outer.nu_c.channels()));
        let dnu_c = of(outer.dnu_c.channels());
        let c = of(self.stack.outer().params().sliding_gain.channels());
        let lag = nu - nu_c;
        let nu_r = nu_c - c.component_mul(&self.integral);
        let dnu_r = dnu_c - c.component_mul(&lag);
        let s = nu - nu_r;
        let (mass, coriolis, gravity) = dense(&robot, q, speed);
        let friction = of(robot.friction(speed).channels());
        let rest = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
        let (mass_at_rest, _, _) = dense(&robot, &rest, &Velocity::zero());
        let inverse = mass_at_rest.lu().solve(&Matrix::identity()).unwrap();
        let own = Vector::from_fn(|i, _| 1.0 / inverse[(i, i)]);
        let (kd, kp) = (of(gains.damping.channels()), of(gains.stiffness.channels()));
        let sign = s.map(|s| if s > 0.0 { 1.0 } else { -1.0 });
        let equivalent = [mass * dnu_r, coriolis * nu_r, gravity, friction];
        let terms: Vec<Vector> = match self.kind {
            LawKind::Ctc => {
                let back = kd.component_mul(&lag) + kp.component_mul(&self.integral);
                vec![mass * dnu_c, -(mass * back), coriolis * nu, gravity, friction]
            }
            LawKind::Pid => {
                let ki = of(gains.integral.channels());
                let back =
                    kd.component_mul(&lag) + kp.component_mul(&self.integral) + ki.component_mul(&self.twice);
                let mut wanted = dnu_c - back;
                wanted.fixed_rows_mut::<3>(2).fill(0.0);
                let mut out = mass * wanted + coriolis * nu + friction;
                for i in 2..5 {
                    out[i] = -own[i] * back[i];
                }
                vec![out]
            }
            LawKind::Lqr => {
                let (mass0, _, gravity0) = dense(&robot, &rest, &Velocity::zero());
                let (k1, k2) = hamiltonian_twin(&mass0, &gains);
                vec![mass0 * dnu_c, gravity0, -(k1 * self.integral), -(k2 * lag)]
            }
            LawKind::SmcDecentralized => {
                let part = |v: &Vector, keep: std::ops::Range<usize>| {
                    Vector::from_fn(|i, _| if keep.contains(&i) { v[i] } else { 0.0 })
                };
                let own = |keep: std::ops::Range<usize>| {
                    let alone = Velocity::from_channels(part(&nu, keep.clone()).iter().copied());
                    let (mass, coriolis, _) = dense(&robot, q, &alone);
                    part(&(mass * part(&dnu_r, keep.clone()) + coriolis * part(&nu_r, keep.clone())), keep)
                };
                let k = of(gains.switching.channels());
                let layer = s.component_div(&of(gains.boundary_layer.channels())).map(|x| x.clamp(-1.0, 1.0));
                vec![own(0..2), own(2..5), gravity, friction, -k.component_mul(&layer)]
            }
            LawKind::BacksteppingAdaptive => {
                let mut all = vec![friction, -own.component_mul(&kd).component_mul(&s), -self.learned];
                for (body, factor) in self.factors.iter_mut().enumerate() {
                    let (mass, coriolis, gravity) = dense(&nearly_alone(&robot, body), q, speed);
                    let share = mass * dnu_r + coriolis * nu_r + gravity;
                    all.push(share * *factor);
                    let step = gains.body_adaptation * share.dot(&s) * PERIOD;
                    *factor = (*factor - step).clamp(gains.body_factor.0, gains.body_factor.1);
                }
                all
            }
            _ => {
                let k1 = of(gains.twisting.channels());
                let root = k1.component_mul(&s.map(|s| s.abs().sqrt())).component_mul(&sign);
                equivalent.into_iter().chain([-root, self.twisted]).collect()
            }
        };
        let limit = of(gains.learning_limit.channels());
        let within = |v: Vector| v.zip_map(&limit, |v, most| v.clamp(-most, most));
        let k2 = of(gains.twisting_rate.channels());
        self.twisted = within(self.twisted - k2.component_mul(&sign) * PERIOD);
        self.learned = within(self.learned + own.component_mul(&s) * gains.force_adaptation * PERIOD);
        self.twice += self.integral * PERIOD;
        self.integral += lag * PERIOD;
        (terms.iter().sum(), terms.iter().map(SVector::norm).sum())
    }
}

#[test]
fn the_torque_is_that_of_the_dense_twin() {
    for kind in BASELINES {
        let mut draw = Random::seeded(1);
        let (mut worst, cases) = (0.0_f64, if kind == LawKind::Lqr { 20 } else { 300 });
        for case in 0..cases {
            // Limits that nothing reaches: what they do to the memories is below.
            let mut params = *draw.robot().params();
            (params.limits.wheel_torque, params.limits.joint_torque) = (1e9, [1e9; 3]);
            let robot = Robot::try_new(params).unwrap();
            let mut gains = Gains::for_robot(&thesis(), kind, PERIOD);
            (gains.acceptable_force, gains.learning_limit) = (Force::splat(300.0), Force::splat(30.0));
            let stack = stack(robot, kind, gains);
            let (mut state, mut twin) = (stack.initial_state(), Twin::new(stack, kind));
            let (mut q, mut nu) = (draw.configuration(), draw.velocity());
            let reference = draw.reference_near(robot.tip_position(&q));
            for tick in 0..6 {
                let input = Input { q, nu, reference };
                let out = stack.update(&mut state, &input).unwrap();
                let (expected, scale) = twin.update(&input);
                let got = robot.force_of(&out.signals.commanded);
                let off = (of(got.channels()) - expected).norm() / scale;
                worst = worst.max(off);
                // The twin's other bodies weigh 1e-12, and its Riccati equation is solved to 1e-10 or so.
                let allowed = if kind == LawKind::Lqr { 1e-8 } else { 1e-10 };
                assert!(off < allowed, "{}, case {case}, tick {tick}: off by {off:e}", kind.name());
                let mut plant = Plant { robot, q, nu, time: 0.0 };
                plant.step(&Torque::zero(), |_| Force::zero(), PERIOD);
                (q, nu) = (plant.q, plant.nu);
            }
        }
        println!("{}: worst {worst:.1e}", kind.name());
    }
}

/// The inverse of a diagonal matrix, entry by entry.
fn inverse_or_zero(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

/// K1 and K2 from the stable subspace of the Hamiltonian.
fn hamiltonian_twin(mass: &Matrix, gains: &Gains<f64, 3>) -> (Matrix, Matrix) {
    // In the units of the acceptable values all weights are one.
    let unit = |channels: Vector| Matrix::from_diagonal(&channels);
    let x = unit(of(gains.acceptable_position.channels()));
    let v = unit(of(gains.acceptable_velocity.channels()));
    let f = unit(of(gains.acceptable_force.channels()));
    let (x_inverse, v_inverse) = (x.map(inverse_or_zero), v.map(inverse_or_zero));
    let (mut a, mut b) = (SMatrix::<f64, 10, 10>::zeros(), SMatrix::<f64, 10, 5>::zeros());
    a.fixed_view_mut::<5, 5>(0, 5).copy_from(&(x_inverse * v));
    b.fixed_view_mut::<5, 5>(5, 0).copy_from(&(v_inverse * mass.lu().solve(&f).unwrap()));
    let q = SMatrix::<f64, 10, 10>::identity();
    let mut sign = SMatrix::<f64, 20, 20>::zeros();
    sign.fixed_view_mut::<10, 10>(0, 0).copy_from(&a);
    sign.fixed_view_mut::<10, 10>(0, 10).copy_from(&-(b * b.transpose()));
    sign.fixed_view_mut::<10, 10>(10, 0).copy_from(&-q);
    sign.fixed_view_mut::<10, 10>(10, 10).copy_from(&-a.transpose());
    for _ in 0..100 {
        let inverse = sign.lu().solve(&SMatrix::identity()).unwrap();
        let scale = (inverse.norm() / sign.norm()).sqrt();
        sign = (sign * scale + inverse / scale) * 0.5;
    }
    // sign [I; P] = -[I; P]: an overdetermined linear system in P.
    let one = SMatrix::<f64, 10, 10>::identity();
    let (mut left, mut right) = (SMatrix::<f64, 20, 10>::zeros(), SMatrix::<f64, 20, 10>::zeros());
    left.fixed_view_mut::<10, 10>(0, 0).copy_from(&sign.fixed_view::<10, 10>(0, 10));
    left.fixed_view_mut::<10, 10>(10, 0).copy_from(&(sign.fixed_view::<10, 10>(10, 10) + one));
    right.fixed_view_mut::<10, 10>(0, 0).copy_from(&-(sign.fixed_view::<10, 10>(0, 0) + one));
    right.fixed_view_mut::<10, 10>(10, 0).copy_from(&-sign.fixed_view::<10, 10>(10, 0));
    let p = left.svd(true, true).solve(&right, 1e-14).unwrap();
    let k = f * b.transpose() * p;
    (k.fixed_view::<5, 5>(0, 0) * x_inverse, k.fixed_view::<5, 5>(0, 5) * v_inverse)
}

fn entries(matrix: &ChannelMatrix<f64, 3>) -> Matrix {
    Matrix::from_rows(&matrix.rows().map(|row| of(row.channels()).transpose()).collect::<Vec<_>>())
}

#[test]
fn the_feedback_of_lqr_solves_the_riccati_equation() {
    let robot = thesis();
    let rest = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
    let (mass, _, _) = dense(&robot, &rest, &Velocity::zero());
    let mut draw = Random::seeded(3);
    for case in 0..10 {
        let mut gains = Gains::for_robot(&robot, LawKind::Lqr, PERIOD);
        // Weights of all sizes: up to a factor of 10 either way on each.
        let mut any = |_: f64| if case == 0 { 1.0 } else { draw.between(0.1, 10.0) };
        gains.acceptable_position = gains.acceptable_position.map(|x| x * any(x));
        gains.acceptable_velocity = gains.acceptable_velocity.map(|x| x * any(x));
        gains.acceptable_force = gains.acceptable_force.map(|x| x * any(x));
        let Law::Lqr(law) = Law::try_new(LawKind::Lqr, &robot, &gains).unwrap() else {
            panic!("another law was built")
        };
        let StateFeedback { position, velocity } = law.feedback();
        let (k1, k2) = hamiltonian_twin(&mass, &gains);
        for (got, expected) in [(entries(position), k1), (entries(velocity), k2)] {
            let off = (got - expected).abs().max() / expected.abs().max();
            assert!(off < 1e-8, "case {case}: gains off by {off:e}");
        }
    }
}

#[test]
fn lqr_of_one_mass_is_the_textbook_one() {
    // x'' = f/m with weights q1, q2, r: K1 = sqrt(q1/r), K2 = sqrt(q2/r + 2 m K1).
    let (m, x, v, f) = (2.0, 0.1, 0.5, 30.0);
    let inverse = ChannelMatrix::<f64, 0>::diagonal([1.0 / m, 1.0 / m].into_iter());
    let feedback =
        StateFeedback::solve(&inverse, (&Velocity::splat(x), &Velocity::splat(v)), &Force::splat(f)).unwrap();
    let k1: f64 = f / x;
    let k2 = (f / v * (f / v) + 2.0 * m * k1).sqrt();
    assert!((feedback.position.forward.forward / k1 - 1.0).abs() < 1e-12, "{:?}", feedback.position);
    assert!((feedback.velocity.yaw.yaw_rate / k2 - 1.0).abs() < 1e-12, "{:?}", feedback.velocity);
    assert!(feedback.position.forward.yaw_rate.abs() < 1e-12, "two masses that do not touch");
}

#[test]
fn weights_beyond_all_measure_are_refused() {
    let mut gains = Gains::for_robot(&thesis(), LawKind::Lqr, PERIOD);
    gains.acceptable_position = Velocity { forward: 1e-200, ..gains.acceptable_position };
    let refused = Law::try_new(LawKind::Lqr, &thesis(), &gains).err();
    assert_eq!(refused, Some(SetupError::Riccati), "weights that overflow");
}

#[test]
fn the_bodies_add_up_to_the_robot() {
    let mut draw = Random::seeded(5);
    for _ in 0..200 {
        let (robot, q) = (draw.robot(), draw.configuration());
        let (nu, a, b) = (draw.velocity(), draw.velocity(), draw.velocity());
        let all = |robot: &Robot<f64, 3>| {
            let inertia = robot.inertia(&robot.posture(&q.joints));
            robot
                .mass_product(&inertia, &a)
                .plus(robot.coriolis_product(&inertia, &nu, &b))
                .plus(robot.gravity(&inertia))
        };
        let whole = of(all(&robot).channels());
        let parts: Vec<Vector> = (0..4).map(|body| of(all(&robot.body_alone(body)).channels())).collect();
        let scale: f64 = parts.iter().map(SVector::norm).sum();
        let off = (whole - parts.iter().sum::<Vector>()).norm() / scale;
        assert!(off < 1e-13, "the sum is off by {off:e}");
        let none = of(all(&robot.body_alone(4)).channels());
        assert_eq!(none, Vector::zeros(), "without bodies there is no force");
    }
}

/// One loop of a kind under a constant force: errors of the tip, and the learned parts.
fn run(kind: LawKind, ticks: u32) -> Vec<(f64, Force<f64, 3>)> {
    let heavy = Robot::try_new(RobotParams::thesis().with_mass_scaled(1.25)).unwrap();
    let stack = stack(thesis(), kind, Gains::for_robot(&thesis(), kind, PERIOD));
    let q = Configuration { joints: thesis().params().rest_posture, ..Configuration::zero() };
    let start = thesis().tip_position(&q);
    let hold = Vector3::zeros();
    let reference = Reference { position: start, velocity: hold, acceleration: hold };
    let (mut state, mut plant) =
        (stack.initial_state(), Plant { robot: heavy, q, nu: Velocity::zero(), time: 0.0 });
    let push = force(&Vector::from([0.0, 0.0, 5.0, -5.0, 5.0]));
    (0..ticks)
        .map(|_| {
            let out = stack.update(&mut state, &Input { q: plant.q, nu: plant.nu, reference }).unwrap();
            plant.step(&out.torque, |_| push, PERIOD);
            (out.signals.error.norm(), out.signals.learned)
        })
        .collect()
}

#[test]
fn every_baseline_holds_the_tip_against_a_constant_force() {
    for kind in BASELINES {
        let ticks = run(kind, 6000);
        let late = ticks.iter().skip(5000).map(|(error, _)| *error).fold(0.0, f64::max);
        println!("{}: {late:.1e} m after 5 s", kind.name());
        // Each has an integral of the velocity's error, and the outer loop one more through the pose.
        assert!(late < 2e-4, "{}: {late} m off after 5 s", kind.name());
    }
}

#[test]
fn what_is_learned_stays_within_its_limits() {
    for kind in [LawKind::BacksteppingAdaptive, LawKind::SuperTwisting] {
        let limit = Gains::for_robot(&thesis(), kind, PERIOD).learning_limit;
        let ticks = run(kind, 2000);
        for (_, learned) in &ticks {
            for (d, most) in learned.channels().zip(limit.channels()) {
                assert!(d.abs() <= most, "{}: {d} learned, {most} allowed", kind.name());
            }
        }
        let last = ticks.last().unwrap().1;
        assert!(last.joints.iter().any(|d| d.abs() > 1.0), "{}: it learned {last:?}", kind.name());
    }
}

#[test]
fn a_limited_torque_stops_the_memory() {
    for kind in BASELINES {
        let mut params = RobotParams::<f64, 3>::thesis();
        (params.limits.wheel_torque, params.limits.joint_torque) = (1e-6, [1e-6; 3]);
        let robot = Robot::try_new(params).unwrap();
        let gains = Gains::for_robot(&thesis(), kind, PERIOD);
        let stack = stack(robot, kind, gains);
        let (mut state, mut draw) = (stack.initial_state(), Random::seeded(7));
        let fresh = state;
        let q = draw.configuration();
        let reference = draw.reference_near(robot.tip_position(&q));
        for _ in 0..5 {
            let input = Input { q, nu: draw.velocity(), reference };
            let out = stack.update(&mut state, &input).unwrap();
            assert!(out.status.saturated, "{}: nothing is limited", kind.name());
            assert_eq!(out.signals.learned, Force::zero(), "{}: it learned", kind.name());
        }
        let text = |state| {
            format!("{state:?}").replace("held: true", "held: false").replace("updates: 5", "updates: 0")
        };
        assert_eq!(text(state), text(fresh), "{}: the memory moved", kind.name());
    }
}
