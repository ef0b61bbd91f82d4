//! Every way to get a scenario wrong is answered with the file as given, line and column, the key, what was
//! found, what was expected and, for a name, the nearest known one.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_sim::experiment::Experiment;
use mm_sim::scenario::{self, Loaded, ScenarioError};

/// A scenario to break: the lines are counted in the tests below.
const GOOD: &str = r#"name = "test"

[simulation]
duration_s = 2
plant_step_s = 0.001
control_period_s = 0.001

[robot]
preset = "thesis"
base_mass_kg = 50.0

[trajectory]
kind = "circle"
center_m = [0.0, 0.0, 0.5]
radius_m = 1.0
speed_m_s = -0.3

[[disturbance]]
on = "joint1"
shape = "sine"
amplitude_n_m = 10.0
frequency_rad_s = 2.0
"#;

fn read(text: &str, sets: &[&str]) -> Result<Loaded, ScenarioError> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::from_text("my.toml", text, &sets)
}

/// Replaces one piece of the good scenario.
fn broken(from: &str, to: &str) -> String {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} is in the scenario once");
    GOOD.replace(from, to)
}

/// The rendered error, after checking its first problem's key and place and that it says all of `parts`.
fn fails(text: &str, sets: &[&str], key: &str, place: &str, parts: &[&str]) -> ScenarioError {
    let error = read(text, sets).err().unwrap_or_else(|| panic!("accepted, though {key} is wrong"));
    let shown = error.to_string();
    assert!(shown.is_ascii(), "plain text:\n{shown}");
    let problem = error.problems().first().unwrap_or_else(|| panic!("no problem in {shown}"));
    assert_eq!(problem.key(), key, "the key in:\n{shown}");
    let (name, line, column) = error.location(problem).unwrap_or_else(|| panic!("no place in {shown}"));
    assert_eq!(format!("{name}:{line}:{column}"), place, "the place in:\n{shown}");
    for part in [&format!("--> {place}"), key].iter().chain(parts) {
        assert!(shown.contains(*part), "{part:?} is not in:\n{shown}");
    }
    error
}

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
fn periods() {
    let text = broken("plant_step_s = 0.001", "plant_step_s = 0.0003");
    fails(
        &text,
        &[],
        "simulation.plant_step_s",
        "my.toml:5:16",
        &["found 0.0003, which does not divide the control period", "control_period_s = 0.001"],
    );
    let text = broken("plant_step_s = 0.001", "plant_step_s = 0.002");
    fails(&text, &[], "simulation.plant_step_s", "my.toml:5:16", &["found 0.002"]);
    let text = broken("duration_s = 2", "duration_s = 0.0005");
    fails(&text, &[], "simulation.duration_s", "my.toml:4:14", &["shorter than one control period"]);
    for steps in [1, 2, 3, 7, 10, 1000] {
        let step = format!("simulation.plant_step_s={}", 0.001 / f64::from(steps));
        assert!(read(GOOD, &[&step]).is_ok(), "{step} divides the period");
    }
}

#[test]
fn rules_between_keys() {
    let link = |limit: &str| format!("{GOOD}[[robot.link]]\njoint_limit_rad = {limit}\n");
    fails(&link("[1.0, -1.0]"), &[], "robot.link.0.joint_limit_rad", "my.toml:24:19", &["lo below hi"]);
    assert!(read(&link("[-1, 1.0]"), &[]).is_ok(), "a range in order");
    let text = broken("preset = \"thesis\"", "preset = \"thesis\"\nfile = \"nowhere.toml\"");
    fails(&text, &[], "robot.file", "my.toml:10:8", &["given together with `robot.preset`"]);
    let text = broken("frequency_rad_s = 2.0", "frequency_rad_s = 2.0\nfrom_s = 3.0\nto_s = 2.0");
    fails(&text, &[], "disturbance.0.to_s", "my.toml:24:8", &["found 2", "more than from_s = 3"]);
    let text = broken("\"joint1\"", "\"tip\"");
    fails(&text, &[], "disturbance.0.amplitude_n", "my.toml:18:1", &["missing key"]);
    let text = broken("name = \"test\"", "name = \"../test\"");
    fails(&text, &[], "name", "my.toml:1:8", &["not a file name"]);
    fails(GOOD, &["controller.kind=none"], "controller.kind", "--set:1:17", &["`velocities`"]);
    let text = "name = \"v\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"velocities\"\n\
                segment = [{ until_s = 0.5 }, { until_s = 0.5 }]\n";
    fails(text, &[], "trajectory.segment.1.until_s", "my.toml:6:43", &["more than the 0.5"]);
}

