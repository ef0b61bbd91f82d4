//! A sweep gives the same samples however they are run, goes on where it was cut off, and tells how to run each one again.
//!
//! Law: a sample depends on the scenario, the seed and its own number alone, not on the number of samples or threads; a file that
//! was cut anywhere is completed to the byte; a file of another sweep is left alone; the command printed for a sample gives its
//! digest again; statistics are those of the samples.
//! Why: a failure among a thousand plants is worth something only if it can be looked at.
//! Reference: the files of undisturbed runs, the digests of single runs, statistics recomputed here from the file. No tolerance.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::{Folder, ended};
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// Everything that can vary, for a tenth of a second.
const TEXT: &str = "name = \"small\"\n[simulation]\nduration_s = 0.1\nseed = 5\n[trajectory]\nkind = \"square\"\n\
    [sweep]\nwheel_viscous_n_m_s = 0.5\nwheel_coulomb_n_m = 0.5\njoint_viscous_n_m_s = 1.0\njoint_coulomb_n_m = 1.0\n";

const FILE: &str = "out/small.sweep.csv";

fn folder(test: &str) -> Folder {
    let folder = Folder::new(test);
    // A name that a shell has to be told to leave alone.
    folder.write("it's small.toml", TEXT);
    folder
}

fn sweep(folder: &Folder, more: &[&str]) -> Value {
    let ended = folder.expect(0, &[&["sweep", "--scenario", "it's small.toml", "--json"], more].concat());
    assert!(ended.stderr.is_empty(), "nothing to complain of, no progress off a terminal: {}", ended.stderr);
    serde_json::from_str(&ended.stdout)
        .unwrap_or_else(|e| panic!("not one JSON object ({e}): {}", ended.stdout))
}

fn file(folder: &Folder) -> String {
    std::fs::read_to_string(folder.path(FILE)).expect("a file of samples")
}

/// The cells of each sample.
fn rows(text: &str) -> Vec<Vec<&str>> {
    text.lines().skip(2).map(|line| line.split(',').collect()).collect()
}

#[test]
fn samples_depend_on_neither_threads_nor_their_number() {
    let folder = folder("sweep-jobs");
    let one = sweep(&folder, &["--samples", "9", "--jobs", "1"]);
    let text = file(&folder);
    let three = sweep(&folder, &["--samples", "9", "--jobs", "3", "--fresh"]);
    assert_eq!(file(&folder), text, "the file, for 3 threads");
    assert_eq!(three, one, "the report, for 3 threads");
    sweep(&folder, &["--samples", "4", "--fresh"]);
    assert!(text.starts_with(&file(&folder)), "the first four of nine are the four");
    let again = sweep(&folder, &["--samples", "9"]);
    assert_eq!((file(&folder), again), (text.clone(), one), "and five more make nine");
    let fewer = sweep(&folder, &["--samples", "4"]);
    assert_eq!(fewer["samples"], 4, "of a longer file those asked for");
    assert_eq!(file(&folder), text, "the others stay");
    let mut digests: Vec<&str> = rows(&text).iter().map(|row| row[10]).collect();
    digests.sort_unstable();
    digests.dedup();
    assert_eq!(digests.len(), 9, "no two samples are the same run");
}

#[test]
fn a_file_that_was_cut_off_is_completed() {
    let folder = folder("sweep-resume");
    let whole_report = sweep(&folder, &["--samples", "5"]);
    let whole = file(&folder);
    let third = whole.match_indices('\n').nth(3).map(|(at, _)| at).expect("a third line");
    // In a number, before and after the end of a line, in the columns, in the first line, nothing at all.
    for cut in [third + 70, third, third + 1, whole.find("rmse").expect("columns"), 20, 0] {
        folder.write(FILE, &whole[..cut]);
        let report = sweep(&folder, &["--samples", "5"]);
        assert_eq!(file(&folder), whole, "cut after {cut} bytes");
        assert_eq!(report, whole_report, "the report after {cut} bytes");
    }
    // What is there is not run again: a number that no run gives stays.
    let marked = whole.replacen("0.1,", "0.25,", 1);
    assert_ne!(marked, whole, "a sample was changed");
    folder.write(FILE, &marked);
    sweep(&folder, &["--samples", "5"]);
    assert_eq!(file(&folder), marked, "no sample was run again");
}

