//! The estimator in a closed loop with a robot that the model does not know.

use super::noise::noise_gain;
use super::twins::Dense;
use super::{PERIOD, filter, hold, observer, outputs, rest, stack, thesis};
use crate::common::plant::Plant;
use mm_control::{Estimator, Measurement, Reference, WheelAngles};
use mm_model::{Force, Real, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

/// Mean square error of the velocity in a closed loop with a heavier robot that follows a circle.
fn tracking_error(estimator: Estimator<f64>) -> f64 {
    let stack = stack(estimator);
    let robot = Robot::try_new(RobotParams::thesis().with_mass_scaled(1.25)).unwrap();
    let mut plant = Plant { robot, q: rest(), nu: Velocity::zero(), time: 0.0 };
    let start = robot.tip_position(&plant.q);
    let mut state = stack.initial_state();
    let (mut sum, mut travel) = (0.0, 0.0);
    for k in 0..3000_i32 {
        let t = f64::from(k) * PERIOD;
        let (sin, cos) = Real::sin_cos(2.0 * t);
        let reference = Reference {
            position: start + 0.1 * Vector3::new(sin, 1.0 - cos, 0.5 * sin),
            velocity: 0.2 * Vector3::new(cos, sin, 0.5 * cos),
            acceleration: 0.4 * Vector3::new(-sin, cos, -0.5 * sin),
        };
        let turned = robot.wheel_rates(travel, plant.q.heading);
        let wheels = Some(WheelAngles { right: turned.right, left: turned.left });
        let out = stack.update_measured(&mut state, &Measurement { q: plant.q, wheels }, &reference).unwrap();
        if k > 1000 {
            sum += out.signals.nu.minus(plant.nu).channels().map(|x| x * x).sum::<f64>() / 1999.0;
        }
        let before = plant.nu.forward;
        plant.step(
            &out.torque,
            |t| Force { joints: [5.0 * Real::sin_cos(3.0 * t).0; 3], ..Force::zero() },
            PERIOD,
        );
        travel += 0.5 * PERIOD * (before + plant.nu.forward);
    }
    sum
}

#[test]
fn the_observer_lags_less_than_a_filter_of_the_same_noise() {
    // Impulse response of the observer without a model, by the dense one.
    let mut dense = Dense::new(60.0, 0.0);
    let steps: Vec<f64> = (0..4000).map(|k| dense.next(0.0, if k == 0 { 1.0 } else { 0.0 })).collect();
    let noise = steps.iter().map(|v| v * v).sum::<f64>();
    let mut cutoff = 60.0;
    while noise_gain(cutoff) > noise {
        cutoff *= 0.99;
    }
    assert!(cutoff < 60.0 && cutoff > 10.0, "a filter as quiet has its cutoff at {cutoff} Hz");
    let (filtered, observed) = (tracking_error(filter(cutoff)), tracking_error(observer(60.0)));
    assert!(observed < 0.25 * filtered, "{observed} against {filtered} of a filter at {cutoff} Hz");
}

#[test]
fn a_constant_push_leaves_no_error_of_the_velocity() {
    let stack = stack(observer(60.0));
    let robot = thesis();
    let mut plant = Plant { robot, q: rest(), nu: Velocity::zero(), time: 0.0 };
    let reference = hold(&robot, &rest());
    let mut state = stack.initial_state();
    let mut last = f64::INFINITY;
    for _ in 0..3000 {
        let measurement = Measurement { q: plant.q, wheels: None };
        let out = stack.update_measured(&mut state, &measurement, &reference).unwrap();
        last = out.signals.nu.minus(plant.nu).channels().fold(0.0, |most, x| most.max(x.abs()));
        plant.step(&out.torque, |_| Force { joints: [8.0, -20.0, 5.0], ..Force::zero() }, PERIOD);
    }
    assert!(last < 1e-6, "{last} left");
}

#[test]
fn a_delay_is_made_up_for() {
    let still = stack(filter(60.0));
    let ahead = still.with_delay(0.02).unwrap();
    let path = || {
        (0..500_i32).map(|k| {
            let mut q = rest();
            q.x = 0.3 * f64::from(k) * PERIOD;
            q.joints[0] += 0.2 * f64::from(k) * PERIOD;
            Measurement { q, wheels: None }
        })
    };
    let (a, b) = (outputs(&still, path()).pop().unwrap(), outputs(&ahead, path()).pop().unwrap());
    let mut q = rest();
    q.x = 0.3 * (0.499 + 0.02);
    q.joints[0] += 0.2 * (0.499 + 0.02);
    let expected = thesis::<f64>().tip_position(&q);
    assert!((b.signals.tip - expected).norm() < 1e-9, "{} for {expected}", b.signals.tip);
    assert!((a.signals.tip - expected).norm() > 5e-3, "without it the tip is behind");
}
