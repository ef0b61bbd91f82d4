//! A reproduction covers the thesis: every figure once, Table 5.2 as printed, whole files, the same for any number of threads.
//!
//! Laws: figures 3.4 to 3.18 and 5.2 to 5.44 have one counterpart each; the table's numbers are those of the thesis, its
//! improvements follow from its own ITAE, its ratios are ours over the thesis's; files are whole or not there.
//! Why: a table that misquotes is worse than none, and people build reports on the files.
//! Reference: the thesis's list of figures and Table 5.2, written out here; the XML reader `roxmltree`.
//! Tolerance: none, but rounding where numbers are recomputed. Runs are cut to a fraction of a second: what is checked here does
//! not depend on their length.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use mm_sim::figures::Recording;
use mm_sim::reproduce::{EXPERIMENTS, FIGURES, Options, Plan, Report, ReproduceError, Row, Watch};
use mm_sim::scenario;

struct Silent;
impl Watch for Silent {}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("reproduce").join(name);
    let _ = std::fs::remove_dir_all(&path);
    path
}

fn plan(jobs: usize, sets: &[&str]) -> Plan {
    let sets = sets.iter().map(|&set| set.to_owned()).collect();
    Plan::new(&Options { jobs, sets }).unwrap_or_else(|error| panic!("{error}"))
}

fn reproduced(name: &str, jobs: usize, sets: &[&str]) -> (Report, PathBuf) {
    let out = folder(name);
    let report = plan(jobs, sets).run(&out, &Silent).unwrap_or_else(|error| panic!("{error}"));
    (report, out)
}

/// Contents of all files below a folder, by path.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for below in [".", "data", "figures"] {
        for entry in std::fs::read_dir(folder.join(below)).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_file() {
                let name = path.strip_prefix(folder).expect("below").display().to_string();
                all.insert(name, std::fs::read(&path).expect("a file"));
            }
        }
    }
    all
}

/// Fields of the lines of a CSV file, whose quoted fields hold no quotes.
fn csv(bytes: &[u8]) -> Vec<Vec<String>> {
    let text = std::str::from_utf8(bytes).expect("text");
    let fields = |line: &str| {
        let mut fields = vec![String::new()];
        let mut quoted = false;
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => fields.push(String::new()),
                c => fields.last_mut().expect("a field").push(c),
            }
        }
        fields
    };
    text.lines().map(fields).collect()
}

#[test]
fn every_figure_of_the_thesis_has_one_counterpart() {
    let wanted = (4..=18).map(|n| format!("3.{n}")).chain((2..=44).map(|n| format!("5.{n}")));
    let is_number = |number: &str| number.starts_with(|c: char| c.is_ascii_digit());
    let printed: Vec<&str> = FIGURES.iter().map(|figure| figure.number).filter(|n| is_number(n)).collect();
    assert_eq!(printed, wanted.collect::<Vec<_>>(), "in the order of the thesis, each once");
    let mut numbers: Vec<&str> = FIGURES.iter().map(|figure| figure.number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), FIGURES.len(), "additions have names of their own");
    for figure in FIGURES {
        let of = EXPERIMENTS.iter().find(|experiment| experiment.name == figure.experiment);
        let experiment = of.unwrap_or_else(|| panic!("figure {} shows no experiment", figure.number));
        let known = figure.controllers.iter().all(|law| experiment.controllers.contains(law));
        assert!(known, "figure {} shows laws of its experiment", figure.number);
    }
    for name in ["verify-straight", "sinusoid", "spiral", "square", "spiral-compare", "square-compare"] {
        let is_it = |experiment: &&mm_sim::reproduce::Experiment| experiment.scenario == name;
        assert!(EXPERIMENTS.iter().any(|e| is_it(&e)), "{name} is run");
        assert!(scenario::bundled().iter().any(|(bundled, _)| *bundled == name), "{name} is bundled");
    }
}

