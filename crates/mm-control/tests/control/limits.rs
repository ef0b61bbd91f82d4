//! Anti-windup and the momentum observer, in and out of the torque limits.
//!
//! Laws: (1) while a torque is limited, the integral of nu - nu_c and the learned disturbance stay what they were, so that a
//! long saturation leaves no trace; (2) the observer is a first-order filter, d_hat' = L (d - d_hat), whatever
//! the robot does meanwhile; (3) its projection holds |d_hat_i| <= limit_i and lets go at once when d turns round.
//!
//! Reference: De Luca and Mattone (2003) for the filter, in closed form d (1 - exp(-L t)); a stack that never saturated for (1).
//! Plant: RK4 at the control period.
//!
//! Tolerance: 2 % of d for the filter, L dt/2 = 1 % being the Euler rule of the observer itself; the learned part is held
//! exactly, the torque after it to 1e-9, since the observer moves its momentum along with rounding.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use crate::common::plant::Plant;
use mm_control::{
    ControlStack, ControlState, Estimator, Gains, Input, LawKind, OuterParams, Output, Reference, StackParams,
};
use mm_model::{Configuration, Force, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

type Stack = ControlStack<f64, 3>;
type State = ControlState<f64, 3>;

const PERIOD: f64 = 1e-3;
const BANDWIDTH: f64 = 20.0;

fn thesis() -> Robot<f64, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn stack(kind: LawKind, change: impl Fn(&mut Gains<f64, 3>)) -> Stack {
    let mut gains = Gains::for_robot(&thesis(), kind, PERIOD);
    change(&mut gains);
    let params =
        StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None };
    ControlStack::try_new(thesis(), kind, params).unwrap()
}

fn rest() -> Configuration<f64, 3> {
    Configuration { joints: thesis().params().rest_posture, ..Configuration::zero() }
}

/// Standing still at the rest posture, the tip wanted `offset` away.
fn wanting(offset: Vector3<f64>) -> Input<f64, 3> {
    let reference = Reference {
        position: thesis().tip_position(&rest()) + offset,
        velocity: Vector3::zeros(),
        acceleration: Vector3::zeros(),
    };
    Input { q: rest(), nu: Velocity::zero(), reference }
}

fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

/// The integral of nu - nu_c, from what the signals say of it.
fn integral(stack: &Stack, out: &Output<f64, 3>) -> Velocity<f64, 3> {
    let c = stack.outer().params().sliding_gain;
    out.signals.nu_c.minus(out.signals.nu_r).zip(c, |difference, c| difference / c)
}

#[test]
fn nothing_winds_up_while_a_torque_is_limited() {
    for kind in LawKind::ALL {
        let stack = stack(kind, |_| {});
        let (small, mut far) = (wanting(Vector3::repeat(2e-4)), wanting(Vector3::new(5.0, 3.0, 0.5)));
        // The outer loop corrects no faster than a metre a second; the reference itself may ask for anything.
        far.reference.acceleration = Vector3::repeat(300.0);
        let mut state = stack.initial_state();
        for _ in 0..20 {
            let out = stack.update(&mut state, &small).unwrap();
            assert!(!out.status.saturated, "{}: a small error saturates", kind.name());
            assert_eq!(
                out.torque,
                out.signals.commanded,
                "{}: the torque is not the one asked for",
                kind.name()
            );
        }
        let mut unharmed: State = state;
        let first = stack.update(&mut state, &far).unwrap();
        for tick in 0..1000 {
            let out = stack.update(&mut state, &far).unwrap();
            assert!(out.status.saturated, "{}: a far target does not saturate", kind.name());
            assert_ne!(out.torque, out.signals.commanded, "{}: a cut torque equals its command", kind.name());
            assert_eq!(
                out.signals.learned,
                first.signals.learned,
                "{}, tick {tick}: learning went on",
                kind.name()
            );
            for (a, b) in integral(&stack, &out).channels().zip(integral(&stack, &first).channels()) {
                assert!(near(a, b, 1e-12), "{}, tick {tick}: the integral went from {b} to {a}", kind.name());
            }
        }
        // Back at the small error the torque is what it would have been without the excursion.
        let after = stack.update(&mut state, &small).unwrap();
        let never = stack.update(&mut unharmed, &small).unwrap();
        let size = never.torque.channels().fold(0.0, |most: f64, t| most.max(t.abs()));
        for (a, b) in after.torque.channels().zip(never.torque.channels()) {
            assert!(near(a, b, 1e-9 * size), "{}: {a} after the excursion, {b} without", kind.name());
        }
    }
}