#[test]
fn ramps_of_the_reference() {
    let with = |keys: &str| broken("speed_m_s = -0.3", &format!("speed_m_s = -0.3\n{keys}"));
    let text = with("stop_at_s = 1.5");
    let expected = "given without `trajectory.stop_ramp_s`";
    fails(&text, &[], "trajectory.stop_at_s", "my.toml:17:13", &[expected, "expected both or none"]);
    let text = with("start_ramp_s = 1\nstop_ramp_s = 0.75\nstop_at_s = 1.5");
    let message = "rest at 1.5 s leaves no time for ramps of 1 and 0.75 s";
    fails(
        &text,
        &[],
        "trajectory.stop_at_s",
        "my.toml:19:13",
        &[message, "expected rest at 1.75 s or later"],
    );
    let text = with("start_ramp_s = 1\nstop_ramp_s = 1.5");
    let message = "rest at 2 s leaves no time for ramps of 1 and 1.5 s";
    fails(
        &text,
        &[],
        "trajectory.stop_ramp_s",
        "my.toml:18:15",
        &[message, "expected rest at 2.5 s or later"],
    );
    for good in ["start_ramp_s = 1\nstop_ramp_s = 1", "stop_ramp_s = 1\nstop_at_s = 1", "stop_ramp_s = 0"] {
        let accepted = read(&with(good), &[]);
        assert!(accepted.is_ok(), "{good}: {:?}", accepted.err());
    }
    let text = "name = \"v\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"velocities\"\n\
                segment = [{ until_s = 0.5 }]\nstop_ramp_s = 0.1\n";
    let parts = [
        "no ramp goes with kind = \"velocities\"",
        "expected none: the motion has its own beginning and end",
    ];
    fails(text, &[], "trajectory.stop_ramp_s", "my.toml:7:15", &parts);
    let text = with("smoothing_s = 1");
    let parts = ["not a key of kind = \"circle\"", "expected only with kind `square`"];
    fails(&text, &[], "trajectory.smoothing_s", "my.toml:17:1", &parts);
}

