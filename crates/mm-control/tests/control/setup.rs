//! What a stack refuses, what its errors say, and that it runs the same everywhere.
//!
//! Laws: a parameter that cannot work is refused by its name, the one that a scenario file uses; every error reads as the end
//! of a sentence; the same inputs give the same bits; single precision follows double; the base alone, N = 0, is a robot too.
//!
//! Reference: the documentation of the parameters; the loop in f64 for the one in f32.
//!
//! Tolerance: f32 against f64 after 200 periods in closed loop, 0.2 um at the tip and 1e-4 of the torque limits, some ten times
//! what is seen: one rounding of a position of 1 m is 0.06 um, and the loop holds what it makes of it.

#![expect(clippy::unwrap_used, reason = "a helper that cannot build its stack has failed the test")]

use crate::common::plant::Plant;
use mm_control::fuzzy::{Bundled, Curve, FuzzyError, MamdaniTables, MembershipFunction, SMOOTH, Variable};
use mm_control::laws::FuzzyTerm;
use mm_control::{
    Bfsmc, ControlError, ControlStack, Estimator, Gains, Input, Law, LawKind, OuterParams, Reference,
    SetupError, StackParams,
};
use mm_model::{
    Configuration, Force, Link, Mechanism, ParamError, Real, Robot, RobotParams, Torque, Velocity,
};
use nalgebra::Vector3;

const PERIOD: f64 = 1e-3;

fn params() -> StackParams<f64, 3> {
    let gains = Gains::for_robot(&thesis(), LawKind::Bfsmc, PERIOD);
    StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None }
}

fn thesis<T: Real>() -> Robot<T, 3>
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    Robot::try_new(RobotParams::thesis()).unwrap()
}

type Spoil = fn(&mut StackParams<f64, 3>);

fn refused(spoil: Spoil) -> Option<SetupError> {
    let mut spoilt = params();
    spoil(&mut spoilt);
    let all = LawKind::ALL.map(|kind| ControlStack::try_new(thesis(), kind, spoilt).err());
    assert!(all.iter().skip(1).all(|error| *error == all[0]), "the laws disagree: {all:?}");
    all[0]
}

#[test]
fn parameters_are_refused_by_name() {
    use ParamError::{Negative, NonFinite, NonPositive};
    let cases: [(ParamError, Spoil); 28] = [
        (NonPositive("control_period_s"), |p| p.period = 0.0),
        (NonPositive("control_period_s"), |p| p.period = -1e-3),
        (NonFinite("control_period_s"), |p| p.period = f64::NAN),
        (NonPositive("position_gain_1_s"), |p| p.outer.position_gain.y = 0.0),
        (NonFinite("position_gain_1_s"), |p| p.outer.position_gain.z = f64::INFINITY),
        (Negative("sliding_gain_1_s"), |p| p.outer.sliding_gain.joints[2] = -1.0),
        (NonPositive("weights"), |p| p.outer.weights.forward = -1.0),
        (NonPositive("weights"), |p| p.outer.weights.joints[0] = 0.0),
        (NonFinite("weights"), |p| p.outer.weights.yaw_rate = f64::NAN),
        (Negative("posture_gain_1_s"), |p| p.outer.posture_gain = -0.1),
        (Negative("joint_limit_gain_rad_s"), |p| p.outer.joint_limit_gain = -0.1),
        (NonPositive("joint_limit_margin_rad"), |p| p.outer.joint_limit_margin = 0.0),
        (Negative("manipulability_gain_rad_s"), |p| p.outer.manipulability_gain = -0.1),
        (NonPositive("manipulability_threshold"), |p| p.outer.manipulability_threshold = 0.0),
        (Negative("damping_max"), |p| p.outer.damping_max = -0.1),
        (NonPositive("correction_speed_limit_m_s"), |p| p.outer.correction_speed_limit = 0.0),
        (Negative("joint_limit_rate_1_s"), |p| p.outer.joint_limit_rate = -1.0),
        (Negative("base_hold_s"), |p| p.outer.base_hold = -1.0),
        (NonFinite("base_release_s"), |p| p.outer.base_release = f64::NAN),
        (NonFinite("switching_gain"), |p| p.gains.switching.yaw = f64::NAN),
        (Negative("switching_gain"), |p| p.gains.switching.joints[1] = -1.0),
        (NonPositive("boundary_layer"), |p| p.gains.boundary_layer.forward = 0.0),
        (Negative("fuzzy_gain"), |p| p.gains.fuzzy.forward = -1.0),
        (NonPositive("fuzzy_scale"), |p| p.gains.fuzzy_scale.joints[0] = 0.0),
        (Negative("observer_bandwidth_1_s"), |p| p.gains.observer_bandwidth = -1.0),
        (NonFinite("observer_bandwidth_1_s"), |p| p.gains.observer_bandwidth = f64::NAN),
        (Negative("learning_limit"), |p| p.gains.learning_limit.joints[2] = -1.0),
        (Negative("reaching_margin"), |p| p.gains.reaching_margin.yaw = -1.0),
    ];
    assert_eq!(refused(|_| {}), None, "the defaults are refused");
    for (error, spoil) in cases {
        assert_eq!(refused(spoil), Some(SetupError::Param(error)), "{error} was expected");
    }
}