/// What the observer has learned at every period of a loop that holds its tip under an external force.
fn learned(
    stack: &Stack,
    start: Velocity<f64, 3>,
    ticks: u32,
    external: impl Fn(f64) -> Force<f64, 3>,
) -> Vec<Force<f64, 3>> {
    let mut plant = Plant { robot: thesis(), q: rest(), nu: start, time: 0.0 };
    let mut state = stack.initial_state();
    let input = wanting(Vector3::zeros());
    (0..ticks)
        .map(|_| {
            let out = stack.update(&mut state, &Input { q: plant.q, nu: plant.nu, ..input }).unwrap();
            assert!(!out.status.saturated, "the disturbance is too much for the torque limits");
            plant.step(&out.torque, &external, PERIOD);
            out.signals.learned
        })
        .collect()
}

#[test]
fn a_constant_disturbance_is_learned_with_the_bandwidth() {
    let stack = stack(LawKind::Bfsmc, |gains| gains.observer_bandwidth = BANDWIDTH);
    let d = Force { forward: 60.0, yaw: -4.0, joints: [6.0, -8.0, 5.0] };
    let moving = Velocity { forward: 0.05, yaw_rate: -0.05, joints: [0.1, 0.1, -0.1] };
    for start in [Velocity::zero(), moving] {
        let all = learned(&stack, start, 500, |_| d);
        let mut decay = 1.0;
        for (tick, now) in all.iter().enumerate() {
            for (got, d) in now.channels().zip(d.channels()) {
                let expected = d * (1.0 - decay);
                assert!(near(got, expected, 0.02 * d.abs()), "tick {tick}: {got} instead of {expected}");
            }
            decay *= 1.0 - BANDWIDTH * PERIOD + 0.5 * (BANDWIDTH * PERIOD).powi(2);
        }
        let last = all[499];
        for (got, d) in last.channels().zip(d.channels()) {
            assert!(near(got, d, 1e-3 * d.abs()), "{got} after ten time constants, not {d}");
        }
    }
}

#[test]
fn of_the_switching_laws_only_bfsmc_learns_and_only_with_a_bandwidth() {
    let d = Force { joints: [5.0, 5.0, 5.0], ..Force::zero() };
    for kind in LawKind::SWITCHING {
        let bandwidth = if kind == LawKind::Bfsmc { 0.0 } else { BANDWIDTH };
        let all =
            learned(&stack(kind, |gains| gains.observer_bandwidth = bandwidth), Velocity::zero(), 50, |_| d);
        assert!(all.iter().all(|d| *d == Force::zero()), "{} learns", kind.name());
    }
}

#[test]
fn the_projection_holds_and_lets_go() {
    const LIMIT: f64 = 2.0;
    let stack = stack(LawKind::Bfsmc, |gains| {
        gains.observer_bandwidth = BANDWIDTH;
        gains.learning_limit = Force::splat(LIMIT);
    });
    // Ten N m for half a second, then as much the other way.
    let external = |t: f64| Force { joints: [if t < 0.5 - 1e-9 { 10.0 } else { -10.0 }; 3], ..Force::zero() };
    let all = learned(&stack, Velocity::zero(), 1000, external);
    for (tick, now) in all.iter().enumerate() {
        assert!(now.channels().all(|d| d.abs() <= LIMIT), "tick {tick}: {now:?} beyond the limit");
    }
    for joint in 0..3 {
        let of = |tick: usize| all[tick].joints[joint];
        assert!((200..=500).all(|tick| near(of(tick), LIMIT, 0.0)), "joint {joint} is not held at the limit");
        // From +2 towards -10 with 1/L = 50 ms: below zero after 50 ln(12/10) = 9.1 ms, at -2 after 50 ln(12/8) = 20.3 ms.
        let crossing = (501..1000).find(|&tick| of(tick) < 0.0).unwrap();
        let arrival = (501..1000).find(|&tick| of(tick) <= -LIMIT).unwrap();
        assert!((509..=511).contains(&crossing), "joint {joint} turns round at {crossing}: it was wound up");
        assert!((519..=522).contains(&arrival), "joint {joint} arrives at {arrival}");
        assert!((600..1000).all(|tick| near(of(tick), -LIMIT, 0.0)), "joint {joint} is not held below");
    }
}
