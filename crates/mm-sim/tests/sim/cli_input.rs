//! Bad usage and bad input end with exit code 2, say where and why, and leave nothing behind.
//!
//! Law: the message on standard error names the file as given, line, column, key and what was expected; standard output stays
//! empty; no file or folder is made.
//! Why: a typing error has to be found without reading the source, and must not cost an earlier run its log.
//! Reference: lines and columns counted by hand in the scenario below. No tolerance.

#![expect(clippy::expect_used, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::Folder;

/// A scenario to break.
const GOOD: &str = r#"name = "mine"

[simulation]
duration_s = 0.01
plant_step_s = 0.001
control_period_s = 0.001

[robot]
preset = "thesis"
base_mass_kg = 50.0

[trajectory]
kind = "hold"
point_m = [0.5, 0.0, 0.5]
"#;

fn broken(from: &str, to: &str) -> String {
    assert_eq!(GOOD.matches(from).count(), 1, "{from:?} is in the scenario once");
    GOOD.replace(from, to)
}

/// Whether the folder holds these files and nothing else.
fn holds_only(folder: &Folder, names: &[&str]) {
    let mut found: Vec<String> = std::fs::read_dir(folder.path(""))
        .expect("the folder")
        .map(|entry| entry.expect("an entry").file_name().into_string().expect("text"))
        .collect();
    found.sort();
    assert_eq!(found, names, "nothing but the input is there");
}

#[test]
fn each_bad_input_is_refused_with_its_place() {
    let cases: [(&str, &str, &str, &str, &str); 13] = [
        // what to break, how, place, key, what is expected
        ("plant_step_s", "plant_setp_s", "5:1", "simulation.plant_setp_s", "plant_step_s"),
        ("= 0.01\n", "= \"long\"\n", "4:14", "simulation.duration_s", "expected a number above 0"),
        ("50.0", "-50.0", "10:16", "robot.base_mass_kg", "expected a number above 0"),
        ("50.0", "nan", "10:16", "robot.base_mass_kg", "not a finite number"),
        ("\"thesis\"", "\"thesys\"", "9:10", "robot.preset", "expected `thesis`"),
        ("= 0.01\n", "= 0\n", "4:14", "simulation.duration_s", "expected a number above 0"),
        ("= 0.01\n", "= 0.0005\n", "4:14", "simulation.duration_s", "at least 0.001"),
        (
            "plant_step_s = 0.001",
            "plant_step_s = 0.0003",
            "5:16",
            "simulation.plant_step_s",
            "control_period_s = 0.001 over a whole number",
        ),
        ("0.0, 0.5]", "0.0, 2.0]", "14:11", "trajectory.point_m", "a height from"),
        ("\"hold\"", "\"holt\"", "13:8", "trajectory.kind", "`hold`"),
        ("[robot]", "[robbot]", "8:2", "robbot", "`robot`"),
        ("\"mine\"", "\"../mine\"", "1:8", "name", "no `/`"),
        ("[0.5, 0.0, 0.5]", "[0.5, 0.0]", "14:11", "trajectory.point_m", "3"),
    ];
    let folder = Folder::new("bad-input");
    folder.write("mine.toml", GOOD);
    folder.expect(0, &["--scenario", "mine.toml", "--no-log", "--quiet"]);
    for (from, to, place, key, expected) in cases {
        folder.write("mine.toml", &broken(from, to));
        for args in [
            &["--scenario", "mine.toml"] as &[&str],
            &["--scenario", "./mine.toml", "--out", "elsewhere", "--json"],
            &["scenario", "check", "mine.toml"],
            &["compare", "--scenario", "mine.toml", "--controllers", "bsmc,bfsmc"],
        ] {
            let ended = folder.expect(2, args);
            assert!(ended.stdout.is_empty(), "{to}: nothing on standard output:\n{}", ended.stdout);
            let file = if args.contains(&"./mine.toml") { "./mine.toml" } else { "mine.toml" };
            for part in [&format!("--> {file}:{place}"), key, expected] {
                assert!(ended.stderr.contains(part), "{part:?} is not in:\n{}", ended.stderr);
            }
            holds_only(&folder, &["mine.toml"]);
        }
    }
}