#[test]
fn an_observer_faster_than_its_clock_is_refused() {
    let with = |kind, bandwidth: f64| {
        let mut params = params();
        params.gains.observer_bandwidth = bandwidth;
        ControlStack::try_new(thesis::<f64>(), kind, params).err()
    };
    let error = SetupError::Param(ParamError::OutOfRange("observer_bandwidth_1_s"));
    assert_eq!(with(LawKind::Bfsmc, 1.001 / PERIOD), Some(error), "L dt above 1 diverges from 2 on");
    assert_eq!(with(LawKind::Bfsmc, 0.999 / PERIOD), None, "L dt below 1 works");
    assert_eq!(with(LawKind::Bsmc, 1.001 / PERIOD), None, "a law that does not learn has no observer");
}

#[test]
fn a_gain_that_is_too_fast_for_the_period_is_refused() {
    type Change = fn(&mut StackParams<f64, 3>, f64);
    let build = |change: Change, rate: f64| {
        let mut params = params();
        change(&mut params, rate);
        ControlStack::try_new(thesis::<f64>(), LawKind::Bfsmc, params).err()
    };
    let changes: [(&str, Change); 3] = [
        ("position_gain_1_s", |params, rate| params.outer.position_gain.y = rate),
        ("sliding_gain_1_s", |params, rate| params.outer.sliding_gain.joints[1] = rate),
        ("posture_gain_1_s", |params, rate| params.outer.posture_gain = rate),
    ];
    for (name, change) in changes {
        let error = SetupError::Param(ParamError::OutOfRange(name));
        assert_eq!(build(change, 1.001 / PERIOD), Some(error), "{name}");
        assert_eq!(build(change, 0.999 / PERIOD), None, "{name}");
    }
}

#[test]
fn errors_read_as_sentences() {
    let inputs = [Variable { range: (f64::NAN, 1.0), ..SMOOTH.inputs[0] }];
    let fuzzy: SetupError =
        Curve::<f64>::try_new(&MamdaniTables { inputs: &inputs, ..SMOOTH }).unwrap_err().into();
    assert_eq!(fuzzy, SetupError::Fuzzy(FuzzyError::NonFinite("inputs.range")), "another error");
    let texts = [
        (
            SetupError::from(ParamError::Negative("fuzzy_gain")).to_string(),
            "fuzzy_gain must be zero or above",
        ),
        (fuzzy.to_string(), "fuzzy rule base: `inputs.range` is not finite"),
        (ControlError::NonFinite("velocity").to_string(), "velocity is infinite or not a number"),
        (ControlError::Overflow.to_string(), "the torque overflowed: an input is far beyond any robot"),
    ];
    for (text, expected) in texts {
        assert_eq!(text, expected, "an error reads differently");
    }
    let errors: [&dyn core::error::Error; 2] = [&fuzzy, &ControlError::Overflow];
    assert!(errors.iter().all(|error| !error.to_string().ends_with('.')), "an error ends in a full stop");
    // A gain that is refused is refused by a law made by hand as well.
    let mut gains = params().gains;
    gains.fuzzy_scale.forward = -1.0;
    let error =
        Bfsmc::with_term(&gains, FuzzyTerm::table(&Curve::<f64>::try_new(&SMOOTH).unwrap()).unwrap()).err();
    assert_eq!(error, Some(SetupError::Param(ParamError::NonPositive("fuzzy_scale"))), "a negative scale");
    // Rules that answer nowhere make a law of no authority, not a refusal.
    let terms = [MembershipFunction::Triangle([-1.0, 0.0, 1.0]); 7];
    let outputs = [Variable { terms: &terms, ..SMOOTH.outputs[0] }];
    let mute = MamdaniTables { outputs: &outputs, ..SMOOTH };
    let law = Law::Bfsmc(
        Bfsmc::with_term(&params().gains, FuzzyTerm::table(&Curve::<f64>::try_new(&mute).unwrap()).unwrap())
            .unwrap(),
    );
    assert!(law.authority().unwrap().channels().all(|k| k.abs() < 1e-9), "mute rules have an authority");
}

