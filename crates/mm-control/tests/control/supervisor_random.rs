//! The supervisor under anything: random robots, random faults, both scalars.
//!
//! Laws: (1) whatever numbers come in, the torque is finite and within the limits; (2) the modes are those of a model that looks back over
//! the whole history of an update's outcomes instead of counting; (3) a torque is held for at most `hold_periods` updates in a row;
//! (4) the damping of a stop takes power away, the energy with that of its spring never rises, and the robot comes to rest.
//!
//! Reference: the limits; the history; kinetic energy and spring of the robot integrated by RK4.
//!
//! Tolerance: none for torques and modes; 20 % of the energy may be left after 1.5 s, in the spring of an arm whose
//! inertia is far from that at rest; 1e-3 of the first kinetic energy for the energy, since a torque held for 1 ms at a braking rate
//! of 20/s lags by that much.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use crate::common::plant::Plant;
use crate::common::random::Random;
use mm_control::fuzzy::Bundled;
use mm_control::laws::EffectiveInertia;
use mm_control::supervisor::{Findings, Mode};
use mm_control::{
    ControlStack, Estimator, Gains, Input, LawKind, OuterParams, Reference, StackParams, SupervisedStack,
    SupervisorParams, Timing,
};
use mm_model::{Configuration, Force, Mechanism, Real, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

fn supervised<T: Real + Bundled>(robot: Robot<T, 3>, period: T) -> SupervisedStack<T, 3>
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, period);
    let outer = OuterParams::for_robot(&robot);
    let params = StackParams { period, outer, gains, estimator: Estimator::None };
    let stack = ControlStack::try_new(robot, LawKind::Bfsmc, params).unwrap();
    SupervisedStack::try_new(stack, SupervisorParams::for_robot(&robot, period)).unwrap()
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small index")]
/// A number that no sensor should give, or one that it might.
fn strange(draw: &mut Random) -> f64 {
    let all =
        [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, 1e300, -1e30, 1e9, 20.0, -3.0, 1e-300, -0.0, 0.1];
    all[draw.between(0.0, 12.0) as usize]
}

/// Feeds a walk with strange numbers in it; `T` is the scalar of the controller.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small index")]
fn walk<T: Real + Bundled>(seed: u64)
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    let mut draw = Random::seeded(seed);
    let mut params = RobotParams::<T, 3>::thesis().with_mass_scaled(T::from_f64(draw.between(0.3, 3.0)));
    params.wheel_radius = T::from_f64(draw.between(0.03, 0.3));
    params.limits.wheel_torque = T::from_f64(draw.between(5.0, 100.0));
    let robot = Robot::try_new(params).unwrap();
    let stack = supervised(robot, T::from_f64(1e-3));
    let mut state = stack.initial_state();
    let mut numbers = [0.0, 0.0, 0.0, 0.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut held = 0;
    let mut seen = [0_u32; 4];
    for k in 0..4000 {
        for (i, number) in numbers.iter_mut().enumerate() {
            *number += if i < 6 { 1e-4 } else { 1e-2 } * draw.between(-1.0, 1.0);
        }
        let mut now = numbers;
        let mut reference = [0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut timing = [1e-3, 0.0];
        // Bad stretches, of one update to hundreds.
        if draw.between(0.0, 1.0) < 0.1 || (k / 300) % 3 == 2 {
            match draw.between(0.0, 4.0) as usize {
                0 | 1 => now[draw.between(0.0, 11.0) as usize] = strange(&mut draw),
                2 => reference[draw.between(0.0, 9.0) as usize] = strange(&mut draw),
                _ => timing[draw.between(0.0, 2.0) as usize] = strange(&mut draw),
            }
        }
        let n = T::from_f64;
        let [x, y, heading, q1, q2, q3, v, w, d1, d2, d3] = now.map(n);
        let [px, py, pz, vx, vy, vz, ax, ay, az] = reference.map(n);
        let input = Input {
            q: Configuration { x, y, heading, joints: [q1, q2, q3] },
            nu: Velocity { forward: v, yaw_rate: w, joints: [d1, d2, d3] },
            reference: Reference {
                position: Vector3::new(px, py, pz),
                velocity: Vector3::new(vx, vy, vz),
                acceleration: Vector3::new(ax, ay, az),
            },
        };
        let command = if draw.between(0.0, 1.0) < 0.02 {
            stack.missed(&mut state, n(timing[0]))
        } else {
            stack.update(&mut state, Timing { elapsed: n(timing[0]), age: n(timing[1]) }, &input)
        };
        assert!(command.torque.is_finite(), "seed {seed}, update {k}: {command:?}");
        assert!(!robot.limit_torque(&command.torque).1, "seed {seed}, update {k}: {command:?}");
        assert_eq!(command.mode == Mode::Run, command.output.is_some(), "seed {seed}, update {k}");
        held = if command.mode == Mode::Hold { held + 1 } else { 0 };
        assert!(held <= stack.params().hold_periods, "seed {seed}, update {k}: held for {held}");
        seen[command.mode as usize] += 1;
        if command.mode == Mode::Fault {
            assert!(command.brake, "seed {seed}, update {k}: a fault brakes");
            if draw.between(0.0, 1.0) < 0.02 {
                stack.reset(&mut state);
            }
        }
    }
    assert!(seen[0] > 100 && seen[1] > 10 && seen[2] > 10, "seed {seed}: {seen:?} updates a mode");
}

#[test]
fn no_torque_ever_leaves_the_limits() {
    for seed in 0..12 {
        walk::<f64>(seed);
        walk::<f32>(seed);
    }
}

/// What an update brings, as the model of the modes sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Brings {
    Good,
    BadReference,
    BadState,
    Nothing,
}

