//! The whole update against a slow twin, and what it does at the limits of torque and of numbers.
//!
//! Laws: (1) tau = B^-1 (M nu_r' + C nu_r + g + friction + law(s) - d_hat) with all of it on generalized forces, so that s_v
//! pushes both wheels alike (written on torques, as printed, it drives the right one); (2) a refused update leaves
//! the state as it was, bit by bit; (3) finite inputs of any size give a torque within the limits or a refusal; (4) while a torque is limited
//! neither the integral nor the learned part moves; (5) the same inputs give the same bits, and f32 what f64 gives.
//!
//! Reference: a recomputation from M(q) and the columns of C as dense matrices, B inverted by LU, sign, saturation and
//! fuzzy engines as their own formulas, and the momentum observer of De Luca and Mattone with dense C'.
//!
//! Tolerance: 1e-10 of the sum of the magnitudes of the terms, where rounding is about 1e-13 and a wrong term 1e-3 and more.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use crate::common::plant::Plant;
use crate::common::random::Random;
use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH, Surface, THESIS};
use mm_control::{
    ControlError, ControlStack, ControlState, Estimator, Gains, Input, LawKind, OuterParams, Reference,
    StackParams,
};
use mm_model::{Configuration, Force, Mechanism, Robot, RobotParams, Torque, Velocity};
use nalgebra::{SMatrix, SVector, Vector3};

type Vector = SVector<f64, 5>;
type Matrix = SMatrix<f64, 5, 5>;
type Stack = ControlStack<f64, 3>;

const PERIOD: f64 = 1e-3;

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn stack(robot: Robot<f64, 3>, kind: LawKind, gains: Gains<f64, 3>) -> Stack {
    ControlStack::try_new(
        robot,
        kind,
        StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None },
    )
    .unwrap()
}

fn default_stack(kind: LawKind) -> Stack {
    stack(thesis(), kind, Gains::for_robot(&thesis(), kind, PERIOD))
}

/// The state as text that tells any two bit patterns of finite numbers apart.
fn bits(state: &ControlState<f64, 3>) -> String {
    format!("{state:?}")
}

fn input(robot: &Robot<f64, 3>, draw: &mut Random) -> Input<f64, 3> {
    let (q, nu) = (draw.configuration(), draw.velocity());
    Input { q, nu, reference: draw.reference_near(robot.tip_position(&q)) }
}

/// The update again, from dense matrices.
struct Twin {
    stack: Stack,
    kind: LawKind,
    integral: Vector,
    explained: Option<Vector>,
    learned: Vector,
    held: bool,
}

impl Twin {
    fn new(stack: Stack, kind: LawKind) -> Self {
        let zero = Vector::zeros();
        Self { stack, kind, integral: zero, explained: None, learned: zero, held: false }
    }

    fn law(&self, s: &Vector) -> Vector {
        let gains = self.stack.gains();
        let per_channel = |width: &Velocity<f64, 3>| s.component_div(&of(width.channels()));
        let (k, kf) = (of(gains.switching.channels()), of(gains.fuzzy.channels()));
        let sign = s.map(|s| if s > 0.0 { 1.0 } else { -1.0 });
        match self.kind {
            LawKind::Bsmc => -k.component_mul(&sign),
            LawKind::BsmcSat => {
                -k.component_mul(&per_channel(&gains.boundary_layer).map(|x| x.clamp(-1.0, 1.0)))
            }
            LawKind::BfsmcThesis => {
                let engine = Curve::<f64>::try_new(&THESIS).unwrap();
                kf.component_mul(&per_channel(&gains.fuzzy_scale).map(|x| engine.evaluate(x)))
                    - k.component_mul(&sign)
            }
            _ => {
                let surface =
                    Surface::<f64, 65>::from_engine(&Curve::<f64>::try_new(&SMOOTH).unwrap()).unwrap();
                kf.component_mul(&per_channel(&gains.fuzzy_scale).map(|x| surface.evaluate(x)))
            }
        }
    }

