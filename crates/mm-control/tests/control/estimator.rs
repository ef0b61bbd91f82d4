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

use crate::common::plant::Plant;
use crate::common::random::Random;
use mm_control::fuzzy::Bundled;
use mm_control::{
    ControlError, ControlStack, Estimator, Gains, LawKind, Measurement, OuterParams, Output, Reference,
    SetupError, StackParams, WheelAngles,
};
use mm_model::{Configuration, Force, Mechanism, ParamError, Real, Robot, RobotParams, Velocity};
use nalgebra::{Matrix3, RowVector3, Vector3};

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

/// Impulse response of the low-pass, from its continuous poles.
fn response(cutoff: f64, length: usize) -> Vec<f64> {
    let part = TAU * cutoff * PERIOD / 2.0_f64.sqrt();
    let decay = Real::exp(-part);
    let gain = 1.0 - 2.0 * decay * Real::sin_cos(part).1 + decay * decay;
    let power = |n: f64| Real::exp(-n * part) * Real::sin_cos(n * part).0;
    (0..length).map(|n| gain * power(n as f64 + 1.0) / power(1.0)).collect()
}

#[test]
fn the_filter_is_its_impulse_response() {
    for cutoff in [5.0, 60.0, 300.0] {
        let path = walk(1, 400, true);
        let h = response(cutoff, path.len());
        let out = outputs(&stack(filter(cutoff)), path.iter().copied());
        assert_eq!(out[0].signals.nu, Velocity::zero(), "no difference, no velocity");
        for k in 1..path.len() {
            let convolved = |position: &dyn Fn(&Measurement<f64, 3>) -> f64| {
                let parts =
                    (1..=k).map(|i| h[k - i] * (position(&path[i]) - position(&path[i - 1])) / PERIOD);
                parts.sum::<f64>()
            };
            let nu = &out[k].signals.nu;
            let joint = convolved(&|m| m.q.joints[1]);
            assert!((nu.joints[1] - joint).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {joint}", nu.joints[1]);
            let forward = convolved(&|m| 0.03 * m.wheels.map_or(0.0, |w| w.right + w.left));
            assert!((nu.forward - forward).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {forward}", nu.forward);
            let yaw = convolved(&|m| 0.3 * m.wheels.map_or(0.0, |w| w.right - w.left));
            assert!((nu.yaw_rate - yaw).abs() < 1e-9, "{cutoff} Hz, {k}: {} for {yaw}", nu.yaw_rate);
        }
    }
}

#[test]
fn the_filter_is_three_decibels_down_at_its_cutoff() {
    let cutoff = 10.0;
    let path = (0..2000_i32).map(|k| {
        let mut q = rest();
        q.joints[0] += 1e-3 * Real::sin_cos(TAU * cutoff * f64::from(k) * PERIOD).0;
        Measurement { q, wheels: None }
    });
    let out = outputs(&stack(filter(cutoff)), path);
    let most = out[1000..].iter().fold(0.0, |most: f64, o| most.max(o.signals.nu.joints[0]));
    let ratio = most / (1e-3 * TAU * cutoff);
    // The samples are 100 a period, so that the largest is within 0.05 % of the amplitude.
    assert!((ratio - 0.5_f64.sqrt()).abs() < 2e-3, "{ratio}");
}

/// The observer of one channel with dense matrices: gains by Ackermann's formula.
struct Dense {
    transition: Matrix3<f64>,
    gain: Vector3<f64>,
    state: Vector3<f64>,
}

impl Dense {
    fn new(cutoff: f64, position: f64) -> Self {
        let dt = PERIOD;
        let transition = Matrix3::new(1.0, dt, 0.5 * dt * dt, 0.0, 1.0, dt, 0.0, 0.0, 1.0);
        let shifted = transition - Matrix3::identity() * Real::exp(-TAU * cutoff * dt / 3.0);
        let c = RowVector3::new(1.0, 0.0, 0.0);
        let observability = Matrix3::from_rows(&[c, c * transition, c * transition * transition]);
        let last = observability.lu().solve(&Vector3::new(0.0, 0.0, 1.0)).unwrap();
        let predictor = shifted * shifted * shifted * last;
        let gain = transition.lu().solve(&predictor).unwrap();
        Self { transition, gain, state: Vector3::new(position, 0.0, 0.0) }
    }

    fn next(&mut self, expected: f64, position: f64) -> f64 {
        let dt = PERIOD;
        let predicted = self.transition * self.state + Vector3::new(0.5 * dt * dt, dt, 0.0) * expected;
        self.state = predicted + self.gain * (position - predicted.x);
        self.state.y
    }
}

#[test]
fn the_observer_is_the_dense_one() {
    for cutoff in [20.0, 60.0, 200.0] {
        let stack = stack(observer(cutoff));
        let path = walk(2, 300, true);
        let turned = |m: &Measurement<f64, 3>| {
            let WheelAngles { right, left } = m.wheels.unwrap();
            let [q1, q2, q3] = m.q.joints;
            [0.03 * (right + left), 0.3 * (right - left), q1, q2, q3]
        };
        let mut dense = turned(&path[0]).map(|position| Dense::new(cutoff, position));
        let mut state = stack.initial_state();
        let mut expected = Velocity::zero();
        for (k, m) in path.iter().enumerate() {
            let out = stack.update_measured(&mut state, m, &hold(stack.robot(), &m.q)).unwrap();
            let nu = out.signals.nu;
            let mut joints = m.q.joints;
            if k > 0 {
                let twin = dense.each_mut().into_iter().zip(turned(m)).zip(expected.channels());
                for (((channel, position), a), found) in twin.zip(nu.channels()) {
                    let wanted = channel.next(a, position);
                    assert!(
                        (found - wanted).abs() < 1e-9 * (1.0 + wanted.abs()),
                        "{k}: {found} for {wanted}"
                    );
                }
                joints = [dense[2].state.x, dense[3].state.x, dense[4].state.x];
            }
            let q = Configuration { joints, ..m.q };
            expected = stack.robot().forward_dynamics(&q, &nu, &out.torque, &Force::zero());
        }
    }
}

/// Standard normal numbers, near enough: twelve uniform ones.
fn noise(draw: &mut Random) -> f64 {
    (0..12).map(|_| draw.between(-0.5, 0.5)).sum()
}

/// Variance of the velocity of joint 1 under white noise of its angle; the others stand still.
fn noise_of(stack: &ControlStack<f64, 3>, sigma: f64, length: usize) -> f64 {
    let mut draw = Random::seeded(3);
    let path = (0..length).map(|_| {
        let mut q = rest();
        q.joints[0] += sigma * noise(&mut draw);
        Measurement { q, wheels: None }
    });
    let out = outputs(stack, path);
    let late = &out[500..];
    late.iter().map(|o| o.signals.nu.joints[0].powi(2)).sum::<f64>() / late.len() as f64
}

/// Variance of the filtered difference of white noise of variance 1.
fn noise_gain(cutoff: f64) -> f64 {
    let h = response(cutoff, 4000);
    let steps = h.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum::<f64>();
    (h[0].powi(2) + steps) / PERIOD.powi(2)
}

#[test]
fn noise_comes_out_as_the_impulse_response_says() {
    let sigma = 1e-7;
    for cutoff in [20.0, 60.0] {
        let part = TAU * cutoff * PERIOD / 2.0_f64.sqrt();
        let (a1, a2) = (-2.0 * Real::exp(-part) * Real::sin_cos(part).1, Real::exp(-2.0 * part));
        let closed = 2.0 * ((1.0 + a1 + a2) / PERIOD).powi(2) / ((1.0 - a2) * (1.0 + a2 - a1));
        assert!((noise_gain(cutoff) / closed - 1.0).abs() < 1e-9, "the closed form at {cutoff} Hz");
        let found = noise_of(&stack(filter(cutoff)), sigma, 40_000);
        let ratio = found / (noise_gain(cutoff) * sigma * sigma);
        // The noise is correlated over about 1/(cutoff dt) samples: 40,000 of them are some 800 independent ones.
        assert!((ratio - 1.0).abs() < 0.15, "filter at {cutoff} Hz: {ratio} of the theory");
    }
}

#[test]
fn the_fused_pose_is_quieter_and_bears_a_slip() {
    let gain = 1.0 - Real::exp(-TAU * 60.0 / 16.0 * PERIOD);
    let still = WheelAngles { right: 0.0, left: 0.0 };
    for estimator in [filter(60.0), observer(60.0)] {
        let stack = stack(estimator);
        let mut draw = Random::seeded(4);
        let noisy = (0..60_000).map(|_| {
            let q = Configuration { x: 1e-4 * noise(&mut draw), ..rest() };
            Measurement { q, wheels: Some(still) }
        });
        let tip = stack.robot().tip_position(&rest()).x;
        let out = outputs(&stack, noisy);
        let late = &out[2000..];
        let variance = late.iter().map(|o| (o.signals.tip.x - tip).powi(2)).sum::<f64>() / late.len() as f64;
        let ratio = variance / (1e-8 * gain / (2.0 - gain));
        // Correlated over 2/gain samples: about 680 independent ones.
        assert!((ratio - 1.0).abs() < 0.22, "{estimator:?}: {ratio} of the theory");

        let slip = 0.05;
        let slipping = (0..3000_i32).map(|k| {
            let q = Configuration { y: slip * f64::from(k) * PERIOD, ..rest() };
            Measurement { q, wheels: Some(still) }
        });
        let last = outputs(&stack, slipping).pop().unwrap().signals;
        let error = slip * 2.999 - last.tip.y;
        let theory = slip * PERIOD * (1.0 - gain) / gain;
        assert!((error - theory).abs() < 1e-9, "{estimator:?}: {error} m of slip left, theory {theory}");
    }
}

/// Mean square error of the velocity in a closed loop with a heavier robot that follows a circle.
fn tracking_error(estimator: Estimator<f64>) -> f64 {
    let stack = stack(estimator);
    let robot = Robot::try_new(RobotParams::thesis().with_mass_scaled(1.25)).unwrap();
    let mut plant = Plant { robot, q: rest(), nu: Velocity::zero(), time: 0.0 };
    let start = robot.tip_position(&plant.q);
    let mut state = stack.initial_state();
    let (mut sum, mut travel) = (0.0, 0.0);
    for k in 0..3000_i32 {
        let t = f64::from(k) * PERIOD;
        let (sin, cos) = Real::sin_cos(2.0 * t);
        let reference = Reference {
            position: start + 0.1 * Vector3::new(sin, 1.0 - cos, 0.5 * sin),
            velocity: 0.2 * Vector3::new(cos, sin, 0.5 * cos),
            acceleration: 0.4 * Vector3::new(-sin, cos, -0.5 * sin),
        };
        let turned = robot.wheel_rates(travel, plant.q.heading);
        let wheels = Some(WheelAngles { right: turned.right, left: turned.left });
        let out = stack.update_measured(&mut state, &Measurement { q: plant.q, wheels }, &reference).unwrap();
        if k > 1000 {
            sum += out.signals.nu.minus(plant.nu).channels().map(|x| x * x).sum::<f64>() / 1999.0;
        }
        let before = plant.nu.forward;
        plant.step(
            &out.torque,
            |t| Force { joints: [5.0 * Real::sin_cos(3.0 * t).0; 3], ..Force::zero() },
            PERIOD,
        );
        travel += 0.5 * PERIOD * (before + plant.nu.forward);
    }
    sum
}

#[test]
fn the_observer_lags_less_than_a_filter_of_the_same_noise() {
    // Impulse response of the observer without a model, by the dense one.
    let mut dense = Dense::new(60.0, 0.0);
    let steps: Vec<f64> = (0..4000).map(|k| dense.next(0.0, if k == 0 { 1.0 } else { 0.0 })).collect();
    let noise = steps.iter().map(|v| v * v).sum::<f64>();
    let mut cutoff = 60.0;
    while noise_gain(cutoff) > noise {
        cutoff *= 0.99;
    }
    assert!(cutoff < 60.0 && cutoff > 10.0, "a filter as quiet has its cutoff at {cutoff} Hz");
    let (filtered, observed) = (tracking_error(filter(cutoff)), tracking_error(observer(60.0)));
    assert!(observed < 0.25 * filtered, "{observed} against {filtered} of a filter at {cutoff} Hz");
}

#[test]
fn a_constant_push_leaves_no_error_of_the_velocity() {
    let stack = stack(observer(60.0));
    let robot = thesis();
    let mut plant = Plant { robot, q: rest(), nu: Velocity::zero(), time: 0.0 };
    let reference = hold(&robot, &rest());
    let mut state = stack.initial_state();
    let mut last = f64::INFINITY;
    for _ in 0..3000 {
        let measurement = Measurement { q: plant.q, wheels: None };
        let out = stack.update_measured(&mut state, &measurement, &reference).unwrap();
        last = out.signals.nu.minus(plant.nu).channels().fold(0.0, |most, x| most.max(x.abs()));
        plant.step(&out.torque, |_| Force { joints: [8.0, -20.0, 5.0], ..Force::zero() }, PERIOD);
    }
    assert!(last < 1e-6, "{last} left");
}

#[test]
fn a_delay_is_made_up_for() {
    let still = stack(filter(60.0));
    let ahead = still.with_delay(0.02).unwrap();
    let path = || {
        (0..500_i32).map(|k| {
            let mut q = rest();
            q.x = 0.3 * f64::from(k) * PERIOD;
            q.joints[0] += 0.2 * f64::from(k) * PERIOD;
            Measurement { q, wheels: None }
        })
    };
    let (a, b) = (outputs(&still, path()).pop().unwrap(), outputs(&ahead, path()).pop().unwrap());
    let mut q = rest();
    q.x = 0.3 * (0.499 + 0.02);
    q.joints[0] += 0.2 * (0.499 + 0.02);
    let expected = thesis::<f64>().tip_position(&q);
    assert!((b.signals.tip - expected).norm() < 1e-9, "{} for {expected}", b.signals.tip);
    assert!((a.signals.tip - expected).norm() > 5e-3, "without it the tip is behind");
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
