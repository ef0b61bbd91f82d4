//! Rounding, noise and odometry.

use super::{STEP, exact, start, thesis};
use mm_control::Measurement;
use mm_model::{Configuration, Velocity};
use mm_sim::disturbance::{Disturbance, Disturbances, Shape, Slip, Target};
use mm_sim::hardware::{Hardware, PoseSource, Running, Sensors, quantized};
use mm_sim::plant::{Plant, PlantState};
use mm_sim::random::Stream;

/// What is read of a sequence of states.
fn read(sensors: Sensors, states: &[PlantState]) -> Vec<Measurement<f64, 3>> {
    let hardware = Hardware { sensors, ..exact() };
    let mut running = Running::new(&hardware, &thesis(), &states[0]);
    states.iter().map(|state| running.measure(state)).collect()
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
