//! `mmsim reproduce` does what the interface promises: table or JSON on standard output, files in a folder, exit codes.
//!
//! Law: results on standard output and nothing else there; 1 when a run or a file failed, 2 for bad usage; Ctrl-C leaves whole
//! files.
//! Why: people and programs rely on it. Reference: the interface, whose names are written out here. No tolerance.

use crate::common::command::{Folder, ended};
use serde_json::Value;

const SHORT: [&str; 3] = ["reproduce", "--set", "simulation.duration_s=0.2"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    SHORT.iter().chain(more).copied().collect()
}

#[test]
fn json_is_one_object_and_files_are_where_it_says() {
    let folder = Folder::new("reproduce-json");
    let ended = folder.expect(0, &with(&["--json", "--out", "here", "--jobs", "2"]));
    let report: Value = serde_json::from_str(&ended.stdout).expect("one object");
    let keys: Vec<&String> = report.as_object().expect("an object").keys().collect();
    assert_eq!(keys, ["schema", "out", "wall_s", "runs", "table", "figures"], "its keys");
    assert_eq!(report["schema"], "mmsim.reproduce/1", "its format");
    let row = report["table"][0].as_object().expect("a row");
    let expected = ["experiment", "controller", "quantity", "unit", "thesis", "ours", "ratio", "note"];
    assert_eq!(row.keys().collect::<Vec<_>>(), expected, "keys of a row");
    for figure in report["figures"].as_array().expect("figures") {
        let svg = figure["svg"].as_str().expect("a path");
        assert!(folder.path("here").join(svg).is_file(), "{svg} is there");
    }
    let page = std::fs::read_to_string(folder.path("here/report.html")).expect("a page with all of it");
    for number in 2..=44 {
        assert!(page.contains(&format!("id=\"figure-5.{number}\"")), "figure 5.{number} is in the page");
    }
    assert!(page.contains("Table 5.2") && page.len() < 15_000_000, "the table, in {} bytes", page.len());
    for run in report["runs"].as_array().expect("runs") {
        assert_eq!(run["finished"], true, "{run}");
        assert_eq!(run["missed"].as_array().map(Vec::len), Some(0), "an edited scenario is not judged");
        assert!(run["metrics"]["itae_m_s2"]["sum"].is_number(), "{run}");
    }
    assert!(!ended.stderr.contains("error"), "nothing to complain of:\n{}", ended.stderr);
}

#[test]
fn the_table_is_for_people_and_quiet_is_quiet() {
    let folder = Folder::new("reproduce-table");
    let ended = folder.expect(0, &SHORT);
    for part in [
        "thesis       ours      ratio",
        "5.8  square-compare",
        "47.31",
        "10.98",
        "[1] ",
        "written to ./out/reproduce",
    ] {
        assert!(ended.stdout.contains(part), "{part:?} is not in:\n{}", ended.stdout);
    }
    let widest = ended.stdout.lines().filter(|line| !line.contains('[')).map(str::len).max();
    assert!(widest < Some(100), "a terminal is wide enough: {widest:?}");
    assert!(ended.stdout.is_ascii(), "plain text");
    assert!(folder.path("out/reproduce/table.csv").is_file(), "the default folder");
    let quiet = folder.expect(0, &with(&["--quiet"]));
    assert_eq!(quiet.stdout, "", "nothing said");
}

#[test]
fn mistakes_are_said_before_anything_runs() {
    let folder = Folder::new("reproduce-mistakes");
    let ended = folder.expect(2, &["reproduce", "--set", "simulation.duration=1"]);
    assert!(
        ended.stderr.contains("the nearest known name is `duration_s`"),
        "the nearest key:\n{}",
        ended.stderr
    );
    folder.expect(2, &["reproduce", "--jobs", "0"]);
    assert!(!folder.path("out").exists(), "no folder for nothing");
    folder.write("file", "");
    let ended = folder.expect(1, &with(&["--out", "file/below"]));
    assert!(ended.stderr.contains("cannot write"), "which file, and why:\n{}", ended.stderr);
    assert_eq!(ended.stdout, "", "no table without files");
}

#[test]
fn a_run_that_diverges_fails_the_whole_and_leaves_the_rest() {
    let folder = Folder::new("reproduce-diverges");
    // A thousandth of the weight that the controller believes in.
    let args = ["reproduce", "--set", "plant.mass_scale=0.001", "--set", "simulation.duration_s=5"];
    let ended = folder.expect(1, &args);
    let said = "error: step-disturbed with bfsmc: diverged at t = ";
    assert!(ended.stderr.contains(said), "which run, and when:\n{}", ended.stderr);
    let line = ended.stdout.lines().find(|line| line.contains("runs went to their end")).expect("a count");
    let counts: Vec<usize> = line.split(' ').filter_map(|word| word.parse().ok()).take(2).collect();
    let [finished, all] = counts[..] else { panic!("two counts in {line}") };
    let named = ended.stderr.lines().filter(|line| line.contains("diverged at t = ")).count();
    assert!(finished > 0 && named > 0, "the others are there: {line}");
    assert_eq!(finished + named, all, "every run that is not there is named: {line}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_with_whole_files() {
    use std::time::{Duration, Instant};

    let folder = Folder::new("reproduce-interrupted");
    // Fifty steps of the plant in each period: a minute of work, of which a second is done.
    let child = folder
        .command(&["reproduce", "--set", "simulation.plant_step_s=2e-5"])
        .spawn()
        .expect("the binary starts");
    let begin = Instant::now();
    while !folder.path("out/reproduce/figures").exists() {
        assert!(begin.elapsed() < Duration::from_secs(60), "no folder after a minute");
        std::thread::sleep(Duration::from_millis(20));
    }
    std::thread::sleep(Duration::from_millis(100));
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()), "the signal is sent");
    let ended = ended(child.wait_with_output().expect("the process ends"));
    assert_eq!(ended.code, 1, "an interrupted reproduction failed:\n{}", ended.stderr);
    assert!(ended.stderr.contains("error: interrupted"), "{}", ended.stderr);
    assert!(!folder.path("out/reproduce/table.csv").exists(), "no table");
    for entry in std::fs::read_dir(folder.path("out/reproduce/data")).expect("a folder") {
        let name = entry.expect("an entry").file_name();
        assert!(!name.to_string_lossy().contains("part"), "nothing half done: {}", name.display());
    }
}
