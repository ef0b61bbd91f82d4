//! Rules between keys of a scenario: what breaks one is answered with its place and what would keep it.

use mm_sim::experiment::Experiment;
use mm_sim::scenario;

use crate::common::scenario::{GOOD, broken, fails, read};

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
    // A hundred characters, but three hundred bytes: no file system takes that.
    let text = broken("name = \"test\"", &format!("name = \"{}\"", "€".repeat(100)));
    let error = read(&text, &[]).expect_err("a name that no file can have");
    let problem = error.problems().first().expect("a problem");
    assert_eq!((problem.key(), problem.message()), ("name", "300 bytes long"));
    assert_eq!(error.location(problem), Some(("my.toml", 1, 8)));
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
