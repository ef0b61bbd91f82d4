//! The estimator stage: velocity and configuration from measured positions.
//!
//! Laws: (1) the filter is the Butterworth low-pass of second order over differences, poles mapped exactly; (2) the observer is the
//! Luenberger observer of (position, velocity, acceleration) whose three error poles are exp(-2 pi cutoff dt/3); (3) white noise of the
//! positions becomes noise of the velocity as the impulse responses say; (4) the fused pose has sqrt(g/(2-g)) of the measured noise and
//! bears a slip with the error u dt (1-g)/g; (5) in a closed loop with a robot 25 % heavier the observer is nearer the true velocity than
//! a filter of the same noise; (6) a refused measurement leaves the state as it was.
//!
//! Reference: the impulse response from the continuous poles; gains by Ackermann's formula on dense matrices with forward dynamics; sums
//! of squares. Tolerance: rounding over the length of a run (1e-9) for (1) and (2); 4 standard deviations of a variance for (3), (4).

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

mod in_a_loop;
mod noise;
mod twins;

use crate::common::random::Random;
use mm_control::fuzzy::Bundled;
use mm_control::{
    ControlError, ControlStack, Estimator, Gains, LawKind, Measurement, OuterParams, Output, Reference,
    SetupError, StackParams, WheelAngles,
};
use mm_model::{Configuration, Mechanism, ParamError, Real, Robot, RobotParams};
use nalgebra::Vector3;

const PERIOD: f64 = 1e-3;
const TAU: f64 = core::f64::consts::TAU;

fn thesis<T: Real>() -> Robot<T, 3> {
    Robot::try_new(RobotParams::thesis()).unwrap()
}

fn try_stack<T: Bundled, const N: usize>(
    robot: Robot<T, N>,
    estimator: Estimator<T>,
) -> Result<ControlStack<T, N>, SetupError>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let period = T::from_f64(PERIOD);
    let gains = Gains::for_robot(&robot, LawKind::Bfsmc, period);
    let params = StackParams { period, outer: OuterParams::default(), gains, estimator };
    ControlStack::try_new(robot, LawKind::Bfsmc, params)
}

fn stack(estimator: Estimator<f64>) -> ControlStack<f64, 3> {
    try_stack(thesis(), estimator).unwrap()
}

const fn filter(cutoff_hz: f64) -> Estimator<f64> {
    Estimator::FilteredDifference { cutoff_hz }
}

const fn observer(cutoff_hz: f64) -> Estimator<f64> {
    Estimator::Observer { cutoff_hz }
}

fn rest<T: Real>() -> Configuration<T, 3> {
    Configuration { joints: RobotParams::thesis().rest_posture, ..Configuration::zero() }
}

