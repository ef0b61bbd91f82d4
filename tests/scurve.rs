//! The way from rest to rest is the fastest one within its limits.
//!
//! Laws: duration and states are those of the time-optimal profile with bounded speed, acceleration and jerk; way, speed and
//! acceleration are continuous and each the integral of the next; no limit is exceeded; both ends rest; the exact way is covered.
//! Why: the limits are what the user's hardware allows, and a slower way than needed wastes them.
//! Reference: rsruckig, a port of Ruckig, which solves the general problem by a case analysis with polynomial roots.
//! Tolerances: rounding, 1e-12 of each quantity's scale; 1e-9 for the acceleration, in which the rounding of the times of a slow
//! way counts with the jerk.

use mm_sim::trajectory::{Limits, SCurve};
use mm_tests::{Random, measured};
use rsruckig::prelude::*;

/// A random way and random limits, each over four decades.
fn case(random: &mut Random) -> (f64, Limits) {
    let mut decades = || libm::pow(10.0, random.between(-2.0, 2.0));
    (decades(), Limits { speed: decades(), acceleration: decades(), jerk: decades() })
}

/// The same way by Ruckig.
fn ruckig(length: f64, limits: Limits) -> Trajectory<1> {
    let mut input = InputParameter::<1>::new(None);
    input.target_position[0] = length;
    input.max_velocity[0] = limits.speed;
    input.max_acceleration[0] = limits.acceleration;
    input.max_jerk[0] = limits.jerk;
    let mut trajectory = Trajectory::new(None);
    let result = Ruckig::<1, ThrowErrorHandler>::new(None, 0.01).calculate(&input, &mut trajectory);
    assert!(result.is_ok(), "Ruckig solves {length} m within {limits:?}: {:?}", result.err());
    trajectory
}

#[test]
fn it_is_the_time_optimal_profile() {
    let mut random = Random::seeded(31);
    let (mut worst_time, mut worst_way) = (0.0_f64, 0.0_f64);
    for _ in 0..2000 {
        let (length, limits) = case(&mut random);
        let ours = SCurve::new(length, limits);
        let theirs = ruckig(length, limits);
        let off = (ours.duration() / theirs.get_duration() - 1.0).abs();
        worst_time = worst_time.max(off);
        assert!(off < 1e-12, "{length} m within {limits:?}: the duration is off by {off:e}");
        for part in [0.03, 0.2, 0.45, 0.5, 0.6, 0.9, 0.999] {
            let t = part * ours.duration();
            let fresh = || DataArrayOrVec::<f64, 1>::new(None, 0.0);
            let (mut position, mut velocity, mut acceleration) = (fresh(), fresh(), fresh());
            let p = &mut Some(&mut position);
            theirs.at_time(
                t,
                p,
                &mut Some(&mut velocity),
                &mut Some(&mut acceleration),
                &mut None,
                &mut None,
            );
            let [way, speed, change] = ours.at(t);
            let off = ((way - position[0]) / length).abs();
            worst_way = worst_way.max(off);
            assert!(off < 1e-12, "{length} m within {limits:?}: {off:e} of the way off at {part}");
            let off = (speed - velocity[0]).abs() / limits.speed;
            assert!(off < 1e-12, "{length} m within {limits:?}: {off:e} of the speed off at {part}");
            let off = (change - acceleration[0]).abs() / limits.acceleration;
            assert!(off < 1e-9, "{length} m within {limits:?}: {off:e} of the acceleration off at {part}");
        }
    }
    measured("duration off by", worst_time);
    measured("way off by", worst_way);
}

#[test]
fn it_rests_at_both_ends_and_keeps_its_limits() {
    let is = |state: [f64; 3], wanted: [f64; 3]| state.map(f64::to_bits) == wanted.map(f64::to_bits);
    let mut random = Random::seeded(32);
    for number in 0..300 {
        let (length, limits) = case(&mut random);
        let curve = SCurve::new(length, limits);
        let end = curve.duration();
        for t in [-1.0, 0.0] {
            assert!(is(curve.at(t), [0.0; 3]), "case {number} starts at rest, at {t} s");
        }
        for t in [end, 2.0 * end] {
            assert!(is(curve.at(t), [length, 0.0, 0.0]), "case {number} ends at rest, at {t} s");
        }
        let steps = 4000_u32;
        let h = end / f64::from(steps);
        let mut before = curve.at(0.0);
        for i in 1..=steps {
            let now = curve.at(f64::from(i) * h);
            let [way, speed, acceleration] = now;
            assert!(speed <= limits.speed * (1.0 + 1e-12) && speed >= 0.0, "case {number}: {speed} m/s");
            assert!(
                acceleration.abs() <= limits.acceleration * (1.0 + 1e-12),
                "case {number}: {acceleration} m/s^2"
            );
            // Acceleration is piecewise linear and continuous: the trapezoidal rule is exact for the speed but where the jerk
            // changes, and off by at most j h^2/4 there, and by twice j h^3 for the way.
            let jerk = (acceleration - before[2]).abs() / h;
            assert!(jerk <= limits.jerk * (1.0 + 1e-6), "case {number}: {jerk} m/s^3 of {}", limits.jerk);
            let gained = speed - before[1] - 0.5 * h * (acceleration + before[2]);
            let rounding = 1e-12 * limits.speed;
            assert!(
                gained.abs() <= 0.25 * limits.jerk * h * h + rounding,
                "case {number}: speed jumps {gained:e}"
            );
            let gained = way - before[0] - 0.5 * h * (speed + before[1]);
            let bound = limits.jerk * h * h * h + limits.acceleration * h * h + 1e-12 * length;
            assert!(gained.abs() <= bound, "case {number}: the way jumps by {gained:e} m");
            before = now;
        }
    }
}

/// Ways worked out by hand, one for each kind of profile, with 1 m/s, 1 m/s^2 and 2 m/s^3.
#[test]
fn profiles_by_hand() {
    let limits = Limits { speed: 1.0, acceleration: 1.0, jerk: 2.0 };
    // All seven phases: 0.5 s of jerk, 0.5 s at 1 m/s^2, 0.5 s of jerk take 0.75 m; 1 m is left for 1 s.
    let full = SCurve::new(2.5, limits);
    assert!((full.duration() - 4.0).abs() < 1e-15, "seven phases take 4 s, not {}", full.duration());
    let [way, speed, acceleration] = full.at(0.75);
    let off = (way - 1.0 / 24.0 - 0.0625 - 0.03125).abs() + (speed - 0.5).abs() + (acceleration - 1.0).abs();
    assert!(off < 1e-15, "half way up the ramp is off by {off:e}");
    // Without constant speed: v (v + 1/2) = 1/2 has v = 1/2, so that the hold is 0 and T = 1/2.
    let short = SCurve::new(0.5, limits);
    assert!((short.duration() - 2.0).abs() < 1e-15, "half a metre takes 2 s, not {}", short.duration());
    // Jerk alone: 2 j T^3 = 4 T^3 = 0.0625 gives T = 1/4.
    let tiny = SCurve::new(0.0625, limits);
    assert!((tiny.duration() - 1.0).abs() < 1e-15, "jerk alone takes 1 s, not {}", tiny.duration());
    // The speed is reached before the acceleration: T = sqrt(v/j) = 1/4 for v = 1/8.
    let slow = SCurve::new(0.25, Limits { speed: 0.125, ..limits });
    assert!((slow.duration() - 2.5).abs() < 1e-15, "2 s of way and 0.5 s of ramps, not {}", slow.duration());
}