    /// Torque asked for, and the sum of the magnitudes of its terms.
    fn update(&mut self, input: &Input<f64, 3>) -> (Vector, f64) {
        let Input { q, nu: speed, reference } = input;
        let robot = self.stack.robot();
        let posture = robot.posture(&q.joints);
        let outer = self.stack.outer().evaluate(robot, (q, &robot.sines(q)), speed, reference, 0);
        let (nu, nu_c) = (of(speed.channels()), of(outer.nu_c.channels()));
        let c = of(self.stack.outer().params().sliding_gain.channels());
        let lag = nu - nu_c;
        let nu_r = nu_c - c.component_mul(&self.integral);
        let dnu_r = of(outer.dnu_c.channels()) - c.component_mul(&lag);

        let blocks = robot.mass_matrix_at(q);
        let mass = Matrix::from_fn(|i, j| match (i < 2, j < 2) {
            (true, true) => blocks.base[(i, j)],
            (true, false) => blocks.coupling[(i, j - 2)],
            (false, true) => blocks.coupling[(j, i - 2)],
            (false, false) => blocks.arm[(i - 2, j - 2)],
        });
        let columns: Vec<Vector> = robot.coriolis_columns(q, speed).map(|c| of(c.channels())).collect();
        let coriolis = Matrix::from_columns(&columns);
        let load =
            of(robot.gravity(&robot.inertia(&posture)).channels()) + of(robot.friction(speed).channels());

        let gains = self.stack.gains();
        let (bandwidth, limit) = (gains.observer_bandwidth, of(gains.learning_limit.channels()));
        let learns = self.kind == LawKind::Bfsmc && bandwidth > 0.0;
        let momentum = mass * nu;
        if let (true, false, Some(explained)) = (learns, self.held, self.explained) {
            self.learned =
                ((momentum - explained) * bandwidth).zip_map(&limit, |d, most| d.clamp(-most, most));
        }
        let terms = [mass * dnu_r, coriolis * nu_r, load, self.law(&(nu - nu_r)), -self.learned];
        let (radius, half) = (robot.params().wheel_radius, 0.5 * robot.params().track_width);
        let mut b = Matrix::identity();
        b.fixed_view_mut::<2, 2>(0, 0).copy_from_slice(&[
            1.0 / radius,
            half / radius,
            1.0 / radius,
            -half / radius,
        ]);
        let commanded = b.lu().solve(&terms.iter().sum::<Vector>()).unwrap();
        let limits = &robot.params().limits;
        let [l1, l2, l3] = limits.joint_torque;
        let most = Vector::from([limits.wheel_torque, limits.wheel_torque, l1, l2, l3]);
        let torque = commanded.zip_map(&most, |t, most| t.clamp(-most, most));
        self.held = torque != commanded;
        if learns {
            let known = b * torque + coriolis.transpose() * nu - load + self.learned;
            self.explained = Some(momentum - self.learned / bandwidth + known * PERIOD);
        }
        if !self.held {
            self.integral += lag * PERIOD;
        }
        (commanded, terms.iter().map(|term| term.norm()).sum())
    }
}

fn of(channels: impl Iterator<Item = f64>) -> Vector {
    Vector::from_iterator(channels)
}

#[test]
fn the_torque_is_that_of_the_dense_twin() {
    let mut draw = Random::seeded(1);
    let (mut worst, mut saturated, mut learned) = (0.0_f64, 0, 0);
    for case in 0..2000 {
        let kind = LawKind::SWITCHING[case % 4];
        let mut params = *draw.robot().params();
        if case % 3 > 0 {
            (params.limits.wheel_torque, params.limits.joint_torque) = (1e5, [1e5; 3]);
        }
        let robot = Robot::try_new(params).unwrap();
        let stack = stack(robot, kind, Gains::for_robot(&robot, kind, PERIOD));
        let (mut state, mut twin) = (stack.initial_state(), Twin::new(stack, kind));
        let Input { mut q, mut nu, reference } = input(&robot, &mut draw);
        for tick in 0..6 {
            let input = Input { q, nu, reference };
            let out = stack.update(&mut state, &input).unwrap();
            let (expected, scale) = twin.update(&input);
            let off = (of(out.signals.commanded.channels()) - expected).norm() / scale;
            worst = worst.max(off);
            assert!(off < 1e-10, "{}, case {case}, tick {tick}: off by {off:e}", kind.name());
            let d = (of(out.signals.learned.channels()) - twin.learned).norm();
            assert!(d <= 1e-9 * (1.0 + scale), "case {case}, tick {tick}: learned part off by {d}");
            assert_eq!(out.status.saturated, twin.held, "case {case}, tick {tick}: saturation");
            saturated += u32::from(out.status.saturated);
            learned += u32::from(out.signals.learned.channels().any(|d| d.abs() > 1e-3));
            let mut plant = Plant { robot, q, nu, time: 0.0 };
            plant.step(&Torque::zero(), |_| Force::zero(), PERIOD);
            (q, nu) = (plant.q, plant.nu);
        }
    }
    println!("worst {worst:.1e}; {saturated} saturated, {learned} with a learned part");
    assert!(
        saturated > 500 && learned > 500,
        "{saturated} saturated and {learned} learning ticks are too few"
    );
}

