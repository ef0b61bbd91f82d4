//! The plant's integrator is the classical Runge-Kutta method of order 4, and knows nothing of where the robot stands.
//!
//! Laws: the global error falls by 16 when the step is halved, free, driven and disturbed; one step is that of a naive
//! Runge-Kutta method; turning and shifting the start turns and shifts the motion.
//! Why: with a right-hand side that is smooth over the step, order 4 is a theorem, and any slip in a stage, in a weight or in
//! the sines carried from stage to stage lowers the order. The equations of motion depend on neither x, y nor heading.
//! References: the same plant at a step 32 times finer; Runge-Kutta written out here over `Robot::forward_dynamics` with fresh
//! sines for every stage.
//! Tolerances: ratios from 14 to 18, since the next term of the error is of relative size h; 1e-12 for a step, which is the
//! rounding of accelerations up to 1e3 over 1 ms.

#![expect(clippy::expect_used, reason = "a helper that cannot go on is a failed test")]

use mm_model::{Configuration, Friction, Robot, RobotParams, Torque, Velocity};
use mm_sim::disturbance::{Disturbance, Disturbances, Shape, Target};
use mm_sim::plant::{Plant, PlantState};
use mm_tests::{Random, measured};
use nalgebra::Vector3;

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).expect("the preset is a robot")
}

/// A start with everything in motion, in a posture far from the singular ones.
fn moving() -> PlantState {
    PlantState {
        q: Configuration { x: 0.3, y: -0.2, heading: 0.7, joints: [0.2, 0.9, -1.6] },
        nu: Velocity { forward: 0.4, yaw_rate: -0.6, joints: [0.5, -0.3, 0.8] },
        travel: 0.0,
        yaw_slip: 0.0,
    }
}

/// The state after `steps` steps of `h` from time 0.
fn integrate(plant: &Plant, start: &PlantState, torque: &Torque<f64, 3>, h: f64, steps: u32) -> PlantState {
    (0..steps).fold(*start, |state, i| {
        let sines = plant.sines(&state.q);
        plant.step(f64::from(i) * h, &state, &sines, torque)
    })
}

/// Every number of a state.
fn numbers(s: &PlantState) -> Vec<f64> {
    let [q1, q2, q3] = s.q.joints;
    [s.q.x, s.q.y, s.q.heading, q1, q2, q3, s.travel].into_iter().chain(s.nu.channels()).collect()
}

fn distance(a: &PlantState, b: &PlantState) -> f64 {
    numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Torques and a force at the tip, all smooth in time.
fn smooth() -> Disturbances {
    let sine = |target, amplitude, frequency, phase| Disturbance {
        target,
        shape: Shape::Sine { frequency, phase },
        amplitude,
        from: 0.0,
        to: f64::INFINITY,
    };
    let joints = Torque { right: 0.5, left: -0.3, joints: [1.0; 3] };
    Disturbances::new(vec![
        sine(Target::Torque(joints), 10.0, 5.0, 0.4),
        sine(Target::Tip(Vector3::new(0.6, 0.0, 0.8)), 8.0, 3.0, 0.0),
    ])
}

#[test]
fn halving_the_step_divides_the_global_error_by_sixteen() {
    let push = Torque { right: 2.0, left: -1.0, joints: [5.0, 60.0, 15.0] };
    let mut rough = RobotParams::thesis();
    rough.friction = Friction { joint_viscous: [2.0, 3.0, 1.0], wheel_viscous: 0.2, ..Friction::none() };
    let rough = Robot::try_new(rough).expect("viscous friction is allowed");
    let cases = [
        ("free", thesis(), Torque::zero(), Disturbances::default()),
        ("driven", thesis(), push, Disturbances::default()),
        ("disturbed", thesis(), push, smooth()),
        ("with viscous friction", rough, push, smooth()),
    ];
    for (name, robot, torque, disturbances) in cases {
        // 0.4 s in steps of 4, 2 and 1 ms: well above rounding, well below the time in which the falling arm turns.
        let end = |divisor: u32| {
            let h = 4e-3 / f64::from(divisor);
            let plant = Plant::new(robot, disturbances.clone(), h);
            integrate(&plant, &moving(), &torque, h, 100 * divisor)
        };
        let exact = end(128);
        let errors = [1, 2, 4].map(|divisor| distance(&end(divisor), &exact));
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            measured(&format!("{name}, error {:.2e}, ratio", pair[0]), ratio);
            assert!((14.0..=18.0).contains(&ratio), "{name}: errors {errors:?}, ratio {ratio}");
        }
    }
}

