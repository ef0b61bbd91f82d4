//! `mmsim fis`: evaluates, checks and draws fuzzy systems as its help says.
//!
//! Law: results on standard output as numbers that read back to the same bits, all else on standard error; exit codes 0, 1, 2.
//! Why: what comes out is compared with MATLAB and goes into other programs.
//! Reference: the thesis's Appendix C by hand (1/3 at both ends, 0 at 0), the closed form and the 101 samples of
//! mm-control's own engines called directly. No tolerance but where a test gives one.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]
#![expect(clippy::float_cmp, reason = "numbers are read back to the bit")]

mod compile;
mod eval;

use crate::common::command::{Ended, Folder, ended};
use mm_control::fuzzy::{Curve, Defuzzifier, FuzzySystem as _, MamdaniTables, THESIS};
use serde_json::Value;
use std::io::Write as _;
use std::process::Stdio;

/// Two inputs, one output, from good to bad service and food.
const TIP: &str = "[System]
Name='tip'
Type='mamdani'
[Input1]
Name='service'
Range=[0 10]
MF1='poor':'trimf',[0 0 5]
MF2='good':'trimf',[0 5 10]
MF3='excellent':'trimf',[5 10 10]
[Input2]
Name='food'
Range=[0 10]
MF1='rancid':'trapmf',[0 0 1 3]
MF2='delicious':'trapmf',[7 9 10 10]
[Output1]
Name='tip'
Range=[0 30]
MF1='cheap':'trimf',[0 5 10]
MF2='average':'trimf',[10 15 20]
MF3='generous':'trimf',[20 25 30]
[Rules]
1 1, 1 (1) : 2
2 0, 2 (1) : 1
3 2, 3 (1) : 2
";

/// One input with a gap, in which no rule fires.
const GAP: &str = "[System]\nType='mamdani'\n[Input1]\nName='x'\nRange=[0 4]\nMF1='a':'trimf',[0 0 1]\nMF2='b':'trimf',[3 4 4]\n\
    [Output1]\nName='y'\nRange=[0 10]\nMF1='c':'trimf',[0 1 2]\nMF2='d':'trimf',[8 9 10]\n[Rules]\n1, 1 (1) : 1\n2, 2 (1) : 1\n";

fn fis(folder: &Folder, code: i32, args: &[&str]) -> Ended {
    folder.expect(code, &[&["fis"], args].concat())
}

/// Runs with a text on standard input.
fn piped(folder: &Folder, args: &[&str], text: &str) -> Ended {
    let mut child = folder.command(args).stdin(Stdio::piped()).spawn().expect("the binary starts");
    let mut input = child.stdin.take().expect("a pipe");
    // A child that refuses its arguments does not read.
    let _ = input.write_all(text.as_bytes());
    drop(input);
    ended(child.wait_with_output().expect("the binary ends"))
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("not JSON ({error}):\n{text}"))
}

#[test]
fn systems_come_from_files_names_and_standard_input() {
    let folder = Folder::new("fis-files");
    folder.write("tip.fis", TIP);
    let expected = fis(&folder, 0, &["eval", "tip.fis", "3", "8"]).stdout;
    let run = piped(&folder, &["fis", "eval", "-", "3", "8"], TIP);
    assert_eq!((run.code, run.stdout), (0, expected.clone()), "standard input: {}", run.stderr);
    let run = piped(&folder, &["fis", "eval", "-"], TIP);
    assert_eq!(run.code, 2, "both cannot come from there");
    folder.write("thesis.fis", GAP);
    assert_eq!(fis(&folder, 0, &["eval", "thesis.fis", "0.5"]).stdout, "0.5 1\n", "the file first");
    assert_eq!(
        fis(&folder, 0, &["eval", "thesis", "0"]).stdout,
        "0 0\n",
        "no file of this name: the bundled one"
    );
    let run = fis(&folder, 2, &["eval", "thess", "0"]);
    for part in [
        "error: cannot read `thess`: no such file and no bundled system of that name",
        "`thesis`, `smooth`",
        "nearest known name is `thesis`",
    ] {
        assert!(run.stderr.contains(part), "{part:?} in\n{}", run.stderr);
    }
    fis(&folder, 2, &["eval", "./smooth", "0"]);
    fis(&folder, 2, &["check", "."]);
    // A name in Latin-1, as older tools write it.
    let mut bytes = TIP.replace("cheap", "ch?ap").into_bytes();
    bytes.iter_mut().filter(|byte| **byte == b'?').for_each(|byte| *byte = 0xe9);
    std::fs::write(folder.path("latin.fis"), bytes).expect("a file");
    let run = fis(&folder, 0, &["eval", "latin.fis", "3", "8"]);
    assert_eq!(run.stderr, "warning: latin.fis is not UTF-8; it is read as Latin-1\n");
    assert_eq!(run.stdout, expected, "and means the same");
}

