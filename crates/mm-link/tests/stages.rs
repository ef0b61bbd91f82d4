//! Check sums by stage: a change in one signal shows in the stage that computes it, and in no earlier one.
//!
//! Law: for every signal of an update, changing one of its numbers by the last bit changes the sum of its stage and of none before. The twin is
//! the list below, which names each field of the output by hand.

#![expect(clippy::expect_used, reason = "helpers of tests")]

use mm_control::{Input, LawKind, Output, Reference};
use mm_link::signals::{SIGNALS, Stage, numbers};
use mm_link::{Setup, Stages};
use mm_model::{Configuration, RobotParams, Velocity};
use nalgebra::Vector3;

/// What changes one number of one signal.
type Change = (&'static str, Stage, fn(&mut Output<f64, 3>) -> &mut f64);

const CHANGES: [Change; 16] = [
    ("nu", Stage::Estimate, |output| &mut output.signals.nu.yaw_rate),
    ("tip", Stage::Kinematics, |output| &mut output.signals.tip.z),
    ("error", Stage::Kinematics, |output| &mut output.signals.error.x),
    ("nu_c", Stage::Kinematics, |output| &mut output.signals.nu_c.joints[2]),
    ("manipulability_squared", Stage::Kinematics, |output| &mut output.signals.manipulability_squared),
    ("damping_squared", Stage::Kinematics, |output| &mut output.signals.damping_squared),
    ("nu_r", Stage::Dynamics, |output| &mut output.signals.nu_r.forward),
    ("dnu_r", Stage::Dynamics, |output| &mut output.signals.dnu_r.joints[0]),
    ("sliding", Stage::Dynamics, |output| &mut output.signals.sliding.joints[1]),
    ("equivalent", Stage::Dynamics, |output| &mut output.signals.equivalent.yaw),
    ("fuzzy", Stage::Fuzzy, |output| &mut output.signals.fuzzy.joints[2]),
    ("learned", Stage::Fuzzy, |output| &mut output.signals.learned.forward),
    ("commanded", Stage::Torque, |output| &mut output.signals.commanded.right),
    ("commanded", Stage::Torque, |output| &mut output.signals.commanded.joints[2]),
    ("torque", Stage::Torque, |output| &mut output.torque.left),
    ("torque", Stage::Torque, |output| &mut output.torque.joints[0]),
];

fn output() -> Output<f64, 3> {
    let setup = Setup::for_robot(RobotParams::<f64, 3>::thesis(), LawKind::Bfsmc, 1e-3).expect("a setup");
    let stack = *setup.build().expect("a stack").stack();
    let q = Configuration { x: 0.1, y: -0.2, heading: 3.0, joints: [0.3, 1.0 / 3.0, -2.0] };
    let nu = Velocity { forward: 0.5, yaw_rate: -0.25, joints: [0.1, 0.2, 0.3] };
    let position = Vector3::new(0.5, -0.5, 0.75);
    let reference = Reference { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() };
    stack.update(&mut stack.initial_state(), &Input { q, nu, reference }).expect("an update")
}

#[test]
fn a_change_shows_in_the_stage_that_computes_it() {
    let before = output();
    let sums = Stages::of(&before);
    assert_eq!(sums.first_difference(&sums), None, "nothing differs from itself");
    for (name, stage, field) in CHANGES {
        let mut after = before;
        let number = field(&mut after);
        *number = f64::from_bits(number.to_bits() ^ 1);
        assert_eq!(Stages::of(&after).first_difference(&sums), Some(stage), "{name}");
        let place = numbers(&after).zip(numbers(&before)).position(|(a, b)| a.to_bits() != b.to_bits());
        let signal = mm_link::signals::signal(place.expect("a difference"));
        assert_eq!((signal.name, signal.stage), (name, stage), "the number's place");
    }
    let mut after = before;
    after.status.joint_limited ^= true;
    assert_eq!(Stages::of(&after).first_difference(&sums), Some(Stage::Torque), "outcomes");
}

#[test]
fn stages_follow_each_other_and_every_signal_is_named() {
    assert!(SIGNALS.is_sorted_by_key(|(stage, _, _)| *stage as u8), "in the order of the computation");
    for (_, name, _) in SIGNALS {
        assert!(CHANGES.iter().any(|(other, _, _)| *other == name), "{name} is not tried");
    }
    assert_eq!(numbers(&output()).count(), mm_link::signals::COUNT, "all of them");
}
