//! Sensors, actuators, payload and slip, each against its own law.
//!
//! Laws: rounding is to the nearest mark; noise is white and normal, of the given deviation, and depends on the seed alone; a delay is of
//! whole periods; a lag is the exponential and a rate limit the ramp; a motor is the armature's equation and at a steady rate the line
//! k n (supply - k n w)/R; a payload weighs m g at its lever; a slip moves the base and not the wheels.
//!
//! Reference: closed forms where there are any, else explicit Euler in steps a thousand times finer, whose error is about h/T = 1e-5 of the
//! range; sums of squares for the noise, within 4 standard deviations of the statistic.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

mod actuators;
mod sensors;

use mm_model::{Configuration, Real, Robot, RobotParams, Torque, Velocity};
use mm_sim::disturbance::{Disturbance, Disturbances, Shape, Slip, Target};
use mm_sim::experiment::Experiment;
use mm_sim::hardware::{Actuators, Hardware, Sensors};
use mm_sim::plant::{Payload, Plant, PlantState};
use mm_sim::scenario;
use mm_sim::simulation::{NoRecorder, RunResult};

const STEP: f64 = 1e-3;

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap_or_else(|error| panic!("{error}"))
}

fn start() -> PlantState {
    let q = Configuration { joints: thesis().params().rest_posture, ..Configuration::zero() };
    PlantState { q, nu: Velocity::zero(), travel: 0.0, yaw_slip: 0.0 }
}

fn exact() -> Hardware {
    Hardware { sensors: Sensors::ideal(), actuators: Actuators::ideal(STEP) }
}

fn run(sets: &[&str]) -> RunResult {
    let mut all = vec!["simulation.duration_s=1.0".to_owned()];
    all.extend(sets.iter().map(|set| (*set).to_owned()));
    let loaded = scenario::load("square-realistic", &all).unwrap_or_else(|error| panic!("{error}"));
    let experiment = Experiment::build(&loaded).unwrap_or_else(|error| panic!("{error}"));
    let Ok(result) = experiment.run(&mut NoRecorder);
    result
}

