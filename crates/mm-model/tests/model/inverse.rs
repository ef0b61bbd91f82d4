//! Inverse kinematics and the range of heights of the tip.
//!
//! Law: every branch that inverse kinematics gives puts the tip where it was asked for, one of them is the posture that the
//! point was made of, and a point beyond the reach is told from a NaN. References: forward kinematics; the elbow's position
//! by geometry; a search over the box of joint limits for the heights.
//! Tolerance: 1e-12 of the sizes involved at the tip, also where the arm is stretched (there the elbow's angle is only good to
//! the root of that, but the tip does not feel it); 1e-8 rad for angles away from stretched and vertical arms.

use crate::common::random::{self, Random};
use crate::common::worst::Worst;
use mm_model::{Configuration, InverseKinematics, JointSolution, Real, Robot, RobotParams};
use nalgebra::{SVector, Vector3, vector};

const CASES: u32 = 10_000;

fn branches(robot: &Robot<f64, 3>, q: &Configuration<f64, 3>, tip: &Vector3<f64>) -> [JointSolution<f64>; 4] {
    match robot.inverse_kinematics(q, tip) {
        InverseKinematics::Solutions { branches, .. } => branches,
        other => unreachable!("{other:?} for a point that the arm had reached, {tip:?}, at {q:?}"),
    }
}

#[test]
fn every_branch_returns_to_the_point() {
    let mut draw = Random::seeded(51);
    let (mut back, mut angles) = (Worst::of("tip of each branch"), Worst::of("the posture it was made of"));
    let mut compared = 0;
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let q = draw.configuration();
        let tip = robot.tip_position(&q);
        let found = branches(&robot, &q, &tip);
        for (branch, expected) in
            found.iter().zip([(true, true), (true, false), (false, true), (false, false)])
        {
            assert_eq!((branch.facing, branch.elbow_up), expected, "case {case}: order of the branches");
            let there = robot.tip_position(&Configuration { joints: branch.joints, ..q });
            back.see(case, &there, &tip, 10.0);
            let [q1, q2, q3] = branch.joints;
            assert!((-f64::PI..f64::PI).contains(&q1), "case {case}: q1 = {q1}");
            assert_eq!(branch.within_limits, robot.within_joint_limits(&branch.joints), "case {case}");
            // Elbow and tip in the arm's plane, seen along the reach.
            let [_, a2, a3] = robot.params().links.map(|link| link.length);
            let ((s2, c2), (s23, c23)) = (Real::sin_cos(q2), Real::sin_cos(q2 + q3));
            let (rho, height) = (a2 * c2 + a3 * c23, a2 * s2 + a3 * s23);
            let above = (a2 * s2 - height * (a2 * c2 / rho)) > 0.0;
            if rho.abs() > 0.01 && Real::sin_cos(q3).0.abs() > 0.01 {
                assert_eq!(branch.facing, rho > 0.0, "case {case}: {branch:?}");
                assert_eq!(branch.elbow_up, above, "case {case}: {branch:?}");
            }
        }
        let [q1, q2, q3] = q.joints;
        let [_, a2, a3] = robot.params().links.map(|link| link.length);
        let rho = a2 * Real::sin_cos(q2).1 + a3 * Real::sin_cos(q2 + q3).1;
        if rho.abs() > 0.05 && Real::sin_cos(q3).0.abs() > 0.05 {
            compared += 1;
            let nearest = found.iter().map(|branch| {
                let [b1, b2, b3] = branch.joints;
                [b1 - q1, b2 - q2, b3 - q3].map(|d| d.wrap_to_pi().abs()).into_iter().fold(0.0, f64::max)
            });
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            angles.see(case, &vector![nearest], &vector![0.0], 1.0);
        }
    }
    assert!(compared > CASES / 2, "only {compared} postures were regular");
    back.within(1e-12);
    angles.within(1e-8);
}

