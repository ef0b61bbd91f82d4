//! Wheels, inputs, constraints and friction of the base, and the base without an arm.
//!
//! Law: torques and wheel rates are dual (the same power in both), the velocity maps span what the constraints leave free
//! (A S = 0, full ranks), friction only takes power, and the base alone is the robot whose arm weighs nothing.
//! References: hand-written (3.14), (3.32), (3.76) and (3.92) with their misprints mended, multiplied out as matrices.
//! Tolerance: 1e-13 relative for what is multiplied out; 1e-6 for an arm of 1e-9 of its mass, whose reaction is some hundred
//! times that fraction of the lightest base's.

use crate::common::random::{self, Random};
use crate::common::vectors::{of_force, of_velocity};
use crate::common::worst::Worst;
use mm_model::{
    Angle, Configuration, Force, Friction, Limits, Mechanism, Real, Robot, RobotParams, Torque, Velocity,
    WheelRates,
};
use nalgebra::{SMatrix, SVector, matrix, vector};

const CASES: u32 = 10_000;
const TOLERANCE: f64 = 1e-13;

/// The same base without its arm.
fn without_arm(p: &RobotParams<f64, 3>) -> Robot<f64, 0> {
    let f = &p.friction;
    let params = RobotParams {
        base_mass: p.base_mass,
        base_yaw_inertia: p.base_yaw_inertia,
        base_com_offset: p.base_com_offset,
        arm_offset: p.arm_offset,
        mount_height: p.mount_height,
        wheel_radius: p.wheel_radius,
        track_width: p.track_width,
        gravity: p.gravity,
        links: [],
        rest_posture: [],
        friction: Friction {
            wheel_viscous: f.wheel_viscous,
            wheel_coulomb: f.wheel_coulomb,
            joint_viscous: [],
            joint_coulomb: [],
            smoothing: f.smoothing,
        },
        limits: Limits { joints: [], wheel_torque: 60.0, joint_torque: [], speed: 2.0 },
    };
    Robot::try_new(params).unwrap_or_else(|error| unreachable!("a base of a random robot: {error}"))
}

fn of_torque(t: &Torque<f64, 3>) -> SVector<f64, 5> {
    SVector::from_iterator(t.channels())
}

fn pair<const N: usize>(v: &Force<f64, N>) -> SVector<f64, 2> {
    vector![v.forward, v.yaw]
}

#[test]
fn input_map_and_wheel_kinematics_round_trip_and_are_dual() {
    let mut draw = Random::seeded(41);
    let [mut torques, mut forces, mut speeds, mut power] =
        ["B^-1 B tau", "B B^-1 f", "speeds of wheel rates", "power in wheels and joints"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let nu = draw.velocity();
        let torque = Torque::from_channels([(); 5].into_iter().map(|()| draw.between(-50.0, 50.0)));
        let force = robot.force_of(&torque);
        let (t, f) = (of_torque(&torque), of_force(&force));
        torques.see(case, &of_torque(&robot.torque_of(&force)), &t, t.norm());
        forces.see(case, &of_force(&robot.force_of(&robot.torque_of(&force))), &f, f.norm());
        let wheels = robot.wheel_rates(nu.forward, nu.yaw_rate);
        let (v, omega) = robot.base_speed(wheels);
        let size = nu.forward.abs() + nu.yaw_rate.abs();
        speeds.see(case, &vector![v, omega], &vector![nu.forward, nu.yaw_rate], size);
        let joints = torque.joints.iter().zip(nu.joints).fold(0.0, |sum, (t, rate)| sum + t * rate);
        let spent = torque.right * wheels.right + torque.left * wheels.left + joints;
        let scale = f.norm() * of_velocity(&nu).norm();
        power.see(case, &vector![nu.power(&force)], &vector![spent], scale);
    }
    for worst in [torques, forces, speeds, power] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn the_right_wheel_is_the_faster_one_in_a_left_turn() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).expect("the preset is a robot");
    let WheelRates { right, left } = robot.wheel_rates(0.6, 1.0);
    // (0.6 +- 0.1 * 1.0) / 0.06.
    assert!((right - 0.7 / 0.06).abs() < 1e-12 && (left - 0.5 / 0.06).abs() < 1e-12, "{right} {left}");
    let force = robot.force_of(&Torque { right: 3.0, left: 0.0, joints: [0.0; 3] });
    assert!((force.forward - 50.0).abs() < 1e-12 && (force.yaw - 5.0).abs() < 1e-12, "{force:?}");
}

