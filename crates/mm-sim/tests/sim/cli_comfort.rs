//! The command is at home in a shell: help with examples, completions, manual pages, a scenario to begin with, logs in a pipe.
//!
//! Law: what is promised on standard output is there and nothing else; a reader that goes away ends the command quietly; no file is
//! overwritten. Reference: the interface; the `mcap` crate reads the log. No tolerance.

use std::io::Read as _;
use std::process::Stdio;

use crate::common::command::Folder;

const COMMANDS: [&str; 9] =
    ["run", "compare", "reproduce", "sweep", "tune", "pil", "scenario new", "completions", "robot import"];

#[test]
fn every_command_has_help_with_examples() {
    let folder = Folder::new("help");
    for command in COMMANDS.into_iter().chain([
        "",
        "scenario",
        "scenario list",
        "scenario show",
        "scenario check",
        "scenario schema",
        "robot export",
        "man",
        "fis eval",
        "fis check",
        "fis plot",
        "fis compile",
    ]) {
        let args: Vec<&str> = command.split_whitespace().chain(["--help"]).collect();
        let help = folder.expect(0, &args).stdout;
        assert!(help.contains("Example") && help.contains("mmsim"), "{args:?} has no example:\n{help}");
        assert!(!help.contains('\u{1b}'), "{args:?}: no colour in a pipe");
        let widest = help.lines().map(|line| line.chars().count()).max().unwrap_or(0);
        assert!(widest <= 130, "{args:?}: a line of {widest} columns");
    }
}

#[test]
fn completions_and_manual_know_every_command() {
    let folder = Folder::new("shells");
    for shell in ["bash", "zsh", "fish"] {
        let script = folder.expect(0, &["completions", shell]).stdout;
        for word in ["compare", "controllers", "no-log", "bfsmc-thesis", "completions"] {
            assert!(script.contains(word), "{word} is not in the completions of {shell}");
        }
    }
    let ended = folder.expect(2, &["completions", "tcsh"]);
    assert!(ended.stderr.contains("bash"), "which shells there are:\n{}", ended.stderr);
    let page = folder.expect(0, &["man"]).stdout;
    for part in [".TH mmsim 1", "Exit codes", "\\-\\-scenario"] {
        assert!(page.contains(part), "{part:?} is not in the page:\n{page}");
    }
    folder.expect(0, &["man", "--out", "man"]);
    for name in ["mmsim", "mmsim-compare", "mmsim-fis-eval", "mmsim-scenario-new", "mmsim-robot-import"] {
        assert!(folder.path(&format!("man/{name}.1")).is_file(), "{name}.1");
    }
}

#[test]
fn a_new_scenario_runs_and_replaces_nothing() {
    let folder = Folder::new("scenario-new");
    let made = folder.expect(0, &["scenario", "new", "-o", "lift.toml"]);
    assert!(made.stdout.is_empty() && made.stderr.contains("mmsim --scenario lift.toml"), "{}", made.stderr);
    let ran = folder.expect(0, &["--scenario", "lift.toml"]);
    assert!(
        ran.stdout.starts_with("lift with bfsmc") && ran.stderr.is_empty(),
        "{}{}",
        ran.stdout,
        ran.stderr
    );
    let before = std::fs::read(folder.path("lift.toml")).expect("the file");
    let again = folder.expect(2, &["scenario", "new", "--name", "lift"]);
    assert!(again.stderr.contains("lift.toml is there already"), "{}", again.stderr);
    assert_eq!(std::fs::read(folder.path("lift.toml")).expect("the file"), before, "untouched");
    let text = folder.expect(0, &["scenario", "new", "--name", "a \"b\"", "-o", "-"]).stdout;
    assert!(text.contains("name = 'a \"b\"'"), "a name in quotes that it needs:\n{text}");
    let bad = folder.expect(2, &["scenario", "new", "--name", "a/b"]);
    assert!(bad.stderr.contains("not a file name"), "{}", bad.stderr);
    folder.expect(0, &["scenario", "new"]);
    assert!(folder.path("my-scenario.toml").is_file(), "the default name");
}

const SHORT: [&str; 5] = ["--scenario", "square", "--set", "simulation.duration_s=2", "--out"];

#[test]
fn a_log_goes_to_standard_output_alone() {
    let folder = Folder::new("out-stdout");
    folder.expect(0, &[&SHORT[..], &["."]].concat());
    let output = folder.command(&[&SHORT[..], &["-"]].concat()).output().expect("the binary starts");
    assert_eq!(output.status.code(), Some(0), "done");
    let (piped, file) = (&output.stdout, std::fs::read(folder.path("square.mcap")).expect("the log"));
    let messages = |bytes: &[u8]| mcap::MessageStream::new(bytes).expect("a log").count();
    assert_eq!(messages(piped), messages(&file), "the same log and nothing else");
    let table = String::from_utf8_lossy(&output.stderr);
    assert!(table.contains("ITAE") && table.contains("digest"), "the table is beside it:\n{table}");
    let quiet =
        folder.command(&[&SHORT[..], &["-", "--quiet"]].concat()).output().expect("the binary starts");
    assert!(quiet.stderr.is_empty(), "unless nobody wants it");
    assert!(!folder.path("-").exists(), "no folder of that name");
    for args in [
        [&SHORT[..], &["-", "--json"]].concat(),
        [&["compare", "--controllers", "pid"], &SHORT[..], &["-"]].concat(),
    ] {
        let ended = folder.expect(2, &args);
        assert!(ended.stderr.contains("--out -"), "{args:?}:\n{}", ended.stderr);
    }
}

#[test]
fn a_reader_of_the_log_that_goes_away_ends_the_run_quietly() {
    let folder = Folder::new("out-closed");
    let args = ["--scenario", "square", "--out", "-"];
    let mut child = folder.command(&args).stdout(Stdio::piped()).spawn().expect("the binary starts");
    let mut start = [0; 8];
    child.stdout.take().expect("a pipe").read_exact(&mut start).expect("the start of a log");
    let ended = crate::common::command::ended(child.wait_with_output().expect("it ends"));
    assert_eq!((ended.code, ended.stderr.as_str()), (0, ""), "quietly");
    assert_eq!(&start[1..5], b"MCAP", "what was read");
}

#[test]
fn the_table_shows_the_error_over_time() {
    let folder = Folder::new("sparkline");
    let table = folder.expect(0, &[&SHORT[..4], &["--no-log"]].concat()).stdout;
    let line = table
        .lines()
        .find(|line| line.starts_with("error over time"))
        .unwrap_or_else(|| panic!("none:\n{table}"));
    let blocks: Vec<char> = line.chars().filter(|c| ('\u{2581}'..='\u{2588}').contains(c)).collect();
    assert!(blocks.len() == 48 && blocks.contains(&'\u{2588}'), "48 columns up to the largest: {line}");
}