#[test]
fn a_stretched_or_folded_arm_is_still_within_reach() {
    let mut draw = Random::seeded(52);
    let mut back = Worst::of("tip of a stretched arm");
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let mut q = draw.configuration();
        q.joints[2] = if case % 2 == 0 { 0.0 } else { f64::PI };
        let tip = robot.tip_position(&q);
        for branch in branches(&robot, &q, &tip) {
            let there = robot.tip_position(&Configuration { joints: branch.joints, ..q });
            back.see(case, &there, &tip, 10.0);
        }
    }
    back.within(1e-12);
}

#[test]
fn a_stretched_arm_is_within_reach_in_single_precision() {
    let mut draw = Random::seeded(55);
    // Links of very different lengths: cos q3 is then known worst.
    let mut params = RobotParams::<f32, 3>::thesis();
    (params.links[1].length, params.links[2].length) = (0.9, 0.15);
    let robot = random::robot(params);
    let mut back = Worst::of("f32 tip of a stretched arm");
    for case in 0..CASES {
        let n = |x: f64| <f32 as Real>::from_f64(x);
        let q = draw.configuration();
        let [q1, q2, _] = q.joints.map(n);
        let q = Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: [q1, q2, 0.0] };
        let tip = robot.tip_position(&q);
        let found = robot.inverse_kinematics(&q, &tip);
        let InverseKinematics::Solutions { branches, .. } = found else {
            unreachable!("case {case}: {found:?} for a point that the arm had reached")
        };
        for branch in branches {
            let there = robot.tip_position(&Configuration { joints: branch.joints, ..q });
            back.see(case, &there.map(f64::from), &tip.map(f64::from), 10.0);
        }
    }
    back.within(1e-5);
}

#[test]
fn a_point_out_of_reach_tells_its_distance() {
    let mut draw = Random::seeded(53);
    let [mut distance, mut reach] = ["distance of the point", "reach"].map(Worst::of);
    for case in 0..CASES {
        let robot = random::robot(draw.params(case));
        let q = draw.configuration();
        let p = robot.params();
        let [a1, a2, a3] = p.links.map(|link| link.length);
        let (near, far) = ((a2 - a3).abs(), a2 + a3);
        // Beyond the outer edge or, every other time, inside the inner one.
        let away =
            if case % 2 == 0 { far * draw.between(1.001, 3.0) } else { near * draw.between(0.0, 0.99) };
        let direction = Vector3::from_fn(|_, _| draw.between(-1.0, 1.0));
        let (sin, cos) = Real::sin_cos(q.heading);
        let shoulder = Vector3::new(q.x + p.arm_offset * cos, q.y + p.arm_offset * sin, p.mount_height + a1);
        let tip = shoulder + direction * (away / direction.norm());
        let InverseKinematics::OutOfReach { distance: d, reach: (lo, hi) } =
            robot.inverse_kinematics(&q, &tip)
        else {
            unreachable!("case {case}: {away} m from the shoulder of an arm that reaches {near} to {far} m")
        };
        distance.see(case, &vector![d], &vector![away], 10.0);
        reach.see(case, &vector![lo, hi], &vector![near, far], 1.0);
    }
    // So far that the squares, and then the sums, overflow.
    let robot = random::robot(RobotParams::<f64, 3>::thesis());
    for far in [1e20, 1e200, f64::MAX] {
        let found = robot.inverse_kinematics(&Configuration::zero(), &Vector3::new(far, -far, far));
        assert!(matches!(found, InverseKinematics::OutOfReach { .. }), "{far}: {found:?}");
    }
    distance.within(1e-13);
    reach.within(1e-15);
}