#[test]
fn a_payload_weighs_m_g_at_its_lever() {
    let (robot, mass) = (thesis(), 2.0);
    let loaded = Robot::try_new(robot.params().with_payload(mass)).unwrap_or_else(|error| panic!("{error}"));
    let payload = Payload { robot: loaded, from: 1.0, to: 2.0 };
    let plant = Plant::new(robot, Disturbances::default(), STEP).with_payload(payload);
    let PlantState { q, .. } = start();
    let held = |t: f64| {
        plant.robot_at(t).torque_of(&plant.robot_at(t).inverse_dynamics(
            &q,
            &Velocity::zero(),
            &Velocity::zero(),
        ))
    };
    for (t, load) in [(0.0, 0.0), (0.999, 0.0), (1.0, mass), (1.999, mass), (2.0, 0.0), (3.0, 0.0)] {
        // The tip stands 0.5 m ahead of the shoulder and 0.25 m ahead of the elbow.
        let more = [held(t).joints[1] - held(0.0).joints[1], held(t).joints[2] - held(0.0).joints[2]];
        assert!((more[0] - load * 9.81 * 0.5).abs() < 1e-12, "{} N m at the shoulder at {t} s", more[0]);
        assert!((more[1] - load * 9.81 * 0.25).abs() < 1e-12, "{} N m at the elbow at {t} s", more[1]);
    }
    let moving =
        PlantState { nu: Velocity { forward: 0.3, yaw_rate: 0.1, joints: [0.2, 0.1, -0.3] }, ..start() };
    let step = |t: f64| plant.step(t, &moving, &plant.sines(&q), &held(0.0)).nu;
    let gap = |a: Velocity<f64, 3>, b: Velocity<f64, 3>| {
        a.minus(b).channels().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    assert!(gap(step(0.5), step(1.5)) > 1e-3, "the load counts");
    assert!(gap(step(1.5), moving.nu) < 0.05, "the velocity does not jump");
    assert!(gap(step(0.5), step(2.5)) <= 0.0, "and without it all is as before");
}

#[test]
fn a_slip_moves_the_base_and_not_the_wheels() {
    let slipping = |target, amplitude| {
        let slip = Disturbance {
            target: Target::Slip(target),
            shape: Shape::Sine { frequency: 3.0, phase: 0.4 },
            amplitude,
            from: 0.0,
            to: f64::INFINITY,
        };
        let plant = Plant::new(thesis(), Disturbances::new(vec![slip]), STEP);
        let torque = plant.robot().torque_of(&plant.robot().inverse_dynamics(
            &start().q,
            &Velocity::zero(),
            &Velocity::zero(),
        ));
        let mut state = PlantState { q: Configuration { heading: 0.7, ..start().q }, ..start() };
        for i in 0..1000_i32 {
            state = plant.step(f64::from(i) * STEP, &state, &plant.sines(&state.q), &torque);
        }
        state
    };
    // The integral of the sine over 1 s; Simpson's rule, which Runge-Kutta is here, errs by h^4.
    let way = 0.05 * (Real::sin_cos(0.4).1 - Real::sin_cos(3.4).1) / 3.0;
    let (sin, cos) = Real::sin_cos(0.7);
    let none = Slip::default();
    for (target, [x, y, turn]) in [
        (Slip { forward: 1.0, ..none }, [way * cos, way * sin, 0.0]),
        (Slip { sideways: 1.0, ..none }, [-way * sin, way * cos, 0.0]),
        (Slip { yaw_rate: 1.0, ..none }, [0.0, 0.0, way]),
    ] {
        let end = slipping(target, 0.05);
        let gap = (end.q.x - x).abs().max((end.q.y - y).abs()).max((end.q.heading - 0.7 - turn).abs());
        assert!(gap < 1e-9, "{target:?}: {gap}");
        assert!((end.yaw_slip - turn).abs() < 1e-9, "{target:?}: {} of yaw", end.yaw_slip);
        assert!(end.travel.abs() < 1e-9, "{target:?}: the wheels rolled {} m", end.travel);
    }
}

#[test]
fn a_varying_torque_keeps_the_order() {
    let plant = |step| Plant::new(thesis(), Disturbances::default(), step);
    let wave = |t: f64| {
        let swing = 5.0 * Real::sin_cos(8.0 * t).0;
        Torque { right: 0.4 * swing, left: -0.2 * swing, joints: [swing, 34.0 + swing, 10.0 - swing] }
    };
    let end = |step: f64, count: u32| {
        let plant = plant(step);
        (0..count).fold(start(), |state, i| {
            let t = f64::from(i) * step;
            let torques = [wave(t), wave(t + 0.5 * step), wave(t + step)];
            plant.step_driven(t, &state, &plant.sines(&state.q), &torques)
        })
    };
    let gap = |a: &PlantState, b: &PlantState| {
        let joints = a.q.joints.iter().zip(b.q.joints).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        (joints + (a.q.x - b.q.x).powi(2)).sqrt()
    };
    let fine = end(1.25e-3, 400);
    let ratio = gap(&end(20e-3, 25), &fine) / gap(&end(10e-3, 50), &fine);
    assert!((10.0..25.0).contains(&ratio), "halving the step divides the error by {ratio}, not by 16");
    let (plant, state) = (plant(STEP), start());
    let torque = wave(0.3);
    let sines = plant.sines(&state.q);
    let constant = plant.step_driven(0.0, &state, &sines, &[torque; 3]);
    assert_eq!(constant, plant.step(0.0, &state, &sines, &torque), "a constant torque is the plain step");
}

#[test]
fn a_seed_fixes_the_run_and_another_one_changes_it() {
    let digest = |sets: &[&str]| run(sets).digest;
    assert_eq!(digest(&[]), digest(&[]), "the same seed, the same bits");
    assert_ne!(digest(&[]), digest(&["simulation.seed=1"]), "another seed, another run");
    let silent = ["plant.sensors.position_noise_m=0", "plant.sensors.heading_noise_rad=0"];
    let seeded = [silent[0], silent[1], "simulation.seed=1"];
    assert_eq!(digest(&silent), digest(&seeded), "without noise there is nothing to seed");
}

#[test]
fn finer_plant_steps_change_the_run_by_little() {
    let error = |sets: &[&str]| run(sets).metrics.iae_m_s.sum;
    let noise =
        ["plant.sensors.position_noise_m=0", "plant.sensors.heading_noise_rad=0", "plant.sensors.bits=32"];
    let (coarse, fine) =
        (error(&noise), error(&[noise[0], noise[1], noise[2], "simulation.plant_step_s=0.00025"]));
    assert!((coarse / fine - 1.0).abs() < 0.01, "{coarse} and {fine}");
}

#[test]
fn estimators_follow_sensors() {
    let build = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let loaded = scenario::load("square", &sets).unwrap_or_else(|error| panic!("{error}"));
        match Experiment::build(&loaded) {
            Ok(Experiment::Closed(simulation)) => Ok(simulation),
            Ok(Experiment::Open(_)) => panic!("the square has a controller"),
            Err(error) => Err(error.to_string()),
        }
    };
    let closed = |sets: &[&str]| build(sets).unwrap_or_else(|error| panic!("{error}"));
    assert!(closed(&[]).hardware.is_none(), "nothing in between");
    assert!(closed(&["plant.sensors.bits=12"]).stack.estimates(), "encoders need an estimator");
    let lagging = closed(&["plant.actuators.lag_s=0.001"]);
    assert!(lagging.hardware.is_some() && !lagging.stack.estimates(), "actuators alone need none");
    assert!(closed(&["controller.estimator.kind=observer"]).hardware.is_some(), "asked for");
    let refused = build(&["plant.sensors.bits=12", "controller.estimator.kind=none"]).err();
    let shown = refused.unwrap_or_else(|| panic!("accepted"));
    for part in
        ["controller.estimator.kind", "no estimator, where sensors read positions alone", "`observer`"]
    {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
    let refused = build(&["plant.sensors.bits=12", "controller.estimator.cutoff_hz=500"]).err();
    let shown = refused.unwrap_or_else(|| panic!("accepted"));
    assert!(shown.contains("controller.estimator.cutoff_hz"), "{shown}");
}

#[test]
fn bad_keys_are_refused_where_they_stand() {
    let shown = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        scenario::load("square-compare", &sets)
            .map_or_else(|error| error.to_string(), |_| panic!("accepted {sets:?}"))
    };
    for (sets, parts) in [
        (&["plant.sensors.bits=3"][..], &["plant.sensors.bits", "4"][..]),
        (&["plant.sensors.delay_periods=-1"], &["plant.sensors.delay_periods"]),
        (
            &["plant.sensors.pose_source=\"odometry\"", "plant.sensors.position_noise_m=0.1"],
            &["odometry", "wheel_bits"],
        ),
        (&["plant.sensors.position_nois_m=0.1"], &["position_noise_m"]),
        (&["plant.actuators.lag_s=-1.0"], &["plant.actuators.lag_s"]),
        (&["plant.actuators.motor.wheel.resistance_ohm=0.0"], &["resistance_ohm", "supply_v"]),
        (
            &["plant.payload_kg=2.0", "plant.payload_from_s=5.0", "plant.payload_to_s=4.0"],
            &["payload_to_s", "payload_from_s = 5"],
        ),
        (&["disturbance.0.on=slip-yaw"], &["amplitude_n_m", "`amplitude_rad_s`"]),
        (&["controller.estimator.cutoff_hz=0.0"], &["controller.estimator.cutoff_hz"]),
        (&["controller.estimator.kind=kalman"], &["filtered-difference"]),
    ] {
        let text = shown(sets);
        for part in parts {
            assert!(text.contains(part), "{part:?} is not in:\n{text}");
        }
    }
    let sets = ["plant.actuators.lag_s=0.01".to_owned()];
    let loaded = scenario::load("verify-circle", &sets).unwrap_or_else(|error| panic!("{error}"));
    let text = Experiment::build(&loaded).map_or_else(|error| error.to_string(), |_| panic!("accepted"));
    assert!(text.contains("plant.actuators") && text.contains("neither measured nor driven"), "{text}");
}
