//! References of the tip: position, velocity and acceleration belong together, and the curves are those of the thesis.
//!
//! Laws: velocity and acceleration are the derivatives of position; the square is that of Appendix B with its rounded constants,
//! whose small jumps are known; a start ramp begins at rest and ends on the path with its velocity and acceleration; a stop is
//! the same backwards.
//! Why: the controller feeds velocity and acceleration forward, so that a slip in them is a tracking error.
//! References: Richardson's extrapolation of central differences of position; curve points worked out by hand.
//! Tolerances: 1e-10 for differences over 20 ms, whose truncation is h^4/480 of a fifth derivative below 0.1 and whose rounding
//! is eps times 20 m over h; 1e-8 on a ramp, whose derivatives are up to a hundred times larger; a few eps for points by hand.

use mm_control::Reference;
use mm_sim::trajectory::{Path, Stop, Trajectory};
use mm_tests::measured;
use nalgebra::Vector3;

/// Speed on the square, m/s.
const RATE: f64 = 0.31416;

/// Times at which the square changes between straight and arc: straights of 2 m, arcs of 5 s, as printed.
const JOINTS: [f64; 16] = [
    6.36618, 11.36618, 17.73236, 22.73236, 29.09855, 34.09855, 40.46447, 45.46447, 51.83065, 56.83065,
    63.19683, 68.19683, 74.56301, 79.56301, 85.92919, 90.92919,
];

/// Window of the smooth square, s.
const WINDOW: f64 = 0.8;