fn hold<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>) -> Reference<T> {
    Reference { position: robot.tip_position(q), velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
}

/// The outputs over a sequence of measurements, with the tip asked to stay where it is.
fn outputs(
    stack: &ControlStack<f64, 3>,
    measurements: impl Iterator<Item = Measurement<f64, 3>>,
) -> Vec<Output<f64, 3>> {
    let mut state = stack.initial_state();
    measurements.map(|m| stack.update_measured(&mut state, &m, &hold(stack.robot(), &m.q)).unwrap()).collect()
}

/// A walk of the joints, without and with wheels.
fn walk(seed: u64, length: usize, with_wheels: bool) -> Vec<Measurement<f64, 3>> {
    let mut draw = Random::seeded(seed);
    let (mut q, mut wheels) = (rest::<f64>(), WheelAngles { right: 3.0, left: -2.0 });
    (0..length)
        .map(|_| {
            for joint in &mut q.joints {
                *joint += draw.between(-2e-4, 2e-4);
            }
            wheels.right += draw.between(-2e-3, 2e-3);
            wheels.left += draw.between(-2e-3, 2e-3);
            Measurement { q, wheels: with_wheels.then_some(wheels) }
        })
        .collect()
}

#[test]
fn turns_are_taken_the_short_way_round() {
    for estimator in [filter(60.0), observer(60.0)] {
        let stack = stack(estimator);
        // The heading and single-turn wheel encoders pass pi; the same motion without the jump is the reference.
        let path = |wraps: bool| {
            (0..200_i32).map(move |k| {
                let turn = 0.01 * f64::from(k);
                let (heading, wheel) = (2.5 + turn, 2.8 + 2.0 * turn);
                let read = |angle: f64| if wraps { angle.wrap_to_pi() } else { angle };
                let wheels = WheelAngles { right: read(wheel), left: read(-wheel) };
                Measurement { q: Configuration { heading: read(heading), ..rest() }, wheels: Some(wheels) }
            })
        };
        let (plain, wrapped) = (outputs(&stack, path(false)), outputs(&stack, path(true)));
        for (a, b) in plain.iter().zip(&wrapped) {
            let gap = a.signals.nu.minus(b.signals.nu).channels().fold(0.0, |most: f64, x| most.max(x.abs()));
            assert!(gap < 1e-9, "{estimator:?}: {gap}");
            assert!((a.signals.tip - b.signals.tip).norm() < 1e-9, "{estimator:?}: the tip is where it was");
        }
    }
}

#[test]
fn misuse_is_an_error_and_changes_nothing() {
    let q = rest();
    let measurement = Measurement { q, wheels: Some(WheelAngles { right: 0.0, left: 0.0 }) };
    let reference = hold(&thesis(), &q);
    let none = stack(Estimator::None);
    assert!(!none.estimates(), "nothing is estimated");
    let mut state = none.initial_state();
    let refused = none.update_measured(&mut state, &measurement, &reference);
    assert_eq!(refused, Err(ControlError::NoEstimator), "a measurement alone is not enough");
    assert_eq!(state, none.initial_state(), "the state is as before");
    for estimator in [filter(60.0), observer(60.0)] {
        let stack = stack(estimator);
        assert!(stack.estimates(), "{estimator:?}");
        let mut state = stack.initial_state();
        stack.update_measured(&mut state, &measurement, &reference).unwrap();
        let before = format!("{state:?}");
        let nan = Configuration { joints: [0.0, f64::NAN, 0.0], ..q };
        let wheels = Some(WheelAngles { right: f64::INFINITY, left: 0.0 });
        let far = Reference { position: Vector3::repeat(f64::NAN), ..reference };
        for (bad, reference, expected) in [
            (Measurement { q: nan, ..measurement }, &reference, ControlError::NonFinite("configuration")),
            (Measurement { wheels, ..measurement }, &reference, ControlError::NonFinite("wheel angles")),
            (measurement, &far, ControlError::NonFinite("reference")),
        ] {
            assert_eq!(stack.update_measured(&mut state, &bad, reference), Err(expected), "{estimator:?}");
            assert_eq!(format!("{state:?}"), before, "{estimator:?}: the state is as before");
        }
        let huge = Measurement { q: Configuration { joints: [1e300, 0.0, 0.0], ..q }, ..measurement };
        if stack.update_measured(&mut state, &huge, &reference).is_err() {
            assert_eq!(format!("{state:?}"), before, "{estimator:?}: the state is as before");
        }
    }
}

#[test]
fn bad_cutoffs_and_delays_are_refused_by_name() {
    for make in [filter as fn(f64) -> Estimator<f64>, observer] {
        for (cutoff, error) in [
            (0.0, ParamError::NonPositive("cutoff_hz")),
            (-1.0, ParamError::NonPositive("cutoff_hz")),
            (f64::NAN, ParamError::NonFinite("cutoff_hz")),
            (500.0, ParamError::OutOfRange("cutoff_hz")),
        ] {
            assert_eq!(try_stack(thesis(), make(cutoff)), Err(error.into()), "a cutoff of {cutoff}");
        }
        let negative = stack(make(60.0)).with_delay(-1e-3);
        assert_eq!(negative, Err(ParamError::Negative("delay_s").into()), "no foresight");
    }
}

#[test]
fn single_precision_and_a_base_alone_follow() {
    for (wide, narrow) in [
        (filter(60.0), Estimator::FilteredDifference { cutoff_hz: 60.0_f32 }),
        (observer(60.0), Estimator::Observer { cutoff_hz: 60.0_f32 }),
    ] {
        let (wide, narrow) = (stack(wide), try_stack(thesis::<f32>(), narrow).unwrap());
        let (mut a, mut b) = (wide.initial_state(), narrow.initial_state());
        for k in 0..500_u16 {
            // Steps of 2^-12 rad are exact in both.
            let turn = f32::from(k % 64) / 4096.0;
            let mut q32 = rest::<f32>();
            q32.joints = [turn, 1.0, -2.0];
            let q = Configuration { joints: q32.joints.map(f64::from), ..rest() };
            let m = Measurement { q, wheels: Some(WheelAngles { right: f64::from(turn), left: 0.0 }) };
            let m32 = Measurement { q: q32, wheels: Some(WheelAngles { right: turn, left: 0.0 }) };
            let out = wide.update_measured(&mut a, &m, &hold(wide.robot(), &q)).unwrap().signals.nu;
            let out32 = narrow.update_measured(&mut b, &m32, &hold(narrow.robot(), &q32)).unwrap().signals.nu;
            for (x, y) in out.channels().zip(out32.channels()) {
                assert!((x - f64::from(y)).abs() < 2e-3 * (1.0 + x.abs()), "{k}: {y} for {x}");
            }
        }
    }
    let params = RobotParams::thesis();
    let base = Robot::<f64, 0>::try_new(RobotParams {
        links: [],
        rest_posture: [],
        friction: mm_model::Friction::none(),
        limits: mm_model::Limits {
            joints: [],
            joint_torque: [],
            wheel_torque: params.limits.wheel_torque,
            speed: params.limits.speed,
        },
        base_mass: params.base_mass,
        base_yaw_inertia: params.base_yaw_inertia,
        base_com_offset: params.base_com_offset,
        arm_offset: params.arm_offset,
        mount_height: params.mount_height,
        wheel_radius: params.wheel_radius,
        track_width: params.track_width,
        gravity: params.gravity,
    })
    .unwrap();
    let stack = try_stack(base, observer(60.0)).unwrap();
    let mut state = stack.initial_state();
    for k in 0..2000_i32 {
        let way = 0.1 * f64::from(k) * PERIOD;
        let q = Configuration { x: way, ..Configuration::zero() };
        let reference = Reference {
            position: base.tip_position(&q),
            velocity: Vector3::new(0.1, 0.0, 0.0),
            acceleration: Vector3::zeros(),
        };
        let out = stack.update_measured(&mut state, &Measurement { q, wheels: None }, &reference).unwrap();
        if k > 1000 {
            let nu = out.signals.nu;
            assert!((nu.forward - 0.1).abs() < 1e-3 && nu.yaw_rate.abs() < 1e-6, "{k}: {nu:?}");
        }
    }
}
