//! Single precision against double, on 10,000 random robots and states.
//!
//! Law: the model in `f32` is the model in `f64` to the rounding of `f32`. Reference: the closed form in `f64` with the same
//! parameters and states, rounded to `f32` first, so that only the arithmetic differs; that one has its own twins.
//! Tolerance: 1e-5 relative to the norm of the terms that are summed, 84 roundings; accelerations are compared by the force
//! that their difference takes, since M itself has condition numbers up to 5e4, which `f32` cannot make up for.

use crate::common::random::{self, Random};
use crate::common::vectors::{Vector, of_force, of_velocity};
use crate::common::worst::Worst;
use crate::common::{coriolis, mass};
use mm_model::{
    Configuration, Force, Friction, Limits, Link, Mechanism, Real, Robot, RobotParams, Torque, Velocity,
    reference,
};
use nalgebra::{SVector, Vector3};

const CASES: u32 = 10_000;
const TOLERANCE: f64 = 1e-5;

/// The same parameters in another precision.
fn params<S: Real, T: Real>(p: &RobotParams<S, 3>) -> RobotParams<T, 3> {
    let n = |x: S| T::from_f64(x.to_f64());
    RobotParams {
        base_mass: n(p.base_mass),
        base_yaw_inertia: n(p.base_yaw_inertia),
        base_com_offset: n(p.base_com_offset),
        arm_offset: n(p.arm_offset),
        mount_height: n(p.mount_height),
        wheel_radius: n(p.wheel_radius),
        track_width: n(p.track_width),
        gravity: n(p.gravity),
        links: p.links.map(|link| Link {
            length: n(link.length),
            mass: n(link.mass),
            com: n(link.com),
            axial_inertia: n(link.axial_inertia),
            pitch_inertia: n(link.pitch_inertia),
            normal_inertia: n(link.normal_inertia),
        }),
        rest_posture: p.rest_posture.map(n),
        friction: Friction {
            wheel_viscous: n(p.friction.wheel_viscous),
            wheel_coulomb: n(p.friction.wheel_coulomb),
            joint_viscous: p.friction.joint_viscous.map(n),
            joint_coulomb: p.friction.joint_coulomb.map(n),
            smoothing: n(p.friction.smoothing),
        },
        limits: Limits {
            joints: p.limits.joints.map(|(lo, hi)| (n(lo), n(hi))),
            wheel_torque: n(p.limits.wheel_torque),
            joint_torque: p.limits.joint_torque.map(n),
            speed: n(p.limits.speed),
        },
    }
}

fn configuration<S: Real, T: Real>(q: &Configuration<S, 3>) -> Configuration<T, 3> {
    let n = |x: S| T::from_f64(x.to_f64());
    Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: q.joints.map(n) }
}

fn velocity<S: Real, T: Real>(nu: &Velocity<S, 3>) -> Velocity<T, 3> {
    Velocity::from_channels(nu.channels().map(|x| T::from_f64(x.to_f64())))
}

fn wide<const R: usize>(v: &SVector<f32, R>) -> SVector<f64, R> {
    v.map(f64::from)
}

/// One robot and state in both precisions, equal in value.
struct Pair {
    small: (Robot<f32, 3>, Configuration<f32, 3>, Velocity<f32, 3>, Velocity<f32, 3>),
    large: (Robot<f64, 3>, Configuration<f64, 3>, Velocity<f64, 3>, Velocity<f64, 3>),
}

fn pair(draw: &mut Random, case: u32) -> Pair {
    let rounded: RobotParams<f32, 3> = params(&draw.params(case));
    let (q, nu, nu_r) =
        (configuration(&draw.configuration()), velocity(&draw.velocity()), velocity(&draw.velocity()));
    Pair {
        small: (random::robot(rounded), q, nu, nu_r),
        large: (random::robot(params(&rounded)), configuration(&q), velocity(&nu), velocity(&nu_r)),
    }
}

