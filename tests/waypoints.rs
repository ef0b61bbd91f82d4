//! A motion through points passes them, is smooth, keeps the tip's limits in space and rests at both ends.
//!
//! Laws: the spline meets its points with continuous first and second derivatives and bends at its ends as it is told to, which
//! only one cubic spline does; the norms of velocity, acceleration and jerk stay within their limits at every instant;
//! velocity and acceleration are the derivatives of position; on a straight line all three limits are reached; lines stop at each
//! point; many points of a smooth curve are passed about as fast as a straight line.
//! Why: the limits are those of a machine; one instant beyond them is one too many.
//! Reference: the defining properties; differences between close samples, which by the mean value theorem are never larger than
//! the bound on the derivative.
//! Tolerances: 1e-9 relative for the limits, for rounding of differences; see each check.

use mm_control::Reference;
use mm_sim::trajectory::{Joined, Limits, SCurve, Spline, Waypoints};
use mm_tests::{Random, measured};
use nalgebra::Vector3;

/// Random points 2 cm to 2 m apart, over four decades of curvature.
fn points(random: &mut Random, count: usize) -> Vec<Vector3<f64>> {
    let mut points = vec![Vector3::from(random.three(-1.0, 1.0))];
    while points.len() < count {
        let way = Vector3::from(random.three(-1.0, 1.0)) * libm::pow(10.0, random.between(-1.3, 0.3));
        if way.norm() > 0.02 {
            points.push(points[points.len() - 1] + way);
        }
    }
    points
}

fn limits(random: &mut Random) -> Limits {
    let mut decades = || libm::pow(10.0, random.between(-1.0, 1.0));
    Limits { speed: decades(), acceleration: decades(), jerk: decades() }
}

#[test]
fn the_spline_is_the_cubic_spline_through_its_points() {
    let mut random = Random::seeded(41);
    for (count, part) in [(2, 0.0), (3, 0.0), (3, 1.0), (4, 0.3), (7, 0.0), (7, 1.0), (40, 0.0), (40, 1.0)] {
        let points = points(&mut random, count);
        let intervals: Vec<f64> = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        let spline = Spline::through(&points, &intervals, part);
        let scale = spline.bounds();
        let mut knot = 0.0;
        for (number, pair) in points.windows(2).enumerate() {
            let [at, ..] = spline.at(knot);
            assert!((at - pair[0]).norm() < 1e-14 * 40.0, "{count} points: misses point {number}");
            if number > 0 {
                let (before, after) = (spline.at(knot * (1.0 - 1e-15)), spline.at(knot));
                for order in 0..3 {
                    let jump = (before[order] - after[order]).norm();
                    // 1e-15 of u times the next derivative, and rounding of the piece before.
                    let next = scale.get(order).copied().unwrap_or(0.0) * knot;
                    let allowed = 1e-13 * (next + scale[order.saturating_sub(1)] + 1.0);
                    assert!(
                        jump < allowed,
                        "{count} points: derivative {order} jumps by {jump:e} at {number}"
                    );
                }
            }
            knot += (pair[1] - pair[0]).norm();
        }
        let ends = [(0.0, intervals[0]), (spline.length(), spline.length() - intervals[count - 2])];
        for (end, next) in ends {
            let off = (spline.at(end)[2] - spline.at(next)[2] * part).norm();
            assert!(
                count == 2 || off < 1e-12 * (1.0 + scale[1]),
                "{count} points: the end bends by {off:e} too much"
            );
        }
        let [last, _, bend] = spline.at(spline.length());
        assert!((last - points[count - 1]).norm() < 1e-12, "{count} points: misses the last one");
        let still = spline.at(0.0)[2].norm() + bend.norm();
        assert!(
            part > 0.0 || still < 1e-12 * (1.0 + scale[1]),
            "{count} points: natural ends bend by {still:e}"
        );
        // The bounds bound, and not too far away.
        let mut seen = [0.0_f64; 2];
        for i in 0..=20_000_u32 {
            let [_, first, second] = spline.at(spline.length() * f64::from(i) / 20_000.0);
            seen = [seen[0].max(first.norm()), seen[1].max(second.norm())];
        }
        assert!(seen[0] <= scale[0] * (1.0 + 1e-12) && seen[1] <= scale[1] + 1e-12, "{seen:?} of {scale:?}");
        assert!(seen[0] > 0.98 * scale[0] && seen[1] >= 0.98 * scale[1], "{seen:?} of a loose {scale:?}");
    }
}