#[test]
fn each_sliding_variable_acts_along_its_own_direction() {
    for kind in LawKind::SWITCHING {
        let mut gains = Gains::for_robot(&thesis(), kind, PERIOD);
        gains.observer_bandwidth = 0.0;
        let with = stack(thesis(), kind, gains);
        (gains.switching, gains.fuzzy) = (Force::zero(), Force::zero());
        let without = stack(thesis(), kind, gains);
        let q = Configuration { joints: [0.3, 0.9, -1.7], heading: 0.4, ..Configuration::zero() };
        let hold = Vector3::zeros();
        let reference = Reference { position: thesis().tip_position(&q), velocity: hold, acceleration: hold };
        let nu_c = with
            .outer()
            .evaluate(&thesis(), (&q, &thesis().sines(&q)), &Velocity::zero(), &reference, 0)
            .nu_c;
        let push = |forward: f64, yaw_rate: f64| {
            let nu = Velocity { forward: nu_c.forward + forward, yaw_rate: nu_c.yaw_rate + yaw_rate, ..nu_c };
            let torque = |stack: &Stack| {
                stack
                    .update(&mut stack.initial_state(), &Input { q, nu, reference })
                    .unwrap()
                    .signals
                    .commanded
            };
            torque(&with).minus(torque(&without))
        };
        let (ahead, turning) = (push(0.01, 0.0), push(0.0, 0.01));
        assert!(ahead.right < -0.1, "{}: too fast ahead, pushed by {}", kind.name(), ahead.right);
        assert!((ahead.right - ahead.left).abs() < 1e-10, "{}: s_v turns: {ahead:?}", kind.name());
        assert!(turning.right < -0.1, "{}: turning too fast, {}", kind.name(), turning.right);
        assert!((turning.right + turning.left).abs() < 1e-10, "{}: s_omega pushes: {turning:?}", kind.name());
        for joint in ahead.joints.iter().chain(&turning.joints) {
            assert!(joint.abs() < 1e-10, "{}: the base's s moves a joint by {joint}", kind.name());
        }
    }
}

#[test]
fn a_refusal_names_the_input_and_leaves_the_state() {
    type Spoil = fn(&mut Input<f64, 3>, f64);
    let spoils: [(&str, Spoil); 17] = [
        ("configuration", |i, x| i.q.x = x),
        ("configuration", |i, x| i.q.y = x),
        ("configuration", |i, x| i.q.heading = x),
        ("configuration", |i, x| i.q.joints[0] = x),
        ("configuration", |i, x| i.q.joints[2] = x),
        ("velocity", |i, x| i.nu.forward = x),
        ("velocity", |i, x| i.nu.yaw_rate = x),
        ("velocity", |i, x| i.nu.joints[1] = x),
        ("reference", |i, x| i.reference.position.x = x),
        ("reference", |i, x| i.reference.position.y = x),
        ("reference", |i, x| i.reference.position.z = x),
        ("reference", |i, x| i.reference.velocity.x = x),
        ("reference", |i, x| i.reference.velocity.y = x),
        ("reference", |i, x| i.reference.velocity.z = x),
        ("reference", |i, x| i.reference.acceleration.x = x),
        ("reference", |i, x| i.reference.acceleration.y = x),
        ("reference", |i, x| i.reference.acceleration.z = x),
    ];
    let mut draw = Random::seeded(2);
    for kind in LawKind::ALL {
        let stack = default_stack(kind);
        let mut state = stack.initial_state();
        let good = input(stack.robot(), &mut draw);
        stack.update(&mut state, &good).unwrap();
        let before = bits(&state);
        for (name, spoil) in spoils {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let mut bad = good;
                spoil(&mut bad, value);
                let answer = stack.update(&mut state, &bad);
                assert_eq!(answer, Err(ControlError::NonFinite(name)), "{}: {value} as {name}", kind.name());
                assert_eq!(bits(&state), before, "{}: {value} as {name} changed the state", kind.name());
            }
        }
        let mut absurd = good;
        absurd.nu = Velocity::splat(f64::MAX);
        assert_eq!(stack.update(&mut state, &absurd), Err(ControlError::Overflow), "{}", kind.name());
        let mut absurd = good;
        absurd.reference.acceleration.z = f64::MAX;
        absurd.reference.position = Vector3::repeat(-f64::MAX);
        assert_eq!(stack.update(&mut state, &absurd), Err(ControlError::Overflow), "{}", kind.name());
        assert_eq!(bits(&state), before, "{}: an overflow changed the state", kind.name());
        assert!(stack.update(&mut state, &good).is_ok(), "{}: a good input after bad ones", kind.name());
    }
}

