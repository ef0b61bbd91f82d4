//! The loop stays within bounds where the reference asks for what the robot cannot do, says so, and recovers.
//!
//! Laws: with a tip far away, above or below reach, over the shoulder axis, or a start outside a joint limit, (1) no velocity exceeds
//! a stated bound, (2) no joint leaves its limits by more than the inner loop's error, (3) no torque exceeds its limit, (4) the
//! status names what was limited, (5) once the reference is back within reach the tip is within 1 cm of it after a stated time.
//! Why: the outer loop limits the speed of the correction and the joint rates that it asks for, and damps; nothing winds up meanwhile.
//!
//! Reference: none but the bounds. Plant: the robot of the thesis, RK4 at the control period of 1 ms.
//!
//! Tolerance: the bounds are 1.2 to 2 times what was measured, which the tests print.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its loop has failed the test")]

use crate::common::plant::Plant;
use mm_control::{ControlStack, Gains, Input, LawKind, OuterParams, Reference, StackParams};
use mm_model::{Configuration, Force, Real, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

const PERIOD: f64 = 1e-3;
const LAWS: [LawKind; 3] = [LawKind::Bsmc, LawKind::BsmcSat, LawKind::Bfsmc];

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn at(joints: [f64; 3]) -> Configuration<f64, 3> {
    Configuration { joints, ..Configuration::zero() }
}

/// Away from the first point over `ramp` seconds from t = 1 s on, and back from t = 6 s on; at once with a ramp of 0.
fn excursion(from: Vector3<f64>, by: Vector3<f64>, ramp: f64, t: f64) -> Reference<f64> {
    let step = |since: f64| {
        if ramp <= 0.0 || since >= ramp || since <= 0.0 {
            return (if since > 0.0 { 1.0 } else { 0.0 }, 0.0, 0.0);
        }
        let u = since / ramp;
        let rise = u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
        let speed = 30.0 * u * u * (1.0 - u) * (1.0 - u) / ramp;
        (rise, speed, 60.0 * u * (1.0 - u) * (1.0 - 2.0 * u) / (ramp * ramp))
    };
    let (out, back) = (step(t - 1.0), step(t - 6.0));
    Reference {
        position: from + by * (out.0 - back.0),
        velocity: by * (out.1 - back.1),
        acceleration: by * (out.2 - back.2),
    }
}

/// What a run came to.
#[derive(Debug, Default)]
struct Extremes {
    forward: f64,
    yaw_rate: f64,
    joint_rate: f64,
    /// Farthest outside a joint limit, rad; negative within.
    beyond: f64,
    /// Whether the status named a joint beyond its limit at the first update.
    began_beyond: bool,
    /// Last time at which a joint was beyond its limits by more than 1e-3 rad, s.
    last_beyond: f64,
    saturated: u32,
    near_singular: u32,
    speed_limited: u32,
    joint_limited: u32,
    /// Last time at which the tip was more than 1 cm off, s.
    settled: f64,
    /// Error at the end, m.
    last: f64,
}

fn run(kind: LawKind, start: Configuration<f64, 3>, reference: impl Fn(f64) -> Reference<f64>) -> Extremes {
    let robot = thesis();
    let gains = Gains::for_robot(&robot, kind, PERIOD);
    let params = StackParams {
        period: PERIOD,
        outer: OuterParams::for_robot(&robot),
        gains,
        estimator: mm_control::Estimator::None,
    };
    let stack = ControlStack::try_new(robot, kind, params).unwrap();
    let mut state = stack.initial_state();
    let mut plant = Plant { robot, q: start, nu: Velocity::zero(), time: 0.0 };
    let limits = &robot.params().limits;
    let mut seen = Extremes { beyond: f64::NEG_INFINITY, ..Extremes::default() };
    for tick in 0..12_000 {
        let reference = reference(plant.time);
        let out = stack.update(&mut state, &Input { q: plant.q, nu: plant.nu, reference }).unwrap();
        let torque = &out.torque;
        assert!(
            torque.right.abs() <= limits.wheel_torque && torque.left.abs() <= limits.wheel_torque,
            "tick {tick}: {torque:?}"
        );
        for (torque, limit) in torque.joints.iter().zip(limits.joint_torque) {
            assert!(torque.abs() <= limit, "tick {tick}: {torque} above {limit}");
        }
        seen.forward = seen.forward.max(plant.nu.forward.abs());
        seen.yaw_rate = seen.yaw_rate.max(plant.nu.yaw_rate.abs());
        for rate in plant.nu.joints {
            seen.joint_rate = seen.joint_rate.max(rate.abs());
        }
        for (q, (lo, hi)) in plant.q.joints.iter().zip(limits.joints) {
            seen.beyond = seen.beyond.max(q - hi).max(lo - q);
            if (q - hi).max(lo - q) > 1e-3 {
                seen.last_beyond = plant.time;
            }
        }
        seen.began_beyond |= tick == 0 && out.status.beyond_joint_limit;
        seen.saturated += u32::from(out.status.saturated);
        seen.near_singular += u32::from(out.status.near_singular);
        seen.speed_limited += u32::from(out.status.speed_limited);
        seen.joint_limited += u32::from(out.status.joint_limited);
        seen.last = out.signals.error.norm();
        if seen.last > 0.01 {
            seen.settled = plant.time;
        }
        plant.step(&out.torque, |_| Force::zero(), PERIOD);
    }
    seen
}

const REST: [f64; 3] = [0.0, f64::PI / 3.0, -2.0 * f64::PI / 3.0];

/// An excursion of the reference and what it may lead to.
struct Case {
    name: &'static str,
    start: [f64; 3],
    by: [f64; 3],
    ramp: f64,
    /// Time after which the tip stays within 1 cm; the reference is back where it began at 6 s and the ramp.
    settled: f64,
    /// Whether each status has to come up: near singular, speed limited, joint limited.
    said: [bool; 3],
}

impl Case {
    const fn new(name: &'static str, by: [f64; 3], ramp: f64, settled: f64, said: [bool; 3]) -> Self {
        Self { name, start: REST, by, ramp, settled, said }
    }

    /// Runs it with every law, within the bounds that hold for all cases.
    fn check(&self) {
        let [x, y, z] = self.by;
        let from = thesis().tip_position(&at(self.start));
        for kind in LAWS {
            let seen = run(kind, at(self.start), |t| excursion(from, Vector3::new(x, y, z), self.ramp, t));
            let what = format!("{}, {}: {seen:.4?}", self.name, kind.name());
            println!("{what}");
            // The model holds up to 2 m/s, which is what the outer loop asks for at most; the inner loop overshoots by 14 % at a step.
            assert!(seen.forward < 2.4 && seen.yaw_rate < 3.0, "the base is too fast: {what}");
            // 1 m/s over twice the damping of 0.1, and the posture task.
            assert!(seen.joint_rate < 5.5, "a joint is too fast: {what}");
            assert!(seen.beyond < 1e-3, "a joint is beyond its limits: {what}");
            assert!(seen.settled < self.settled && seen.last < 1e-4, "it does not recover: {what}");
            let said = [seen.near_singular > 0, seen.speed_limited > 0, seen.joint_limited > 0];
            assert_eq!(said, self.said, "what the status says of {what}");
        }
    }
}

#[test]
fn a_tip_far_away_is_reached_at_the_speed_of_the_correction() {
    for (name, by) in [("ahead", [4.0, 0.0, 0.0]), ("beside", [0.0, 4.0, 0.0]), ("behind", [-4.0, 0.3, 0.0])]
    {
        // 4 m at 1 m/s.
        Case::new(name, by, 0.0, 10.2, [false, true, false]).check();
    }
    Case::new("half a metre off", [0.3, 0.4, 0.0], 0.0, 6.8, [false, true, false]).check();
}

#[test]
fn a_tip_above_reach_is_waited_for() {
    let said = [true, true, false];
    Case::new("up at once", [0.0, 0.0, 1.2], 0.0, 7.5, said).check();
    Case::new("up in 2 s", [0.0, 0.0, 1.2], 2.0, 7.2, said).check();
    Case::new("up and aside", [0.3, 0.6, 1.2], 0.0, 7.8, said).check();
    Case::new("up and away", [3.0, 1.0, 1.2], 0.0, 9.8, said).check();
}

#[test]
fn a_tip_below_reach_leaves_the_joints_within_their_limits() {
    let said = [true, true, true];
    Case::new("down at once", [0.0, 0.0, -1.2], 0.0, 7.2, said).check();
    Case::new("down in 2 s", [0.0, 0.0, -1.2], 2.0, 7.6, said).check();
    Case::new("down and aside", [-0.3, 0.6, -1.2], 0.0, 7.5, said).check();
}

#[test]
fn a_path_through_the_singularity_is_followed_again() {
    // The arm stretched straight up reaches 1.5 m; here it is asked for 1.49 m.
    Case::new("to the top", [0.0, 0.0, 0.99], 2.0, 3.5, [true, false, false]).check();
    // Fast over the shoulder, with the first pitch joint at its bound: the base takes over and the tip never leaves its path.
    Case::new("over the shoulder", [-1.0, 0.0, 0.9], 1.0, PERIOD, [true, false, true]).check();
}

#[test]
fn a_joint_that_starts_beyond_its_limit_comes_back() {
    let robot = thesis();
    for joints in [[0.0, 2.0, -2.0], [0.0, 0.9, -2.85], [0.0, -0.4, 0.5]] {
        let from = robot.tip_position(&at(joints));
        for kind in LAWS {
            let seen = run(kind, at(joints), |t| excursion(from, Vector3::new(0.3, 0.3, 0.0), 0.0, t));
            let what = format!("from {joints:?}, {}: {seen:.4?}", kind.name());
            println!("{what}");
            assert!(seen.began_beyond && seen.last_beyond < 0.2, "it stays beyond its limit: {what}");
            assert!(seen.joint_rate < 5.5 && seen.forward < 2.0, "it is too fast: {what}");
            assert!(seen.settled < 6.8 && seen.last < 1e-4, "it does not recover: {what}");
        }
    }
}
