//! The smooth square is the average of the exact square, its acceleration is continuous, its jerk bounded, from rest to rest.
//!
//! Laws: with R = 1 m and w = pi/10 rad/s, the reference at t is the mean of the exact square over [t - T/2, t + T/2]; the
//! position and its two derivatives change by no more than their own derivatives' bounds allow; jerk <= w^2 R/T; the printed
//! square is within w^2 R T^2/24 and its own rounding; the scenario starts and ends at rest and keeps the bounds that its
//! description names.
//! Why: a step of acceleration is a step of torque, which no drive follows.
//! Reference: an exact square written down a second time, walked along by length, averaged by Simpson's rule on each side of the
//! joint in the window; differences between neighbouring samples; the printed square.
//! Tolerances: twice the error (w T/256)^4/2880 m of Simpson's rule with 256 intervals, and 5e-13 m for rounding of its
//! sum of some 1500 terms of up to 16 m; for differences, rounding of positions of 16 m over the step.

use mm_control::Reference;
use mm_sim::trajectory::{Path, Trajectory};
use mm_tests::{closed, load, measured};
use nalgebra::Vector3;

const RATE: f64 = core::f64::consts::PI / 10.0;

/// Times at which exact straights and arcs meet.
fn joints() -> Vec<f64> {
    let (straight, arc) = (2.0 / RATE, 5.0);
    (0..8)
        .flat_map(|i| [f64::from(i) * (straight + arc) + straight, f64::from(i + 1) * (straight + arc)])
        .collect()
}

/// The exact square at time `t`: walks along straights and arcs, turning by 90 degrees right, right, left, left, ...
fn exact(t: f64) -> Vector3<f64> {
    let (mut x, mut y, mut heading) = (0.0, 0.0, core::f64::consts::FRAC_PI_2);
    let mut left = t * RATE;
    for corner in 0..8 {
        let straight = left.min(2.0);
        x += straight * libm::cos(heading);
        y += straight * libm::sin(heading);
        left -= straight;
        if left <= 0.0 {
            return Vector3::new(x, y, 0.5);
        }
        let side = if corner % 4 < 2 { -1.0 } else { 1.0 };
        let turn = left.min(core::f64::consts::FRAC_PI_2);
        // The centre is 1 m to that side.
        let (cx, cy) = (x - side * libm::sin(heading), y + side * libm::cos(heading));
        heading += side * turn;
        (x, y) = (cx + side * libm::sin(heading), cy - side * libm::cos(heading));
        left -= turn;
        if left <= 0.0 {
            return Vector3::new(x, y, 0.5);
        }
    }
    Vector3::new(x + left * libm::cos(heading), y + left * libm::sin(heading), 0.5)
}

/// The mean of the exact square over a window, by Simpson's rule between the joints.
fn mean(t: f64, window: f64) -> Vector3<f64> {
    let (a, b) = (t - 0.5 * window, t + 0.5 * window);
    let mut edges = vec![a];
    edges.extend(joints().into_iter().filter(|joint| (a..b).contains(joint)));
    edges.push(b);
    let mut sum = Vector3::zeros();
    for pair in edges.windows(2) {
        let (from, step) = (pair[0], (pair[1] - pair[0]) / 256.0);
        for i in 0..256_u32 {
            let at = |part: f64| exact(from + (f64::from(i) + part) * step);
            sum += (at(0.0) + at(0.5) * 4.0 + at(1.0)) * (step / 6.0);
        }
    }
    sum / (b - a)
}

#[test]
fn it_is_the_average_of_the_exact_square() {
    for window in [0.05, 0.5, 1.0, 4.0, 9.0] {
        let path = Path::SmoothSquare { window };
        let mut worst = 0.0_f64;
        for i in 0..300_u32 {
            let t = 4.6 + f64::from(i) * 0.313;
            worst = worst.max((path.at(t).position - mean(t, window)).norm());
        }
        measured(&format!("off the mean over {window} s, m"), worst);
        let turn = RATE * window.min(5.0) / 256.0;
        let tolerance = 5e-13 + turn * turn * turn * turn / 1440.0;
        assert!(worst <= tolerance, "off the mean over {window} s by {worst:e} m");
    }
    let path = Path::SmoothSquare { window: 0.5 };
    // Before its first joint it is the straight from the origin, also behind it.
    for t in [0.0, 0.1, 6.0] {
        assert!(
            (path.at(t).position - Vector3::new(0.0, RATE * t, 0.5)).norm() < 1e-15,
            "the straight at {t} s"
        );
    }
    let bare = Path::SmoothSquare { window: 0.0 };
    let worst = (0..970_u32).map(|i| f64::from(i) * 0.1).map(|t| (bare.at(t).position - exact(t)).norm());
    let worst = worst.fold(0.0, f64::max);
    assert!(worst <= 3e-14, "without a window it is the exact square, not {worst:e} m off");
}

