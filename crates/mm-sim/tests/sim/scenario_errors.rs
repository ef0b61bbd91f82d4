//! Every way to get a scenario wrong is answered with the file as given, line and column, the key, what was
//! found, what was expected and, for a name, the nearest known one.

use mm_sim::scenario;

use crate::common::scenario::{GOOD, broken, fails, read};

#[test]
fn the_good_scenario_is_good() {
    let loaded = read(GOOD, &[]).unwrap_or_else(|error| panic!("{error}"));
    assert!((loaded.file.simulation.duration_s - 2.0).abs() < 1e-12, "an integer serves as a float");
}

#[test]
fn misspelt_key() {
    let text = broken("plant_step_s =", "plant_setp_s =");
    fails(
        &text,
        &[],
        "simulation.plant_setp_s",
        "my.toml:5:1",
        &["unknown key", "`control_period_s`", "the nearest known name is `plant_step_s`"],
    );
}

#[test]
fn forgotten_unit() {
    let text = broken("base_mass_kg", "base_mass");
    fails(&text, &[], "robot.base_mass", "my.toml:10:1", &["the nearest known name is `base_mass_kg`"]);
}

#[test]
fn key_in_the_wrong_table() {
    let text = broken("base_mass_kg = 50.0", "seed = 3");
    fails(&text, &[], "robot.seed", "my.toml:10:1", &["the nearest known name is `simulation.seed`"]);
}

#[test]
fn misspelt_table() {
    let text = broken("[robot]", "[robbot]");
    fails(&text, &[], "robbot", "my.toml:8:2", &["the nearest known name is `robot`"]);
}

#[test]
fn wrong_type() {
    let text = broken("duration_s = 2", "duration_s = \"long\"");
    fails(
        &text,
        &[],
        "simulation.duration_s",
        "my.toml:4:14",
        &["found a string, \"long\"", "expected a number above 0"],
    );
    let text = broken("[[disturbance]]", "[disturbance]");
    fails(&text, &[], "disturbance", "my.toml:18:1", &["found a table", "expected an array of tables"]);
    let text = broken("duration_s = 2", "duration_s = 2024-01-01");
    fails(&text, &[], "simulation.duration_s", "my.toml:4:14", &["found a date or time"]);
}

#[test]
fn negative_mass() {
    let text = broken("50.0", "-50.0");
    fails(&text, &[], "robot.base_mass_kg", "my.toml:10:16", &["found -50.0", "expected a number above 0"]);
}

#[test]
fn not_a_finite_number() {
    for number in ["nan", "-nan", "inf", "-inf", "1e999"] {
        let text = broken("-0.3", number);
        fails(&text, &[], "trajectory.speed_m_s", "my.toml:16:13", &[number, "not a finite number"]);
        let text = broken("[0.0, 0.0, 0.5]", &format!("[0.0, {number}, 0.5]"));
        fails(&text, &[], "trajectory.center_m.1", "my.toml:14:18", &[number, "not a finite number"]);
    }
}

#[test]
fn wrong_array_length() {
    let text = broken("[0.0, 0.0, 0.5]", "[0.0, 0.5]");
    fails(
        &text,
        &[],
        "trajectory.center_m",
        "my.toml:14:12",
        &["found 2 entries", "expected an array of 3 numbers"],
    );
    let links = format!("{GOOD}[[robot.link]]\n[[robot.link]]\n[[robot.link]]\n[[robot.link]]\n");
    let error = read(&links, &[]).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(error.contains("found 4 entries"), "a fourth link is refused: {error}");
}

#[test]
fn unknown_preset() {
    let text = broken("\"thesis\"", "\"theses\"");
    fails(
        &text,
        &[],
        "robot.preset",
        "my.toml:9:10",
        &["found a string, \"theses\"", "expected `thesis`", "the nearest known name is `thesis`"],
    );
}

