//! Runs that end otherwise than planned say so by exit code and message, and keep their log.
//!
//! Law: 1 for a run that diverged, was interrupted or could not be written; 3 for a finished run of the file as it stands that
//! misses its [expect], which is a warning as soon as anything was changed; a log is finished whatever ends the run.
//! Why: scripts branch on the code, people want to look into the run that failed.
//! Reference: the interface; the `mcap` crate reads the logs. No tolerance.

#![expect(clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::{Folder, complete_log, ended};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A reference that runs away from wheels of little torque: 3 m/s at 0.1 N m.
const RUNAWAY: &str = "name = \"away\"\n[simulation]\nduration_s = 10\n[robot]\nwheel_torque_limit_n_m = 0.1\n\
    [trajectory]\nkind = \"line\"\nfrom_m = [0.5, 0.0, 0.5]\nvelocity_m_s = [3.0, 0.0, 0.0]\n";

/// A spiral too short to come down to its reference, with a bound that it cannot keep.
const MISSES: &str = "name = \"short\"\n[simulation]\nduration_s = 0.1\n[trajectory]\nkind = \"spiral\"\n\
    [expect]\nmax_error_m = { max = 0.01 }\nsettling_time_s = { max = 0.05 }\n";

/// A controller that hears nothing more from 0.5 s on.
const LOST: &str = "name = \"lost\"\n[simulation]\nduration_s = 2\n[trajectory]\nkind = \"sinusoid\"\n\
    [controller.supervisor]\nenabled = true\n[[fault]]\non = \"clock\"\nkind = \"drop\"\nfrom_s = 0.5\n";

fn summary(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("not one JSON object ({error}):\n{text}"))
}

#[test]
fn a_run_that_diverges_says_when_and_what_and_keeps_its_log() {
    let folder = Folder::new("diverges");
    folder.write("away.toml", RUNAWAY);
    let ended = folder.expect(1, &["--scenario", "away.toml", "--json"]);
    let value = summary(&ended.stdout);
    let warning = value["warnings"].to_string();
    for part in ["diverged at t = 3.", "distance of the tip from its reference (m)"] {
        assert!(ended.stderr.contains(part), "{part:?} is not in:\n{}", ended.stderr);
        assert!(warning.contains(part), "{part:?} is not in the warnings {warning}");
    }
    assert!(ended.stderr.contains("away.toml"), "the file is named:\n{}", ended.stderr);
    assert!(ended.stderr.contains("out/away.mcap"), "the log is named:\n{}", ended.stderr);
    assert_eq!(value["ended"], "diverged", "in a word");
    let until = value["simulated_s"].as_f64().expect("a number");
    assert!(warning.contains(&format!("diverged at t = {until:.3} s")), "up to {until} s, not {warning}");
    let largest = value["metrics"]["max_error_m"].as_f64().expect("a number");
    assert!(largest > 10.0 && largest < 10.1, "the error that ended the run counts, not {largest} m");
    let log = complete_log(&folder.path("out/away.mcap"));
    assert_eq!(log.result["outcome"], "diverged", "how it ended");
    assert!(log.topics["/control"] > 300, "what led there is in the log: {:?}", log.topics);
    assert_eq!(summary(&log.attachments["summary.json"]), value, "the summary is in the log");
}

#[test]
fn a_robot_that_is_given_up_fails_the_run_and_says_what_the_supervisor_did() {
    let folder = Folder::new("lost");
    folder.write("lost.toml", LOST);
    let ended = folder.expect(1, &["--scenario", "lost.toml", "--json"]);
    let told = "the supervisor gave up at t = 1.000 s (missed); the simulated robot has no brakes";
    let did = "the supervisor found 501 missed, first missed at t = 0.500 s; it held the torque for 2 updates, stopped it 1 \
               time(s), first at t = 0.502 s, for 498 updates";
    for line in [format!("error: lost.toml: {told}"), format!("warning: {did}")] {
        assert!(ended.stderr.lines().any(|said| said == line), "{line:?} is not in:\n{}", ended.stderr);
    }
    assert!(ended.stderr.contains("out/lost.mcap"), "the log is named:\n{}", ended.stderr);
    let value = summary(&ended.stdout);
    assert_eq!((&value["ended"], &value["simulated_s"]), (&"fault".into(), &1.0.into()));
    assert_eq!(value["warnings"], serde_json::json!([did, told]), "both among the warnings");
    let expected = serde_json::json!({
        "mode": "fault", "held_periods": 2, "stopped_periods": 498, "stops": 1, "first_stop_s": 0.502,
        "findings": [{ "finding": "missed", "periods": 501, "first_s": 0.5 }],
    });
    assert_eq!(value["supervisor"], expected, "2 held, 500 blind, the next is a fault");
    let log = complete_log(&folder.path("out/lost.mcap"));
    assert_eq!(log.result["outcome"], "fault", "how it ended");
    let unsupervised = folder.expect(
        0,
        &["--scenario", "lost.toml", "--json", "--no-log", "--set", "controller.supervisor.enabled=false"],
    );
    assert!(summary(&unsupervised.stdout)["supervisor"].is_null(), "nothing to tell without one");
}

