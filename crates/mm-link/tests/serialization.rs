//! Parameters, inputs and outcomes survive serialization.
//!
//! Law: reading what was written gives the same value, bit for bit, as bytes (postcard) and, short numbers, as text (JSON: serde_json
//! reads long ones within a rounding), for arms of 0 and 3 joints; a stack built of what was read computes what the original does. Numbers are written whole, so there is no
//! tolerance. The bytes of an array are those of its elements alone: a frame's layout is fixed.

#![expect(clippy::expect_used, reason = "helpers of tests")]

use mm_control::supervisor::{Findings, Mode, Timing};
use mm_control::{Estimator, Input, LawKind, Measurement, Reference, Status, WheelAngles};
use mm_link::{Fuzzy, Pace, Setup};
use mm_model::{Configuration, Force, Friction, Limits, RobotParams, Torque, Velocity};
use nalgebra::Vector3;
use serde::{Serialize, de::DeserializeOwned};

#[track_caller]
fn survives<V: Serialize + DeserializeOwned + PartialEq + core::fmt::Debug>(value: &V) -> usize {
    let mut buffer = [0; 4096];
    let bytes = postcard::to_slice(value, &mut buffer).expect("room");
    let length = bytes.len();
    let (read, rest) = postcard::take_from_bytes::<V>(bytes).expect("what was written");
    assert_eq!((&read, rest.len()), (value, 0), "as bytes");
    let text = serde_json::to_string(value).expect("as text");
    assert_eq!(&serde_json::from_str::<V>(&text).expect("what was written"), value, "as text: {text}");
    length
}

fn reference() -> Reference<f64> {
    Reference {
        position: Vector3::new(1.0, -2.5, 0.125),
        velocity: Vector3::new(0.1, 1e-300, -0.0),
        acceleration: Vector3::new(7.0, 8.0, 9.0),
    }
}

fn configuration() -> Configuration<f64, 3> {
    Configuration { x: 0.1, y: -0.2, heading: 3.0, joints: [0.3, 1.0 / 3.0, -2.0] }
}

#[test]
fn inputs_and_outcomes_survive_and_take_no_more_than_their_numbers() {
    let nu = Velocity { forward: 0.5, yaw_rate: -0.25, joints: [0.1, 0.2, 0.3] };
    let q = configuration();
    assert_eq!(survives(&q), 6 * 8, "a configuration");
    assert_eq!(survives(&Input { q, nu, reference: reference() }), 20 * 8, "an input");
    let measurement = Measurement { q, wheels: Some(WheelAngles { right: 1.5, left: -8.0 }) };
    assert_eq!(survives(&measurement), 8 * 8 + 1, "a measurement");
    assert_eq!(survives(&Measurement { wheels: None, ..measurement }), 6 * 8 + 1, "one without wheels");
    assert_eq!(survives(&Force::<f32, 3> { forward: 1.0, yaw: 2.0, joints: [3.0; 3] }), 20, "a force");
    assert_eq!(survives(&Torque::<f32, 3> { right: 1.0, left: 2.0, joints: [3.0; 3] }), 20, "a torque");
    survives(&Timing { elapsed: 1e-3_f32, age: 0.0 });
    survives(&Findings::STALE.and(Findings::REFUSED));
    for mode in [Mode::Run, Mode::Hold, Mode::Stop, Mode::Fault] {
        assert_eq!(survives(&mode), 1, "a mode");
    }
    survives(&Status { saturated: true, beyond_joint_limit: true, ..Status::default() });
}

#[test]
fn an_arm_without_joints_survives() {
    let robot = RobotParams::<f32, 0> {
        base_mass: 50.0,
        base_yaw_inertia: 2.0,
        base_com_offset: 0.0,
        arm_offset: 0.0,
        mount_height: 0.1,
        wheel_radius: 0.06,
        track_width: 0.2,
        gravity: 9.81,
        links: [],
        rest_posture: [],
        friction: Friction::none(),
        limits: Limits { joints: [], wheel_torque: 60.0, joint_torque: [], speed: 2.0 },
    };
    assert_eq!(survives(&robot), (8 + 3 + 2) * 4, "the numbers of the base");
}

#[test]
fn too_few_elements_are_refused() {
    let error =
        serde_json::from_str::<Velocity<f64, 3>>(r#"{"forward":1.0,"yaw_rate":2.0,"joints":[1.0,2.0]}"#);
    let message = error.expect_err("two joints of three").to_string();
    assert!(message.starts_with("invalid length 2, expected 3 elements"), "{message}");
    let short = postcard::from_bytes::<Velocity<f32, 3>>(&[0; 19]);
    assert_eq!(short, Err(postcard::Error::DeserializeUnexpectedEnd), "19 bytes of 20");
}

#[test]
fn setups_of_all_laws_survive_and_build_the_same_stack() {
    let estimators = [
        Estimator::None,
        Estimator::FilteredDifference { cutoff_hz: 60.0 },
        Estimator::Observer { cutoff_hz: 50.0 },
    ];
    for (i, law) in LawKind::ALL.into_iter().enumerate() {
        let mut setup =
            Setup::for_robot(RobotParams::<f64, 3>::thesis(), law, 1e-3).expect("the thesis's robot");
        setup.stack.estimator = estimators[i % 3];
        setup.delay = 1e-3;
        for fuzzy in [Fuzzy::Own, Fuzzy::Table, Fuzzy::Rules, Fuzzy::Q15, Fuzzy::Surface] {
            setup.fuzzy = fuzzy;
            setup.pace = if i % 2 == 0 { Pace::Lockstep } else { Pace::RealTime };
            let mut buffer = [0; 2048];
            let bytes = postcard::to_slice(&setup, &mut buffer).expect("room");
            assert!(bytes.len() < 1400, "{} bytes: the length that buffers are made for", bytes.len());
            let read: Setup<f64> = postcard::from_bytes(bytes).expect("what was written");
            assert!(read == setup, "{law:?}, {fuzzy:?}");
            let (here, there) = (setup.build().expect("a stack"), read.build().expect("a stack"));
            assert!(here == there, "{law:?}, {fuzzy:?}");
            let (mut first, mut second) = (here.initial_state(), there.initial_state());
            if setup.stack.estimator == Estimator::None {
                let nu = Velocity { forward: 0.5, yaw_rate: -0.25, joints: [0.1, 0.2, 0.3] };
                let input = Input { q: configuration(), nu, reference: reference() };
                let timing = Timing::exact(1e-3);
                let torques = [
                    here.update(&mut first, timing, &input).torque,
                    there.update(&mut second, timing, &input).torque,
                ];
                assert_eq!(torques[0], torques[1], "{law:?}, {fuzzy:?}");
            }
        }
    }
}

#[test]
fn a_setup_that_does_not_work_is_refused_by_name() {
    let mut setup = Setup::for_robot(RobotParams::<f32, 3>::thesis(), LawKind::Bfsmc, 1e-3).expect("a robot");
    setup.stack.period = 0.0;
    let error = setup.build().expect_err("no period").to_string();
    assert_eq!(error, "control_period_s must be above zero");
}
