//! Where the tip is and how it moves, on 10,000 random robots and states.
//!
//! Law: position, Jacobian, its rate and the manipulability's slope are derivatives of one another. References: the chain of
//! Denavit-Hartenberg transforms (3.35) to (3.42) on the base's (3.50) to (3.54), multiplied out as matrices; determinants
//! of the explicit J J'; central differences of eighth order; virtual work for (3.49).
//! Mended in the chain: alpha_1 of Table 3.2 is pi/2 (printed pi would leave a planar arm at the height a1), and (3.51)
//! carries the position of the axle. Tolerance: 1e-13 relative to the sizes involved; 1e-11 for differences (see
//! `common/differences.rs`), 1e-8 for those of det(J J'), which is of degree six in the lengths.

use crate::common::differences::derivative;
use crate::common::random::{self, Random};
use crate::common::worst::Worst;
use mm_model::{Angle, Configuration, Mechanism, Real, Robot, Velocity};
use nalgebra::{Matrix4, SMatrix, SVector, Vector3, matrix};

const CASES: u32 = 10_000;
const TOLERANCE: f64 = 1e-13;
const BY_DIFFERENCES: f64 = 1e-11;
/// No angle below turns faster: 5 rad/s a joint at most, two joints at a time, and the yaw rate with q1.
const FASTEST: f64 = 10.0;

/// The transform (3.35) of one row of Table 3.2.
fn denavit_hartenberg(alpha: f64, a: f64, d: f64, q: f64) -> Matrix4<f64> {
    let ((s, c), (sa, ca)) = (Real::sin_cos(q), Real::sin_cos(alpha));
    matrix![
        c, -s * ca, s * sa, a * c;
        s, c * ca, -c * sa, a * s;
        0.0, sa, ca, d;
        0.0, 0.0, 0.0, 1.0
    ]
}

/// Where the configuration is after a short while at constant velocity, to first order in x and y, exact in the angles.
fn after(q: &Configuration<f64, 3>, nu: &Velocity<f64, 3>, t: f64) -> Configuration<f64, 3> {
    let rate = Robot::<f64, 3>::configuration_rate(Angle::of(q.heading), nu);
    let mut joints = q.joints;
    for (angle, dq) in joints.iter_mut().zip(rate.joints) {
        *angle += t * dq;
    }
    Configuration { x: q.x + t * rate.x, y: q.y + t * rate.y, heading: q.heading + t * rate.heading, joints }
}

fn of_velocity(nu: &Velocity<f64, 3>) -> SVector<f64, 5> {
    SVector::from_iterator(nu.channels())
}

#[test]
fn the_chain_of_transforms_ends_at_the_tip() {
    let mut draw = Random::seeded(31);
    let mut worst = Worst::of("tip by the chain of transforms");
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let q = draw.configuration();
        let p = robot.params();
        let [a1, a2, a3] = p.links.map(|link| link.length);
        let [q1, q2, q3] = q.joints;
        let (s, c) = Real::sin_cos(q.heading);
        let world_from_platform = matrix![
            c, -s, 0.0, q.x; s, c, 0.0, q.y; 0.0, 0.0, 1.0, p.mount_height; 0.0, 0.0, 0.0, 1.0
        ];
        let platform_from_arm = Matrix4::new_translation(&Vector3::new(p.arm_offset, 0.0, 0.0));
        let chain = world_from_platform
            * platform_from_arm
            * denavit_hartenberg(f64::PI / 2.0, 0.0, a1, q1)
            * denavit_hartenberg(0.0, a2, 0.0, q2)
            * denavit_hartenberg(0.0, a3, 0.0, q3);
        let tip: Vector3<f64> = chain.fixed_view::<3, 1>(0, 3).into_owned();
        worst.see(case, &robot.tip_position(&q), &tip, 1.0 + tip.norm());
    }
    worst.within(TOLERANCE);
}

#[test]
fn jacobian_and_its_rate_are_derivatives() {
    let mut draw = Random::seeded(32);
    let [mut jacobian, mut rate, mut bias] =
        ["J nu by differences", "dJ/dt by differences", "dJ/dt nu from dJ/dt"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let u = of_velocity(&nu);
        let j = robot.jacobian(&q);
        let size = j.to_matrix().norm();
        let velocity = derivative(FASTEST, |t| robot.tip_position(&after(&q, &nu, t)));
        jacobian.see(case, &j.product(&nu), &velocity, (size + 10.0) * FASTEST);
        let columns =
            robot.tip_jacobian_rate(Angle::of(q.heading), &robot.posture(&q.joints), &nu).to_matrix();
        let slope = derivative(FASTEST, |t| robot.jacobian(&after(&q, &nu, t)).to_matrix());
        rate.see(case, &columns, &slope, size * FASTEST);
        bias.see(case, &robot.jacobian_bias(&q, &nu), &(columns * u), columns.norm() * u.norm());
    }
    jacobian.within(BY_DIFFERENCES);
    rate.within(BY_DIFFERENCES);
    bias.within(TOLERANCE);
}