#[test]
fn waypoints() {
    let with = |points: &str| {
        format!(
            "name = \"w\"\n[simulation]\nduration_s = 1\n[trajectory]\nkind = \"waypoints\"\nspeed_m_s = 1\n\
             acceleration_m_s2 = 1\njerk_m_s3 = 1\n{points}"
        )
    };
    let two = "points_m = [[0, 0, 0.5], [1, 0, 0.5]]\n";
    let accepted = read(&with(two), &[]);
    assert!(accepted.is_ok(), "{:?}", accepted.err());
    fails(
        &with(""),
        &[],
        "trajectory.points_m",
        "my.toml:4:1",
        &["missing key", "an array of points, or `file`"],
    );
    let text = with("points_m = [[0, 0, 0.5]]\n");
    let parts = ["found 1 entry", "expected an array of at least 2 arrays of 3 numbers"];
    fails(&text, &[], "trajectory.points_m", "my.toml:9:12", &parts);
    let text = with("points_m = [[0, 0, 0.5], [1, 0.5]]\n");
    let parts = ["found 2 entries", "expected an array of 3 numbers"];
    fails(&text, &[], "trajectory.points_m.1", "my.toml:9:26", &parts);
    let text = with("points_m = [[0, 0, 0.5], [inf, 0, 0.5]]\n");
    fails(&text, &[], "trajectory.points_m.1.0", "my.toml:9:27", &["found inf, not a finite number"]);
    for (limit, line) in [("speed_m_s", "6:13"), ("acceleration_m_s2", "7:21"), ("jerk_m_s3", "8:13")] {
        for bad in ["0", "-1"] {
            let text = with(two).replace(&format!("{limit} = 1"), &format!("{limit} = {bad}"));
            let key = format!("trajectory.{limit}");
            let parts = [&format!("found {bad}"), "expected a number above 0"];
            fails(&text, &[], &key, &format!("my.toml:{line}"), &parts);
        }
    }
    let text = with("path = \"splines\"\n");
    let parts = ["`spline`, `lines`", "the nearest known name is `spline`"];
    let text = text + two;
    fails(&text, &[], "trajectory.path", "my.toml:9:8", &parts);
    let text = with(&format!("{two}file = \"path.csv\"\n"));
    let parts = ["given together with `trajectory.points_m`", "expected only one of the two"];
    fails(&text, &[], "trajectory.file", "my.toml:10:8", &parts);
    let text = with("file = \"nowhere.csv\"\n");
    let parts = ["cannot read `nowhere.csv`: ", "expected a file of points"];
    fails(&text, &[], "trajectory.file", "my.toml:9:8", &parts);
    let text = with("file = \"path.xlsx\"\n");
    let parts = ["found \"path.xlsx\", a file of unknown format", "expected a `.csv` or `.toml` file"];
    fails(&text, &[], "trajectory.file", "my.toml:9:8", &parts);
    let text = with(&format!("{two}start_ramp_s = 1\n"));
    let parts = ["no ramp goes with kind = \"waypoints\"", "expected none: the motion has its own"];
    fails(&text, &[], "trajectory.start_ramp_s", "my.toml:10:16", &parts);
}

/// What only building the motion shows; the place is that of the point.
#[test]
fn waypoints_that_make_no_motion() {
    let cases = [
        (
            "[[0, 0, 0.5], [1, 0, 0.5], [1, 0, 0.5]]",
            1.0,
            "trajectory.points_m.2",
            "point 2 is the same as the one before",
        ),
        (
            "[[0, 0, 0.5], [1e-7, 0, 0.5]]",
            1.0,
            "trajectory.points_m.1",
            "expected another point, 0.000001 m away or more",
        ),
        ("[[0, 0, 0.5], [1, 0, 1.6]]", 1.0, "trajectory.points_m.1", "which no posture reaches"),
        ("[[0, 0, 0.5], [1e300, 0, 0.5]]", 1.0, "trajectory.points_m", "the motion has no finite duration"),
        ("[[0, 0, 0.5], [1e10, 0, 0.5]]", 1e-300, "trajectory.points_m", "the motion has no finite duration"),
    ];
    for (points, speed, key, part) in cases {
        let text = format!(
            "name = \"w\"\n[simulation]\nduration_s = 60\n[trajectory]\nkind = \"waypoints\"\nspeed_m_s = {speed}\n\
             acceleration_m_s2 = 1\njerk_m_s3 = 1\npoints_m = {points}\n"
        );
        let loaded = read(&text, &[]).unwrap_or_else(|error| panic!("{error}"));
        let error =
            Experiment::build(&loaded).err().unwrap_or_else(|| panic!("{points} at {speed} m/s are built"));
        let shown = error.to_string();
        assert!(shown.contains(part) && shown.contains("--> my.toml:9:"), "{part:?} is not in:\n{shown}");
        assert_eq!(error.problems().first().map(scenario::Problem::key), Some(key), "the key in:\n{shown}");
    }
}

