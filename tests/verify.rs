//! The verification motions of section 3.7 are the ones that geometry gives.
//!
//! Laws: a base at constant speed v drives straight, with a constant yaw rate w on a circle of radius |v/w| about the point
//! v/w to its left, so that w > 0 turns counter-clockwise either way; joints ramp; the tip is where the closed form of the
//! kinematics puts it.
//! Why: the velocities are imposed, so that only kinematics and their integration are at work.
//! Reference: base motion and tip written out here for the thesis's robot (arm offset 0.06 m, links of 0.5 m).
//! Tolerance: 1e-9 m after up to 10^4 steps: Runge-Kutta at 1 ms leaves 1e-13 of the circle, the sum of 10^4 steps 1e-12.

use mm_sim::scenario::Loaded;
use mm_sim::simulation::Ending;
use mm_sim::summary;
use mm_tests::{Tick, build, load, measured, recorded, run};
use nalgebra::Vector3;

const TOLERANCE: f64 = 1e-9;
const ARM_OFFSET: f64 = 0.06;
const LINK: f64 = 0.5;

/// What a motion should be at a time: x, y, heading, joints.
type Motion = fn(f64) -> ([f64; 3], [f64; 3]);

const REST: [f64; 3] = [0.0, core::f64::consts::FRAC_PI_3, -2.0 * core::f64::consts::FRAC_PI_3];

fn straight(t: f64) -> ([f64; 3], [f64; 3]) {
    ([0.1 * t, 0.0, 0.0], REST)
}

/// About (0, 0.5), counter-clockwise from (0, 0).
fn circle(t: f64) -> ([f64; 3], [f64; 3]) {
    ([0.5 * libm::sin(t), 0.5 - 0.5 * libm::cos(t), t], REST)
}

/// About (0, -0.5): the heading still turns counter-clockwise, the base runs backwards.
fn reverse_circle(t: f64) -> ([f64; 3], [f64; 3]) {
    ([-0.5 * libm::sin(t), -0.5 + 0.5 * libm::cos(t), t], REST)
}

fn joint2(t: f64) -> ([f64; 3], [f64; 3]) {
    ([0.0; 3], [0.0, REST[1] + 0.15 * t, REST[2]])
}

fn joints23(t: f64) -> ([f64; 3], [f64; 3]) {
    ([0.0; 3], [0.0, REST[1] + 0.15 * t, REST[2] + 0.15 * t])
}

fn moving_base(t: f64) -> ([f64; 3], [f64; 3]) {
    ([-0.5 * t, 0.0, 0.0], [core::f64::consts::FRAC_PI_2 * t, REST[1], REST[2]])
}

/// The tip of the thesis's robot.
fn tip([x, y, heading]: [f64; 3], [q1, q2, q3]: [f64; 3]) -> Vector3<f64> {
    let reach = LINK * libm::cos(q2) + LINK * libm::cos(q2 + q3);
    Vector3::new(
        x + ARM_OFFSET * libm::cos(heading) + reach * libm::cos(heading + q1),
        y + ARM_OFFSET * libm::sin(heading) + reach * libm::sin(heading + q1),
        LINK + LINK * libm::sin(q2) + LINK * libm::sin(q2 + q3),
    )
}

/// Runs a scenario with every tick recorded and holds it against the motion; gives the ticks.
fn check(name: &str, motion: Motion) -> Vec<Tick> {
    let loaded: Loaded = load(name, &[]);
    let result = run(&build(&loaded));
    assert_eq!(result.ending, Ending::Finished, "{name} has to reach its end");
    let missed = summary::missed(&loaded.file.expect, &result.metrics);
    assert!(missed.is_empty(), "{name} misses {missed:?}");
    assert!(loaded.file.expect.max_error_m.is_some(), "{name} bounds the error");

    let (ticks, again) = recorded(&build(&load(name, &["simulation.log_rate_hz=1000"])));
    assert_eq!(again.digest, result.digest, "{name}: the log rate changes nothing");
    let mut worst: f64 = 0.0;
    for tick in &ticks {
        let (base, joints) = motion(tick.t);
        let q = &tick.state.q;
        let mut off = (tick.tip - tip(base, joints)).norm();
        for (got, wanted) in [q.x, q.y, q.heading].iter().zip(base).chain(q.joints.iter().zip(joints)) {
            off = off.max((got - wanted).abs());
        }
        worst = worst.max(off).max((tick.desired - tip(base, joints)).norm());
        assert!(off <= TOLERANCE, "{name} at {} s: off by {off:e}", tick.t);
    }
    measured(&format!("{name}: farthest from the closed form"), worst);
    assert!(worst <= TOLERANCE, "{name}: the analytic motion is off by {worst:e}");
    ticks
}