#[test]
fn velocity_maps_span_what_the_constraints_leave_free() {
    let mut draw = Random::seeded(42);
    let [mut wheels, mut axle, mut arm, mut platform] =
        ["A S (3.31)", "A S (3.11), (3.14)", "A S (3.91), (3.92)", "S against (3.32)"].map(Worst::of);
    for case in 0..CASES {
        let mut p = draw.params(case);
        let robot = random::robot(p);
        let heading = Angle::of(draw.between(-7.0, 7.0));
        let (a, s) = (robot.wheel_constraint_matrix(heading), robot.wheel_velocity_map(heading));
        wheels.see(case, &(a * s), &SMatrix::zeros(), a.norm() * s.norm());
        assert_eq!((a.rank(1e-9), s.rank(1e-9)), (3, 2), "case {case}: 5 coordinates, 2 free");
        // (3.31) as printed repeats its second row and loses a constraint.
        let mut printed = a;
        printed.set_row(2, &a.row(1));
        assert_eq!(printed.rank(1e-9), 2, "case {case}");

        let (d, Angle { sin, cos }) = (p.base_com_offset, heading);
        let from_speeds = matrix![cos, -d * sin; sin, d * cos; 0.0, 1.0];
        for rates in [WheelRates { right: 1.0, left: 0.0 }, WheelRates { right: 0.0, left: 1.0 }] {
            let (v, omega) = robot.base_speed(rates);
            let got = (s * vector![rates.right, rates.left]).fixed_rows::<3>(0).into_owned();
            platform.see(case, &got, &(from_speeds * vector![v, omega]), s.norm());
        }

        let (a, s) = (Robot::<f64, 3>::constraint_matrix(heading), Robot::<f64, 3>::velocity_map(heading));
        arm.see(case, &(a * s), &SMatrix::zeros(), 1.0);
        assert_eq!((a.rank(1e-9), s.rank(1e-9)), (1, 5), "case {case}: 6 coordinates, 5 free");
        let nu = draw.velocity();
        let rate = Robot::<f64, 3>::configuration_rate(heading, &nu);
        let product = s * of_velocity(&nu);
        let [d1, d2, d3] = rate.joints;
        arm.see(case, &vector![rate.x, rate.y, rate.heading, d1, d2, d3], &product, product.norm());

        p.base_com_offset = 0.0;
        let robot = random::robot(p);
        let (a, s) = (robot.wheel_constraint_matrix(heading), robot.wheel_velocity_map(heading));
        let (k, l) = (p.wheel_radius / 2.0, p.track_width / 2.0);
        let literal = matrix![k * cos, k * cos; k * sin, k * sin; k / l, -k / l; 1.0, 0.0; 0.0, 1.0];
        axle.see(case, &(a * literal), &SMatrix::zeros(), a.norm() * s.norm());
        axle.see(case, &s, &literal, s.norm());
    }
    for worst in [wheels, axle, arm, platform] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn friction_opposes_every_motion() {
    let mut draw = Random::seeded(43);
    let mut each = Worst::of("friction, channel by channel");
    for case in 0..CASES {
        let mut p = draw.params(case);
        let robot = random::robot(p);
        let nu = draw.velocity();
        let force = robot.friction(&nu);
        assert!(nu.power(&force) > 0.0, "case {case}: friction gives power");
        assert_eq!(robot.friction(&nu.scaled(-1.0)), force.scaled(-1.0), "case {case}: friction is not odd");
        let f = p.friction;
        let law = |w: f64, viscous: f64, coulomb: f64| viscous * w + coulomb * w / Real::sqrt(w * w + 0.01);
        let rates = robot.wheel_rates(nu.forward, nu.yaw_rate);
        let wheel = |w| law(w, f.wheel_viscous, f.wheel_coulomb);
        let joint = |i: usize| law(nu.joints[i], f.joint_viscous[i], f.joint_coulomb[i]);
        let torque = vector![wheel(rates.right), wheel(rates.left), joint(0), joint(1), joint(2)];
        each.see(case, &of_torque(&robot.torque_of(&force)), &torque, torque.norm());

        p.friction = Friction::none();
        assert_eq!(random::robot(p).friction(&nu), Force::zero(), "case {case}");
        assert_eq!(robot.friction(&Velocity::zero()), Force::zero(), "case {case}");
    }
    each.within(TOLERANCE);
}

#[test]
fn limits_cut_torques_and_know_the_joints() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).expect("the preset is a robot");
    let within = Torque { right: 60.0, left: -60.0, joints: [150.0, -200.0, 150.0] };
    assert_eq!(robot.limit_torque(&within), (within, false));
    let (cut, was_cut) = robot.limit_torque(&within.scaled(1.5));
    assert_eq!((cut, was_cut), (within, true));
    let one_beyond = Torque { joints: [150.0, -200.5, 150.0], ..within };
    assert_eq!(robot.limit_torque(&one_beyond), (within, true));
    assert!(robot.within_joint_limits(&[0.0, 1.92, -2.79]));
    assert!(!robot.within_joint_limits(&[0.0, 1.93, 0.0]));
    assert!(!robot.within_joint_limits(&[0.0, 0.0, f64::NAN]));
}