/// Largest change between neighbouring samples of position, velocity and acceleration, over the time between them.
fn rates(at: impl Fn(f64) -> Reference<f64>, (from, to): (f64, f64), step: f64) -> [f64; 3] {
    let mut largest = [0.0_f64; 3];
    let mut before = at(from);
    let mut number = 1.0;
    while from + number * step <= to {
        let now = at(from + number * step);
        let changes = [
            now.position - before.position,
            now.velocity - before.velocity,
            now.acceleration - before.acceleration,
        ];
        for (largest, change) in largest.iter_mut().zip(changes) {
            *largest = largest.max(change.norm() / step);
        }
        before = now;
        number += 1.0;
    }
    largest
}

#[test]
fn nothing_jumps_at_the_joints() {
    for window in [0.2, 0.5, 2.0] {
        let path = Path::SmoothSquare { window };
        let step = 1e-4;
        let jerk_bound = RATE * RATE / window;
        for joint in joints() {
            for edge in [joint - 0.5 * window, joint, joint + 0.5 * window] {
                let [speed, acceleration, jerk] =
                    rates(|t| path.at(t), (edge - 20.0 * step, edge + 20.0 * step), step);
                // Rounding: 16 m and 0.3 m/s in a difference over 0.1 ms.
                assert!(speed <= RATE + 1e-10, "window {window}: {speed} m/s at {edge} s");
                assert!(
                    acceleration <= RATE * RATE + 1e-11,
                    "window {window}: {acceleration} m/s^2 at {edge} s"
                );
                assert!(jerk <= jerk_bound + 1e-11, "window {window}: {jerk} m/s^3 at {edge} s");
            }
        }
    }
}

#[test]
fn it_stays_as_near_to_the_printed_square_as_its_window_says() {
    let window = 0.5;
    let path = Path::SmoothSquare { window };
    let mut worst = 0.0_f64;
    for i in 0..9800_u32 {
        let t = f64::from(i) * 0.01;
        worst = worst.max((path.at(t).position - Path::Square.at(t).position).norm());
    }
    measured("off the printed square, m", worst);
    // The cut of a corner is w^2 T^2/24 = 1.03 mm; the printed speed of 0.31416 m/s gains 7.3e-6 m a second and its joints
    // lie up to 8.2e-5 m beside the exact ones.
    let cut = RATE * RATE * window * window / 24.0;
    assert!(worst >= cut * 0.999, "the arcs are {cut:e} m nearer to their centres, found {worst:e}");
    assert!(worst <= cut + 98.0 * 7.4e-6 + 1e-4, "off the printed square by {worst:e} m");
}

/// The trajectory of the bundled scenario.
fn bundled() -> Trajectory {
    closed(&load("square-smooth", &[])).trajectory
}

#[test]
fn the_scenario_goes_from_rest_to_rest_within_the_bounds_it_names() {
    let trajectory = bundled();
    let start = trajectory.at(0.0);
    assert!((start.position - Vector3::new(0.0, 0.0, 0.5)).norm() < 1e-300, "starts at the square's start");
    for t in [0.0, 97.0, 98.0] {
        let at = trajectory.at(t);
        let moving = at.velocity.norm() + at.acceleration.norm();
        assert!(moving < 1e-300, "rests at {t} s, found {moving:e}");
    }
    // The own time is 97 - 1.5 - 1.5 s; the last straight starts at the joint of 8 (20/pi + 5) = 90.93 s.
    let end = Vector3::new(16.0, RATE * (94.0 - joints()[15]), 0.5);
    assert!((trajectory.at(97.0).position - end).norm() < 1e-14, "ends on the last straight");
    let [speed, acceleration, jerk] = rates(|t| trajectory.at(t), (0.0, 98.0), 1e-3);
    measured("speed, m/s", speed);
    measured("acceleration, m/s^2", acceleration);
    measured("jerk, m/s^3", jerk);
    assert!(speed <= RATE + 1e-11, "{speed} m/s");
    // Ramps of 3 s: 1.5 v/T and 6 v/T^2; blends of 0.5 s: 0.197 m/s^3.
    assert!(acceleration <= 1.5 * RATE / 3.0 + 1e-11, "{acceleration} m/s^2");
    assert!(jerk <= 6.0 * RATE / 9.0 + 1e-11, "{jerk} m/s^3");
    assert!(jerk >= 0.2, "a ramp alone takes 0.209 m/s^3, found {jerk}");
}