#[test]
fn jacobian_products_are_those_of_the_matrix() {
    let mut draw = Random::seeded(33);
    let [mut forward, mut arm, mut columns] = ["J nu", "J_arm dq", "columns"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let j = robot.jacobian(&q);
        let m = j.to_matrix();
        let scale = m.norm() * of_velocity(&nu).norm();
        forward.see(case, &j.product(&nu), &(m * of_velocity(&nu)), scale);
        let product = m.fixed_columns::<3>(2) * SVector::from(nu.joints);
        arm.see(case, &j.joint_product(&nu.joints), &product, scale);
        let listed: Vec<Vector3<f64>> = j.columns().copied().collect();
        columns.see(case, &SMatrix::<f64, 3, 5>::from_columns(&listed), &m, m.norm());
    }
    for worst in [forward, arm, columns] {
        worst.within(TOLERANCE);
    }
}

#[test]
fn a_force_at_the_tip_does_the_same_work_in_the_joints() {
    let mut draw = Random::seeded(34);
    let [mut work, mut matrix, mut solved] = ["virtual work", "J'F", "F from (3.49)"].map(Worst::of);
    let mut inverted = 0;
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let force = Vector3::from_fn(|_, _| draw.between(-30.0, 30.0));
        let j = robot.jacobian(&q);
        let m = j.to_matrix();
        let along = j.transpose_product(&force);
        matrix.see(
            case,
            &SVector::<f64, 5>::from_iterator(along.channels()),
            &(m.transpose() * force),
            m.norm() * force.norm(),
        );
        // Work done at the tip, its path taken by differences, is work done along the channels.
        let path = derivative(FASTEST, |t| robot.tip_position(&after(&q, &nu, t)));
        let one = |x: f64| SVector::<f64, 1>::new(x);
        let scale = (m.norm() + 10.0) * FASTEST * force.norm();
        work.see(case, &one(nu.power(&along)), &one(path.dot(&force)), scale);
        // (3.49) as printed, with the arm's own Jacobian: the force that given torques hold.
        let square: SMatrix<f64, 3, 3> = m.fixed_columns::<3>(2).into_owned();
        if square.determinant().abs() > 0.05 * square.norm().powi(3) {
            inverted += 1;
            let found = square.transpose().lu().solve(&SVector::from(along.joints)).expect("regular");
            solved.see(case, &found, &force, force.norm());
        }
    }
    assert!(inverted > CASES / 20, "only {inverted} arms were regular");
    work.within(BY_DIFFERENCES);
    matrix.within(TOLERANCE);
    solved.within(TOLERANCE);
}

#[test]
fn manipulability_is_the_determinant() {
    let mut draw = Random::seeded(35);
    let [mut squared, mut root] = ["det(J J')", "sqrt(det(J J'))"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let q = draw.configuration();
        let j = robot.jacobian(&q).to_matrix();
        let expected = (j * j.transpose()).determinant();
        let one = |x: f64| SVector::<f64, 1>::new(x);
        let got = robot.manipulability_squared(&robot.posture(&q.joints));
        squared.see(case, &one(got), &one(expected), j.norm().powi(6));
        let product = j.singular_values().product();
        root.see(case, &one(robot.manipulability(&q)), &one(product), j.norm().powi(3));
    }
    squared.within(TOLERANCE);
    // Near zero the root of a number of size 1e-16 is of size 1e-8.
    root.within(1e-10);
}

#[test]
fn slope_of_the_manipulability_is_its_derivative() {
    let mut draw = Random::seeded(36);
    let [mut gradient, mut rate] = ["gradient of det(J J')", "rate of that gradient"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let (q, nu) = (draw.configuration(), draw.velocity());
        let scale = robot.jacobian(&q).to_matrix().norm().powi(6);
        let slope = robot.manipulability_slope(&robot.posture(&q.joints), &nu.joints);
        let mut expected = Vector3::zeros();
        for (joint, entry) in expected.iter_mut().enumerate() {
            *entry = derivative(2.0, |t| {
                let mut joints = q.joints;
                joints[joint] += t;
                SVector::<f64, 1>::new(robot.manipulability_squared(&robot.posture(&joints)))
            })[0];
        }
        gradient.see(case, &Vector3::from(slope.gradient), &expected, scale);
        let along = derivative(2.0 * FASTEST, |t| {
            let there = robot.posture(&after(&q, &nu, t).joints);
            Vector3::from(robot.manipulability_slope(&there, &nu.joints).gradient)
        });
        rate.see(case, &Vector3::from(slope.rate), &along, scale * FASTEST);
    }
    gradient.within(1e-8);
    rate.within(1e-8);
}
