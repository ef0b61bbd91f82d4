//! Lags, rate limits and motors.

use super::{STEP, exact, run, start, thesis};
use mm_model::{Real, Torque, Velocity};
use mm_sim::hardware::{Actuators, Axis, Hardware, Motor, Running};

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
fn actuators_show_in_torque_and_saturation() {
    let gentle = run(&["plant.actuators.joint_torque_limit_n_m=[20.0, 30.0, 20.0]"]);
    assert!(gentle.metrics.saturated_fraction > 0.0, "34 N m of gravity are more than 30");
    let most = gentle.metrics.peak_torque_n_m.joints;
    assert!(most[1] <= 30.0 && most[0] <= 20.0 && most[2] <= 20.0, "{most:?}");
}
