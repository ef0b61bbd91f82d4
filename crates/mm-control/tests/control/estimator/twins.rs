//! Filter and observer against their impulse response and dense matrices.

use super::{PERIOD, TAU, filter, hold, observer, outputs, rest, stack, walk};
use mm_control::{Measurement, WheelAngles};
use mm_model::{Configuration, Force, Real, Velocity};
use nalgebra::{Matrix3, RowVector3, Vector3};

/// Impulse response of the low-pass, from its continuous poles.
pub(super) fn response(cutoff: f64, length: usize) -> Vec<f64> {
    let part = TAU * cutoff * PERIOD / 2.0_f64.sqrt();
    let decay = Real::exp(-part);
    let gain = 1.0 - 2.0 * decay * Real::sin_cos(part).1 + decay * decay;
    let power = |n: f64| Real::exp(-n * part) * Real::sin_cos(n * part).0;
    (0..length).map(|n| gain * power(n as f64 + 1.0) / power(1.0)).collect()
}

#[test]
fn the_filter_is_its_impulse_response() {
    for cutoff in [5.0, 60.0, 300.0] {
        let path = walk(1, 400, true);
        let h = response(cutoff, path.len());
        let out = outputs(&stack(filter(cutoff)), path.iter().copied());
        assert_eq!(out[0].signals.nu, Velocity::zero(), "no difference, no velocity");
        for k in 1..path.len() {
            let convolved = |position: &dyn Fn(&Measurement<f64, 3>) -> f64| {
                let parts =
                    (1..=k).map(|i| h[k - i] * (position(&path[i]) - position(&path[i - 1])) / PERIOD);
                parts.sum::<f64>()
            };
            let nu = &out[k].signals.nu;
            let joint = convolved(&|m| m.q.joints[1]);
            assert!((nu.joints[1] - joint).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {joint}", nu.joints[1]);
            let forward = convolved(&|m| 0.03 * m.wheels.map_or(0.0, |w| w.right + w.left));
            assert!((nu.forward - forward).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {forward}", nu.forward);
            let yaw = convolved(&|m| 0.3 * m.wheels.map_or(0.0, |w| w.right - w.left));
            assert!((nu.yaw_rate - yaw).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {yaw}", nu.yaw_rate);
        }
    }
}

#[test]
fn the_filter_is_three_decibels_down_at_its_cutoff() {
    let cutoff = 10.0;
    let path = (0..2000_i32).map(|k| {
        let mut q = rest();
        q.joints[0] += 1e-3 * Real::sin_cos(TAU * cutoff * f64::from(k) * PERIOD).0;
        Measurement { q, wheels: None }
    });
    let out = outputs(&stack(filter(cutoff)), path);
    let most = out[1000..].iter().fold(0.0, |most: f64, o| most.max(o.signals.nu.joints[0]));
    let ratio = most / (1e-3 * TAU * cutoff);
    // The samples are 100 a period, so that the largest is within 0.05 % of the amplitude.
    assert!((ratio - 0.5_f64.sqrt()).abs() < 2e-3, "{ratio}");
}

/// The observer of one channel with dense matrices: gains by Ackermann's formula.
pub(super) struct Dense {
    transition: Matrix3<f64>,
    gain: Vector3<f64>,
    state: Vector3<f64>,
}

impl Dense {
    pub(super) fn new(cutoff: f64, position: f64) -> Self {
        let dt = PERIOD;
        let transition = Matrix3::new(1.0, dt, 0.5 * dt * dt, 0.0, 1.0, dt, 0.0, 0.0, 1.0);
        let shifted = transition - Matrix3::identity() * Real::exp(-TAU * cutoff * dt / 3.0);
        let c = RowVector3::new(1.0, 0.0, 0.0);
        let observability = Matrix3::from_rows(&[c, c * transition, c * transition * transition]);
        let last = observability.lu().solve(&Vector3::new(0.0, 0.0, 1.0)).unwrap();
        let predictor = shifted * shifted * shifted * last;
        let gain = transition.lu().solve(&predictor).unwrap();
        Self { transition, gain, state: Vector3::new(position, 0.0, 0.0) }
    }

    pub(super) fn next(&mut self, expected: f64, position: f64) -> f64 {
        let dt = PERIOD;
        let predicted = self.transition * self.state + Vector3::new(0.5 * dt * dt, dt, 0.0) * expected;
        self.state = predicted + self.gain * (position - predicted.x);
        self.state.y
    }
}

#[test]
fn the_observer_is_the_dense_one() {
    for cutoff in [20.0, 60.0, 200.0] {
        let stack = stack(observer(cutoff));
        let path = walk(2, 300, true);
        let turned = |m: &Measurement<f64, 3>| {
            let WheelAngles { right, left } = m.wheels.unwrap();
            let [q1, q2, q3] = m.q.joints;
            [0.03 * (right + left), 0.3 * (right - left), q1, q2, q3]
        };
        let mut dense = turned(&path[0]).map(|position| Dense::new(cutoff, position));
        let mut state = stack.initial_state();
        let mut expected = Velocity::zero();
        for (k, m) in path.iter().enumerate() {
            let out = stack.update_measured(&mut state, m, &hold(stack.robot(), &m.q)).unwrap();
            let nu = out.signals.nu;
            let mut joints = m.q.joints;
            if k > 0 {
                let twin = dense.each_mut().into_iter().zip(turned(m)).zip(expected.channels());
                for (((channel, position), a), found) in twin.zip(nu.channels()) {
                    let wanted = channel.next(a, position);
                    assert!(
                        (found - wanted).abs() < 1e-9 * (1.0 + wanted.abs()),
                        "{k}: {found} for {wanted}"
                    );
                }
                joints = [dense[2].state.x, dense[3].state.x, dense[4].state.x];
            }
            let q = Configuration { joints, ..m.q };
            expected = stack.robot().forward_dynamics(&q, &nu, &out.torque, &Force::zero());
        }
    }
}