/// The reference of the closed loops: a tip that sets off smoothly, 0.2 m/s^2 and 0.1 m/s^2.
fn path(start: Vector3<f64>, t: f64) -> Reference<f64> {
    let a = Vector3::new(0.2, 0.1, 0.1);
    Reference { position: start + a * (0.5 * t * t), velocity: a * t, acceleration: a }
}

fn at_rest(params: RobotParams<f64, 3>) -> Plant {
    let q = Configuration { joints: params.rest_posture, ..Configuration::zero() };
    Plant { robot: Robot::try_new(params).unwrap(), q, nu: Velocity::zero(), time: 0.0 }
}

/// A closed loop of 200 periods with a stack in precision `T` and a plant in f64: torques and tips.
fn run<T: Bundled>(kind: LawKind) -> Vec<(Torque<f64, 3>, Vector3<f64>)>
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    let period = T::from_f64(PERIOD);
    let gains = Gains::for_robot(&thesis::<T>(), kind, period);
    let params = StackParams { period, outer: OuterParams::default(), gains, estimator: Estimator::None };
    let stack = ControlStack::try_new(thesis::<T>(), kind, params).unwrap();
    let mut state = stack.initial_state();
    let heavier = RobotParams::<f64, 3>::thesis().with_mass_scaled(1.1);
    let mut plant = at_rest(heavier);
    let start = plant.robot.tip_position(&plant.q);
    let n = |x: f64| T::from_f64(x);
    (0..200)
        .map(|_| {
            let (q, nu, wanted) = (plant.q, plant.nu, path(start, plant.time));
            let input = Input {
                q: Configuration { x: n(q.x), y: n(q.y), heading: n(q.heading), joints: q.joints.map(n) },
                nu: Velocity { forward: n(nu.forward), yaw_rate: n(nu.yaw_rate), joints: nu.joints.map(n) },
                reference: Reference {
                    position: wanted.position.map(n),
                    velocity: wanted.velocity.map(n),
                    acceleration: wanted.acceleration.map(n),
                },
            };
            let torque = stack.update(&mut state, &input).unwrap().torque;
            let torque = Torque {
                right: torque.right.to_f64(),
                left: torque.left.to_f64(),
                joints: torque.joints.map(Real::to_f64),
            };
            plant.step(&torque, |_| Force { joints: [2.0; 3], ..Force::zero() }, PERIOD);
            (torque, plant.robot.tip_position(&plant.q))
        })
        .collect()
}

#[test]
fn two_runs_give_the_same_bits() {
    for kind in LawKind::ALL {
        assert_eq!(format!("{:?}", run::<f64>(kind)), format!("{:?}", run::<f64>(kind)), "{}", kind.name());
        assert_eq!(format!("{:?}", run::<f32>(kind)), format!("{:?}", run::<f32>(kind)), "{}", kind.name());
    }
}