#[test]
fn bad_files_are_refused_with_the_place_underlined() {
    let folder = Folder::new("fis-bad");
    folder.write("bad.fis", &TIP.replace("MF2='good':'trimf'", "MF2='good':'trimff'"));
    for what in ["eval", "check", "plot"] {
        let run = fis(&folder, 2, &[what, "bad.fis"]);
        assert!(run.stdout.is_empty(), "{what} has no result: {}", run.stdout);
        for part in ["trimff", "--> bad.fis:8:13", "^^^^^^", "`trimf`"] {
            assert!(run.stderr.contains(part), "{part:?} in\n{}", run.stderr);
        }
    }
    assert!(!folder.path("bad.svg").exists(), "nothing is drawn");
    folder.write("empty.fis", "");
    assert!(fis(&folder, 2, &["check", "empty.fis"]).stderr.contains("empty.fis"), "the file is named");
    for args in [
        &["fis"] as &[&str],
        &["fis", "evaluate", "thesis"],
        &["fis", "eval"],
        &["fis", "eval", "thesis", "--engine", "exakt"],
    ] {
        let run = folder.expect(2, args);
        assert!(!run.stderr.is_empty() && run.stdout.is_empty(), "{args:?}");
    }
    assert!(
        folder.mmsim(&["fis", "eval", "thesis", "--engine", "exakt"]).stderr.contains("'exact'"),
        "the nearest"
    );
}

#[test]
fn check_reports_in_words_and_in_json() {
    let folder = Folder::new("fis-check");
    let run = fis(&folder, 0, &["check", "thesis"]);
    assert!(run.stderr.is_empty(), "{}", run.stderr);
    for part in [
        "1 input, 1 output, 8 rules",
        "output `output1` takes on [-0.888867, 0.888867], its range is [-1, 1]",
        "warning: term `AZ` of output `output1` is used by no rule [unused-term]",
        "warning: output `output1` jumps at `input1` = 0 (from 0.888867 through 0 to -0.888867) [jump]",
        "note: terms `NB` and `PB` of input `input1` reach beyond its range, [-1.4, 1.4] [term-beyond-range]",
        "it is 0.333333 from -1.4 to -1, rises to 0.888867 at -0.25, falls to 0.870344 at -0.125",
        "4 warnings, 2 notes",
    ] {
        assert!(run.stdout.contains(part), "{part:?} is not in\n{}", run.stdout);
    }
    let value = json(&fis(&folder, 0, &["check", "thesis", "--json"]).stdout);
    assert_eq!(
        (&value["warnings"], &value["notes"], &value["sampled"]),
        (&4.into(), &2.into(), &false.into())
    );
    let jump =
        value["findings"].as_array().expect("findings").iter().find(|f| f["kind"] == "jump").expect("a jump");
    assert_eq!(jump["jumps"][0]["inputs"], serde_json::json!([0.0]), "where");
    let left = jump["jumps"][0]["left"].as_f64().expect("a number");
    assert!((left - 0.888_866_666_666_666_7).abs() < 1e-9, "in full: {left}");
    fis(&folder, 1, &["check", "thesis", "--strict"]);
    let sound = fis(&folder, 0, &["check", "smooth", "--strict"]);
    assert!(sound.stdout.ends_with("\n\nno findings\n"), "{}", sound.stdout);
}

