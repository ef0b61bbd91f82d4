//! Sensors, actuators, payload and slip, each against its own law.
//!
//! Laws: rounding is to the nearest mark; noise is white and normal, of the given deviation, and depends on the seed alone; a delay is of
//! whole periods; a lag is the exponential and a rate limit the ramp; a motor is the armature's equation and at a steady rate the line
//! k n (supply - k n w)/R; a payload weighs m g at its lever; a slip moves the base and not the wheels.
//!
//! Reference: closed forms where there are any, else explicit Euler in steps a thousand times finer, whose error is about h/T = 1e-5 of the
//! range; sums of squares for the noise, within 4 standard deviations of the statistic.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_control::Measurement;
use mm_model::{Configuration, Real, Robot, RobotParams, Torque, Velocity};
use mm_sim::disturbance::{Disturbance, Disturbances, Shape, Slip, Target};
use mm_sim::experiment::Experiment;
use mm_sim::hardware::{Actuators, Axis, Hardware, Motor, PoseSource, Running, Sensors, quantized};
use mm_sim::plant::{Payload, Plant, PlantState};
use mm_sim::random::Stream;
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

/// What is read of a sequence of states.
fn read(sensors: Sensors, states: &[PlantState]) -> Vec<Measurement<f64, 3>> {
    let hardware = Hardware { sensors, ..exact() };
    let mut running = Running::new(&hardware, &thesis(), &states[0]);
    states.iter().map(|state| running.measure(state)).collect()
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
fn rounding_is_to_the_nearest_mark() {
    let step = core::f64::consts::TAU / 16384.0;
    let (mut sum, mut squares) = (0.0, 0.0);
    for i in 0..10_000_i32 {
        let value = f64::from(i - 5000) * 1.234_567e-3;
        let error = quantized(value, step) - value;
        assert!(error.abs() <= 0.5 * step * (1.0 + 1e-9), "{value} is off by {error}");
        let marks = quantized(value, step) / step;
        assert!((marks - marks.round()).abs() < 1e-9, "{value} becomes {marks} marks");
        (sum, squares) = (sum + error, squares + error * error);
    }
    // Uniform errors: mean 0 and variance step^2/12; the values are spread evenly, so that 1 % holds.
    assert!((sum / 1e4).abs() < 0.01 * step, "a bias of {}", sum / 1e4);
    assert!((squares / 1e4 / (step * step / 12.0) - 1.0).abs() < 0.02, "{squares}");
    assert_eq!(quantized(0.123, 0.0).to_bits(), 0.123_f64.to_bits(), "no marks, no rounding");
}

#[test]
fn normal_numbers_are_normal_and_white() {
    let n = 200_000_usize;
    let mut stream = Stream::new(7, 1);
    let x: Vec<f64> = (0..n).map(|_| stream.next_normal()).collect();
    let mean_of = |f: &dyn Fn(usize) -> f64, n: usize| (0..n).map(f).sum::<f64>() / n as f64;
    let spread = 4.0 / (n as f64).sqrt();
    assert!(mean_of(&|i| x[i], n).abs() < spread, "mean");
    assert!((mean_of(&|i| x[i].powi(2), n) - 1.0).abs() < 2.0_f64.sqrt() * spread, "variance");
    // Twelve uniform numbers: 3 - 6/(5 12) = 2.9 for the fourth moment, whose own deviation is about 9.8.
    assert!((mean_of(&|i| x[i].powi(4), n) - 2.9).abs() < 9.8 * spread, "fourth moment");
    assert!(mean_of(&|i| x[i].powi(3), n).abs() < 15.0_f64.sqrt() * spread, "third moment");
    for lag in 1..6 {
        assert!(mean_of(&|i| x[i] * x[i + lag], n - lag).abs() < spread, "correlation at lag {lag}");
    }
    for (seed, number) in [(8, 1), (7, 2)] {
        let mut other = Stream::new(seed, number);
        let y: Vec<f64> = (0..n).map(|_| other.next_normal()).collect();
        assert!(mean_of(&|i| x[i] * y[i], n).abs() < spread, "stream {number} of seed {seed} is another one");
    }
}

#[test]
fn sensors_read_what_they_are_said_to() {
    let states: Vec<PlantState> = (0..20_000_i32)
        .map(|i| {
            let q = Configuration { x: 1.0, y: -2.0, heading: 0.5, ..start().q };
            PlantState { q, travel: 1e-5 * f64::from(i), ..start() }
        })
        .collect();
    let pose = PoseSource::True {
        position_resolution: 0.0,
        position_noise: 2e-4,
        heading_resolution: 0.0,
        heading_noise: 3e-4,
    };
    let noisy = Sensors { pose, seed: 5, ..Sensors::ideal() };
    let readings = read(noisy, &states);
    let n = readings.len() as f64;
    for (what, sigma, error) in [
        ("x", 2e-4, readings.iter().map(|m| m.q.x - 1.0).collect::<Vec<_>>()),
        ("y", 2e-4, readings.iter().map(|m| m.q.y + 2.0).collect()),
        ("heading", 3e-4, readings.iter().map(|m| m.q.heading - 0.5).collect()),
    ] {
        let variance = error.iter().map(|e| e * e).sum::<f64>() / n;
        assert!((variance / (sigma * sigma) - 1.0).abs() < 4.0 * (2.0 / n).sqrt(), "{what}: {variance}");
        let next = error.windows(2).map(|pair| pair[0] * pair[1]).sum::<f64>() / n;
        assert!(next.abs() < 4.0 * sigma * sigma / n.sqrt(), "{what} is white: {next}");
    }
    assert_eq!(readings, read(noisy, &states), "the same seed, the same bits");
    assert_ne!(readings, read(Sensors { seed: 6, ..noisy }, &states), "another seed, other noise");

    let coarse = Sensors { wheel_step: 0.1, joint_step: 0.01, delay: 3, ..Sensors::ideal() };
    for (k, reading) in read(coarse, &states).iter().enumerate() {
        let wheels = reading.wheels.unwrap_or_else(|| panic!("the wheels have encoders"));
        let angle = quantized(states[k.saturating_sub(3)].travel / 0.06, 0.1);
        assert!(
            (wheels.right - angle).abs() < 1e-12,
            "{k}: {} for {angle}, three periods late",
            wheels.right
        );
        let marks = states[0].q.joints.map(|q| quantized(q, 0.01).to_bits());
        assert_eq!(reading.q.joints.map(f64::to_bits), marks, "joints in marks");
    }
    let bare = Sensors { wheel_encoders: false, ..Sensors::ideal() };
    assert!(read(bare, &states).iter().all(|m| m.wheels.is_none()), "no encoders, no angles");
}

#[test]
fn odometry_is_the_pose_where_nothing_slips() {
    let slipping = |amplitude| {
        let target = Target::Slip(Slip { yaw_rate: 1.0, ..Slip::default() });
        let slip = Disturbance { target, shape: Shape::Constant, amplitude, from: 0.0, to: f64::INFINITY };
        let plant = Plant::new(thesis(), Disturbances::new(vec![slip]), STEP);
        let torque = thesis().torque_of(&thesis().inverse_dynamics(
            &start().q,
            &Velocity::zero(),
            &Velocity { forward: 0.4, yaw_rate: 0.3, joints: [0.0; 3] },
        ));
        let mut states = vec![start()];
        for i in 0..1000_i32 {
            let state = states[states.len() - 1];
            states.push(plant.step(f64::from(i) * STEP, &state, &plant.sines(&state.q), &torque));
        }
        let last = read(Sensors { pose: PoseSource::Odometry, ..Sensors::ideal() }, &states).pop();
        (last.unwrap_or_else(|| panic!("a reading")).q, states[1000].q)
    };
    let (found, pose) = slipping(0.0);
    // Chords in place of arcs: (turn per step)^2/24 of the way.
    let gap =
        (found.x - pose.x).abs().max((found.y - pose.y).abs()).max((found.heading - pose.heading).abs());
    assert!(gap < 1e-7 && pose.heading > 0.1, "{gap} after a turn of {}", pose.heading);
    let (found, pose) = slipping(0.2);
    assert!((pose.heading - found.heading - 0.2).abs() < 1e-9, "a slip of 0.2 rad/s over 1 s is not seen");
}

/// The torque of the right wheel at every step after a command, the wheel standing still or turning.
fn response(actuators: Actuators, first: f64, command: f64, steps: usize) -> Vec<f64> {
    let hardware = Hardware { actuators, ..exact() };
    let mut running = Running::new(&hardware, &thesis(), &start());
    let torque = |right| Torque { right, left: 0.0, joints: [0.0; 3] };
    let still = Velocity::zero();
    running.command(&torque(first), &still);
    (0..steps)
        .map(|_| {
            running.command(&torque(command), &still);
            let [begin, middle, end] = running.drive(&still);
            assert!(
                (begin.right - middle.right).abs() <= (begin.right - end.right).abs() + 1e-12,
                "on the way"
            );
            assert!((running.torque().right - end.right).abs() < 1e-12, "the end is the next begin");
            end.right
        })
        .collect()
}

fn with_axis(axis: Axis) -> Actuators {
    Actuators { axes: [axis; 5], ..Actuators::ideal(STEP) }
}

#[test]
fn a_lag_is_an_exponential_and_a_rate_limit_a_ramp() {
    let none = f64::INFINITY;
    let lag = Axis { limit: none, lag: 0.003, rate: none };
    for (k, torque) in response(with_axis(lag), 2.0, 10.0, 30).into_iter().enumerate() {
        let exact = 10.0 - 8.0 * Real::exp(-(k as f64 + 1.0) * STEP / 0.003);
        assert!((torque - exact).abs() < 1e-12, "{k}: {torque} for {exact}");
    }
    let ramp = Axis { limit: 9.0, lag: 0.0, rate: 500.0 };
    for (k, torque) in response(with_axis(ramp), 2.0, 10.0, 30).into_iter().enumerate() {
        let exact = (2.5 + 0.5 * k as f64).min(9.0);
        assert!((torque - exact).abs() < 1e-12, "{k}: {torque} for {exact}");
    }
    // Both: y' = (u - y)/lag cut to the rate, by Euler.
    let both = Axis { limit: none, lag: 0.003, rate: 1000.0 };
    let mut y: f64 = -4.0;
    for (k, torque) in response(with_axis(both), -4.0, 10.0, 40).into_iter().enumerate() {
        for _ in 0..1000 {
            y += 1e-6 * ((10.0 - y) / 0.003).clamp(-1000.0, 1000.0);
        }
        assert!((torque - y).abs() < 1e-2, "{k}: {torque} for {y}");
    }
    let delayed = Actuators { delay: 3, ..Actuators::ideal(STEP) };
    let found = response(delayed, 2.0, 10.0, 6);
    assert_eq!(found, [2.0, 2.0, 2.0, 10.0, 10.0, 10.0], "three periods late");
}

fn motor() -> Motor {
    Motor {
        resistance: 0.5,
        inductance: 1e-3,
        torque_constant: 0.05,
        gear_ratio: 30.0,
        supply: 24.0,
        current_limit: 20.0,
    }
}

#[test]
fn a_motor_is_its_armature() {
    let actuators = Actuators { motors: [Some(motor()); 5], ..Actuators::ideal(STEP) };
    let per_current = 0.05 * 30.0;
    // A step of 1.5 to 15 N m: 1 A to 10 A, with the drive's voltage R i*.
    let mut current: f64 = 1.0;
    for (k, torque) in response(actuators, 1.5, 15.0, 12).into_iter().enumerate() {
        for _ in 0..1000 {
            current += 1e-6 * (0.5 * 10.0 - 0.5 * current) / 1e-3;
        }
        assert!((torque - per_current * current).abs() < 1e-2, "{k}: {torque} for {}", per_current * current);
    }
    // At a steady rate the torque ends on the lower of command, current limit and the line of supply and rate.
    let hardware = Hardware { actuators, ..exact() };
    for rate in [0.0, 2.0, 5.0, 8.0, 12.0, 15.0, 18.0, -5.0] {
        for command in [5.0, 25.0, 100.0, -100.0] {
            let mut running = Running::new(&hardware, &thesis(), &start());
            let nu = Velocity { joints: [0.0, 0.0, rate], ..Velocity::zero() };
            let torque = Torque { right: 0.0, left: 0.0, joints: [0.0, 0.0, command] };
            let mut limited = false;
            for _ in 0..50 {
                limited = running.command(&torque, &nu);
                running.drive(&nu);
            }
            let emf = per_current * rate;
            let (low, high) = (per_current * (-24.0 - emf) / 0.5, per_current * (24.0 - emf) / 0.5);
            let expected = command.clamp(-30.0, 30.0).clamp(low, high);
            let found = running.torque().joints[2];
            assert!((found - expected).abs() < 1e-9, "{command} N m at {rate} rad/s: {found} for {expected}");
            assert_eq!(
                limited,
                (expected - command).abs() > 1e-9,
                "{command} N m at {rate} rad/s is limited"
            );
        }
    }
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
fn actuators_show_in_torque_and_saturation() {
    let gentle = run(&["plant.actuators.joint_torque_limit_n_m=[20.0, 30.0, 20.0]"]);
    assert!(gentle.metrics.saturated_fraction > 0.0, "34 N m of gravity are more than 30");
    let most = gentle.metrics.peak_torque_n_m.joints;
    assert!(most[1] <= 30.0 && most[0] <= 20.0 && most[2] <= 20.0, "{most:?}");
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
