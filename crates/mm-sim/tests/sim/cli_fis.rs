//! `mmsim fis`: evaluates, checks and draws fuzzy systems as its help says.
//!
//! Law: results on standard output as numbers that read back to the same bits, all else on standard error; exit codes 0, 1, 2.
//! Why: what comes out is compared with MATLAB and goes into other programs.
//! Reference: the thesis's Appendix C by hand (1/3 at both ends, 0 at 0), the closed form and the 101 samples of
//! mm-control's own engines called directly. No tolerance but where a test gives one.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]
#![expect(clippy::float_cmp, reason = "numbers are read back to the bit")]

use std::io::Write as _;
use std::process::Stdio;

use crate::common::command::{Ended, Folder, ended};
use mm_control::fuzzy::fixed::Evaluate as _;
use mm_control::fuzzy::{Curve, Defuzzifier, FuzzySystem as _, MamdaniTables, Sampling, THESIS};
use mm_fis::compile::{CompiledSurface, Q15};
use serde_json::Value;

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

/// The numbers of each line.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let number = |word: &str| word.parse().unwrap_or_else(|_| panic!("{word:?} is no number in\n{text}"));
    text.lines().map(|line| line.split(' ').map(number).collect()).collect()
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("not JSON ({error}):\n{text}"))
}

/// The thesis's system from its constant.
fn thesis(defuzzifier: Defuzzifier, x: f64) -> f64 {
    let tables = MamdaniTables { defuzzifier, ..THESIS };
    Curve::<f64>::try_new(&tables).expect("the tables are right").evaluate(x)
}

#[test]
fn eval_gives_inputs_then_outputs_to_the_bit() {
    let folder = Folder::new("fis-eval");
    for args in [
        &["eval", "thesis", "-1.4", "0", "-.5", "-1e-3", "0.3", "1.4"] as &[&str],
        &["eval", "thesis", "--", "-1.4", "0", "-.5", "-1e-3", "0.3", "1.4"],
        &["eval", "--engine", "exact", "thesis.fis", "-1.4", "0", "-.5", "-1e-3", "0.3", "1.4"],
    ] {
        let run = fis(&folder, 0, args);
        assert!(run.stderr.is_empty(), "nothing to remark: {}", run.stderr);
        let inputs = [-1.4, 0.0, -0.5, -0.001, 0.3, 1.4];
        let expected: Vec<Vec<f64>> =
            inputs.iter().map(|&x| vec![x, thesis(Defuzzifier::Centroid, x)]).collect();
        assert_eq!(rows(&run.stdout), expected, "{args:?}");
        let at_end = rows(&run.stdout)[0][1];
        assert!((at_end - 1.0 / 3.0).abs() < 1e-15, "1/3 at the end: {at_end}");
        assert_eq!(run.stdout.lines().nth(1), Some("0 0"), "0 at 0, without a sign");
        assert_eq!(
            run.stdout.lines().nth(3).and_then(|line| line.split(' ').next()),
            Some("-0.001"),
            "no exponent"
        );
    }
    assert!(!folder.path("thesis.svg").exists(), "nothing is written");
}

#[test]
fn eval_samples_as_matlab_and_as_fuzzylite_do() {
    let folder = Folder::new("fis-sampled");
    let value = |args: &[&str]| rows(&fis(&folder, 0, &[&["eval", "thesis"], args].concat()).stdout)[0][1];
    let sampled = |points| Defuzzifier::SampledCentroid(points);
    assert_eq!(
        value(&["0.0001", "--engine", "sampled"]),
        thesis(sampled(Sampling::Ends(101)), 1e-4),
        "101 from end to end"
    );
    assert!(
        (value(&["0.0001", "--engine", "sampled"]) + 0.8954).abs() < 1e-4,
        "what MATLAB shows just above 0"
    );
    assert!((value(&["0.0001"]) + 0.8889).abs() < 1e-4, "and the closed form");
    assert_eq!(
        value(&["0.3", "--engine", "sampled", "--points", "1000", "--sampling", "midpoints"]),
        thesis(sampled(Sampling::Midpoints(1000)), 0.3),
        "1000 in the middles of parts"
    );
    let run = fis(&folder, 0, &["eval", "thesis", "0.3", "--points", "7"]);
    assert!(run.stderr.contains("matter only with `--engine sampled`"), "{}", run.stderr);
    let largest = TIP.replace("Type='mamdani'", "Type='mamdani'\nDefuzzMethod='lom'");
    folder.write("lom.fis", &largest);
    let row = &rows(&fis(&folder, 0, &["eval", "lom.fis", "5", "5", "--points", "11"]).stdout)[0];
    assert_eq!(row[2], 15.0, "of 0, 3, ... 30 the one where `average` is largest");
}