#[test]
fn dynamics_in_single_precision() {
    let mut draw = Random::seeded(11);
    let [mut mass, mut coriolis, mut reaching, mut transpose] =
        ["f32 M", "f32 C nu", "f32 C nu_r", "f32 C' nu"].map(Worst::of);
    let [mut gravity, mut bias, mut forward] =
        ["f32 g", "f32 bias", "f32 forward dynamics, as force"].map(Worst::of);
    for case in 0..CASES {
        let Pair { small: (robot, q, nu, nu_r), large: (exact, q64, nu64, nu_r64) } = pair(&mut draw, case);
        let (inertia, inertia64) =
            (robot.inertia(&robot.posture(&q.joints)), exact.inertia(&exact.posture(&q64.joints)));
        let (u, u_r) = (of_velocity(&nu64), of_velocity(&nu_r64));
        let m = mass::dense(&exact.mass_matrix(&inertia64));
        mass.see(case, &mass::dense(&robot.mass_matrix(&inertia)), &m, m.norm());
        let c = coriolis::matrix(&exact, &q64, &nu64);
        let of = |force: Force<f32, 3>| of_force(&force);
        let turning = c.norm() * u.norm();
        coriolis.see(case, &of(robot.coriolis_product(&inertia, &nu, &nu)), &(c * u), turning);
        let product = of(robot.coriolis_product(&inertia, &nu, &nu_r));
        reaching.see(case, &product, &(c * u_r), c.norm() * u_r.norm());
        let product = of(robot.coriolis_transpose_product(&inertia, &nu));
        transpose.see(case, &product, &(c.transpose() * u), turning);
        let p = exact.params();
        let weight = p.gravity * p.links.iter().fold(0.0, |sum, link| sum + link.mass);
        gravity.see(case, &of(robot.gravity(&inertia)), &of_force(&exact.gravity(&inertia64)), weight);
        let drag = of_force(&exact.friction(&nu64)).norm();
        let scale = turning + weight + drag;
        let h = of_force(&exact.bias(&inertia64, &nu64));
        bias.see(case, &of(robot.bias(&inertia, &nu)), &h, scale);
        let torque = Torque { right: 20.0, left: -7.0, joints: [30.0, -40.0, 11.0] };
        let a = of_velocity(&robot.forward_dynamics(&q, &nu, &torque, &Force::zero()));
        let wide = Torque::from_channels(torque.channels().map(f64::from));
        let b = of_velocity(&exact.forward_dynamics(&q64, &nu64, &wide, &Force::zero()));
        let push = of_force(&exact.force_of(&wide)).norm();
        forward.see(case, &(m * a), &(m * b), scale + push + m.norm() * b.norm());
    }
    for worst in [mass, coriolis, reaching, transpose, gravity, bias, forward] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn the_literal_form_in_single_precision() {
    let mut draw = Random::seeded(13);
    let [mut mass, mut coriolis, mut gravity, mut input] =
        ["f32 S'MS", "f32 S'(M dS + C S)", "f32 S'G", "f32 S'E"].map(Worst::of);
    for case in 0..CASES {
        let Pair { small: (robot, q, nu, _), large: (exact, q64, nu64, _) } = pair(&mut draw, case);
        let (got, expected) = (reference::reduce(&robot, &q, &nu), reference::reduce(&exact, &q64, &nu64));
        mass.see(case, &got.mass.map(f64::from), &expected.mass, expected.mass.norm());
        let size = expected.mass.norm() * of_velocity(&nu64).norm();
        coriolis.see(case, &got.coriolis.map(f64::from), &expected.coriolis, size);
        let p = exact.params();
        let weight = p.gravity * p.links.iter().fold(0.0, |sum, link| sum + link.mass);
        gravity.see(case, &wide(&got.gravity), &expected.gravity, weight);
        input.see(case, &got.input.map(f64::from), &expected.input, expected.input.norm());
    }
    for worst in [mass, coriolis, gravity, input] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn kinematics_in_single_precision() {
    let mut draw = Random::seeded(12);
    let [mut tip, mut jacobian, mut rate, mut squared, mut slope] =
        ["f32 tip", "f32 J", "f32 dJ/dt nu", "f32 det(J J')", "f32 slope of det(J J')"].map(Worst::of);
    for case in 0..CASES {
        let Pair { small: (robot, q, nu, _), large: (exact, q64, nu64, _) } = pair(&mut draw, case);
        let p = exact.tip_position(&q64);
        tip.see(case, &wide(&robot.tip_position(&q)), &p, 1.0 + p.norm());
        let j = exact.jacobian(&q64).to_matrix();
        jacobian.see(case, &robot.jacobian(&q).to_matrix().map(f64::from), &j, j.norm());
        let expected: Vector3<f64> = exact.jacobian_bias(&q64, &nu64);
        let u: Vector = of_velocity(&nu64);
        rate.see(case, &wide(&robot.jacobian_bias(&q, &nu)), &expected, j.norm() * u.norm_squared());
        let one = |x: f64| SVector::<f64, 1>::new(x);
        let (posture, posture64) = (robot.posture(&q.joints), exact.posture(&q64.joints));
        let scale = j.norm().powi(6);
        let got = robot.manipulability_squared(&posture).to_f64();
        squared.see(case, &one(got), &one(exact.manipulability_squared(&posture64)), scale);
        let got = robot.manipulability_slope(&posture, &nu.joints);
        let exactly = exact.manipulability_slope(&posture64, &nu64.joints);
        let both = |gradient: [f64; 3], rate: [f64; 3]| {
            SVector::<f64, 6>::from_iterator(gradient.into_iter().chain(rate))
        };
        let a = both(got.gradient.map(f64::from), got.rate.map(f64::from));
        slope.see(case, &a, &both(exactly.gradient, exactly.rate), scale * (1.0 + u.norm()));
    }
    for worst in [tip, jacobian, rate, squared, slope] {
        worst.within(TOLERANCE);
    }
}