#[test]
fn plot_draws_every_term_by_name() {
    let folder = Folder::new("fis-plot");
    let odd = TIP.replace("'average'", "'a <b> & c'").replace("Name='tip'\nType", "Name='<tip>'\nType");
    folder.write("tip.fis", &odd);
    folder.write("gap.fis", GAP);
    let cases: [(&[&str], &str, &[&str]); 6] = [
        (
            &["plot", "thesis"],
            "thesis.svg",
            &["NB", "ANZ", "APZ", "AZ", "input: input1", "output1 over input1"],
        ),
        (
            &["plot", "tip.fis", "-o", "pictures.svg"],
            "pictures.svg",
            &["excellent", "a <b> & c", "Fuzzy system <tip>", "tip over service and food"],
        ),
        (&["plot", "thesis", "--overlay", "surface", "-o", "over.svg"], "over.svg", &["compiled surface"]),
        (&["plot", "tip.fis", "--inputs", "2"], "tip.svg", &["tip over food (service = 5)"]),
        (&["plot", "tip.fis", "--inputs", "food"], "tip.svg", &["tip over food (service = 5)"]),
        (&["plot", "tip.fis", "--inputs", "2,1"], "tip.svg", &["tip over food and service"]),
    ];
    for (args, file, texts) in cases {
        let run = fis(&folder, 0, args);
        assert_eq!((run.stdout, run.stderr.as_str()), (format!("picture in {file}\n"), ""), "{args:?}");
        let svg = std::fs::read_to_string(folder.path(file)).expect("the picture");
        let document = roxmltree::Document::parse(&svg).unwrap_or_else(|error| panic!("{args:?}: {error}"));
        let written: Vec<&str> = document
            .descendants()
            .filter(|n| n.has_tag_name("text"))
            .filter_map(|n| n.text())
            .map(str::trim)
            .collect();
        for text in texts {
            assert!(written.contains(text), "{text:?} is not among {written:?}");
        }
        assert!(svg.len() < 1_000_000, "{args:?}: {} bytes", svg.len());
    }
    let svg = fis(&folder, 0, &["plot", "thesis", "-o", "-"]).stdout;
    assert!(
        svg.starts_with("<svg")
            && svg
                == std::fs::read_to_string(folder.path("thesis.svg")).expect("it").trim_end().to_owned()
                    + "\n",
        "the same on standard output"
    );
    for (inputs, part) in [
        ("3", "no input `3`: expected one of 1 `service`, 2 `food`"),
        ("0", "no input `0`"),
        ("1,service", "two different"),
        ("1,1", "two different"),
        ("1,2,1", "one input or two"),
    ] {
        let run = fis(&folder, 2, &["plot", "tip.fis", "--inputs", inputs]);
        assert!(run.stderr.contains(part), "{part:?} in {}", run.stderr);
    }
    let run = fis(&folder, 2, &["plot", "tip.fis", "-o", "tip.png"]);
    assert!(run.stderr.contains("expected a name that ends in .svg, or -"), "{}", run.stderr);
    assert!(!folder.path("tip.png").exists(), "nothing is written");
    let run = fis(&folder, 1, &["plot", "tip.fis", "-o", "no/such/folder.svg"]);
    assert!(run.stderr.contains("cannot write no/such/folder.svg"), "{}", run.stderr);
}

#[test]
fn each_command_has_help_with_an_example() {
    let folder = Folder::new("fis-help");
    for what in ["eval", "check", "plot", "compile"] {
        let run = fis(&folder, 0, &[what, "--help"]);
        assert!(run.stdout.contains(&format!("mmsim fis {what} thesis")), "{}", run.stdout);
    }
}

/// Law: an option without effect is named on standard error, and the result is there all the same.
#[test]
fn options_without_effect_are_warned_of() {
    let folder = Folder::new("fis-idle");
    for (args, part) in [
        (&["eval", "thesis", "--bits", "8", "0"] as &[&str], "--bits matters only with `--engine surface`"),
        (
            &["eval", "thesis", "--engine", "q15", "--bits", "8", "--bound", "1", "0"],
            "--bits and --bound matter only with `--engine surface`",
        ),
        (&["eval", "thesis", "--engine", "surface", "--points", "5", "0"], "only with `--engine sampled`"),
        (&["compile", "thesis", "--to", "q15", "--bits", "8"], "--bits matters only with `--to surface`"),
        (&["plot", "thesis", "--bits", "8", "-o", "-"], "--bits matters only with `--overlay surface`"),
    ] {
        let run = fis(&folder, 0, args);
        assert!(run.stderr.starts_with("warning: --"), "{}", run.stderr);
        assert!(run.stderr.contains(part) && !run.stdout.is_empty(), "{part:?} in {}", run.stderr);
    }
    for args in
        [&["eval", "thesis", "--engine", "surface", "--bits", "16", "0"] as &[&str], &["eval", "thesis", "0"]]
    {
        assert_eq!(fis(&folder, 0, args).stderr, "", "{args:?}");
    }
    let run = fis(&folder, 2, &["eval", "thesis", "--points", "-5", "0"]);
    assert!(run.stderr.contains("invalid value '-5' for '--points <N>'"), "{}", run.stderr);
}

/// The numbers of each line.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let number = |word: &str| word.parse().unwrap_or_else(|_| panic!("{word:?} is no number in\n{text}"));
    text.lines().map(|line| line.split(' ').map(number).collect()).collect()
}

/// The thesis's system from its constant.
fn thesis(defuzzifier: Defuzzifier, x: f64) -> f64 {
    let tables = MamdaniTables { defuzzifier, ..THESIS };
    Curve::<f64>::try_new(&tables).expect("the tables are right").evaluate(x)
}