/// Largest norms of the differences of position, velocity and acceleration over the time between samples.
fn rates(motion: &Waypoints, samples: u32) -> [f64; 3] {
    let h = motion.duration() / f64::from(samples);
    let parts = |at: &Reference<f64>| [at.position, at.velocity, at.acceleration];
    let mut before = parts(&motion.at(-h));
    let mut largest = [0.0_f64; 3];
    for i in 0..=samples + 1 {
        let now = parts(&motion.at(f64::from(i) * h));
        for (largest, (now, before)) in largest.iter_mut().zip(now.iter().zip(&before)) {
            *largest = largest.max((now - before).norm() / h);
        }
        before = now;
    }
    largest
}

/// Velocity, acceleration and jerk of motions through random points; also that nothing jumps, since a jump of any of the three
/// would show as a difference beyond the limit.
#[test]
fn limits_hold_in_space() {
    let mut random = Random::seeded(42);
    for joined in [Joined::Spline, Joined::Lines] {
        let mut used = [0.0_f64; 3];
        for number in 0..60_u32 {
            let points = points(&mut random, 2 + number as usize % 9);
            let limits = limits(&mut random);
            let motion = Waypoints::try_new(&points, joined, limits).expect("proper points");
            let largest = rates(&motion, 20_000);
            for (index, (largest, limit)) in
                largest.iter().zip([limits.speed, limits.acceleration, limits.jerk]).enumerate()
            {
                let part = largest / limit;
                assert!(
                    part <= 1.0 + 1e-6,
                    "{joined:?} {number}: derivative {} at {part} of its limit",
                    index + 1
                );
                used[index] = used[index].max(part);
            }
            let best = used.iter().copied().fold(0.0, f64::max);
            assert!(best > 0.0, "{joined:?} {number} moves");
        }
        for (name, used) in ["speed", "acceleration", "jerk"].iter().zip(used) {
            measured(&format!("{joined:?}: largest part used of the {name}"), used);
            assert!(used > 0.9, "{joined:?}: the limit of {name} is never used, at most {used}");
        }
    }
}

#[test]
fn velocity_and_acceleration_are_derivatives() {
    let mut random = Random::seeded(43);
    for joined in [Joined::Spline, Joined::Lines] {
        let points = points(&mut random, 6);
        let limits = Limits { speed: 1.0, acceleration: 1.0, jerk: 2.0 };
        let motion = Waypoints::try_new(&points, joined, limits).expect("proper points");
        let h = 1e-4;
        for i in 1..5000_u32 {
            let t = motion.duration() * f64::from(i) / 5000.0;
            let [before, at, after] = [t - h, t, t + h].map(|t| motion.at(t));
            // Central differences: h^2/6 of the third derivative where it is smooth, h/2 of the jump of the jerk at a knot, and
            // rounding of metres over h.
            let off = ((after.position - before.position) / (2.0 * h) - at.velocity).norm();
            assert!(off < 2.0 * h * h + 1e-10, "{joined:?}: velocity off by {off:e} at {t} s");
            let off = ((after.velocity - before.velocity) / (2.0 * h) - at.acceleration).norm();
            assert!(off < 2.0 * h + 1e-10, "{joined:?}: acceleration off by {off:e} at {t} s");
        }
    }
}

