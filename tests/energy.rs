//! The plant neither makes nor loses energy: what the actuators and disturbances put in is what the robot has more.
//!
//! Laws: without gravity and torque the kinetic energy stays; falling freely under gravity the sum with the potential energy
//! stays, and what does change is the truncation of order 4; along a controlled run the energy changes by torque times the
//! angles turned through, and friction takes the rest.
//! Why: the equations are those of a mechanical system with ideal constraints, and `dM/dt - 2C` is skew.
//! References: constancy; work of a torque held over a step, which is exactly torque times angle, the wheel angles worked out
//! here from path length and heading; Simpson's rule over two steps where the power varies within a step, and its order.
//! Tolerances: see the tests; all are far above the rounding of energies of some 100 J and far below any slip in a sign.

use mm_model::{Configuration, Friction, Robot, RobotParams, Torque, Velocity};
use mm_sim::disturbance::{Disturbance, Disturbances, Shape, Target};
use mm_sim::experiment::Experiment;
use mm_sim::plant::{Plant, PlantState};
use mm_tests::{Random, build, load, measured, recorded};

fn energy(robot: &Robot<f64, 3>, s: &PlantState) -> f64 {
    robot.kinetic_energy(&s.q, &s.nu) + robot.potential_energy_at(&s.q)
}

/// Largest and last change of energy over 10 s in steps of `h`.
fn drift(robot: Robot<f64, 3>, start: PlantState, h: f64, steps: u32) -> (f64, f64) {
    let plant = Plant::new(robot, Disturbances::default(), h);
    let (mut state, mut largest, mut last) = (start, 0.0_f64, 0.0);
    let before = energy(&robot, &start);
    for i in 0..steps {
        let sines = plant.sines(&state.q);
        state = plant.step(f64::from(i) * h, &state, &sines, &Torque::zero());
        last = energy(&robot, &state) - before;
        largest = largest.max(last.abs());
    }
    (largest, last)
}

#[test]
fn kinetic_energy_stays_without_gravity() {
    let mut params = RobotParams::thesis();
    params.gravity = 0.0;
    let robot = Robot::try_new(params).expect("weightless is allowed");
    let mut random = Random::seeded(3);
    let mut worst: f64 = 0.0;
    for case in 0..20 {
        let [forward, yaw_rate, heading] = random.three(-1.0, 1.0);
        let start = PlantState {
            q: Configuration { x: 0.0, y: 0.0, heading, joints: random.three(-2.5, 2.5) },
            nu: Velocity { forward, yaw_rate, joints: random.three(-1.0, 1.0) },
            travel: 0.0,
            yaw_slip: 0.0,
        };
        let (largest, _) = drift(robot, start, 1e-3, 10_000);
        worst = worst.max(largest);
        assert!(largest <= 1e-9, "start {case}: the energy changed by {largest:e} J");
    }
    measured("largest drift without gravity, J", worst);
}

/// What is left after 10 s falls faster than by 16 when the step is halved, by 33: what the integrator loses for good is of order
/// 5. On the way the energy leaves its value and comes back, most where the falling arm is fastest; that part is of order 4, and
/// since the two have opposite signs the largest deviation falls by a little less than 16.
#[test]
fn energy_stays_in_free_fall() {
    let robot = Robot::try_new(RobotParams::thesis()).expect("the preset is a robot");
    let q = Configuration { x: 0.0, y: 0.0, heading: 0.0, joints: RobotParams::thesis().rest_posture };
    let start = PlantState { q, nu: Velocity::zero(), travel: 0.0, yaw_slip: 0.0 };
    let steps = [(2e-3, 5000), (1e-3, 10_000), (5e-4, 20_000)];
    let drifts = steps.map(|(h, steps)| {
        let (largest, last) = drift(robot, start, h, steps);
        measured(&format!("free fall, step {h} s: largest {largest:.3e} J, last"), last);
        (largest, last.abs())
    });
    let [_, (largest, last), (_, half_last)] = drifts;
    assert!(largest < 1e-6, "at 1 ms the energy leaves its value by {largest:e} J");
    // Rounding of 20,000 steps at 100 J is some 1e-12 J: the drift measured is truncation.
    assert!(half_last > 1e-10, "a drift of {half_last:e} J would be rounding, and its ratio chance");
    for pair in drifts.windows(2) {
        let (largest, last) = (pair[0].0 / pair[1].0, pair[0].1 / pair[1].1);
        assert!(last >= 16.0, "halving the step divides the drift by {last} only");
        assert!((12.0..=20.0).contains(&largest), "halving the step divides the deviation by {largest}");
    }
    measured("free fall: drift at 1 ms over that at 0.5 ms", last / half_last);
}

/// Angles of the wheels and joints, from path length and heading.
fn angles(robot: &Robot<f64, 3>, s: &PlantState) -> [f64; 5] {
    let p = robot.params();
    let turn = 0.5 * p.track_width * s.q.heading;
    let [q1, q2, q3] = s.q.joints;
    [(s.travel + turn) / p.wheel_radius, (s.travel - turn) / p.wheel_radius, q1, q2, q3]
}