/// Every kind of path without a file of tests of its own.
fn paths() -> [(&'static str, Path); 8] {
    [
        ("square", Path::Square),
        ("smooth square", Path::SmoothSquare { window: WINDOW }),
        ("sinusoid", Path::Sinusoid),
        ("spiral", Path::Spiral),
        ("step", Path::Step { from: Vector3::new(0.5, 0.0, 0.5), by: Vector3::new(0.2, 0.1, 0.1), at: 7.0 }),
        ("line", Path::Line { from: Vector3::new(0.4, 0.1, 0.5), velocity: Vector3::new(0.2, -0.1, 0.003) }),
        (
            "circle",
            Path::Circle { center: Vector3::new(0.3, -0.4, 0.6), radius: 0.8, rate: -0.5, start: 0.7 },
        ),
        ("hold", Path::Hold(Vector3::new(0.6, 0.1, 0.4))),
    ]
}

/// Times at which a path is not smooth.
fn joints_of(path: &Path) -> Vec<f64> {
    match path {
        Path::Square => JOINTS.to_vec(),
        // The third derivative jumps at either end of each blend.
        Path::SmoothSquare { window } => {
            JOINTS.iter().flat_map(|t| [t - 0.5 * window, t + 0.5 * window]).collect()
        }
        Path::Step { at, .. } => vec![*at],
        _ => Vec::new(),
    }
}

/// Derivative by central differences over h and h/2, extrapolated.
fn derivative(f: impl Fn(f64) -> Vector3<f64>, t: f64, h: f64) -> Vector3<f64> {
    let central = |h: f64| (f(t + h) - f(t - h)) / (2.0 * h);
    (central(0.5 * h) * 4.0 - central(h)) / 3.0
}

fn differ(a: &Reference<f64>, b: &Reference<f64>) -> [f64; 3] {
    [a.position - b.position, a.velocity - b.velocity, a.acceleration - b.acceleration].map(|d| d.norm())
}

#[test]
fn velocity_and_acceleration_are_derivatives() {
    let h = 0.02;
    for (name, path) in paths() {
        for start_ramp in [0.0, 3.0] {
            // With a start ramp the motion also stops, from 90 to 94 s.
            let stop = (start_ramp > 0.0).then_some(Stop { at: 94.0, ramp: 4.0 });
            let trajectory = Trajectory { path: path.clone(), start_ramp, stop };
            // On the path's own clock a ramp of T delays the joints by T/2; its own end is a joint of the third derivative.
            let mut joints: Vec<f64> = joints_of(&path).iter().map(|t| t + 0.5 * start_ramp).collect();
            joints.extend([0.0, start_ramp, 90.0, 94.0]);
            let (mut worst_velocity, mut worst_acceleration) = (0.0_f64, 0.0_f64);
            for i in 1..1940_u32 {
                let t = f64::from(i) * 0.0501;
                if joints.iter().any(|joint| (t - joint).abs() < 2.0 * h) {
                    continue;
                }
                let at = trajectory.at(t);
                let velocity = derivative(|t| trajectory.at(t).position, t, h);
                let acceleration = derivative(|t| trajectory.at(t).velocity, t, h);
                worst_velocity = worst_velocity.max((velocity - at.velocity).norm());
                worst_acceleration = worst_acceleration.max((acceleration - at.acceleration).norm());
            }
            measured(&format!("{name}, ramp {start_ramp}: velocity off by"), worst_velocity);
            measured(&format!("{name}, ramp {start_ramp}: acceleration off by"), worst_acceleration);
            let tolerance = if start_ramp > 0.0 { 1e-8 } else { 1e-10 };
            assert!(
                worst_velocity <= tolerance,
                "{name}, ramp {start_ramp}: velocity off by {worst_velocity:e}"
            );
            assert!(
                worst_acceleration <= tolerance,
                "{name}, ramp {start_ramp}: acceleration off by {worst_acceleration:e}"
            );
        }
    }
}

#[test]
fn the_square_jumps_as_printed_and_no_more() {
    let mut largest = (0.0_f64, 0.0);
    for (number, &joint) in JOINTS.iter().enumerate() {
        let (before, after) = (Path::Square.at(joint), Path::Square.at(joint.next_up()));
        let [position, velocity, acceleration] = differ(&before, &after);
        if position > largest.0 {
            largest = (position, joint);
        }
        // The arcs turn by 5 * 0.31416 = pi/2 + 3.7e-6 rad.
        assert!(velocity <= 2e-6, "the velocity jumps by {velocity:e} m/s at {joint} s");
        let centripetal = RATE * RATE;
        let off = (acceleration - centripetal).abs();
        assert!(off <= 1e-12, "joint {number} at {joint} s: the acceleration jumps by {acceleration} m/s^2");
        // A joint moved to any other time would leave the jump of the path at that time.
        let inside = Path::Square.at(joint - 1e-6);
        assert!((inside.position - before.position).norm() < 4e-7, "the joint is not before {joint} s");
    }
    measured("largest jump of position, m", largest.0);
    measured("at, s", largest.1);
    assert!(largest.0 <= 8.3e-5, "the position jumps by {:e} m at {} s", largest.0, largest.1);
    assert!(largest.0 >= 8.0e-5, "the printed constants leave a jump of 8.2e-5 m, found {:e}", largest.0);
    assert!((largest.1 - 40.46447).abs() < 1e-9, "the largest jump is at 40.46447 s, not at {}", largest.1);
    assert!((RATE * RATE - 0.0987).abs() < 5e-5, "the acceleration's jump rounds to 0.0987 m/s^2");
}

#[test]
fn the_square_runs_from_the_origin_through_four_hills_at_constant_speed() {
    for i in 0..=9800_u32 {
        let t = f64::from(i) * 0.01;
        let at = Path::Square.at(t);
        assert!((at.velocity.norm() - RATE).abs() < 1e-15, "speed {} at {t} s", at.velocity.norm());
        assert!((at.position.z - 0.5).abs() < 1e-15 && at.velocity.z.abs() < 1e-15, "height at {t} s");
        let forwards = at.velocity.x >= -2e-6;
        assert!(forwards, "the square never turns back: {} m/s at {t} s", at.velocity.x);
    }
    // By hand: (x, y) at the start, the two tops and bottoms, and the end. An arc of 5 s leaves 2e-6 m.
    let points = [
        (0.0, 0.0, 0.0),
        (6.36618, 0.0, 2.0),
        (11.36618, 1.0, 3.0),
        (17.73236, 3.0, 3.0),
        (22.73236, 4.0, 2.0),
        (29.09855, 4.0, 0.0),
        (34.09855, 5.0, -1.0),
        (45.46447, 8.0, 0.0),
        (56.83065, 9.0, 3.0),
        (68.19683, 12.0, 2.0),
        (79.56301, 13.0, -1.0),
        (90.92919, 16.0, 0.0),
        (98.0, 16.0, 98.0 * RATE - 28.56631),
    ];
    for (t, x, y) in points {
        let off = (Path::Square.at(t).position - Vector3::new(x, y, 0.5)).norm();
        assert!(off < 1e-4, "at {t} s the square is {off:e} m from ({x}, {y})");
    }
}

#[test]
fn a_ramp_starts_at_rest_and_joins_smoothly() {
    let ramp = 2.5;
    for (name, path) in paths() {
        let trajectory = Trajectory { path: path.clone(), start_ramp: ramp, stop: None };
        let (start, on_path) = (trajectory.at(0.0), path.at(0.0));
        assert_eq!(start.position, on_path.position, "{name}: the ramp starts where the path does");
        let still = start.velocity.norm() + start.acceleration.norm();
        assert!(still < 1e-300, "{name}: the ramp starts at rest, without acceleration, not at {still:e}");
        let jump = differ(&trajectory.at(ramp.next_down()), &trajectory.at(ramp));
        assert!(jump.iter().all(|jump| *jump < 1e-13), "{name}: jumps {jump:?} at the end of the ramp");
        // After it the path runs half the ramp behind.
        for t in [ramp, 4.0, 20.0] {
            assert_eq!(trajectory.at(t), path.at(t - 0.5 * ramp), "{name}: behind by half the ramp at {t} s");
        }
        // Half way up, at u = 1/2: own time T (1/8 - 1/32) and half the rate.
        let half = trajectory.at(0.5 * ramp);
        let own = path.at(ramp * (0.125 - 0.031_25));
        assert!((half.position - own.position).norm() < 1e-15, "{name}: position half way up");
        assert!((half.velocity - own.velocity * 0.5).norm() < 1e-15, "{name}: half the speed half way up");
    }
}

#[test]
fn a_stop_is_a_start_run_backwards() {
    let (start_ramp, stop) = (2.0, Stop { at: 30.0, ramp: 5.0 });
    for (name, path) in paths() {
        let trajectory = Trajectory { path: path.clone(), start_ramp, stop: Some(stop) };
        let before = 30.0 - 5.0;
        let free = Trajectory { path: path.clone(), start_ramp, stop: None };
        for t in [0.5, 2.0, 10.0, before] {
            assert_eq!(trajectory.at(t), free.at(t), "{name}: nothing of the stop shows at {t} s");
        }
        let jump = differ(&trajectory.at(before), &trajectory.at(before.next_up()));
        assert!(jump.iter().all(|jump| *jump < 1e-13), "{name}: jumps {jump:?} where it begins to stop");
        // Half way down, at u = 1/2: 5 (1/8 - 1/32) s of own time are left of all 30 - 1 - 2.5 s.
        let half = trajectory.at(27.5);
        let own = path.at(26.5 - 5.0 * (0.125 - 0.031_25));
        assert!((half.position - own.position).norm() < 1e-14, "{name}: position half way down");
        assert!((half.velocity - own.velocity * 0.5).norm() < 1e-15, "{name}: half the speed half way down");
        for t in [30.0, 30.1, 1e6] {
            let rest = trajectory.at(t);
            assert_eq!(rest.position, path.at(26.5).position, "{name}: rests at {t} s");
            let still = rest.velocity.norm() + rest.acceleration.norm();
            assert!(still < 1e-300, "{name}: moves by {still:e} at {t} s");
        }
        let jump = differ(&trajectory.at(30.0_f64.next_down()), &trajectory.at(30.0));
        assert!(jump.iter().all(|jump| *jump < 1e-13), "{name}: jumps {jump:?} where it comes to rest");
    }
}

#[test]
fn sinusoid_and_spiral_at_points_worked_out_by_hand() {
    let pi = core::f64::consts::PI;
    // 0.4 t = pi/2.
    let top = Path::Sinusoid.at(1.25 * pi);
    let off = [
        (top.position - Vector3::new(0.5 + 0.25 * pi, 0.3, 0.6)).norm(),
        (top.velocity - Vector3::new(0.2, 0.0, 0.0)).norm(),
        (top.acceleration - Vector3::new(0.0, -0.048, -0.016)).norm(),
    ];
    assert!(off.iter().all(|off| *off < 1e-15), "the crest of the sinusoid is off by {off:?}");
    let start = Path::Sinusoid.at(0.0);
    let off = (start.velocity - Vector3::new(0.2, 0.12, 0.04)).norm()
        + (start.position - Vector3::new(0.5, 0.0, 0.5)).norm();
    assert!(off < 1e-15, "the sinusoid starts off by {off:e}");
    // The heading it starts with: atan(0.12/0.2) = 30.96 degrees.
    let heading = libm::atan2(start.velocity.y, start.velocity.x).to_degrees();
    assert!((heading - 30.96).abs() < 0.005, "the sinusoid sets out at {heading} degrees");
    // 0.25 t = pi/2: x = 0.1 t, y = 0, dx = 0.1, dy = -0.025 t; d2x = -t/160, d2y = -0.05.
    let t = 2.0 * pi;
    let side = Path::Spiral.at(t);
    let off = [
        (side.position - Vector3::new(0.1 * t, 0.0, 0.3 + 0.008 * t)).norm(),
        (side.velocity - Vector3::new(0.1, -0.025 * t, 0.008)).norm(),
        (side.acceleration - Vector3::new(-t / 160.0, -0.05, 0.0)).norm(),
    ];
    assert!(off.iter().all(|off| *off < 1e-15), "the spiral a quarter turn on is off by {off:?}");
    let start = Path::Spiral.at(0.0);
    let off = (start.velocity - Vector3::new(0.0, 0.1, 0.008)).norm()
        + (start.position - Vector3::new(0.0, 0.0, 0.3)).norm();
    assert!(off < 1e-15, "the spiral starts off by {off:e}");
}

#[test]
fn a_step_jumps_at_its_time_and_a_circle_turns_the_right_way() {
    let from = Vector3::new(0.56, 0.0, 0.5);
    let by = Vector3::new(0.2, 0.1, 0.1);
    let step = Path::Step { from, by, at: 1.0 };
    assert_eq!(step.at(1.0_f64.next_down()).position, from, "before the step");
    assert_eq!(step.at(1.0).position, from + by, "at the step's time the new point holds");
    let circle = Path::Circle { center: Vector3::zeros(), radius: 2.0, rate: 0.5, start: 0.0 };
    let quarter = circle.at(core::f64::consts::PI);
    let off = (quarter.position - Vector3::new(0.0, 2.0, 0.0)).norm()
        + (quarter.velocity - Vector3::new(-1.0, 0.0, 0.0)).norm()
        + (quarter.acceleration - Vector3::new(0.0, -0.5, 0.0)).norm();
    assert!(off < 1e-14, "a quarter of a counter-clockwise circle is off by {off:e}");
}
