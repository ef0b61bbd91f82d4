//! Points from a CSV or TOML file are the points of the scenario, and a bad file is answered with its place.
//!
//! Laws: the same points make the same motion to the bit, whichever way they come; every mistake gives one message with file, line,
//! column, what was found and what was expected.
//! Why: such files come out of spreadsheets and other programs, and a point that is read wrongly moves a machine.
//! Reference: the points written into the scenario; messages and places counted by hand.
//! Tolerance: none.

#![expect(clippy::expect_used, reason = "a helper of tests reports like a test")]

use mm_sim::experiment::Experiment;
use mm_sim::scenario;
use mm_tests::{closed, load, load_text};

const SCENARIO: &str = "name = \"w\"\n[simulation]\nduration_s = 5\n[trajectory]\nkind = \"waypoints\"\n\
                        speed_m_s = 0.3\nacceleration_m_s2 = 0.5\njerk_m_s3 = 1.0\n";

#[test]
fn points_from_files_are_the_points_of_the_scenario() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("waypoints");
    std::fs::create_dir_all(&folder).expect("a folder of our own");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.join(name), text).expect("a folder of our own");
        folder.join(name).display().to_string()
    };
    let list = "points_m = [[0.1, -2e-1, 0.5], [1, 0.25, 0.75], [2.0, 0.0, 0.6]]\n";
    let inline = closed(&load_text("inline", &format!("{SCENARIO}{list}"), &[])).trajectory;
    let csv = "x_m,y_m,z_m\n0.1,-2e-1,0.5\n\n1, 0.25 ,0.75\n2.0,0.0,0.6\n";
    write("path.csv", csv);
    write("dos.CSV", &format!("\u{feff}{}", csv.replace('\n', "\r\n")));
    write("path.toml", list);
    for name in ["path.csv", "dos.CSV", "path.toml"] {
        let spec = write("scenario.toml", &format!("{SCENARIO}file = \"{name}\"\n"));
        let loaded = load(&spec, &[]);
        let text = std::fs::read_to_string(folder.join(name)).expect("written above");
        let path = folder.join(name).display().to_string();
        assert!(loaded.files().eq([(path.as_str(), text.as_str())]), "{name} goes into the log");
        let from_file = closed(&loaded).trajectory;
        assert_eq!(from_file, inline, "{name} beside the scenario");
        let set = format!("trajectory.file={}", folder.join(name).display());
        let from_set = closed(&load_text("set", &format!("{SCENARIO}{list}"), &[&set])).trajectory;
        assert_eq!(from_set, inline, "{name} by --set, in the place of the scenario's own points");
    }
}

/// The texts of the problems that a file of points gives, with their places.
fn complaints(name: &str, text: &[u8]) -> String {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("bad_waypoints");
    std::fs::create_dir_all(&folder).expect("a folder of our own");
    std::fs::write(folder.join(name), text).expect("a folder of our own");
    let spec = folder.join(format!("{name}.scenario.toml"));
    std::fs::write(&spec, format!("{SCENARIO}file = \"{name}\"\n")).expect("a folder of our own");
    let built = scenario::load(&spec.display().to_string(), &[])
        .and_then(|loaded| Experiment::build(&loaded).map(|_| ()));
    let shown = built.expect_err("a bad file").to_string();
    shown.replace(&format!("{}/", folder.display()), "")
}

#[test]
fn bad_files_are_answered_with_their_place() {
    let head = "x_m,y_m,z_m\n0,0,0.5\n";
    let long = format!("{head}1,0,0.5\n{}", "9".repeat(400));
    let cases: [(&str, &str, &[&str]); 14] = [
        (
            "columns.csv",
            &format!("{head}1,0\n"),
            &["columns.csv:3:1", "found 2 columns", "3 columns, `x_m,y_m,z_m`"],
        ),
        ("one.csv", &format!("{head}1;0;0.5\n"), &["one.csv:3:1", "found 1 column\n", "expected 3 columns"]),
        (
            "text.csv",
            &format!("{head}1, up,0.5\n"),
            &["text.csv:3:4", "found `up`", "expected a finite number"],
        ),
        ("nan.csv", &format!("{head}1,0,nan\n"), &["nan.csv:3:5", "found `nan`", "expected a finite number"]),
        (
            "inf.csv",
            &format!("{head}-inf,0,0.5\n"),
            &["inf.csv:3:1", "found `-inf`", "expected a finite number"],
        ),
        ("big.csv", &format!("{head}1,0,1e999\n"), &["big.csv:3:5", "found `1e999`"]),
        (
            "gap.csv",
            &format!("{head}1,,0.5\n"),
            &["gap.csv:3:3", "found nothing", "expected a finite number"],
        ),
        ("long.csv", &long, &["long.csv:4:1", "found 1 column"]),
        (
            "bare.csv",
            "0,0,0.5\n1,0,0.5\n",
            &["bare.csv:1:1", "found the header `0,0,0.5`", "the header `x_m,y_m,z_m`"],
        ),
        ("empty.csv", "", &["empty.csv:1:1", "found nothing", "expected the header `x_m,y_m,z_m`"]),
        (
            "few.csv",
            head,
            &["few.csv:1:1", "found 1 of at least 2 points", "expected 2 lines of numbers or more"],
        ),
        (
            "same.csv",
            &format!("{head}1,0,0.5\n\n1,0,0.5\n"),
            &["same.csv:5:1", "point 2 is the same as the one before"],
        ),
        (
            "high.csv",
            &format!("{head}1,0,9\n"),
            &["high.csv:3:1", "which no posture reaches", "a height from"],
        ),
        ("points.txt", head, &["unknown format", "a `.csv` or `.toml` file"]),
    ];
    for (name, text, parts) in cases {
        let shown = complaints(name, text.as_bytes());
        for part in parts {
            assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
        }
        assert_eq!(shown.matches("error: ").count(), 1, "one error in:\n{shown}");
    }
    let cases: [(&str, &str, &[&str]); 5] = [
        (
            "key.toml",
            "point_m = [[0, 0, 0.5], [1, 0, 0.5]]\n",
            &["key.toml:1:1", "nearest known name is `points_m`"],
        ),
        (
            "two.toml",
            "points_m = [[0, 0, 0.5], [1, 0.5]]\n",
            &["two.toml:1:26", "found 2 entries", "an array of 3 numbers"],
        ),
        ("few.toml", "points_m = [[0, 0, 0.5]]\n", &["few.toml:1:12", "at least 2 arrays of 3 numbers"]),
        ("nan.toml", "points_m = [[0, 0, 0.5], [nan, 0, 0.5]]\n", &["nan.toml:1:27", "not a finite number"]),
        ("broken.toml", "points_m = [[0, 0, 0.5]\n", &["broken.toml:", "not TOML"]),
    ];
    for (name, text, parts) in cases {
        let shown = complaints(name, text.as_bytes());
        for part in parts {
            assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
        }
    }
    let shown = complaints("bytes.csv", b"x_m,y_m,z_m\n0,\xff,1\n");
    for part in
        ["bytes.csv.scenario.toml:9:8", "cannot read `bytes.csv`", "line 2, column 3", "expected a CSV text"]
    {
        assert!(shown.contains(part), "{part:?} is not in:\n{shown}");
    }
}