#[test]
fn it_rests_at_the_first_and_the_last_point() {
    let mut random = Random::seeded(44);
    for joined in [Joined::Spline, Joined::Lines] {
        let points = points(&mut random, 5);
        let motion = Waypoints::try_new(&points, joined, limits(&mut random)).expect("proper points");
        let end = motion.duration();
        for (t, point) in [(-1.0, points[0]), (0.0, points[0]), (end, points[4]), (end + 100.0, points[4])] {
            let at = motion.at(t);
            assert!((at.position - point).norm() < 1e-13, "{joined:?}: at its end point at {t} s");
            let moving = at.velocity.norm() + at.acceleration.norm();
            assert!(moving < 1e-12, "{joined:?}: rests at {t} s, found {moving:e}");
        }
        let ahead = motion.departure();
        let soon = motion.at(0.01 * end).position - points[0];
        assert!(ahead.dot(&soon) > 0.99 * ahead.norm() * soon.norm(), "{joined:?} sets out the way it says");
    }
}

#[test]
fn lines_stop_at_every_point_and_use_every_limit() {
    let limits = Limits { speed: 0.5, acceleration: 1.0, jerk: 4.0 };
    let points = [[0.0, 0.0, 0.5], [3.0, 0.0, 0.5], [3.0, 4.0, 0.5], [3.0, 4.0, 1.0]].map(Vector3::from);
    let motion = Waypoints::try_new(&points, Joined::Lines, limits).expect("proper points");
    // By hand: each leg takes length/v plus v/a + a/j = 0.75 s; 0.5 m suffices for the full speed.
    let legs = [6.75, 8.75, 1.75];
    assert!((motion.duration() - 17.25).abs() < 1e-12, "{} s", motion.duration());
    let mut t = 0.0;
    for (number, leg) in legs.iter().enumerate() {
        t += leg;
        let at = motion.at(t);
        assert!((at.position - points[number + 1]).norm() < 1e-12, "at point {} at {t} s", number + 1);
        assert!(at.velocity.norm() < 1e-12, "stops at point {}", number + 1);
    }
    for (part, limit) in rates(&motion, 20_000).iter().zip([0.5, 1.0, 4.0]) {
        assert!((part / limit - 1.0).abs() < 1e-6, "uses {part} of {limit}");
    }
    // A spline through two points is the same line.
    let line = Waypoints::try_new(&points[..2], Joined::Spline, limits).expect("proper points");
    assert!((line.duration() - 6.75).abs() < 1e-12, "the spline takes {} s", line.duration());
    for i in 0..100_u32 {
        let t = f64::from(i) * 0.0675;
        let off = (line.at(t).position - motion.at(t).position).norm();
        assert!(off < 1e-14, "off the line by {off:e} m at {t} s");
    }
}

/// Points that come closer on a smooth curve cost no more time: the speed is not lost to the way that the curve is described.
#[test]
fn many_points_of_a_helix_are_passed_about_as_fast_as_a_straight_line_of_its_length() {
    let limits = Limits { speed: 0.5, acceleration: 0.5, jerk: 1.0 };
    // Angle 6 rad, radius 1 m, rising by 0.1 m a rad; at full speed it takes half of the acceleration across the path.
    let least = SCurve::new(6.0 * libm::sqrt(1.01), limits).duration();
    for count in [8, 16, 64, 256] {
        let angle = |i: u32| f64::from(i) / f64::from(count) * 6.0;
        let point = |a: f64| Vector3::new(libm::cos(a), libm::sin(a), 0.5 + 0.1 * a);
        let points: Vec<_> = (0..=count).map(angle).map(point).collect();
        let motion = Waypoints::try_new(&points, Joined::Spline, limits).expect("proper points");
        let part = motion.duration() / least;
        measured(&format!("{count} points: time over that of the straight line"), part);
        assert!((1.0..1.13).contains(&part), "{count} points take {part} of the time of the straight line");
    }
}