#[test]
fn files_are_whole_and_the_same_for_any_number_of_threads() {
    let sets = ["simulation.duration_s=0.3"];
    let (report, one) = reproduced("one", 1, &sets);
    let (again, three) = reproduced("three", 3, &sets);
    let (files, others) = (contents(&one), contents(&three));
    assert!(files == others, "the same names and bytes");
    let digests = |report: &Report| report.runs.iter().map(|run| run.digest.clone()).collect::<Vec<_>>();
    assert_eq!(digests(&report), digests(&again), "the same runs in the same order");
    assert!(files.keys().all(|name| !name.contains(".part")), "nothing half done: {:?}", files.keys());

    let index = csv(&files["figures.csv"]);
    assert_eq!(index[0], ["figure", "caption", "svg", "data"], "header of the index");
    assert_eq!(index.len(), report.figures.len() + 1, "a line for each figure");
    for (line, figure) in index[1..].iter().zip(&report.figures) {
        assert_eq!(line[0], figure.figure, "in order");
        let svg = std::str::from_utf8(&files[&line[2]]).expect("text");
        let document = roxmltree::Document::parse(svg).unwrap_or_else(|e| panic!("{}: {e}", line[0]));
        let lines = document.descendants().filter(|node| node.has_tag_name("polyline")).count();
        assert!(lines > 5, "figure {} has {lines} lines", line[0]);
        assert!(svg.contains(figure.caption), "figure {} has its caption", line[0]);
        assert!(svg.len() < 300_000, "figure {} has {} bytes", line[0], svg.len());
        assert!(!line[3].is_empty(), "figure {} names its data", line[0]);
        for data in line[3].split(' ') {
            assert!(files.contains_key(data), "{data} of figure {} is there", line[0]);
        }
    }
    for run in &report.runs {
        let rows = csv(&files[&run.data]);
        assert_eq!(rows[0], Recording::names().collect::<Vec<_>>(), "columns of {}", run.data);
        assert_eq!(rows.len(), 1 + 28, "{}: 300 periods, every eleventh", run.data);
        assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{}: full rows", run.data);
    }
    let svgs = files.keys().filter(|name| name.ends_with(".svg")).count();
    assert_eq!(svgs, report.figures.len(), "no figure twice under one name");
    assert_eq!(files.len(), svgs + report.runs.len() + 3, "two tables, a page, and nothing else");
}

#[test]
fn the_table_quotes_table_5_2_and_computes_the_rest_from_it() {
    let (report, out) = reproduced("table", 0, &["simulation.duration_s=0.3"]);
    let find = |law: &str, quantity: &str| -> Row {
        let is_it = |row: &&Row| {
            row.experiment == "square-compare" && row.controller == law && row.quantity == quantity
        };
        *report.table.iter().find(is_it).unwrap_or_else(|| panic!("{quantity} of {law} is in the table"))
    };
    for (axis, bsmc, bfsmc, improvement) in [
        (" x", 3.91, 2.06, 47.31),
        (" y", 4.637, 4.265, 8.02),
        (" z", 2.431, 1.232, 49.32),
        (", sum", 10.978, 7.557, 31.16),
    ] {
        let itae = format!("ITAE{axis}");
        let base = find("bsmc", &itae);
        assert_eq!(base.thesis, Some(bsmc), "{itae} of BSMC");
        // The printed improvement follows from the printed ITAE, by the baseline, to the digits printed.
        assert!(((bsmc - bfsmc) / bsmc * 100.0 - improvement).abs() < 0.005_000_1, "{itae}");
        for law in ["bfsmc-thesis", "bfsmc"] {
            let fuzzy = find(law, &itae);
            assert_eq!(fuzzy.thesis, Some(bfsmc), "{itae} of BFSMC beside {law}");
            let below = find(law, &format!("ITAE below bsmc,{}", axis.trim_start_matches(',')));
            assert_eq!(below.thesis, Some(improvement), "improvement along{axis}");
            let (b, f) = (base.ours.expect("a finished run"), fuzzy.ours.expect("a finished run"));
            let percent = below.ours.expect("two finished runs");
            assert!((percent - (b - f) / b * 100.0).abs() < 1e-9, "{law}{axis}: {percent} from {b} and {f}");
        }
        let gains = base.note.is_some_and(|note| note.contains("gains"));
        assert!(gains, "{itae}: said to be incomparable: {:?}", base.note);
    }
    for row in &report.table {
        assert!(
            row.ours.is_some() || row.quantity == "within 10 mm from" || row.quantity.contains("s on"),
            "{row:?}"
        );
        match (row.thesis, row.ours, row.ratio) {
            (Some(thesis), Some(ours), Some(ratio)) => {
                assert!((ratio - ours / thesis).abs() <= 1e-12 * ratio.abs(), "{row:?}");
            }
            (Some(thesis), Some(_), None) => {
                assert!(thesis.abs() < 1e-300, "no ratio to zero alone: {row:?}");
            }
            (_, _, ratio) => assert_eq!(ratio, None, "{row:?}"),
        }
    }
    let lines = csv(&std::fs::read(out.join("table.csv")).expect("the table"));
    assert_eq!(lines.len(), report.table.len() + 1, "a line for each row");
    for (line, row) in lines[1..].iter().zip(&report.table) {
        assert_eq!(line[..4], [row.experiment, row.controller, row.quantity, row.unit], "in order");
        let read = |field: &str| (!field.is_empty()).then(|| field.parse::<f64>().expect("a number"));
        let numbers = [row.thesis, row.ours, row.ratio];
        assert_eq!([4, 5, 6].map(|i| read(&line[i])), numbers, "every digit: {line:?}");
        assert_eq!(line[7], row.note.unwrap_or_default(), "the note of {row:?}");
    }
}

