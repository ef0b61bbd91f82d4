//! Law: each flaw is found, with its names and numbers, in a system that has it; none is found in a system without any.
//!
//! Why: a finding that is not there is worth no more than one that is missed.
//! Reference: small systems whose flaw is put there by hand, its place read off the breakpoints; for the thesis's system its
//! Appendix C and the values of the closed form. Tolerance: breakpoints are found exactly; turning points to 1e-6, values there to 1e-9.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

mod course;
mod coverage;
mod rules;

use mm_fis::check::{Finding, FindingKind as Kind, Report, check};
use mm_fis::{System, read_fis};

/// One input, one output, terms from neighbour to neighbour: no flaw.
const SOUND: &str = "[System]
Name='sound'
Type='mamdani'
[Input1]
Name='x'
Range=[0 4]
MF1='low':'trimf',[0 0 2]
MF2='mid':'trimf',[0 2 4]
MF3='high':'trimf',[2 4 4]
[Output1]
Name='y'
Range=[-1 5]
MF1='few':'trimf',[-1 0 1]
MF2='some':'trimf',[1 2 3]
MF3='many':'trimf',[3 4 5]
[Rules]
1, 1 (1) : 1
2, 2 (1) : 1
3, 3 (1) : 1
";

/// Two inputs, every pair of terms in a rule: no flaw.
const PLANE: &str = "[System]
Name='plane'
Type='sugeno'
AndMethod='prod'
[Input1]
Name='u'
Range=[0 1]
MF1='lo':'linzmf',[0 1]
MF2='hi':'linsmf',[0 1]
[Input2]
Name='v'
Range=[0 1]
MF1='lo':'linzmf',[0 1]
MF2='hi':'linsmf',[0 1]
[Output1]
Name='w'
Range=[0 3]
MF1='nil':'constant',[0]
MF2='one':'constant',[1]
MF3='two':'constant',[2]
MF4='all':'constant',[3]
[Rules]
1 1, 1 (1) : 1
1 2, 2 (1) : 1
2 1, 3 (1) : 1
2 2, 4 (1) : 1
";

fn system(text: &str) -> System {
    read_fis(text).unwrap_or_else(|error| panic!("{error}\n{text}")).system
}

fn report(text: &str) -> Report {
    check(&system(text)).expect("the system runs")
}

/// The text with a part that it has once replaced.
fn with(text: &str, from: &str, to: &str) -> String {
    assert_eq!(text.matches(from).count(), 1, "{from:?} is there once");
    text.replace(from, to)
}

/// The kinds of all findings.
fn kinds(report: &Report) -> Vec<Kind> {
    report.findings.iter().map(|finding| finding.kind).collect()
}

/// The finding of a kind, which has to be the only one of it.
fn one(report: &Report, kind: Kind) -> &Finding {
    let found: Vec<&Finding> = report.findings.iter().filter(|finding| finding.kind == kind).collect();
    assert_eq!(found.len(), 1, "one {kind}: {:#?}", report.findings);
    found[0]
}

fn near(a: f64, b: f64, tolerance: f64, what: &str) {
    assert!((a - b).abs() <= tolerance, "{what}: {a}, expected {b}");
}

#[test]
fn sound_systems_have_no_findings() {
    let smooth =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/fis/smooth.fis"));
    for text in [SOUND, PLANE, &smooth.expect("the bundled file")] {
        let report = report(text);
        assert_eq!(report.findings, [], "{text}");
        assert!(!report.is_sampled && report.skipped.is_empty(), "all was looked at, exactly");
    }
    let plane = report(PLANE);
    assert_eq!(plane.outputs[0].reached, (0.0, 3.0), "corner to corner");
}

#[test]
fn the_thesis_has_the_flaws_that_its_documentation_names() {
    let text =
        std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/fis/thesis.fis"));
    let report = report(&text.expect("the bundled file"));
    assert_eq!(
        kinds(&report),
        [
            Kind::UnusedTerm,
            Kind::ClippedTerm,
            Kind::ClippedTerm,
            Kind::Jump,
            Kind::TermBeyondRange,
            Kind::NotMonotone
        ],
        "{:#?}",
        report.findings
    );
    assert_eq!(one(&report, Kind::UnusedTerm).terms, ["AZ"], "the output term without a rule");
    assert_eq!(one(&report, Kind::TermBeyondRange).terms, ["NB", "PB"], "from -4.6 and to 4.6");
    let [jump] = one(&report, Kind::Jump).jumps.as_slice() else { panic!("one jump") };
    // The half triangle that the range leaves of PB and NB: two thirds of the way to the end.
    let half = 0.6666 + (1.0 - 0.6666) * 2.0 / 3.0;
    assert_eq!((jump.inputs.as_slice(), jump.value), ([0.0].as_slice(), 0.0), "at 0, through 0");
    near(jump.left, half, 1e-9, "left of 0");
    near(jump.right, -half, 1e-9, "right of 0");
    let runs = &one(&report, Kind::NotMonotone).runs;
    let ends: Vec<f64> = runs.iter().map(|run| run.to).collect();
    let expected = [-0.25, -0.125, 0.0, 0.0, 0.125, 0.25, 1.0];
    assert_eq!(ends.len(), expected.len(), "{runs:#?}");
    for (end, expected) in ends.iter().zip(expected) {
        near(*end, expected, 1e-6, "a turn");
    }
    assert_eq!(
        runs.iter().map(mm_fis::check::Run::rises).collect::<Vec<_>>(),
        [true, false, true, false, true, false, true]
    );
    near(runs[0].from_value, 1.0 / 3.0, 1e-9, "a third at the lower end");
    near(runs[6].to_value, -1.0 / 3.0, 1e-9, "a third at the upper end");
    near(report.outputs[0].reached.1, half, 1e-9, "the largest value");
}