#[test]
fn unknown_kind() {
    let text = broken("\"circle\"", "\"circel\"");
    let error = fails(
        &text,
        &[],
        "trajectory.kind",
        "my.toml:13:8",
        &["`velocities`", "the nearest known name is `circle`"],
    );
    assert_eq!(error.problems().len(), 1, "the keys of a circle are not held against an unknown kind");
}

#[test]
fn key_of_another_kind() {
    let text = broken("\"circle\"", "\"hold\"");
    fails(
        &text,
        &[],
        "trajectory.center_m",
        "my.toml:14:1",
        &["not a key of kind = \"hold\"", "expected only with kind `circle`"],
    );
    let text = broken("frequency_rad_s = 2.0", "hold_s = 2.0");
    fails(&text, &[], "disturbance.0.frequency_rad_s", "my.toml:18:1", &["missing key"]);
}

#[test]
fn missing_keys() {
    let text = broken("radius_m = 1.0\n", "");
    fails(&text, &[], "trajectory.radius_m", "my.toml:12:1", &["missing key", "expected a number above 0"]);
    let text = broken("kind = \"circle\"\n", "");
    fails(&text, &[], "trajectory.kind", "my.toml:12:1", &["missing key", "`square`"]);
}

#[test]
fn empty_file() {
    for text in ["", "\n", "# nothing\n"] {
        let error = fails(
            text,
            &[],
            "name",
            "my.toml:1:1",
            &["missing key", "`simulation.duration_s`: missing key", "`trajectory.kind`: missing key"],
        );
        assert_eq!(error.problems().len(), 3, "the three required keys");
    }
}

#[test]
fn several_errors_at_once() {
    let text = broken("duration_s = 2", "duration_s = 0")
        .replace("50.0", "-50.0")
        .replace("\"joint1\"", "\"joint7\"")
        .replace("plant_step_s = 0.001", "plant_step_s = 0.0007");
    let error =
        fails(&text, &["controller.kind=bfsm"], "simulation.duration_s", "my.toml:4:14", &["found 0"]);
    let keys: Vec<&str> = error.problems().iter().map(scenario::Problem::key).collect();
    let expected = [
        "simulation.duration_s",
        "simulation.plant_step_s",
        "robot.base_mass_kg",
        "disturbance.0.on",
        "controller.kind",
    ];
    assert_eq!(keys, expected, "all problems, in the order of the file");
}

#[test]
fn syntax_errors() {
    fails(&broken("duration_s = 2", "duration_s = "), &[], "", "my.toml:4:14", &["not TOML"]);
    fails(&broken("[robot]", "[robot"), &[], "", "my.toml:8:7", &["not TOML"]);
    fails(&broken("base_mass_kg", "preset"), &[], "", "my.toml:10:1", &["not TOML", "duplicate key"]);
}

#[test]
fn columns_count_characters() {
    let text = broken("name = \"test\"", "name = \"t\u{e9}st\" \u{e9}");
    let error = read(&text, &[]).err().unwrap_or_else(|| panic!("accepted"));
    let place = error.problems().first().and_then(|problem| error.location(problem));
    assert_eq!(place, Some(("my.toml", 1, 15)), "the column counts characters, not bytes");
}

/// What stands before the first error of syntax is checked as well; what a line went wrong by is said once.
#[test]
fn syntax_errors_hide_nothing_before_them() {
    let text = broken("plant_step_s =", "plant_setp_s =")
        .replace("[trajectory]", "[trajectory")
        .replace("1.0", "= = 1.0");
    let error =
        fails(&text, &[], "simulation.plant_setp_s", "my.toml:5:1", &["not TOML", "--> my.toml:12:12"]);
    let lines: Vec<usize> = error
        .problems()
        .iter()
        .filter_map(|problem| error.location(problem))
        .map(|(_, line, _)| line)
        .collect();
    assert_eq!(lines, [5, 12, 15], "one a line:\n{error}");
    assert!(!error.to_string().contains("missing key"), "keys may follow:\n{error}");
}