#[test]
fn on_the_yaw_axis_every_yaw_does() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).expect("the preset is a robot");
    // 0.6 m above the shoulder, exactly on the axis: links of 0.5 m reach there with the elbow out to either side.
    let tip = Vector3::new(0.06, 0.0, 1.1);
    let home = Configuration::zero();
    let InverseKinematics::Solutions { branches, yaw_is_free } = robot.inverse_kinematics(&home, &tip) else {
        unreachable!("the point is within reach")
    };
    assert!(yaw_is_free);
    for branch in branches {
        for yaw in [0.0, 1.0, -2.5] {
            let [_, q2, q3] = branch.joints;
            let there = robot.tip_position(&Configuration { joints: [yaw, q2, q3], ..home });
            assert!((there - tip).norm() < 1e-14, "{branch:?} at yaw {yaw}");
        }
    }
    assert!(branches[0].joints[0].abs() < 1e-15 && branches[1].joints[0].abs() < 1e-15, "{branches:?}");
    let beside = Vector3::new(0.06, 1e-6, 1.1);
    let found = robot.inverse_kinematics(&home, &beside);
    assert!(matches!(found, InverseKinematics::Solutions { yaw_is_free: false, .. }), "{found:?}");
}

#[test]
fn straight_behind_the_yaw_stays_below_pi() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).expect("the preset is a robot");
    for y in [0.0, -0.0] {
        for branch in branches(&robot, &Configuration::zero(), &Vector3::new(-0.6, y, 0.7)) {
            let [q1, ..] = branch.joints;
            assert!((-f64::PI..f64::PI).contains(&q1), "{branch:?}");
        }
    }
}

#[test]
fn a_point_that_is_no_number_is_refused() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).expect("the preset is a robot");
    let (home, tip) = (Configuration::zero(), Vector3::new(0.5, 0.1, 0.6));
    assert!(matches!(robot.inverse_kinematics(&home, &tip), InverseKinematics::Solutions { .. }));
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for index in 0..3 {
            let mut point = tip;
            point[index] = bad;
            assert_eq!(robot.inverse_kinematics(&home, &point), InverseKinematics::NotFinite);
        }
        for base in [
            Configuration { x: bad, ..home },
            Configuration { y: bad, ..home },
            Configuration { heading: bad, ..home },
        ] {
            assert_eq!(robot.inverse_kinematics(&base, &tip), InverseKinematics::NotFinite);
        }
    }
}

#[test]
fn heights_are_those_of_a_search() {
    let mut draw = Random::seeded(54);
    let mut worst = Worst::of("lowest and highest tip");
    for case in 0..300 {
        let robot = random::robot(draw.params(case));
        let [_, a2, a3] = robot.params().links.map(|link| link.length);
        let (low, high) = robot.tip_height_range();
        let expected = vector![-search(&robot, -1.0), search(&robot, 1.0)];
        worst.see(case, &SVector::from([low, high]), &expected, a2 + a3);
    }
    // What the function promises: 1e-5 of the arm's length.
    worst.within(1e-5);
}

/// Largest `sign` times the height of the tip: the best point of a grid over the limits of q2 and q3, then of ever finer ones.
fn search(robot: &Robot<f64, 3>, sign: f64) -> f64 {
    let [_, two, three] = robot.params().limits.joints;
    let (steps, mut best) = (60, (f64::NEG_INFINITY, 0.0, 0.0));
    let (mut box2, mut box3) = (two, three);
    for _ in 0..7 {
        let at = |(lo, hi): (f64, f64), i: i32| lo + (hi - lo) * f64::from(i) / f64::from(steps);
        for i in 0..=steps {
            for j in 0..=steps {
                let (q2, q3) = (at(box2, i), at(box3, j));
                let joints = [0.0, q2, q3];
                let height = sign * robot.tip_position(&Configuration { joints, ..Configuration::zero() }).z;
                if height > best.0 {
                    best = (height, q2, q3);
                }
            }
        }
        let around = |q: f64, (lo, hi): (f64, f64), limits: (f64, f64)| {
            let width = 2.0 * (hi - lo) / f64::from(steps);
            ((q - width).max(limits.0), (q + width).min(limits.1))
        };
        (box2, box3) = (around(best.1, box2, two), around(best.2, box3, three));
    }
    best.0
}