#[test]
fn section_3_7_is_measured_on_the_motion() {
    // Enough of the circles for three points; the rest at its full length.
    let (report, _) = reproduced("verify", 0, &["simulation.duration_s=2"]);
    let of = |experiment: &str, quantity: &str| {
        let is_it = |row: &&Row| row.experiment == experiment && row.quantity == quantity;
        report.table.iter().find(is_it).and_then(|row| row.ours).unwrap_or(f64::NAN)
    };
    for (experiment, quantity, expected) in [
        ("verify-straight", "mean speed of the base", 0.1),
        ("verify-straight", "largest |y| of the base", 0.0),
        ("verify-circle", "radius of the circle", 0.5),
        ("verify-reverse-circle", "radius of the circle", 0.5),
        ("verify-moving-base", "way of the base", 1.0),
        // Both links turn about the shoulder as one: |0.5 at 60 degrees + 0.5 at -60 degrees| = 0.5.
        ("verify-joint2", "radius of the tip's arc", 0.5),
        // Half a turn at a reach of 0.5 m, and the way of the base beside it.
        ("verify-resting-base", "span of the semicircle", 1.0),
        ("verify-moving-base", "span of the semicircle", 2.0),
    ] {
        let got = of(experiment, quantity);
        // Runge-Kutta leaves 1e-13, three points on an arc lose some digits.
        assert!((got - expected).abs() < 1e-9, "{experiment}: {quantity} is {got}, not {expected}");
    }
}

/// Asks to end after some steps.
struct Impatient(AtomicUsize);

impl Watch for Impatient {
    fn goes_on(&self) -> bool {
        self.0.load(Ordering::Relaxed) > 0
    }
    fn done(&self, _what: &str) {
        let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(1));
    }
}

#[test]
fn an_interrupted_reproduction_leaves_whole_files_only() {
    let plan = plan(2, &["simulation.duration_s=0.1"]);
    let runs: usize = EXPERIMENTS
        .iter()
        .filter(|e| scenario::bundled().iter().any(|(name, _)| *name == e.scenario))
        .map(|e| e.controllers.len())
        .sum();
    for steps in [3, runs + 5] {
        let out = folder(&format!("interrupted-{steps}"));
        let outcome = plan.run(&out, &Impatient(AtomicUsize::new(steps)));
        assert!(matches!(outcome, Err(ReproduceError::Interrupted)), "{outcome:?}");
        let files = contents(&out);
        assert!(files.len() >= steps, "what was done is there: {:?}", files.keys());
        assert!(!files.contains_key("table.csv"), "no table of half the runs");
        assert!(files.keys().all(|name| !name.contains(".part")), "nothing half done: {:?}", files.keys());
        for (name, bytes) in files.iter().filter(|(name, _)| name.ends_with(".csv")) {
            assert_eq!(csv(bytes).len(), 1 + 10, "{name}: 100 periods, every eleventh");
        }
    }
}

#[test]
fn a_run_that_fails_is_in_the_report_and_out_of_the_table() {
    // A thousandth of the weight that the controller believes in.
    let sets = ["plant.mass_scale=0.001", "simulation.duration_s=5"];
    let (report, _) = reproduced("fails", 0, &sets);
    let failed: Vec<_> = report.runs.iter().filter(|run| !run.finished).collect();
    assert!(!failed.is_empty(), "some run diverges");
    for run in failed {
        let said = run.warnings.last().is_some_and(|warning| warning.contains("diverged at t = "));
        assert!(said, "{} with {}: {:?}", run.experiment, run.controller, run.warnings);
        let of_it = |row: &&Row| row.experiment == run.experiment && row.controller == run.controller;
        let filled = report.table.iter().filter(of_it).filter(|row| row.ours.is_some()).count();
        assert_eq!(filled, 0, "{} with {} has no numbers", run.experiment, run.controller);
    }
}