#[test]
fn another_sweep_leaves_the_file_alone() {
    let folder = folder("sweep-other");
    sweep(&folder, &["--samples", "2"]);
    let text = file(&folder);
    for other in [&["--seed", "6"] as &[&str], &["--set", "sweep.mass=0.1"], &["--set", "simulation.seed=6"]]
    {
        let args = [&["sweep", "--scenario", "it's small.toml", "--samples", "2"], other].concat();
        let ended = folder.expect(2, &args);
        for part in ["out/small.sweep.csv", "another sweep", "--fresh", "seed=5"] {
            assert!(ended.stderr.contains(part), "{part:?} with {other:?} is not in:\n{}", ended.stderr);
        }
        assert_eq!(file(&folder), text, "the samples stay");
        folder.expect(0, &[args.as_slice(), &["--fresh"]].concat());
        assert_ne!(file(&folder), text, "{other:?} are other samples");
        folder.write(FILE, &text);
    }
    folder.write(FILE, "something else");
    let ended = folder.expect(2, &["sweep", "--scenario", "it's small.toml", "--samples", "2"]);
    assert!(ended.stderr.contains("`something else`"), "not a file of samples:\n{}", ended.stderr);
    assert_eq!(file(&folder), "something else", "and left alone");
    // The number of another sample, the seed of another, no number for the RMS error, half a digest.
    let row = rows(&text)[1].clone();
    let end = &row[10][16..];
    for (found, other) in [
        ("\n1,".to_owned(), "\n7,".to_owned()),
        (format!("\n1,{},", row[1]), format!("\n1,{},", rows(&text)[0][1])),
        (format!("finished,{},{},", row[3], row[4]), format!("finished,{},NaN,", row[3])),
        (format!("{end}\n"), "\n".to_owned()),
    ] {
        // Of the last sample, whatever else has the same text.
        let (head, tail) = text.split_at(text.rfind("\n1,").expect("sample 1"));
        let changed = format!("{head}{}", tail.replacen(&found, &other, 1));
        assert_ne!(changed, text, "{found:?} is there");
        folder.write(FILE, &changed);
        let ended = folder.expect(2, &["sweep", "--scenario", "it's small.toml", "--samples", "2"]);
        assert!(ended.stderr.contains("small.sweep.csv:4: not sample 1"), "{other:?}:\n{}", ended.stderr);
        assert_eq!(file(&folder), changed, "and left alone");
    }
    folder.expect(0, &["sweep", "--scenario", "it's small.toml", "--samples", "2", "--controller", "bsmc"]);
    assert!(folder.path("out/small.bsmc.sweep.csv").is_file(), "a file for each controller");
}