#[test]
fn unknown_metric() {
    let text = format!("{GOOD}[expect]\nitae_m_s.sum = {{ max = 1 }}\n");
    fails(&text, &[], "expect.itae_m_s", "my.toml:24:1", &["the nearest known name is `itae_m_s2`"]);
    let text = format!("{GOOD}[expect]\nmax_error_m = {{ min = 2, max = 1 }}\n");
    fails(&text, &[], "expect.max_error_m", "my.toml:24:15", &["min = 2 above max = 1"]);
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

#[test]
fn missing_file() {
    let cases = [
        ("sqare.toml", "`square`"),
        ("sqare", "`square`"),
        ("nowhere/spiral.toml", "`spiral`"),
        ("square-compar", "`square-compare`"),
        ("nothing-like-it.toml", "no bundled scenario of that name"),
    ];
    for (spec, near) in cases {
        let error = scenario::load(spec, &[]).err().unwrap_or_else(|| panic!("{spec} exists"));
        let shown = error.to_string();
        assert!(shown.contains(&format!("`{spec}`")) && shown.contains(near), "{spec}: {shown}");
    }
}

/// No text, however mangled, brings the reader down or makes it speak of a place outside the text.
#[test]
fn mangled_files_are_answered() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        usize::try_from(state >> 33).unwrap_or(0) % below
    };
    let pieces = [
        "[",
        "]]",
        "=",
        "\"",
        "\n",
        ".",
        "nan",
        "-1",
        "{",
        "}",
        "\u{e9}",
        "\t",
        "''",
        "[[robot.link]]\n",
        "\r\n",
    ];
    for (_, text) in scenario::bundled() {
        for _ in 0..150 {
            let mut characters: Vec<char> = text.chars().collect();
            for _ in 0..=random(4) {
                let at = random(characters.len());
                let until = (at + random(12)).min(characters.len());
                characters.splice(at..until, pieces[random(pieces.len())].chars());
            }
            let mangled: String = characters.into_iter().collect();
            let Err(error) = read(&mangled, &["robot.link.2.mass_kg=\u{e9}"]) else { continue };
            assert!(!error.to_string().is_empty(), "an answer to {mangled}");
            for problem in error.problems() {
                let lines = mangled.matches('\n').count() + 1;
                let line = error.location(problem).map_or(0, |(_, line, _)| line);
                assert!((1..=lines).contains(&line), "line {line} of {lines} in {mangled}");
            }
        }
    }
}

#[test]
fn a_hopeless_file_is_answered_briefly() {
    let text: String = (0..500).map(|index| format!("key{index} = 1\n")).collect();
    let shown = read(&text, &[]).err().map(|error| error.to_string()).unwrap_or_default();
    assert!(
        shown.ends_with("and 473 more") && shown.matches("error: ").count() == 30,
        "thirty of 503: {shown}"
    );
}

#[test]
fn a_file_that_is_no_text_is_refused_with_the_place_of_its_first_bad_byte() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("not_text.toml");
    std::fs::write(&path, b"name = \"a\"\nab\xff\xfe = 1\n").expect("a folder of our own");
    let error = scenario::load(&path.display().to_string(), &[]).expect_err("bytes are no scenario");
    let text = error.to_string();
    for part in ["not_text.toml", "line 2, column 3", "not UTF-8", "expected a TOML text"] {
        assert!(text.contains(part), "{part:?} is not in:\n{text}");
    }
}

#[test]
fn a_delay_is_drawn_only_where_an_estimator_runs() {
    let load = |more: &str| scenario::from_text("test.toml", &format!("{GOOD}{more}"), &[]);
    let drawn = "[sweep]\ndelay_periods = 2\n";
    for more in ["", "[plant.sensors]\ndelay_periods = 1\n", "[controller.estimator]\nkind = \"none\"\n"] {
        let text = format!("{more}{drawn}");
        let error = load(&text).err().unwrap_or_else(|| panic!("accepted: {text}")).to_string();
        for part in ["`sweep.delay_periods`", "test.toml:", "controller.estimator.kind"] {
            assert!(error.contains(part), "{part:?} is not in:\n{error}");
        }
    }
    for more in ["[plant.sensors]\nbits = 12\n", "[controller.estimator]\nkind = \"observer\"\n"] {
        load(&format!("{more}{drawn}")).unwrap_or_else(|error| panic!("{error}"));
    }
    let error = load("[plant.sensors]\nbits = 12\n[sweep]\ndelay_periods = 1001\n").err();
    assert!(error.is_some_and(|error| error.to_string().contains("1000")), "the most of it");
}