#[test]
fn a_run_that_is_over_at_once_has_a_summary_too() {
    let folder = Folder::new("at-once");
    folder.write("away.toml", &RUNAWAY.replace("[0.5, 0.0, 0.5]", "[50.0, 0.0, 0.5]"));
    let ended =
        folder.expect(1, &["--scenario", "away.toml", "--set", "initial.base_pose=[0, 0, 0]", "--json"]);
    let value = summary(&ended.stdout);
    assert!(value["metrics"]["min_manipulability"].is_null(), "null where nothing was seen, never infinite");
    assert!(ended.stderr.contains("diverged at t = 0.000 s"), "when:\n{}", ended.stderr);
    let log = complete_log(&folder.path("out/away.mcap"));
    assert_eq!(log.result["outcome"], "diverged", "how it ended");
    assert_eq!(log.result["samples"], "0", "without a sample");
}

#[test]
fn a_missed_expectation_is_3_as_the_file_stands_and_a_warning_otherwise() {
    let folder = Folder::new("misses");
    folder.write("short.toml", MISSES);
    let ended = folder.expect(3, &["--scenario", "short.toml", "--no-log"]);
    assert!(ended.stdout.contains("ITAE"), "the run finished, its table is there");
    for part in ["max_error_m is 0.2", "at most 0.01", "settling_time_s is not defined"] {
        assert!(ended.stderr.contains(part), "{part:?} is not in:\n{}", ended.stderr);
    }
    for change in [&["--set", "description=changed"] as &[&str], &["--controller", "bfsmc"], &["--seed", "0"]]
    {
        let args = [&["--scenario", "short.toml", "--no-log", "--json"], change].concat();
        let ended = folder.expect(0, &args);
        let warnings = summary(&ended.stdout)["warnings"].to_string();
        for said in [&warnings, &ended.stderr] {
            assert!(said.contains("max_error_m is 0.2"), "with {change:?} a warning:\n{said}");
        }
    }
    let args = ["compare", "--scenario", "short.toml", "--controllers", "bfsmc", "--no-log"];
    let ended = folder.expect(0, &args);
    assert!(ended.stderr.contains("max_error_m is 0.2"), "a warning in a comparison:\n{}", ended.stderr);
}