#[test]
fn eval_takes_several_inputs_and_several_evaluations() {
    let folder = Folder::new("fis-several");
    folder.write("tip.fis", TIP);
    let run = fis(&folder, 0, &["eval", "tip.fis", "3", "8", "0", "0", "10", "10"]);
    let rows = rows(&run.stdout);
    assert_eq!(rows.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3, 3], "two inputs and an output");
    assert_eq!((&rows[0][..2], rows[1][2], rows[2][2]), ([3.0, 8.0].as_slice(), 5.0, 25.0), "worst and best");
    for text in ["3 8\n0 0\n10 10\n", "3,8\r\n\r\n 0, 0\r\n10;10", "\u{feff}3\t8\n0 0 10 10\n"] {
        let piped = piped(&folder, &["fis", "eval", "tip.fis"], text);
        assert_eq!((piped.code, &piped.stdout), (0, &run.stdout), "{text:?} {}", piped.stderr);
    }
    assert_eq!(fis(&folder, 0, &["eval", "thesis"]).stdout, "", "nothing in, nothing out");
    let run = fis(&folder, 2, &["eval", "tip.fis", "3", "8", "5"]);
    assert_eq!(
        run.stderr,
        "error: found 3 numbers, expected 2 for each evaluation (`service`, `food`) or a multiple of that\n"
    );
    let run = fis(&folder, 2, &["eval", "tip.fis", "3", "eight"]);
    assert_eq!((run.stderr.as_str(), run.stdout.as_str()), ("error: `eight` is not a number\n", ""));
    let run = piped(&folder, &["fis", "eval", "tip.fis"], "3 8\n\n5 x\n");
    assert_eq!((run.code, run.stderr.as_str()), (2, "error: standard input, line 3: `x` is not a number\n"));
    assert_eq!(run.stdout.lines().count(), 1, "what came before is there");
    let run = piped(&folder, &["fis", "eval", "tip.fis"], "3\n");
    assert_eq!(
        (run.code, run.stderr.as_str()),
        (2, "error: standard input, line 1: found 1 number, expected 2 or a multiple of that\n")
    );
}

#[test]
fn eval_says_once_what_the_engine_met() {
    let folder = Folder::new("fis-met");
    folder.write("gap.fis", GAP);
    let run = fis(&folder, 0, &["eval", "gap.fis", "0.5", "9", "2", "-inf", "nan", "1.5"]);
    let values: Vec<f64> = rows(&run.stdout).iter().map(|row| row[1]).collect();
    assert_eq!(values, [1.0, 9.0, 5.0, 1.0, 5.0, 5.0], "middles of terms, and of the range where none fires");
    assert_eq!(
        run.stderr,
        "warning: evaluation 2: input `x` = 9 is outside its range, [0, 4]; it is taken as 4 (and 1 more evaluation)\n\
         warning: evaluation 5: input `x` is not a number; each output is the middle of its range\n\
         warning: evaluation 3: no rule fires, or what fires has no area: output `y` is 5 (and 1 more evaluation)\n"
    );
    let run = piped(&folder, &["fis", "eval", "gap.fis"], "1\n\n7\n");
    assert!(run.stderr.contains("evaluation 2 (line 3): input `x` = 7"), "{}", run.stderr);
    let run = fis(&folder, 0, &["eval", "gap.fis", "--json", "0.5", "9", "2", "nan"]);
    let value = json(&run.stdout);
    let expected = serde_json::json!([
        {"inputs": [0.5], "outputs": [1.0], "clamped": false, "unfired": false},
        {"inputs": [9.0], "outputs": [9.0], "clamped": true, "unfired": false},
        {"inputs": [2.0], "outputs": [5.0], "clamped": false, "unfired": true},
        {"inputs": [null], "outputs": [5.0], "clamped": false, "unfired": true},
    ]);
    assert_eq!(value, expected, "an object an evaluation");
    assert_eq!(json(&fis(&folder, 0, &["eval", "gap.fis", "--json"]).stdout), serde_json::json!([]), "none");
}

