//! Motions along which the outer loop is differentiated, and random gains for it.

use mm_control::{OuterParams, Reference};
use mm_model::{Configuration, Real, Velocity};
use nalgebra::{SVector, Vector3};

use super::random::Random;

pub(crate) fn vector(nu: &Velocity<f64, 3>) -> SVector<f64, 5> {
    SVector::from_iterator(nu.channels())
}

pub(crate) fn sine(angle: f64) -> f64 {
    Real::sin_cos(angle).0
}

pub(crate) fn cosine(angle: f64) -> f64 {
    Real::sin_cos(angle).1
}

/// Where the exact arc with constant nu is after `t`: chord of the turn for the base, straight lines for the joints.
pub(crate) fn arc(q: &Configuration<f64, 3>, nu: &Velocity<f64, 3>, t: f64) -> Configuration<f64, 3> {
    let half = 0.5 * nu.yaw_rate * t;
    let chord = nu.forward * t * if half.abs() < 1e-9 { 1.0 } else { sine(half) / half };
    let [q1, q2, q3] = q.joints;
    let [d1, d2, d3] = nu.joints;
    Configuration {
        x: q.x + chord * cosine(q.heading + half),
        y: q.y + chord * sine(q.heading + half),
        heading: q.heading + 2.0 * half,
        joints: [q1 + d1 * t, q2 + d2 * t, q3 + d3 * t],
    }
}

/// A smooth path per axis: p = start + size sin(rate t + phase).
pub(crate) struct Path {
    pub(crate) start: Vector3<f64>,
    pub(crate) waves: [(f64, f64, f64); 3],
}

impl Path {
    /// Waves of up to half a metre and 3 rad/s through a point near `start`.
    pub(crate) fn random(draw: &mut Random, start: Vector3<f64>) -> Self {
        let mut wave = || (draw.between(0.0, 0.5), draw.between(0.0, 3.0), draw.between(-3.0, 3.0));
        Self { start, waves: [wave(), wave(), wave()] }
    }

    pub(crate) fn at(&self, t: f64) -> Reference<f64> {
        let wave = |f: fn(f64, f64, f64) -> f64| {
            let [x, y, z] = self
                .waves
                .map(|(size, rate, phase)| size * f(rate, sine(rate * t + phase), cosine(rate * t + phase)));
            Vector3::new(x, y, z)
        };
        Reference {
            position: self.start + wave(|_, sin, _| sin),
            velocity: wave(|rate, _, cos| rate * cos),
            acceleration: wave(|rate, sin, _| -rate * rate * sin),
        }
    }
}

/// Random gains on every axis and channel, the manipulability threshold `ratio` times the manipulability at `q`.
pub(crate) fn random_params(draw: &mut Random, manipulability: f64, ratio: f64) -> OuterParams<f64, 3> {
    OuterParams {
        position_gain: Vector3::new(
            draw.between(1.0, 20.0),
            draw.between(1.0, 20.0),
            draw.between(1.0, 20.0),
        ),
        sliding_gain: Velocity::splat(10.0),
        weights: Velocity::splat(0.0).map(|_: f64| draw.between(0.2, 5.0)),
        posture_gain: draw.between(0.0, 2.0),
        joint_limit_gain: draw.between(0.5, 4.0),
        joint_limit_margin: draw.between(0.05, 0.4),
        manipulability_gain: draw.between(0.0, 0.05),
        manipulability_threshold: manipulability * ratio,
        damping_max: draw.between(0.05, 0.2),
        correction_speed_limit: 1e6,
        joint_limit_rate: 0.0,
        base_hold: 0.0,
        base_release: 0.0,
        minimum_norm: false,
    }
}

/// The derivative at 0 by central differences of steps `h`, `h`/2 and `h`/4, extrapolated twice: error h^6.
pub(crate) fn extrapolated(law: impl Fn(f64) -> SVector<f64, 5>, h: f64) -> SVector<f64, 5> {
    let difference = |h: f64| (law(h) - law(-h)) / (2.0 * h);
    let [d1, d2, d4] = [1.0, 0.5, 0.25].map(|f| difference(h * f));
    let (r1, r2) = ((4.0 * d2 - d1) / 3.0, (4.0 * d4 - d2) / 3.0);
    (16.0 * r2 - r1) / 15.0
}