#[test]
fn single_precision_follows_double() {
    let limits = RobotParams::<f64, 3>::thesis().limits;
    let [l1, l2, l3] = limits.joint_torque;
    // The relay laws chatter: a rounding decides on which side of zero s is, and no two precisions agree on a torque.
    for (kind, smooth) in [(LawKind::Bsmc, false), (LawKind::BsmcSat, true), (LawKind::Bfsmc, true)] {
        let (mut tip, mut torque) = (0.0_f64, 0.0_f64);
        for ((t32, p32), (t64, p64)) in run::<f32>(kind).iter().zip(&run::<f64>(kind)) {
            tip = tip.max((p32 - p64).norm());
            let off = t32.minus(*t64);
            let most = [limits.wheel_torque, limits.wheel_torque, l1, l2, l3];
            torque = off.channels().zip(most).fold(torque, |all, (t, most)| all.max(t.abs() / most));
        }
        println!("{}: tip {tip:.1e} m, torque {torque:.1e} of the limits", kind.name());
        if smooth {
            assert!(tip < 2e-7, "{}: the tips part by {tip} m", kind.name());
            assert!(torque < 1e-4, "{}: the torques part by {torque} of the limits", kind.name());
        } else {
            assert!(tip < 1e-3, "{}: the tips part by {tip} m", kind.name());
        }
    }
}

#[test]
fn the_base_alone_is_a_robot() {
    let arm = RobotParams::<f64, 3>::thesis();
    let base = RobotParams::<f64, 0> {
        base_mass: arm.base_mass,
        base_yaw_inertia: arm.base_yaw_inertia,
        base_com_offset: arm.base_com_offset,
        arm_offset: arm.arm_offset,
        mount_height: 0.3,
        wheel_radius: arm.wheel_radius,
        track_width: arm.track_width,
        gravity: arm.gravity,
        links: [] as [Link<f64>; 0],
        rest_posture: [],
        friction: mm_model::Friction::none(),
        limits: mm_model::Limits { joints: [], wheel_torque: 60.0, joint_torque: [], speed: 2.0 },
    };
    let robot = Robot::try_new(base).unwrap();
    for kind in LawKind::ALL {
        let gains = Gains::for_robot(&robot, kind, PERIOD);
        let params =
            StackParams { period: PERIOD, outer: OuterParams::default(), gains, estimator: Estimator::None };
        let stack = ControlStack::try_new(robot, kind, params).unwrap();
        let (mut state, mut q, mut nu) =
            (stack.initial_state(), Configuration::<f64, 0>::zero(), Velocity::zero());
        // The mount point is driven 0.3 m ahead and 0.1 m aside; its height is no business of two wheels.
        let goal = Vector3::new(0.36, 0.1, 0.3);
        let reference =
            Reference { position: goal, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
        for tick in 0..4000 {
            let out = stack.update(&mut state, &Input { q, nu, reference }).unwrap();
            assert!(out.torque.is_finite(), "{}, tick {tick}: {:?}", kind.name(), out.torque);
            assert!(out.status.near_singular, "two wheels cannot span space");
            let tip = robot.tip_position(&q);
            assert!(
                (out.signals.tip - tip).norm() < 1e-15,
                "{}: the tip is not the mount point",
                kind.name()
            );
            nu = nu.plus(robot.forward_dynamics(&q, &nu, &out.torque, &Force::zero()).scaled(PERIOD));
            let rate = Robot::<f64, 0>::configuration_rate(mm_model::Angle::of(q.heading), &nu);
            q = Configuration {
                x: q.x + rate.x * PERIOD,
                y: q.y + rate.y * PERIOD,
                heading: q.heading + rate.heading * PERIOD,
                joints: [],
            };
        }
        let left = (robot.tip_position(&q) - goal).norm();
        println!("{}: {left:.1e} m from the goal", kind.name());
        assert!(left < 0.02, "{}: {left} m from the goal after four seconds", kind.name());
    }
}

#[test]
fn a_joint_with_little_room_has_a_margin_that_fits() {
    let mut narrow = RobotParams::<f64, 3>::thesis();
    narrow.limits.joints[0] = (-0.05, 0.05);
    let robot = Robot::try_new(narrow).unwrap();
    let outer = OuterParams::for_robot(&robot);
    assert!((outer.joint_limit_margin - 0.025).abs() < 1e-15, "{} rad", outer.joint_limit_margin);
    let fitting = StackParams { outer, ..params() };
    assert!(ControlStack::try_new(robot, LawKind::Bfsmc, fitting).is_ok(), "the default margin fits");
    let refused = ControlStack::try_new(robot, LawKind::Bfsmc, params()).err();
    let expected = SetupError::Param(ParamError::OutOfRange("joint_limit_margin_rad"));
    assert_eq!(refused, Some(expected), "two margins that overlap are taken");
}
