//! `mmsim fis eval`.

use super::{GAP, TIP, fis, json, piped, rows, thesis};
use crate::common::command::Folder;
use mm_control::fuzzy::{Defuzzifier, Sampling};

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