#[test]
fn an_interrupted_sweep_goes_on() {
    let folder = folder("sweep-interrupted");
    let args = ["sweep", "--scenario", "it's small.toml", "--samples", "1000000", "--json"];
    let mut child = folder.command(&args).spawn().expect("the binary starts");
    let lines = || std::fs::read_to_string(folder.path(FILE)).map_or(0, |text| text.lines().count());
    let begin = Instant::now();
    while lines() < 5 && begin.elapsed() < Duration::from_secs(60) {
        assert!(child.try_wait().expect("a child").is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(20));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill is there");
    assert!(sent.success(), "the signal was sent");
    let ended = ended(child.wait_with_output().expect("it ends"));
    assert_eq!(ended.code, 1, "an interrupted sweep failed:\n{}", ended.stderr);
    assert!(ended.stderr.contains("the same command goes on"), "how to go on:\n{}", ended.stderr);
    assert!(ended.stdout.is_empty(), "no report of half a sweep");
    let text = file(&folder);
    let count = rows(&text).len();
    assert!(count >= 3 && text.ends_with('\n'), "whole lines, {count} of them");
    sweep(&folder, &["--samples", &(count + 1).to_string()]);
    let more = file(&folder);
    assert!(more.starts_with(&text) && rows(&more).len() == count + 1, "one more sample");
    sweep(&folder, &["--samples", &(count + 1).to_string(), "--fresh"]);
    assert_eq!(file(&folder), more, "the same as without an interruption");
}

/// The digest that a printed command gives, run by a shell that finds `mmsim`.
fn digest_of(folder: &Folder, command: &str) -> String {
    let binary = Path::new(env!("CARGO_BIN_EXE_mmsim"));
    let path = binary.parent().expect("a folder").to_str().expect("text");
    let mut shell = Command::new("sh");
    shell.current_dir(folder.path(".")).env("PATH", format!("{path}:/usr/bin:/bin"));
    let done = ended(shell.args(["-c", &format!("{command} --no-log --json")]).output().expect("a shell"));
    let summary: Value =
        serde_json::from_str(&done.stdout).unwrap_or_else(|e| panic!("{e}: {command}\n{}", done.stderr));
    summary["digest"].as_str().expect("a digest").to_owned()
}

#[test]
fn the_printed_commands_give_the_digests_again() {
    let folder = folder("sweep-again");
    let more =
        ["--controller", "bsmc", "--set", "plant.mass_scale=1.1", "--set", "sweep.fail_above_rmse_m=0"];
    let args = [more.as_slice(), &["--samples", "3", "--seed", "18446744073709551615"]].concat();
    let report = sweep(&folder, &args);
    let text = std::fs::read_to_string(folder.path("out/small.bsmc.sweep.csv")).expect("samples");
    let rows = rows(&text);
    let failed = report["failed"].as_array().expect("a list");
    assert_eq!(failed.len(), 3, "no sample has no error at all");
    for (failure, row) in failed.iter().zip(&rows) {
        assert_eq!(failure["seed"].to_string(), row[1], "the seed of the sample");
        let command = failure["command"].as_str().expect("a command");
        assert_eq!(digest_of(&folder, command), row[10], "{command}");
    }
    let worst = &report["statistics"][0]["worst"];
    let at = usize::try_from(worst["sample"].as_u64().expect("a number")).expect("a small one");
    assert_eq!(digest_of(&folder, worst["command"].as_str().expect("a command")), rows[at][10], "the worst");
    let table = folder.expect(0, &[&["sweep", "--scenario", "it's small.toml"], args.as_slice()].concat());
    for part in
        ["small with bsmc: 3 samples", "RMS error", "3 of 3", "worst of the finished", "sample 2 failed"]
    {
        assert!(table.stdout.contains(part), "{part:?} is not in:\n{}", table.stdout);
    }
}

#[test]
fn statistics_and_failures_are_those_of_the_samples() {
    let folder = folder("sweep-statistics");
    // Starts are up to 5 cm off, and a tenth of a second brings none of them back: the bound parts the samples.
    let sets = ["--set", "sweep.fail_above_rmse_m=0.03", "--samples", "20"];
    let report = sweep(&folder, &sets);
    let text = file(&folder);
    let rows = rows(&text);
    let column =
        |at: usize| -> Vec<f64> { rows.iter().map(|row| row[at].parse().expect("a number")).collect() };
    for (index, name) in
        ["rmse_m", "max_error_m", "itae_m_s2", "torque_tv_n_m_per_s", "saturated_fraction", "max_speed_m_s"]
            .into_iter()
            .enumerate()
    {
        let quantity = &report["statistics"][index];
        assert_eq!(quantity["name"], name, "the order of the quantities");
        assert_eq!(
            text.lines().nth(1).expect("columns").split(',').nth(4 + index),
            Some(name),
            "the columns"
        );
        let mut values = column(4 + index);
        let largest = values.iter().copied().fold(f64::MIN, f64::max);
        // The JSON reader may be off by the last bit, unlike what it reads.
        let is = |found: &Value, wanted: f64, what: &str| {
            let found = found.as_f64().expect("a number");
            assert!((found - wanted).abs() <= 1e-15 * wanted, "{what}, {name}: {found} for {wanted}");
        };
        is(&quantity["worst"]["value"], largest, "the worst");
        values.sort_by(f64::total_cmp);
        is(&quantity["median"], values[9], "the tenth of twenty");
        is(&quantity["percentile_95"], values[18], "the nineteenth of twenty");
    }
    let failures = column(4).into_iter().filter(|rmse| *rmse > 0.03).count();
    assert!(failures > 0 && failures < 20, "a bound that tells samples apart, not {failures}");
    assert_eq!(report["failures"], failures, "samples above the bound");
    let p = &report["failure_probability"];
    #[expect(clippy::cast_precision_loss, reason = "at most twenty")]
    let share = failures as f64 / 20.0;
    assert_eq!(p["share"], share, "the share of failures");
    assert!(p["low"].as_f64() < Some(share) && p["high"].as_f64() > Some(share), "its bounds {p}");
}

#[test]
fn samples_that_run_away_are_failures() {
    let folder = Folder::new("sweep-away");
    folder.write(
        "away.toml",
        "name = \"away\"\n[simulation]\nduration_s = 5\n[robot]\nwheel_torque_limit_n_m = 0.1\n\
         [trajectory]\nkind = \"line\"\nfrom_m = [0.5, 0.0, 0.5]\nvelocity_m_s = [3.0, 0.0, 0.0]\n",
    );
    let ended = folder.expect(0, &["sweep", "--scenario", "away.toml", "--samples", "2", "--json"]);
    let report: Value = serde_json::from_str(&ended.stdout).expect("a JSON object");
    assert_eq!(report["failures"], 2, "both ran away");
    assert_eq!(report["failed"][1]["ended"], "diverged", "how");
    assert!(report["failed"][1]["simulated_s"].as_f64().is_some_and(|t| t > 3.0 && t < 5.0), "and when");
    let rmse = &report["statistics"][0];
    assert!(rmse["median"].is_null() && rmse["worst"].is_null(), "nothing finished: {rmse}");
    let table = folder.expect(0, &["sweep", "--scenario", "away.toml", "--samples", "2"]).stdout;
    assert!(table.contains("sample 1 failed, diverged at t = 3."), "the table:\n{table}");
    let many =
        ["--samples", "8", "--set", "simulation.duration_s=0.02", "--set", "sweep.fail_above_rmse_m=0"];
    let args = [["sweep", "--scenario", "away.toml", "--fresh"].as_slice(), &many].concat();
    let table = folder.expect(0, &args).stdout;
    assert!(table.contains("sample 4 failed") && !table.contains("sample 5 failed"), "five of 8:\n{table}");
    assert!(table.contains("3 more failed, see ./out/away.sweep.csv"), "and how many more:\n{table}");
}

#[test]
fn a_sample_that_is_no_scenario_is_bad_input() {
    let folder = folder("sweep-bad");
    let args =
        ["sweep", "--scenario", "it's small.toml", "--set", "sweep.start_offset_m=9", "--samples", "9"];
    let ended = folder.expect(2, &args);
    for part in ["sample ", "initial.offset_m", "no posture within the joint limits"] {
        assert!(ended.stderr.contains(part), "{part:?} is not in:\n{}", ended.stderr);
    }
    folder.expect(2, &["sweep", "--samples", "3"]);
    folder.expect(2, &["sweep", "--scenario", "square", "--samples", "0"]);
    folder.expect(2, &["sweep", "--scenario", "square", "--set", "sweep.mass=1"]);
}
