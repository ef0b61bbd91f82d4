//! `[plant.scale]` and `initial.offset_m` change the plant and the start, and nothing that the controller knows.
//!
//! Law: every factor multiplies its parameter and no other; the tip starts off by the offset to rounding; defaults change no bit.
//! Why: a random plant is an ordinary scenario, made of these keys, that anybody can run again.
//! Reference: parameters scaled here by hand, the model's forward kinematics, the digest of `square` from before the keys
//! existed. Tolerance: 1e-12 m, a few thousand roundings of numbers of order one.

#![expect(clippy::panic, reason = "a helper that cannot go on is a failed test")]

use mm_sim::experiment::Experiment;
use mm_sim::scenario;
use mm_sim::simulation::{NoRecorder, Simulation};

fn build(sets: &[&str]) -> Simulation {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    let loaded = scenario::load("square", &sets).unwrap_or_else(|error| panic!("{error}"));
    match Experiment::build(&loaded) {
        Ok(Experiment::Closed(simulation)) => simulation,
        other => panic!("no closed loop: {other:?}"),
    }
}

#[test]
fn every_factor_reaches_its_parameter_of_the_plant_alone() {
    let before = build(&["plant.mass_scale=2"]);
    let after = build(&[
        "plant.mass_scale=2",
        "plant.scale.base_mass=1.5",
        "plant.scale.base_yaw_inertia=0.5",
        "plant.scale.base_com=3",
        "plant.scale.link_mass=[2, 3, 4]",
        "plant.scale.link_inertia=[5, 6, 7]",
        "plant.scale.link_com=[0.25, 0.5, 0.75]",
    ]);
    let mut wanted = *before.plant.robot().params();
    wanted.base_mass *= 1.5;
    wanted.base_yaw_inertia *= 0.5;
    wanted.base_com_offset *= 3.0;
    for (i, (mass, inertia, com)) in
        [(2.0, 5.0, 0.25), (3.0, 6.0, 0.5), (4.0, 7.0, 0.75)].into_iter().enumerate()
    {
        wanted.links[i].mass *= mass;
        wanted.links[i].axial_inertia *= inertia;
        wanted.links[i].pitch_inertia *= inertia;
        wanted.links[i].normal_inertia *= inertia;
        wanted.links[i].com *= com;
    }
    assert_eq!(*after.plant.robot().params(), wanted, "parameters of the plant");
    assert_eq!(after.stack, before.stack, "the controller knows none of them");
    assert_eq!(after.initial, before.initial, "the start is that of the known robot");
}

#[test]
fn the_tip_starts_off_by_the_offset() {
    let before = build(&[]);
    let robot = *before.plant.robot();
    let tip = robot.tip_position(&before.initial.q);
    for offset in [[0.05, 0.0, 0.0], [0.0, -0.05, 0.0], [0.0, 0.0, 0.05], [0.01, 0.02, -0.2]] {
        let [x, y, z] = offset;
        let after = build(&[&format!("initial.offset_m=[{x}, {y}, {z}]")]);
        let moved = robot.tip_position(&after.initial.q) - tip;
        for (axis, (moved, wanted)) in moved.iter().zip(offset).enumerate() {
            assert!((moved - wanted).abs() < 1e-12, "axis {axis} of {offset:?}: {moved}");
        }
        let [first, second, third] = after.initial.q.joints;
        assert!(
            first.abs() < 1e-12 && after.initial.q.heading.to_bits() == before.initial.q.heading.to_bits(),
            "no turn"
        );
        assert!(third < 0.0 && second > 0.0, "the elbow stays up: {:?}", after.initial.q.joints);
        assert_eq!(after.trajectory.at(0.0), before.trajectory.at(0.0), "the reference stays");
    }
}

#[test]
fn a_start_out_of_reach_or_without_a_reference_is_refused() {
    for (name, set, part) in [
        ("square", "initial.offset_m=[0, 0, 2]", "no posture within the joint limits"),
        ("verify-straight", "initial.offset_m=[0.1, 0, 0]", "no reference to start off"),
    ] {
        let loaded = scenario::load(name, &[set.to_owned()]).unwrap_or_else(|error| panic!("{error}"));
        let Err(error) = Experiment::build(&loaded) else { panic!("{set} was accepted") };
        let text = error.to_string();
        assert!(text.contains(part) && text.contains("--set:1:18"), "{part:?} is not in:\n{text}");
    }
}

#[test]
fn defaults_change_no_bit() {
    let Ok(result) = build(&[]).run(&mut NoRecorder);
    assert_eq!(result.digest, "f1f4979cbc947f5605cf553fad527c67", "square with bfsmc, as it was");
}