fn list(torque: &Torque<f64, 3>) -> [f64; 5] {
    let [t1, t2, t3] = torque.joints;
    [torque.right, torque.left, t1, t2, t3]
}

#[test]
fn a_controlled_run_gains_the_work_of_its_torques() {
    // Steps on joint 1 and a heavier robot: the torque on every axis is constant over each plant step.
    let loaded = load(
        "spiral-disturbed",
        &["simulation.duration_s=30", "simulation.log_rate_hz=1000", "plant.mass_scale=1.25"],
    );
    let experiment = build(&loaded);
    let Experiment::Closed(simulation) = &experiment else { panic!("spiral-disturbed has a controller") };
    let (ticks, _) = recorded(&experiment);
    let (plant, robot) = (&simulation.plant, simulation.plant.robot());
    let (mut work, mut moved, mut worst) = (0.0, 0.0, 0.0_f64);
    let before = energy(robot, &ticks[0].state);
    for pair in ticks.windows(2) {
        let (disturbance, _) = plant.disturbances().sizes(pair[0].t, pair[0].t);
        let torque = list(&pair[0].torque.plus(disturbance));
        let (from, to) = (angles(robot, &pair[0].state), angles(robot, &pair[1].state));
        let done: f64 =
            torque.iter().zip(from).zip(to).map(|((torque, from), to)| torque * (to - from)).sum();
        work += done;
        moved += done.abs();
        worst = worst.max((energy(robot, &pair[1].state) - before - work).abs());
    }
    measured("work moved, J", moved);
    measured("largest misfit of energy and work, J", worst);
    assert!(moved > 10.0, "only {moved} J were moved: the run shows nothing");
    assert!(worst <= 1e-8 * moved, "energy and work differ by {worst:e} J of {moved} J");
}

#[test]
fn friction_and_a_varying_disturbance_account_for_the_rest() {
    let mut params = RobotParams::thesis();
    params.friction = Friction {
        wheel_viscous: 0.3,
        wheel_coulomb: 0.4,
        joint_viscous: [1.0, 2.0, 0.5],
        joint_coulomb: [0.5, 1.0, 0.3],
        smoothing: 0.5,
    };
    let robot = Robot::try_new(params).expect("friction is allowed");
    let disturbance = Disturbance {
        target: Target::Torque(Torque { right: 0.1, left: -0.2, joints: [1.0; 3] }),
        shape: Shape::Sine { frequency: 6.0, phase: 0.3 },
        amplitude: 12.0,
        from: 0.0,
        to: f64::INFINITY,
    };
    let start = PlantState {
        q: Configuration { x: 0.0, y: 0.0, heading: 0.3, joints: [0.1, 1.0, -1.5] },
        nu: Velocity { forward: 0.5, yaw_rate: 0.4, joints: [0.3, -0.2, 0.6] },
        travel: 0.0,
        yaw_slip: 0.0,
    };
    let held = Torque { right: 2.0, left: 1.0, joints: [0.5, 70.0, 20.0] };
    // Largest misfit over 2 s, and what friction took.
    let balance = |h: f64, pairs: u32| {
        let plant = Plant::new(robot, Disturbances::new(vec![disturbance]), h);
        let power = |t: f64, s: &PlantState| {
            let (push, _) = plant.disturbances().sizes(t, t);
            let force = robot.force_of(&held.plus(push)).minus(robot.friction(&s.nu));
            s.nu.power(&force)
        };
        let (mut state, mut work, mut worst, mut lost) = (start, 0.0, 0.0_f64, 0.0);
        for i in 0..pairs {
            let t = f64::from(2 * i) * h;
            let middle = plant.step(t, &state, &plant.sines(&state.q), &held);
            let after = plant.step(t + h, &middle, &plant.sines(&middle.q), &held);
            work += h / 3.0 * (power(t, &state) + 4.0 * power(t + h, &middle) + power(t + 2.0 * h, &after));
            lost += 2.0 * h * middle.nu.power(&robot.friction(&middle.nu));
            state = after;
            worst = worst.max((energy(&robot, &state) - energy(&robot, &start) - work).abs());
        }
        (worst, lost)
    };
    let ((coarse, _), (fine, lost)) = (balance(1e-3, 1000), balance(5e-4, 2000));
    measured("lost to friction, J", lost);
    measured("largest misfit of energy and work with friction, J", coarse);
    measured("and at half the step, J", fine);
    assert!(lost > 1.0, "friction took only {lost} J: the run shows nothing");
    // Simpson's rule and the integrator are both of order 4; a force left out would be a misfit of its work at any step.
    assert!(coarse <= 1e-7 * lost, "energy and work differ by {coarse:e} J of {lost} J");
    assert!(coarse >= 12.0 * fine, "the misfit, {coarse:e} J and {fine:e} J, is not truncation");
}