#[test]
fn a_log_that_cannot_be_written_fails_the_run() {
    let folder = Folder::new("unwritable");
    folder.write("out", "a file where the folder should be");
    let args = ["--scenario", "square", "--set", "simulation.duration_s=0.1", "--quiet"];
    let ended = folder.expect(1, &args);
    assert!(ended.stderr.contains("out"), "what cannot be made:\n{}", ended.stderr);
    folder.expect(0, &[&args[..], &["--no-log"]].concat());
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_named_as_the_reason() {
    let folder = Folder::new("full");
    std::fs::create_dir(folder.path("out")).expect("a folder");
    std::os::unix::fs::symlink("/dev/full", folder.path("out/square.mcap")).expect("a link");
    let ended = folder.expect(1, &["--scenario", "square", "--set", "simulation.duration_s=20", "--quiet"]);
    assert!(ended.stderr.contains("out/square.mcap"), "which file:\n{}", ended.stderr);
    assert!(ended.stderr.contains("No space left"), "and why:\n{}", ended.stderr);
}

#[test]
fn a_log_that_another_run_writes_is_left_alone() {
    let folder = Folder::new("busy");
    let args = ["--scenario", "square", "--set", "simulation.duration_s=100000", "--quiet"];
    let mut first = folder.command(&args).spawn().expect("the binary starts");
    let log = folder.path("out/square.mcap");
    let begin = Instant::now();
    while std::fs::metadata(&log).map_or(0, |file| file.len()) < 50_000 {
        assert!(begin.elapsed() < Duration::from_secs(60), "the first run writes");
        std::thread::sleep(Duration::from_millis(20));
    }
    let second = folder.expect(1, &["--scenario", "square", "--set", "simulation.duration_s=0.1", "--quiet"]);
    assert!(second.stderr.contains("another run writes the log ./out/square.mcap"), "{}", second.stderr);
    let length = std::fs::metadata(&log).expect("the log").len();
    assert!(length >= 50_000, "nothing of it is cut off: {length}");
    first.kill().expect("a child");
    first.wait().expect("a child");
    folder.expect(0, &["--scenario", "square", "--set", "simulation.duration_s=0.1", "--quiet"]);
    assert_eq!(complete_log(&log).result["outcome"], "finished", "a killed run holds nothing");
}

#[test]
fn what_a_controller_refuses_is_called_so_in_log_and_summary() {
    let folder = Folder::new("refused");
    folder.write(
        "nan.toml",
        "include = \"square\"\nname = \"nan\"\n[simulation]\nduration_s = 1.0\n[[fault]]\non = \"state\"\nkind = \"nan\"\nfrom_s = 0.5\n",
    );
    let ended = folder.expect(1, &["--scenario", "nan.toml", "--json"]);
    assert_eq!(summary(&ended.stdout)["ended"], "refused", "{}", ended.stderr);
    assert_eq!(complete_log(&folder.path("out/nan.mcap")).result["outcome"], "refused");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_a_complete_log() {
    let folder = Folder::new("interrupted");
    let args = ["--scenario", "sinusoid", "--set", "simulation.duration_s=100000", "--json"];
    let mut child = folder.command(&args).spawn().expect("the binary starts");
    let log = folder.path("out/sinusoid.mcap");
    let size = || std::fs::metadata(&log).map_or(0, |file| file.len());
    let begin = Instant::now();
    // The desired path and the robot are in the file before the first sample.
    while size() < 200_000 && begin.elapsed() < Duration::from_secs(60) {
        assert!(child.try_wait().expect("a child").is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(size() >= 200_000, "the log grows while the run is under way");
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    assert!(sent.success(), "the signal was sent");
    let ended = ended(child.wait_with_output().expect("it ends"));
    assert_eq!(ended.code, 1, "an interrupted run failed:\n{}", ended.stderr);
    assert!(ended.stderr.contains("interrupted at t = "), "when:\n{}", ended.stderr);
    let complete = complete_log(&log);
    assert_eq!(complete.result["outcome"], "interrupted", "how it ended");
    assert!(complete.topics["/control"] > 10, "with its samples: {:?}", complete.topics);
    let value = summary(&ended.stdout);
    assert_eq!(value["ended"], "interrupted", "in a word");
    assert_eq!(summary(&complete.attachments["summary.json"]), value, "the summary of what was run");
    assert_eq!(complete.result["digest"], *value["digest"].as_str().expect("a digest"), "and its digest");
}

#[test]
fn a_reader_that_goes_away_is_no_panic() {
    let folder = Folder::new("closed-stdout");
    for args in [
        &["--scenario", "square", "--set", "simulation.duration_s=1", "--no-log"] as &[&str],
        &["scenario", "list"],
        &["scenario", "schema"],
        &["--help"],
    ] {
        let mut child = folder.command(args).stdout(Stdio::piped()).spawn().expect("the binary starts");
        drop(child.stdout.take());
        let ended = ended(child.wait_with_output().expect("it ends"));
        assert!(!ended.stderr.contains("panicked"), "{args:?}:\n{}", ended.stderr);
        assert_eq!(ended.code, 0, "{args:?} did its work:\n{}", ended.stderr);
    }
}

#[test]
fn a_controller_named_twice_is_refused() {
    let folder = Folder::new("twice");
    let args = ["compare", "--scenario", "square", "--controllers", "bsmc,bfsmc,bsmc"];
    let ended = folder.expect(2, &args);
    assert!(ended.stderr.contains("bsmc"), "which:\n{}", ended.stderr);
    assert!(!folder.path("out").exists(), "two runs would write one log");
}

#[test]
fn an_improvement_is_that_of_whole_runs_and_of_numbers() {
    let folder = Folder::new("improvement");
    folder.write("away.toml", RUNAWAY);
    let compare = ["compare", "--scenario", "away.toml", "--controllers", "bsmc,bfsmc", "--no-log"];
    let json = summary(&folder.expect(1, &[&compare[..], &["--json"]].concat()).stdout);
    assert!(json.get("improvement_percent").is_none(), "none of runs that diverged: {json}");
    let table = folder.expect(1, &compare).stdout;
    let rows: Vec<&str> =
        table.lines().filter(|line| line.starts_with("bsmc") || line.starts_with("bfsmc")).collect();
    assert_eq!(rows.len(), 2, "a row for each:\n{table}");
    let head = table.lines().find(|line| line.contains("ITAE sum")).expect("a head").len();
    for (row, run) in rows.iter().zip(json["runs"].as_array().expect("runs")) {
        let mark = format!("  (diverged at {:.3} s)", run["simulated_s"].as_f64().expect("a number"));
        assert_eq!(row.split_at(head).1, mark, "a row that ended early says so behind its columns:\n{table}");
    }
    // Straight along x: no error in y, nothing to improve there.
    let short = [&compare[..], &["--set", "simulation.duration_s=1"]].concat();
    let table = folder.expect(0, &short).stdout;
    let row = table.lines().find(|line| line.starts_with("bfsmc below bsmc by")).expect("an improvement");
    assert!(row.contains(" - ") && !table.contains("NaN"), "undefined is a dash:\n{table}");
    assert!(!table.contains(" at 1.000 s"), "a finished run has no mark:\n{table}");
    let json = summary(&folder.expect(0, &[&short[..], &["--json"]].concat()).stdout);
    assert_eq!(
        (&json["runs"][0]["ended"], &json["runs"][0]["simulated_s"]),
        (&"finished".into(), &1.0.into())
    );
    assert!(json["improvement_percent"]["y"].is_null(), "and null in JSON");
}
