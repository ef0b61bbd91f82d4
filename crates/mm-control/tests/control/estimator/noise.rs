//! What noise of the positions becomes, and what a slip does to the fused pose.

use super::twins::response;
use super::{PERIOD, TAU, filter, observer, outputs, rest, stack};
use crate::common::random::Random;
use mm_control::{ControlStack, Measurement, WheelAngles};
use mm_model::{Configuration, Real};

/// Standard normal numbers, near enough: twelve uniform ones.
fn noise(draw: &mut Random) -> f64 {
    (0..12).map(|_| draw.between(-0.5, 0.5)).sum()
}

/// Variance of the velocity of joint 1 under white noise of its angle; the others stand still.
fn noise_of(stack: &ControlStack<f64, 3>, sigma: f64, length: usize) -> f64 {
    let mut draw = Random::seeded(3);
    let path = (0..length).map(|_| {
        let mut q = rest();
        q.joints[0] += sigma * noise(&mut draw);
        Measurement { q, wheels: None }
    });
    let out = outputs(stack, path);
    let late = &out[500..];
    late.iter().map(|o| o.signals.nu.joints[0].powi(2)).sum::<f64>() / late.len() as f64
}

/// Variance of the filtered difference of white noise of variance 1.
pub(super) fn noise_gain(cutoff: f64) -> f64 {
    let h = response(cutoff, 4000);
    let steps = h.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>();
    (h[0].powi(2) + steps) / PERIOD.powi(2)
}

#[test]
fn noise_comes_out_as_the_impulse_response_says() {
    let sigma = 1e-7;
    for cutoff in [20.0, 60.0] {
        let part = TAU * cutoff * PERIOD / 2.0_f64.sqrt();
        let (a1, a2) = (-2.0 * Real::exp(-part) * Real::sin_cos(part).1, Real::exp(-2.0 * part));
        let closed = 2.0 * ((1.0 + a1 + a2) / PERIOD).powi(2) / ((1.0 - a2) * (1.0 + a2 - a1));
        assert!((noise_gain(cutoff) / closed - 1.0).abs() < 1e-9, "the closed form at {cutoff} Hz");
        let found = noise_of(&stack(filter(cutoff)), sigma, 40_000);
        let ratio = found / (noise_gain(cutoff) * sigma * sigma);
        // The noise is correlated over about 1/(cutoff dt) samples: 40,000 of them are some 800 independent ones.
        assert!((ratio - 1.0).abs() < 0.15, "filter at {cutoff} Hz: {ratio} of the theory");
    }
}

#[test]
fn the_fused_pose_is_quieter_and_bears_a_slip() {
    let gain = 1.0 - Real::exp(-TAU * 60.0 / 16.0 * PERIOD);
    let still = WheelAngles { right: 0.0, left: 0.0 };
    for estimator in [filter(60.0), observer(60.0)] {
        let stack = stack(estimator);
        let mut draw = Random::seeded(4);
        let noisy = (0..60_000).map(|_| {
            let q = Configuration { x: 1e-4 * noise(&mut draw), ..rest() };
            Measurement { q, wheels: Some(still) }
        });
        let tip = stack.robot().tip_position(&rest()).x;
        let out = outputs(&stack, noisy);
        let late = &out[2000..];
        let variance = late.iter().map(|o| (o.signals.tip.x - tip).powi(2)).sum::<f64>() / late.len() as f64;
        let ratio = variance / (1e-8 * gain / (2.0 - gain));
        // Correlated over 2/gain samples: about 680 independent ones.
        assert!((ratio - 1.0).abs() < 0.22, "{estimator:?}: {ratio} of the theory");

        let slip = 0.05;
        let slipping = (0..3000_i32).map(|k| {
            let q = Configuration { y: slip * f64::from(k) * PERIOD, ..rest() };
            Measurement { q, wheels: Some(still) }
        });
        let last = outputs(&stack, slipping).pop().unwrap().signals;
        let error = slip * 2.999 - last.tip.y;
        let theory = slip * PERIOD * (1.0 - gain) / gain;
        assert!((error - theory).abs() < 1e-9, "{estimator:?}: {error} m of slip left, theory {theory}");
    }
}