#[test]
fn eval_falls_back_to_samples_where_sets_are_curved() {
    let folder = Folder::new("fis-curved");
    folder.write("curved.fis", &TIP.replace("'trimf',[10 15 20]", "'gaussmf',[2 14]"));
    let run = fis(&folder, 0, &["eval", "curved.fis", "5", "5", "5", "4"]);
    assert_eq!(
        run.stderr,
        "note: the output sets are curved, which have no exact centroid here: it is taken from 10001 samples\n",
        "said once"
    );
    let row = &rows(&run.stdout)[0];
    assert!((row[2] - 14.0).abs() < 1e-6, "the middle of the curve: {}", row[2]);
    let sampled = fis(&folder, 0, &["eval", "curved.fis", "5", "5", "--engine", "sampled"]);
    assert!(sampled.stderr.is_empty(), "asked for: {}", sampled.stderr);
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
fn compile_writes_what_the_library_makes() {
    let folder = Folder::new("fis-compile");
    for (file, part) in [
        ("table.rs", "pub const THESIS_SURFACE: Surface1<'static>"),
        ("table.h", "#ifndef THESIS_SURFACE_H"),
        ("table.c", "thesis_surface_evaluate"),
        ("table.toml", "knots = ["),
    ] {
        let run = fis(&folder, 0, &["compile", "thesis", "--bits", "16", "-o", file]);
        assert_eq!(run.stdout, "", "the result is in the file");
        for report in
            [file, "knots of 16 bits", "jump at `input1` = 0", "largest error", "over all 65,536 inputs"]
        {
            assert!(run.stderr.contains(report), "{report:?} in {}", run.stderr);
        }
        let text = std::fs::read_to_string(folder.path(file)).expect("the result");
        assert!(text.contains(part), "{part:?} in {file}:\n{text}");
        assert!(
            text.contains(&format!("Made again by: mmsim fis compile thesis --bits 16 -o {file}")),
            "{text}"
        );
        let again = fis(&folder, 0, &["compile", "thesis", "--quiet", "-o", file]);
        assert_eq!(
            (again.stderr.as_str(), std::fs::read_to_string(folder.path(file)).ok()),
            ("", Some(text)),
            "again"
        );
    }
    let text = std::fs::read_to_string(folder.path("table.toml")).expect("the table");
    let table = CompiledSurface::from_toml(&text).expect("what was written is read");
    let run = fis(&folder, 0, &["eval", "thesis", "--engine", "surface", "-1.4", "-0.3", "0", "0.3", "0.7"]);
    for row in rows(&run.stdout) {
        #[expect(clippy::cast_possible_truncation, reason = "within the range")]
        let q = (row[0] / 1.4 * 32768.0).round() as i16;
        let expected = f64::from(table.surface().evaluate(q)) / 32768.0;
        assert_eq!(row[1], expected, "the command's surface is the file's, at {}", row[0]);
        assert!((row[1] - thesis(Defuzzifier::Centroid, row[0])).abs() <= table.bound, "within the bound");
    }
    let run = fis(&folder, 0, &["compile", "thesis", "--to", "q15", "--lang", "toml"]);
    assert!(run.stderr.contains("units of the last place"), "{}", run.stderr);
    assert_eq!(Q15::from_toml(&run.stdout).expect("read back").inputs[0].len(), 8, "eight input terms");
    let run = fis(&folder, 0, &["compile", "thesis", "--to", "q15", "--name", "rules"]);
    assert!(run.stdout.contains("pub const RULES: Tables<'static>"), "{}", run.stdout);
}

#[test]
fn compile_and_the_engines_of_two_inputs() {
    let folder = Folder::new("fis-compile-2");
    folder.write("tip.fis", TIP);
    let coarse = ["--bound", "0.5", "--input-bits", "8"];
    let run = fis(&folder, 0, &[&["compile", "tip.fis", "-o", "tip.h"], coarse.as_slice()].concat());
    assert!(run.stderr.contains("inputs of 8 bits"), "{}", run.stderr);
    assert!(std::fs::read_to_string(folder.path("tip.h")).expect("it").contains("tip_surface_evaluate"), "C");
    let exact = rows(&fis(&folder, 0, &["eval", "tip.fis", "3", "8"]).stdout)[0][2];
    let of =
        |args: &[&str]| rows(&fis(&folder, 0, &[&["eval", "tip.fis", "3", "8"], args].concat()).stdout)[0][2];
    let surface = of(&[&["--engine", "surface"], coarse.as_slice()].concat());
    assert!(
        (surface - exact).abs() < 0.6 && (surface - exact).abs() > 0.0,
        "the table's {surface}, exactly {exact}"
    );
    let rules = of(&["--engine", "q15"]);
    assert!(
        (rules - exact).abs() < 0.01 && (rules - exact).abs() > 0.0,
        "fixed point {rules}, exactly {exact}"
    );
    let run = fis(&folder, 2, &["compile", "tip.fis", "--bound", "1e-6", "--input-bits", "8"]);
    assert!(run.stderr.contains("ask for less (--bound"), "{}", run.stderr);
    let two =
        TIP.replace("[Rules]", "[Output2]\nName='smile'\nRange=[0 1]\nMF1='wide':'trimf',[0 0.5 1]\n[Rules]");
    let two = two.replace(", 1 (", ", 1 1 (").replace(", 2 (", ", 2 0 (").replace(", 3 (", ", 3 0 (");
    folder.write("two.fis", &two);
    let run = fis(&folder, 2, &["compile", "two.fis"]);
    assert!(run.stderr.contains("choose with --which: 1 `tip`, 2 `smile`"), "{}", run.stderr);
    for which in ["2", "smile"] {
        let run = fis(&folder, 0, &["compile", "two.fis", "--which", which, "--input-bits", "8"]);
        assert!(run.stderr.contains("surface of output `smile`"), "{}", run.stderr);
    }
    fis(&folder, 2, &["compile", "two.fis", "--which", "3"]);
}

#[test]
fn compile_refuses_what_it_cannot_write() {
    let folder = Folder::new("fis-compile-bad");
    for (args, code, part) in [
        (&["thesis", "-o", "table.txt"] as &[&str], 2, "expected .rs, .h, .c or .toml, or --lang"),
        (&["thesis", "--to", "q15", "-o", "table.c"], 2, "for C, compile a surface"),
        (&["thesis", "--bits", "17"], 2, "17"),
        (&["thesis", "--bound", "0"], 2, "expected a number above 0"),
        (
            &["thesis", "--bound", "-1"],
            2,
            "invalid value '-1' for '--bound <ERROR>': expected a number above 0",
        ),
        (
            &["thesis", "-o", "table.h", "--lang", "rust"],
            2,
            "--lang rust contradicts the ending of table.h: expected .rs",
        ),
        (&["thesis", "-o", "no/such/folder.rs"], 1, "cannot write no/such/folder.rs"),
    ] {
        let run = fis(&folder, code, &[&["compile"], args].concat());
        assert!(run.stderr.contains(part) && run.stdout.is_empty(), "{part:?} in {}", run.stderr);
    }
    let left = std::fs::read_dir(folder.path("")).expect("the folder").count();
    assert_eq!(left, 0, "nothing is left behind");
}

#[test]
fn each_command_has_help_with_an_example() {
    let folder = Folder::new("fis-help");
    for what in ["eval", "check", "plot", "compile"] {
        let run = fis(&folder, 0, &[what, "--help"]);
        assert!(run.stdout.contains(&format!("mmsim fis {what} thesis")), "{}", run.stdout);
    }
}

/// Law: digits are the shortest that read back to the same bits, also for the smallest and the largest numbers.
#[test]
fn eval_writes_small_and_large_numbers_with_an_exponent() {
    let folder = Folder::new("fis-digits");
    let run = fis(&folder, 0, &["eval", "thesis", "1e-300", "-1e-8", "1e-7", "1e16", "-inf"]);
    let first: Vec<&str> = run.stdout.lines().filter_map(|line| line.split(' ').next()).collect();
    assert_eq!(first, ["1e-300", "-1e-8", "0.0000001", "1e16", "-inf"], "{}", run.stdout);
    assert_eq!(rows(&run.stdout)[0][0], 1e-300, "read back");
    let value = json(&fis(&folder, 0, &["eval", "thesis", "--json", "inf"]).stdout);
    assert!(value[0]["inputs"][0].is_null(), "JSON has no infinite numbers: {value}");
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
