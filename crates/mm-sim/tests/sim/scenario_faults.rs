//! What is wrong with `[controller.supervisor]` or a `[[fault]]` is said with place, key and what was expected.
//!
//! Laws: an unknown key or word names the nearest known one; a fault takes only the keys that its kind and target have, and all that it
//! needs; times go forward; a supervisor holds before it gives up. Why: a fault that silently does nothing proves nothing.
//! Reference: the messages, word by word. No tolerance.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_sim::experiment::Experiment;
use mm_sim::scenario::{self, Loaded, ScenarioError};

fn read(supervisor: &str, fault: &str) -> Result<Loaded, ScenarioError> {
    let text = format!(
        "name = \"test\"\n[simulation]\nduration_s = 2\n[trajectory]\nkind = \"sinusoid\"\n\
         [controller.supervisor]\n{supervisor}\n[[fault]]\n{fault}\nfrom_s = 0.5\n"
    );
    scenario::from_text("my.toml", &text, &[])
}

/// Checks the message of the only problem: its first line, its place, and all of `parts`.
fn says(error: &ScenarioError, (head, place): (&str, &str), parts: &[&str]) {
    let shown = error.to_string();
    assert_eq!(shown.lines().next(), Some(&*format!("error: {head}")), "the head of:\n{shown}");
    for part in [&*format!("--> {place}\n")].iter().chain(parts) {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
    assert_eq!(shown.matches("error: ").count(), 1, "one problem, one message:\n{shown}");
}

/// A fault whose keys are on the lines from 9 on.
fn fault(keys: &str, head: (&str, &str), parts: &[&str]) {
    let error = read("enabled = true", keys).err().unwrap_or_else(|| panic!("accepted: {keys}"));
    says(&error, head, parts);
}

/// A supervisor whose keys are on the lines from 7 on.
fn supervisor(keys: &str, head: (&str, &str), parts: &[&str]) {
    let good = "on = \"state\"\nkind = \"nan\"";
    let error = read(keys, good).err().unwrap_or_else(|| panic!("accepted: {keys}"));
    says(&error, head, parts);
}

#[test]
fn the_good_keys_are_good() {
    for keys in [
        "on = \"state\"\nkind = \"nan\"\nchannel = 10",
        "on = \"pose\"\nkind = \"offset\"\namplitude_m = 0.1\namplitude_rad = 0.1",
        "on = \"velocity\"\nkind = \"spike\"\namplitude_m_s = 1.0",
        "on = \"age\"\nkind = \"noise\"\namplitude_s = 0.001",
        "on = \"reference\"\nkind = \"scale\"\nfactor = 2.0",
        "on = \"joints\"\nkind = \"delay\"\ndelay_periods = 3",
        "on = \"clock\"\nkind = \"drop\"\nto_s = 0.6",
    ] {
        let loaded =
            read("enabled = true\nhold_periods = 3", keys).unwrap_or_else(|error| panic!("{keys}:\n{error}"));
        assert!(Experiment::build(&loaded).is_ok(), "{keys} is built");
    }
}

#[test]
fn unknown_keys_and_words_name_the_nearest() {
    supervisor(
        "hold_period = 2",
        ("`controller.supervisor.hold_period`: unknown key", "my.toml:7:1"),
        &["the nearest known name is `hold_periods`"],
    );
    let nan = "on = \"state\"\nkind = \"nan\"\n";
    fault(
        &format!("{nan}chanel = 2"),
        ("`fault.0.chanel`: unknown key", "my.toml:11:1"),
        &["the nearest known name is `channel`"],
    );
    fault(
        "on = \"joint\"\nkind = \"nan\"",
        ("`fault.0.on`: found a string, \"joint\"", "my.toml:9:6"),
        &[
            "expected one of `state`, `pose`, `joints`, `velocity`, `reference`, `clock`, `age`",
            "the nearest known name is `joints`",
        ],
    );
    fault(
        "on = \"pose\"\nkind = \"stcuk\"",
        ("`fault.0.kind`: found a string, \"stcuk\"", "my.toml:10:8"),
        &["the nearest known name is `stuck`"],
    );
    fault("kind = \"nan\"", ("`fault.0.on`: missing key", "my.toml:8:1"), &["expected one of `state`"]);
}

#[test]
fn a_kind_goes_with_its_targets() {
    for kind in ["drop", "duplicate", "stall"] {
        let head = format!("`fault.0.kind`: found \"{kind}\" with on = \"state\"");
        fault(
            &format!("on = \"state\"\nkind = \"{kind}\""),
            (&head, "my.toml:10:8"),
            &["expected on = \"clock\" with it"],
        );
    }
    for on in ["clock", "age"] {
        let head = format!("`fault.0.kind`: found \"delay\" with on = \"{on}\"");
        fault(
            &format!("on = \"{on}\"\nkind = \"delay\"\ndelay_periods = 2"),
            (&head, "my.toml:10:8"),
            &["expected what is measured, or `reference`"],
        );
    }
    for (on, count) in [("joints", 3), ("pose", 3), ("velocity", 5), ("reference", 3), ("age", 1)] {
        let head = format!("`fault.0.channel`: found {count}");
        fault(
            &format!("on = \"{on}\"\nkind = \"nan\"\nchannel = {count}"),
            (&head, "my.toml:11:11"),
            &[&*format!("expected less than {count}, since on = \"{on}\"")],
        );
    }
}

#[test]
fn a_fault_has_the_size_that_it_needs_and_no_other() {
    fault(
        "on = \"joints\"\nkind = \"offset\"",
        ("`fault.0.amplitude_rad`: missing key", "my.toml:8:1"),
        &["expected `amplitude_rad`, since kind = \"offset\""],
    );
    fault(
        "on = \"pose\"\nkind = \"noise\"",
        ("`fault.0.amplitude_m`: missing key", "my.toml:8:1"),
        &["expected `amplitude_m` or `amplitude_rad`, since kind = \"noise\""],
    );
    fault(
        "on = \"joints\"\nkind = \"spike\"\namplitude_m = 0.1",
        ("`fault.0.amplitude_m`: not a key of on = \"joints\"", "my.toml:11:15"),
        &["expected `amplitude_rad`"],
    );
    fault(
        "on = \"joints\"\nkind = \"nan\"\namplitude_rad = 0.1",
        ("`fault.0.amplitude_rad`: not a key of kind = \"nan\"", "my.toml:11:17"),
        &["expected `offset`, `spike` or `noise` with it"],
    );
    for (kind, key) in [("scale", "factor"), ("delay", "delay_periods")] {
        let head = format!("`fault.0.{key}`: missing key");
        let expected = format!("expected a value, since kind = \"{kind}\"");
        fault(&format!("on = \"joints\"\nkind = \"{kind}\""), (&head, "my.toml:8:1"), &[&*expected]);
        let head = format!("`fault.0.{key}`: not a key of kind = \"nan\"");
        let expected = format!("expected kind = \"{kind}\" with it");
        let keys = format!("on = \"joints\"\nkind = \"nan\"\n{key} = 2");
        fault(&keys, (&head, &format!("my.toml:11:{}", key.len() + 4)), &[&*expected]);
    }
}

#[test]
fn times_go_forward_and_a_robot_is_held_before_it_is_given_up() {
    for to in ["0.5", "0.1"] {
        let keys = format!("on = \"state\"\nkind = \"nan\"\nto_s = {to}");
        let head = format!("`fault.0.to_s`: found {to}");
        fault(&keys, (&head, "my.toml:11:8"), &["expected more than from_s = 0.5"]);
    }
    supervisor(
        "hold_periods = 9\nblind_periods = 9",
        ("`controller.supervisor.blind_periods`: found 9", "my.toml:8:17"),
        &["expected more than hold_periods = 9"],
    );
    let hold = ("`controller.supervisor.hold_periods`: found 101", "my.toml:7:16");
    supervisor("hold_periods = 101", hold, &["expected a whole number of at least 0 and of at most 100"]);
    let speed = ("`controller.supervisor.speed`: found 2 entries", "my.toml:7:9");
    supervisor("speed = [1.0, 2.0]", speed, &["expected an array of 5 numbers above 0"]);
}

/// What only the stack knows is refused when it is built, with its place all the same.
#[test]
fn what_does_not_fit_the_stack_is_refused_too() {
    let refused = |supervisor: &str, keys: &str| {
        let loaded = read(supervisor, keys).unwrap_or_else(|error| panic!("{error}"));
        Experiment::build(&loaded).err().unwrap_or_else(|| panic!("accepted: {supervisor}, {keys}"))
    };
    says(
        &refused("enabled = true\nblind_periods = 2", "on = \"state\"\nkind = \"nan\""),
        (
            "`controller.supervisor.blind_periods`: blind_periods must lie in its documented range",
            "my.toml:8:17",
        ),
        &["expected limits that a supervisor can work with"],
    );
    says(
        &refused("[plant.sensors]\njoint_bits = 14", "on = \"velocity\"\nkind = \"nan\""),
        ("`fault.0.on`: a velocity that is estimated, not measured", "my.toml:10:6"),
        &["expected `state`, `pose` or `joints`, which sensors read"],
    );
}

#[test]
fn an_imposed_motion_has_no_controller_to_mislead() {
    let sets = ["fault.0={on=\"state\", kind=\"nan\"}".to_owned()];
    let error = scenario::load("verify-straight", &sets).err().unwrap_or_else(|| panic!("accepted"));
    says(
        &error,
        ("`fault.0.on`: a fault without a controller", "--set:1:13"),
        &["expected a law as `controller.kind`"],
    );
}