#[test]
fn base_alone_is_the_literal_form_reduced() {
    let mut draw = Random::seeded(44);
    let [mut mass, mut coriolis, mut input, mut transpose] =
        ["N = 0: S'MS", "S'(M dS + C S)", "S'E", "C' nu"].map(Worst::of);
    let mut forward = Worst::of("N = 0: forward dynamics");
    for case in 0..CASES {
        let p = draw.params(case);
        let robot = without_arm(&p);
        let (nu, nu_r) = (draw.velocity(), draw.velocity());
        let [nu, nu_r] =
            [nu, nu_r].map(|n| Velocity { forward: n.forward, yaw_rate: n.yaw_rate, joints: [] });
        let heading = draw.between(-7.0, 7.0);
        let (sin, cos) = Real::sin_cos(heading);
        // (3.76) for (x, y, heading), with I_b + m d^2 and +-l/r; C q' = -m d omega^2 (cos, sin, 0).
        let (m, d, r, l) = (p.base_mass, p.base_com_offset, p.wheel_radius, p.track_width / 2.0);
        let (cross, yaw) = (m * d, p.base_yaw_inertia + m * d * d);
        let full = matrix![m, 0.0, -cross * sin; 0.0, m, cross * cos; -cross * sin, cross * cos, yaw];
        let omega = nu.yaw_rate;
        let c = matrix![0.0, 0.0, -cross * omega * cos; 0.0, 0.0, -cross * omega * sin; 0.0, 0.0, 0.0];
        let e = matrix![cos / r, cos / r; sin / r, sin / r; l / r, -l / r];
        let s = matrix![cos, 0.0; sin, 0.0; 0.0, 1.0];
        let s_rate = matrix![-sin * omega, 0.0; cos * omega, 0.0; 0.0, 0.0];
        let back = s.transpose();
        let (full, c, e) = (back * full * s, back * (full * s_rate + c * s), back * e);

        let blocks = robot.mass_matrix(&());
        mass.see(case, &blocks.base, &full, full.norm());
        let (u, u_r) = (vector![nu.forward, omega], vector![nu_r.forward, nu_r.yaw_rate]);
        let product = pair(&robot.coriolis_product(&(), &nu, &nu_r));
        let size = full.norm() * u.norm();
        coriolis.see(case, &product, &(c * u_r), size * u_r.norm());
        let product = pair(&robot.coriolis_transpose_product(&(), &nu));
        transpose.see(case, &product, &(c.transpose() * u), size * u.norm());
        let torque = Torque { right: draw.between(-9.0, 9.0), left: draw.between(-9.0, 9.0), joints: [] };
        let t = vector![torque.right, torque.left];
        input.see(case, &pair(&robot.force_of(&torque)), &(e * t), e.norm() * t.norm());
        let q = Configuration { heading, ..Configuration::zero() };
        let a = robot.forward_dynamics(&q, &nu, &torque, &Force::zero());
        let force = e * t - c * u - pair(&robot.friction(&nu));
        let expected = full.lu().solve(&force).expect("positive definite");
        let scale = expected.norm() + (e.norm() * t.norm() + size * u.norm()) / full.norm();
        forward.see(case, &vector![a.forward, a.yaw_rate], &expected, scale);
        let a_again = blocks.factor().expect("positive definite").solve(&Force {
            forward: force[0],
            yaw: force[1],
            joints: [],
        });
        forward.see(case, &vector![a_again.forward, a_again.yaw_rate], &expected, scale);
    }
    for worst in [mass, coriolis, input, transpose, forward] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn base_alone_is_the_robot_whose_arm_weighs_nothing() {
    let mut draw = Random::seeded(45);
    let [mut mass, mut coriolis, mut forward, mut foot] =
        ["M of a massless arm", "C nu_r", "forward dynamics", "tip of an arm of no length"].map(Worst::of);
    for case in 0..CASES {
        let mut p = draw.params(case);
        let base = without_arm(&p);
        let dust = 1e-9;
        for link in &mut p.links {
            link.mass *= dust;
            link.axial_inertia *= dust;
            link.pitch_inertia *= dust;
            link.normal_inertia *= dust;
        }
        p.friction = Friction { joint_viscous: [0.0; 3], joint_coulomb: [0.0; 3], ..p.friction };
        let robot = random::robot(p);
        let (q, nu, nu_r) = (draw.configuration(), draw.velocity(), draw.velocity());
        let short = |n: &Velocity<f64, 3>| Velocity { forward: n.forward, yaw_rate: n.yaw_rate, joints: [] };
        let inertia = robot.inertia(&robot.posture(&q.joints));
        let m = base.mass_matrix(&()).base;
        mass.see(case, &robot.mass_matrix(&inertia).base, &m, m.norm());
        let got = pair(&robot.coriolis_product(&inertia, &nu, &nu_r));
        let expected = pair(&base.coriolis_product(&(), &short(&nu), &short(&nu_r)));
        coriolis.see(case, &got, &expected, m.norm());
        // The arm falls and flings freely: its accelerations are large, its reaction on the base is not.
        let a = robot.forward_dynamics(
            &q,
            &nu,
            &Torque { right: 5.0, left: -2.0, joints: [0.0; 3] },
            &Force::zero(),
        );
        let flat = Configuration { x: q.x, y: q.y, heading: q.heading, joints: [] };
        let b = base.forward_dynamics(
            &flat,
            &short(&nu),
            &Torque { right: 5.0, left: -2.0, joints: [] },
            &Force::zero(),
        );
        let scale = 1.0 + vector![b.forward, b.yaw_rate].norm();
        forward.see(case, &vector![a.forward, a.yaw_rate], &vector![b.forward, b.yaw_rate], scale);

        for link in &mut p.links {
            link.length = 1e-12;
        }
        let stub = random::robot(p);
        foot.see(case, &stub.tip_position(&q), &base.tip_position(&flat), 1.0);
        let columns = |j: [nalgebra::Vector3<f64>; 2]| SMatrix::<f64, 3, 2>::from_columns(&j);
        let (j, j_base) = (stub.jacobian(&q), base.jacobian(&flat));
        foot.see(case, &columns([j.forward, j.yaw_rate]), &columns([j_base.forward, j_base.yaw_rate]), 1.0);
        let bias = base.jacobian_bias(&flat, &short(&nu));
        foot.see(case, &stub.jacobian_bias(&q, &Velocity { joints: [0.0; 3], ..nu }), &bias, 10.0);
        // Two velocities cannot span three directions.
        foot.see(case, &vector![base.manipulability(&flat)], &vector![0.0], 1.0);
    }
    mass.within(1e-6);
    coriolis.within(1e-6);
    forward.within(1e-6);
    foot.within(1e-10);
}