#[test]
fn the_tip_starts_where_the_table_says() {
    let off = (tip([0.0; 3], REST) - Vector3::new(0.56, 0.0, 0.5)).norm();
    assert!(
        off < 1e-15,
        "the closed form puts the tip of the rest posture at (0.56, 0, 0.5), off by {off:e}"
    );
}

#[test]
fn straight_line() {
    let ticks = check("verify-straight", straight);
    let sideways = ticks.iter().map(|tick| tick.state.q.y.abs()).fold(0.0, f64::max);
    assert!(sideways < 1e-300, "y stays zero to the bit, found {sideways:e}");
}

#[test]
fn circles_have_radius_speed_over_yaw_rate_and_turn_counter_clockwise() {
    for (name, motion, center) in
        [("verify-circle", circle as Motion, 0.5), ("verify-reverse-circle", reverse_circle as Motion, -0.5)]
    {
        let ticks = check(name, motion);
        for tick in &ticks {
            let q = &tick.state.q;
            let radius = (q.x * q.x + (q.y - center) * (q.y - center)).sqrt();
            assert!((radius - 0.5).abs() <= 1e-12, "{name}: radius {radius} at {} s", tick.t);
        }
        // Area to the left of the path: positive counter-clockwise, pi r^2 once round.
        let area: f64 = ticks
            .windows(2)
            .map(|pair| {
                let (a, b) = (&pair[0].state.q, &pair[1].state.q);
                0.5 * (a.x * (b.y - center) - (a.y - center) * b.x)
            })
            .sum();
        assert!((area - 0.25 * core::f64::consts::PI).abs() < 1e-3, "{name}: the path encloses {area} m^2");
        let last = ticks.last().expect("a run has ticks");
        assert!((last.state.q.heading - 6.282).abs() < 1e-9, "{name}: one whole turn of the heading");
    }
}

#[test]
fn joint_ramps() {
    let ticks = check("verify-joint2", joint2);
    // The elbow is held: the tip keeps its distance of 0.5 m (an equilateral triangle) from the shoulder.
    for tick in &ticks {
        let from_shoulder = (tick.tip - Vector3::new(ARM_OFFSET, 0.0, LINK)).norm();
        assert!((from_shoulder - 0.5).abs() <= 1e-12, "{from_shoulder} m from the shoulder at {} s", tick.t);
    }
    let _ = check("verify-joints23", joints23);
}

#[test]
fn the_tip_swings_through_a_semicircle_over_a_moving_base() {
    let ticks = check("verify-moving-base", moving_base);
    for tick in &ticks {
        let on_base = tick.tip - Vector3::new(tick.state.q.x + ARM_OFFSET, tick.state.q.y, 0.0);
        let reach = (on_base.x * on_base.x + on_base.y * on_base.y).sqrt();
        assert!((reach - 0.5).abs() <= 1e-12, "the tip is {reach} m from the arm's axis at {} s", tick.t);
        assert!(on_base.y >= -1e-12, "the arm swings to the left, counter-clockwise, at {} s", tick.t);
        assert!((on_base.z - 0.5).abs() <= 1e-12, "the tip keeps its height at {} s", tick.t);
    }
    let last = ticks.last().expect("a run has ticks");
    let ahead = last.tip.x - last.state.q.x;
    assert!((ahead - (ARM_OFFSET - 0.5)).abs() < 1e-5, "after half a turn the tip is behind, at {ahead} m");
}