#[test]
fn a_bad_edit_is_refused_with_its_place() {
    let folder = Folder::new("bad-edit");
    for (set, place, expected) in [
        ("plant.mass_scale=-1", "--set:1:18", "expected a number above 0"),
        ("plant.mass_scale=nan", "--set:1:18", "not a finite number"),
        ("simulation.durations=1", "--set:1:1", "duration_s"),
        ("nothing", "--set:1:1", "KEY=VALUE"),
        ("controller.kind=pidd", "--set:1:17", "`pid`"),
        ("trajectory.kind=\"none\"", "--set:1:17", "`square`"),
        ("robot.link.0.mass_kg=0", "--set:1:22", "expected a number above 0"),
        ("initial.base_pose=[0, 0, 0]\"", "--set:1:19", "an array"),
    ] {
        let ended = folder.expect(2, &["--scenario", "square", "--set", set]);
        assert!(ended.stdout.is_empty(), "{set}: nothing on standard output");
        for part in [place, expected, "given over square"] {
            assert!(ended.stderr.contains(part), "{set}: {part:?} is not in:\n{}", ended.stderr);
        }
    }
    let ended = folder.expect(2, &["--scenario", "square", "--controller", "pidd"]);
    assert!(ended.stderr.contains("bfsmc-thesis, bfsmc"), "the laws there are:\n{}", ended.stderr);
    holds_only(&folder, &[]);
}

#[test]
fn bad_usage_is_refused() {
    let folder = Folder::new("bad-usage");
    for (args, says) in [
        (&[] as &[&str], "--scenario"),
        (&["run"], "--scenario"),
        (&["--scenario"], "--scenario"),
        (&["--scenario", "square", "--frobnicate"], "--frobnicate"),
        (&["frobnicate"], "frobnicate"),
        (&["--scenario", "square", "--seed", "many"], "many"),
        (&["--scenario", "square", "--seed", "18446744073709551616"], "18446744073709551616"),
        (&["compare", "--scenario", "square"], "--controllers"),
        (&["compare", "--scenario", "square", "--controllers", "bsmc,nope"], "nope"),
        (&["compare", "--controllers", "bsmc"], "--scenario"),
        (&["scenario", "check"], "FILE"),
        (&["scenario", "show", "nosuch"], "`nosuch`"),
        (&["--scenario", "nosuch.toml"], "`nosuch.toml`"),
        (&["--scenario", "no/such.toml"], "`no/such.toml`"),
        (&["--scenario", "."], "it is a folder"),
        (&["--scenario", "squar"], "the nearest known name is `square`"),
    ] {
        let ended = folder.expect(2, args);
        assert!(ended.stdout.is_empty(), "{args:?}: nothing on standard output:\n{}", ended.stdout);
        let said = ended.stderr.to_lowercase();
        assert!(said.contains(&says.to_lowercase()), "{args:?}: {says:?} is not in:\n{}", ended.stderr);
    }
    folder.write("empty.toml", "");
    let ended = folder.expect(2, &["--scenario", "empty.toml"]);
    for part in ["empty.toml", "name", "simulation", "trajectory"] {
        assert!(ended.stderr.contains(part), "an empty file lacks `{part}`:\n{}", ended.stderr);
    }
    std::fs::write(folder.path("latin1.toml"), b"name = \"\xe9\"\n").expect("a file of our own");
    folder.expect(2, &["--scenario", "latin1.toml"]);
    holds_only(&folder, &["empty.toml", "latin1.toml"]);
}

#[test]
fn an_earlier_log_outlives_a_bad_command() {
    let folder = Folder::new("earlier-log");
    folder.write("mine.toml", GOOD);
    folder.expect(0, &["--scenario", "mine.toml", "--quiet"]);
    let before = std::fs::read(folder.path("out/mine.mcap")).expect("the log");
    folder.write("mine.toml", &broken("0.0, 0.5]", "0.0, 2.0]"));
    folder.expect(2, &["--scenario", "mine.toml"]);
    assert_eq!(std::fs::read(folder.path("out/mine.mcap")).expect("the log"), before, "the log is untouched");
}

#[test]
fn a_scenario_as_an_argument_is_pointed_at_its_option() {
    let folder = Folder::new("argument");
    folder.write("my own.toml", "include = \"square\"\n");
    for args in
        [&["square"][..], &["run", "square.toml"], &["compare", "square", "--controllers", "bsmc,pid"]]
    {
        let ended = folder.expect(2, args);
        let name = args.iter().find(|arg| arg.starts_with("square")).expect("a scenario");
        let help = format!("help: a scenario is given with `mmsim --scenario {name}`");
        assert!(ended.stderr.contains(&help), "{args:?}:\n{}", ended.stderr);
    }
    let ended = folder.expect(2, &["my own.toml"]);
    assert!(ended.stderr.contains("--scenario 'my own.toml'"), "{}", ended.stderr);
    let ended = folder.expect(2, &["nonsense"]);
    assert!(!ended.stderr.contains("--scenario"), "no scenario of that name:\n{}", ended.stderr);
    let ended = folder.expect(2, &["robot", "export", "--robot", "thesi"]);
    assert!(
        ended.stderr.contains("there is no robot file thesi; expected a file, or `thesis`"),
        "{}",
        ended.stderr
    );
}