/// `value` times a random power of ten, up to `decades` up or down.
fn blown(value: f64, draw: &mut Random, decades: f64) -> f64 {
    let factor: f64 = format!("1e{:.0}", draw.between(-decades, decades)).parse().unwrap();
    value * factor
}

#[test]
fn finite_inputs_of_any_size_give_a_torque_or_a_refusal() {
    let mut draw = Random::seeded(3);
    // Besides the robot's own limits, ones that nothing reaches: then no anti-windup comes to the rescue either.
    for (limit, decades) in [(None, 10.0), (None, 200.0), (Some(1e300), 200.0)] {
        for kind in LawKind::ALL {
            let mut params = RobotParams::<f64, 3>::thesis();
            let gains = Gains::for_robot(&thesis(), kind, PERIOD);
            if let Some(limit) = limit {
                (params.limits.wheel_torque, params.limits.joint_torque) = (limit, [limit; 3]);
            }
            let stack = stack(Robot::try_new(params).unwrap(), kind, gains);
            let mut state = stack.initial_state();
            let (mut given, mut refused) = (0, 0);
            for case in 0..2000 {
                let sane = input(stack.robot(), &mut draw);
                let mut input = sane;
                let mut blow = |x: f64| blown(x, &mut draw, decades);
                input.nu = input.nu.map(&mut blow);
                input.reference.position = input.reference.position.map(&mut blow);
                input.reference.velocity = input.reference.velocity.map(&mut blow);
                input.reference.acceleration = input.reference.acceleration.map(&mut blow);
                (input.q.x, input.q.heading) = (blow(input.q.x), blow(input.q.heading));
                let before = bits(&state);
                match stack.update(&mut state, &input) {
                    Ok(out) => {
                        given += 1;
                        let limits = &params.limits;
                        let joints = out.torque.joints.iter().zip(limits.joint_torque);
                        let inside = joints.fold(true, |all, (t, most)| all && t.abs() <= most)
                            && out.torque.right.abs() <= limits.wheel_torque
                            && out.torque.left.abs() <= limits.wheel_torque;
                        assert!(inside, "{}, case {case}: {:?}", kind.name(), out.torque);
                        let honest = (out.torque != out.signals.commanded) == out.status.saturated;
                        assert!(honest, "{}, case {case}: saturated is not honest", kind.name());
                    }
                    Err(error) => {
                        refused += 1;
                        assert_eq!(error, ControlError::Overflow, "{}, case {case}", kind.name());
                        assert_eq!(
                            bits(&state),
                            before,
                            "{}, case {case}: state after a refusal",
                            kind.name()
                        );
                    }
                }
                let text = bits(&state);
                assert!(
                    !text.contains("NaN") && !text.contains("inf"),
                    "{}, case {case}: {text}",
                    kind.name()
                );
            }
            println!("{}, {decades} decades: {given} torques, {refused} refusals", kind.name());
            // A regressor that overflows has no sign: the adaptive law refuses earlier.
            let least = if kind == LawKind::BacksteppingAdaptive { 50 } else { 200 };
            assert!(given > least, "{}: torques in only {given} cases", kind.name());
        }
    }
}