/// Classical Runge-Kutta over (x, y, heading, joints, travel, nu), every stage from scratch.
fn naive(
    robot: &Robot<f64, 3>,
    disturbances: &Disturbances,
    s: &PlantState,
    torque: &Torque<f64, 3>,
    (t, h): (f64, f64),
) -> Vec<f64> {
    let slope = |t: f64, y: &[f64]| -> Vec<f64> {
        let q = Configuration { x: y[0], y: y[1], heading: y[2], joints: [y[3], y[4], y[5]] };
        let nu = Velocity { forward: y[7], yaw_rate: y[8], joints: [y[9], y[10], y[11]] };
        let (push, force) = disturbances.sizes(t, t);
        let at_tip = robot.jacobian(&q).transpose_product(&force);
        let external = robot.force_of(&push).plus(at_tip);
        let a = robot.forward_dynamics(&q, &nu, torque, &external);
        let mut rate =
            vec![nu.forward * libm::cos(q.heading), nu.forward * libm::sin(q.heading), nu.yaw_rate];
        rate.extend(nu.joints);
        rate.push(nu.forward);
        rate.extend(a.channels());
        rate
    };
    let y = numbers(s);
    let along = |k: &[f64], dt: f64| -> Vec<f64> { y.iter().zip(k).map(|(y, k)| y + dt * k).collect() };
    let k1 = slope(t, &y);
    let k2 = slope(t + 0.5 * h, &along(&k1, 0.5 * h));
    let k3 = slope(t + 0.5 * h, &along(&k2, 0.5 * h));
    let k4 = slope(t + h, &along(&k3, h));
    (0..y.len()).map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])).collect()
}

#[test]
fn a_step_is_that_of_a_naive_runge_kutta_method() {
    let mut random = Random::seeded(11);
    let h = 1e-3;
    let mut worst: f64 = 0.0;
    for case in 0..2000 {
        let disturbances = if case % 2 == 0 { Disturbances::default() } else { smooth() };
        let mut params = RobotParams::thesis().with_mass_scaled(random.between(0.5, 2.0));
        params.friction.joint_viscous = random.three(0.0, 1.0);
        let robot = Robot::try_new(params).expect("a scaled robot is a robot");
        let [x, y, heading] = random.three(-4.0, 4.0);
        let [forward, yaw_rate, _] = random.three(-1.0, 1.0);
        let start = PlantState {
            q: Configuration { x, y, heading, joints: random.three(-3.0, 3.0) },
            nu: Velocity { forward, yaw_rate, joints: random.three(-1.0, 1.0) },
            travel: random.between(-2.0, 2.0),
            yaw_slip: 0.0,
        };
        let [right, left, _] = random.three(-5.0, 5.0);
        let torque = Torque { right, left, joints: random.three(-40.0, 40.0) };
        let t = random.between(0.0, 10.0);
        let plant = Plant::new(robot, disturbances.clone(), h);
        let stepped = plant.step(t, &start, &plant.sines(&start.q), &torque);
        let reference = naive(&robot, &disturbances, &start, &torque, (t, h));
        for (got, wanted) in numbers(&stepped).iter().zip(reference) {
            worst = worst.max((got - wanted).abs());
            assert!((got - wanted).abs() <= 1e-12, "case {case}: {got} instead of {wanted}");
        }
    }
    measured("largest difference of a step from the naive one", worst);
}

#[test]
fn turning_and_shifting_the_start_turns_and_shifts_the_motion() {
    let plant = Plant::new(thesis(), Disturbances::default(), 1e-3);
    let torque = Torque { right: 3.0, left: 2.0, joints: [1.0, 50.0, 10.0] };
    let start = moving();
    let plain = integrate(&plant, &start, &torque, 1e-3, 2000);
    for (turn, dx, dy) in [(0.9, 12.0, -7.0), (-2.5, -3.0, 40.0), (3.1, 0.0, 0.0)] {
        let (sin, cos) = (libm::sin(turn), libm::cos(turn));
        let moved = |x: f64, y: f64| (dx + cos * x - sin * y, dy + sin * x + cos * y);
        let mut other = start;
        (other.q.x, other.q.y) = moved(start.q.x, start.q.y);
        other.q.heading += turn;
        let end = integrate(&plant, &other, &torque, 1e-3, 2000);
        let (x, y) = moved(plain.q.x, plain.q.y);
        let off =
            (end.q.x - x).abs().max((end.q.y - y).abs()).max((end.q.heading - plain.q.heading - turn).abs());
        // 2000 additions to numbers of up to 40 m.
        assert!(off <= 2000.0 * 40.0 * f64::EPSILON, "turned by {turn}: the base is off by {off:e}");
        // Pose enters neither the accelerations nor the joints, not even by rounding.
        assert_eq!(end.nu, plain.nu, "turned by {turn}: the same velocities to the bit");
        assert_eq!(
            end.q.joints.map(f64::to_bits),
            plain.q.joints.map(f64::to_bits),
            "turned by {turn}: the same joints to the bit"
        );
        assert_eq!(end.travel.to_bits(), plain.travel.to_bits(), "turned by {turn}: the same path length");
    }
}