/// The mode after a history, by looking back over it.
fn mode_of(history: &[Brings]) -> Mode {
    let trailing = |all: &[Brings], is: fn(&Brings) -> bool| all.iter().rev().take_while(|b| is(b)).count();
    let blind: fn(&Brings) -> bool = |b| matches!(b, Brings::BadState | Brings::Nothing);
    // Since when the robot stands: the third bad update in a row begins a stop, ten good ones in a row end it.
    let mut stopped = None;
    for end in 1..=history.len() {
        let upto = &history[..end];
        match stopped {
            None if trailing(upto, |b| *b != Brings::Good) >= 3 => stopped = Some(end),
            Some(since) if trailing(&upto[since..], |b| *b == Brings::Good) >= 10 => stopped = None,
            _ => {}
        }
        if stopped.is_some() && trailing(upto, blind) > 20 {
            return Mode::Fault;
        }
    }
    match (stopped, history.last()) {
        (Some(_), _) => Mode::Stop,
        (None, Some(Brings::Good) | None) => Mode::Run,
        (None, Some(_)) => Mode::Hold,
    }
}

#[test]
fn the_modes_are_those_of_the_history() {
    let robot = Robot::try_new(RobotParams::<f64, 3>::thesis()).unwrap();
    let stack = supervised(robot, 1e-3);
    let limits = SupervisorParams { blind_periods: 20, ..*stack.params() };
    let stack = SupervisedStack::try_new(*stack.stack(), limits).unwrap();
    let rest = Configuration { joints: robot.params().rest_posture, ..Configuration::zero() };
    let zero = Vector3::zeros();
    let good = Input {
        q: rest,
        nu: Velocity::zero(),
        reference: Reference { position: robot.tip_position(&rest), velocity: zero, acceleration: zero },
    };
    let mut visits = [0_u32; 4];
    for seed in 0..40 {
        let mut draw = Random::seeded(seed);
        let (mut state, mut history) = (stack.initial_state(), vec![Brings::Good; 5]);
        for _ in 0..5 {
            stack.update(&mut state, Timing::exact(1e-3), &good);
        }
        let mut now = Brings::Good;
        for k in 0..200 {
            if draw.between(0.0, 1.0) < 0.25 {
                let which = draw.between(0.0, 6.0);
                now = if which < 3.0 {
                    Brings::Good
                } else if which < 4.0 {
                    Brings::BadReference
                } else if which < 5.0 {
                    Brings::BadState
                } else {
                    Brings::Nothing
                };
            }
            let mut input = good;
            match now {
                Brings::BadReference => input.reference.position.z = f64::NAN,
                Brings::BadState => input.nu.forward = f64::INFINITY,
                Brings::Good | Brings::Nothing => {}
            }
            let command = if now == Brings::Nothing {
                stack.missed(&mut state, 1e-3)
            } else {
                stack.update(&mut state, Timing::exact(1e-3), &input)
            };
            history.push(now);
            assert_eq!(command.mode, mode_of(&history), "seed {seed}, update {k}: {history:?}");
            let none = command.findings == Findings::NONE;
            assert_eq!(none, now == Brings::Good, "seed {seed}, update {k}: {now:?}");
            visits[command.mode as usize] += 1;
        }
    }
    assert!(visits.iter().all(|count| *count > 100), "every mode was visited: {visits:?}");
}

#[test]
fn a_stop_takes_energy_away_and_ends_at_rest() {
    for seed in 0..15 {
        let mut draw = Random::seeded(100 + seed);
        let robot = draw.robot();
        let stack = supervised(robot, 1e-3);
        let mut state = stack.initial_state();
        let mut q = draw.configuration();
        q.joints = robot.params().rest_posture;
        for (joint, (lo, hi)) in q.joints.iter_mut().zip(robot.params().limits.joints) {
            *joint = joint.clamp(lo, hi);
        }
        let slow = draw.velocity().scaled(0.3);
        let aim = draw.reference_near(robot.tip_position(&q));
        let mut plant = Plant { robot, q, nu: slow, time: 0.0 };
        let rate = stack.params().braking_rate;
        let EffectiveInertia(inertia) = EffectiveInertia::of(&robot);
        let mut posture = None;
        let (mut last, mut first) = (f64::INFINITY, 0.0);
        let mut rest = false;
        for k in 0..1500 {
            // No reference from the first update on: nothing is learned, the state is seen.
            let nan = Vector3::repeat(f64::NAN);
            let reference = Reference { position: nan, ..aim };
            let input = Input { q: plant.q, nu: plant.nu, reference };
            let command = stack.update(&mut state, Timing::exact(1e-3), &input);
            rest = command.brake;
            if command.mode == Mode::Stop {
                let anchor = *posture.get_or_insert(plant.q.joints);
                let spring: f64 = (0..3)
                    .map(|i| {
                        let away: f64 = plant.q.joints[i] - anchor[i];
                        0.25 * rate * rate * inertia.joints[i] * away * away
                    })
                    .sum();
                let energy = robot.kinetic_energy(&plant.q, &plant.nu) + spring;
                first = Real::max(first, energy);
                assert!(energy <= last + 1e-3 * first, "robot {seed}, update {k}: {energy} J after {last} J");
                last = energy;
                let wheels = robot.wheel_rates(plant.nu.forward, plant.nu.yaw_rate);
                let power = command.torque.right * wheels.right + command.torque.left * wheels.left;
                assert!(power <= 1e-12, "robot {seed}, update {k}: the wheels drive with {power} W");
            }
            plant.step(&command.torque, |_| Force::zero(), 1e-3);
        }
        assert!(rest, "robot {seed} is not at rest: {:?}", plant.nu);
        assert!(last < 0.2 * first, "robot {seed}: {last} J of {first} J are left");
    }
}
