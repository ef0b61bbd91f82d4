//! Law: each flaw is found, with its names and numbers, in a system that has it; none is found in a system without any.
//!
//! Why: a finding that is not there is worth no more than one that is missed.
//! Reference: small systems whose flaw is put there by hand, its place read off the breakpoints; for the thesis's system its
//! Appendix C and the values of the closed form. Tolerance: breakpoints are found exactly; turning points to 1e-6, values there to 1e-9.

#![expect(clippy::expect_used, clippy::panic, reason = "a helper that cannot go on is a failed test")]

use mm_fis::check::{Course, Finding, FindingKind as Kind, Report, Severity, along, check};
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

#[test]
fn gaps_between_terms_are_found_to_the_digit() {
    let text = with(&with(SOUND, "[0 0 2]", "[0 0 1]"), "[0 2 4]", "[1.5 2 2.5]");
    let report = report(&with(&text, "[2 4 4]", "[2.5 4 4]"));
    let uncovered = one(&report, Kind::UncoveredInput);
    assert_eq!(uncovered.intervals, [(1.0, 1.5), (2.5, 2.5)], "between the feet, and where two feet meet");
    assert_eq!(uncovered.severity, Severity::Warning, "no rule fires there either");
    assert_eq!(uncovered.message, "no term of input `x` holds on [1, 1.5] and at 2.5");
    let unfired = one(&report, Kind::NoRuleFires);
    assert_eq!(unfired.intervals, uncovered.intervals, "the same places");
    assert_eq!(
        unfired.message, "no rule fires for `x` on [1, 1.5] and at 2.5: output `y` is 2 there",
        "with what the output is"
    );
    // Vertical sides that meet leave no gap.
    let text = with(&with(SOUND, "[0 2 4]", "[0 2 2]"), "'trimf',[2 4 4]", "'trapmf',[2 2 4 4]");
    assert!(!kinds(&check(&system(&text)).expect("runs")).contains(&Kind::UncoveredInput), "both reach 2");
}

#[test]
fn a_gap_that_a_rule_covers_is_a_note() {
    let text = with(&with(SOUND, "[0 2 4]", "[0 2 3]"), "[2 4 4]", "[3.5 4 4]");
    let text = with(&text, "2, 2 (1) : 1", "-1, 2 (1) : 1");
    let report = report(&text);
    let uncovered = one(&report, Kind::UncoveredInput);
    assert_eq!(
        (uncovered.intervals.as_slice(), uncovered.severity),
        ([(3.0, 3.5)].as_slice(), Severity::Note)
    );
    assert!(!kinds(&report).contains(&Kind::NoRuleFires), "`not low` fires: {:#?}", report.findings);
}

#[test]
fn terms_without_feet_count_from_a_thousandth() {
    let text =
        SOUND.replace("'trimf',[0 0 2]", "'gaussmf',[0.2 0]").replace("'trimf',[0 2 4]", "'gaussmf',[0.2 2]");
    let report = report(&text.replace("'trimf',[2 4 4]", "'gaussmf',[0.2 4]"));
    // exp(-z^2/2) = 1/1000 at z^2/2 = ln 1000.
    let reach = 0.2 * (2.0_f64 * 6.907_755_278_982_137).sqrt();
    let uncovered = &one(&report, Kind::UncoveredInput).intervals;
    for ((from, to), center) in uncovered.iter().zip([0.0, 2.0]) {
        near(*from, center + reach, 1e-12, "from where the left one is faint");
        near(*to, center + 2.0 - reach, 1e-12, "to where the right one is no longer");
    }
    assert_eq!(uncovered.len(), 2, "between the three");
    let message = &one(&report, Kind::NoRuleFires).message;
    assert!(message.ends_with("output `y` rests on the tails of terms there"), "{message}");
}

#[test]
fn pairs_of_terms_without_a_rule_are_regions() {
    let text = with(PLANE, "2 2, 4 (1) : 1\n", "");
    let text =
        text.replace("'linzmf',[0 1]", "'linzmf',[0 0.5]").replace("'linsmf',[0 1]", "'linsmf',[0.25 1]");
    let report = report(&with(&text, "MF4='all':'constant',[3]\n", ""));
    let unfired = one(&report, Kind::NoRuleFires);
    assert_eq!(unfired.regions, [vec![(0.5, 1.0), (0.5, 1.0)]], "both beyond the low terms");
    assert_eq!(
        unfired.message,
        "no rule fires for 25 % of the inputs, for example `u` on [0.5, 1], `v` on [0.5, 1]: output `w` is 1.5 there"
    );
    // With `or` one of the two is enough.
    let text = with(PLANE, "2 2, 4 (1) : 1", "2 2, 4 (1) : 2");
    assert!(!kinds(&check(&system(&text)).expect("runs")).contains(&Kind::NoRuleFires), "or");
}

#[test]
fn rules_that_never_fire() {
    for (text, rule, part) in [
        (with(SOUND, "3, 3 (1) : 1\n", "3, 3 (1) : 1\n2, 2 (0) : 1\n"), 4, "its weight is 0"),
        (with(SOUND, "1, 1 (1) : 1\n", "1, 1 (1) : 1\n0, 2 (1) : 2\n"), 2, "no condition, joined by or"),
    ] {
        let report = report(&text);
        let finding = one(&report, Kind::UnreachableRule);
        assert_eq!(finding.rules, [rule], "{}", finding.message);
        assert!(finding.message.contains(part), "{}", finding.message);
    }
    let text =
        with(SOUND, "MF3='high':'trimf',[2 4 4]", "MF3='high':'trimf',[2 4 4]\nMF4='huge':'trimf',[4 5 6]");
    let report = report(&with(&text, "3, 3 (1) : 1\n", "3, 3 (1) : 1\n4, 3 (1) : 1\n"));
    assert_eq!(
        one(&report, Kind::UnreachableRule).message,
        "rule 4 (if x is huge) never fires: \"x is huge\" holds nowhere in its range"
    );
    assert_eq!(
        one(&report, Kind::TermOutsideRange).message,
        "term `huge` of input `x` never holds in [0, 4]",
        "its foot is where the range ends"
    );
    assert_eq!(report.findings.len(), 2, "nothing else: {:#?}", report.findings);
}

#[test]
fn rules_that_say_the_same_or_contradict() {
    let report_of = |rule: &str| report(&with(SOUND, "3, 3 (1) : 1\n", &format!("3, 3 (1) : 1\n{rule}\n")));
    let twice = report_of("2, 2 (0.5) : 2");
    assert_eq!(kinds(&twice), [Kind::DuplicateRules], "{:#?}", twice.findings);
    assert_eq!(twice.findings[0].rules, [2, 4], "and or or: one clause");
    assert_eq!(twice.findings[0].message, "rules 2 and 4 say the same: if x is mid then y is some");
    let against = report_of("1, 3 (1) : 1");
    let finding = one(&against, Kind::ContradictingRules);
    assert_eq!(
        finding.message,
        "rules 1 and 4 contradict each other: if x is low then y is few and y is many"
    );
    assert_eq!(
        (finding.rules.as_slice(), finding.terms.as_slice()),
        ([1, 4].as_slice(), ["few".to_owned(), "many".to_owned()].as_slice())
    );
    assert_eq!(kinds(&report_of("2, 0 (1) : 1")), [Kind::RuleWithoutEffect], "no conclusion");
}

#[test]
fn a_rule_that_another_one_makes_idle() {
    let mamdani = PLANE.replace("'sugeno'\nAndMethod='prod'", "'mamdani'");
    let mamdani =
        mamdani.replace("'constant',[0]", "'trimf',[0 0 1]").replace("'constant',[1]", "'trimf',[0 1 2]");
    let mamdani =
        mamdani.replace("'constant',[2]", "'trimf',[1 2 3]").replace("'constant',[3]", "'trimf',[2 3 3]");
    assert!(!kinds(&report(&mamdani)).contains(&Kind::DominatedRule), "none yet");
    for (rule, idle, by) in [("1 0, 1 (1) : 1", 1, 5), ("1 2, 1 (1) : 2", 1, 5)] {
        let report = report(&with(&mamdani, "2 2, 4 (1) : 1\n", &format!("2 2, 4 (1) : 1\n{rule}\n")));
        assert_eq!(one(&report, Kind::DominatedRule).rules, [idle, by], "{rule}");
    }
    let weaker = report(&with(&mamdani, "2 2, 4 (1) : 1\n", "2 2, 4 (1) : 1\n1 0, 1 (0.5) : 1\n"));
    assert!(!kinds(&weaker).contains(&Kind::DominatedRule), "a weaker rule does not");
    let sugeno = report(&with(PLANE, "2 2, 4 (1) : 1\n", "2 2, 4 (1) : 1\n1 0, 1 (1) : 1\n"));
    assert!(!kinds(&sugeno).contains(&Kind::DominatedRule), "all rules count in a Sugeno system");
}

#[test]
fn what_no_rule_uses() {
    let with_term = with(SOUND, "MF3='many'", "MF4='more':'trimf',[4 4.5 5]\nMF3='many'");
    let report_of = |text: &str| report(text).findings;
    let found = report_of(&with_term);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].message, "term `more` of output `y` is used by no rule");
    let two = PLANE.replace("1 1, 1", "0 1, 1").replace("1 2, 2", "0 2, 2").replace("2 1, 3", "0 1, 1");
    let found = report(&two.replace("2 2, 4", "0 2, 2"));
    assert_eq!(one(&found, Kind::UnusedInput).message, "input `u`: no rule asks for it");
    assert_eq!(
        found.findings.iter().filter(|f| f.kind == Kind::UnusedTerm).count(),
        2,
        "two constants, no input term"
    );
    let text = with(
        SOUND,
        "[Rules]\n1, 1 (1)",
        "[Output2]\nName='z'\nRange=[0 1]\nMF1='a':'trimf',[0 0.5 1]\n[Rules]\n1, 1 0 (1)",
    );
    let text = text.replace("2, 2 (", "2, 2 0 (").replace("3, 3 (", "3, 3 0 (");
    let found = report_of(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    assert_eq!(found[0].message, "output `z`: no rule concludes anything about it");
}

#[test]
fn terms_and_ranges_that_do_not_fit() {
    let clipped = report(&with(SOUND, "Range=[-1 5]", "Range=[0 5]"));
    assert_eq!(kinds(&clipped), [Kind::ClippedTerm], "{:#?}", clipped.findings);
    assert_eq!(
        clipped.findings[0].message,
        "the range of output `y`, [0, 5], cuts term `few` off: its centroid is 0.333333 instead of 0"
    );
    let beyond = report(&with(SOUND, "[2 4 4]", "[2 4 6]"));
    assert_eq!(kinds(&beyond), [Kind::TermBeyondRange], "{:#?}", beyond.findings);
    assert_eq!(beyond.findings[0].message, "term `high` of input `x` reaches beyond its range, [0, 4]");
    let order = report(&with(&with(SOUND, "MF1='few'", "MF2='few'"), "MF2='some'", "MF1='some'"));
    let finding = one(&order, Kind::TermOrder);
    assert_eq!(
        finding.message,
        "the terms of output `y` are not in ascending order: `few` comes after `some`"
    );
    let equal = report(
        &with(SOUND, "MF3='many'", "MF4='lots':'trimf',[3 4 5]\nMF3='many'").replace("3, 3 (1)", "3, 4 (1)"),
    );
    assert_eq!(
        one(&equal, Kind::EqualTerms).message,
        "terms `many` and `lots` of output `y` are the same set"
    );
    let wide = report(&with(SOUND, "Range=[-1 5]", "Range=[-1 20]"));
    assert_eq!(kinds(&wide), [Kind::RangeNotReached], "{:#?}", wide.findings);
    assert_eq!(
        wide.findings[0].message,
        "an end of a range is never near: output `y` takes on [0, 4], its range is [-1, 20]"
    );
    let beyond = report(&with(PLANE, "'constant',[3]", "'constant',[4]"));
    assert_eq!(kinds(&beyond), [Kind::RangeExceeded], "{:#?}", beyond.findings);
}

#[test]
fn turns_and_jumps_of_one_input() {
    let turn = report(&with(SOUND, "3, 3 (1)", "3, 1 (1)").replace("MF3='many':'trimf',[3 4 5]\n", ""));
    let runs = &one(&turn, Kind::NotMonotone).runs;
    assert_eq!(runs.len(), 2, "up and down: {runs:#?}");
    assert_eq!((runs[0].from, runs[0].to, runs[1].to), (0.0, 2.0, 4.0), "at the peak of `mid`");
    near(runs[0].to_value, 2.0, 1e-12, "centroid of `some`");
    assert!(runs[0].rises() && !runs[1].rises(), "which is which");
    // A term with a vertical side: `mid` ends at 3 where it still holds by half.
    let text = with(&with(SOUND, "'trimf',[0 2 4]", "'trapmf',[0 2 3 3]"), "[2 4 4]", "[3 4 4]");
    let report = report(&text);
    let [jump] = one(&report, Kind::Jump).jumps.as_slice() else { panic!("one jump") };
    assert_eq!(jump.inputs, [3.0], "where `mid` ends");
    near(jump.left, 2.0, 1e-9, "only `mid` up to there");
    near(jump.value, 2.0, 1e-9, "and there");
    near(jump.right, 4.0, 1e-9, "only `high` from there");
    let found = one(&report, Kind::Jump).message.clone();
    assert_eq!(found, "output `y` jumps at `x` = 3 (from 2 through 2 to 4)");
}

#[test]
fn turns_and_jumps_of_two_inputs() {
    let turn = report(&with(&with(PLANE, "2 2, 4 (1)", "2 2, 2 (1)"), "MF4='all':'constant',[3]\n", ""));
    let finding = one(&turn, Kind::NotMonotone);
    assert_eq!(finding.variables, ["v", "w"], "along v only: {}", finding.message);
    assert_eq!(
        finding.message,
        "output `w` is not monotone along `v`: it rises where `u` is 0, and falls where `u` is 1"
    );
    let step = with(
        PLANE,
        "Range=[0 1]\nMF1='lo':'linzmf',[0 1]\nMF2='hi':'linsmf',[0 1]\n[Input2]",
        "Range=[0 1]\nMF1='lo':'linzmf',[0.5 0.5]\nMF2='hi':'linsmf',[0.5 0.5]\n[Input2]",
    );
    let report = report(&step);
    let finding = one(&report, Kind::Jump);
    assert_eq!(finding.variables, ["u", "w"], "along u only: {}", finding.message);
    let [jump] = finding.jumps.as_slice() else { panic!("one place: {:#?}", finding.jumps) };
    near(jump.inputs[0], 0.5, 0.0, "at the step");
    near(jump.size(), 2.0, 1e-9, "by two rules' difference");
    assert_eq!(report.findings.len(), 1, "nothing else: {:#?}", report.findings);
}

#[test]
fn curved_and_sampled_outputs_are_looked_at_too() {
    let curved = report(&with(SOUND, "'trimf',[1 2 3]", "'gaussmf',[0.4 2]"));
    assert!(curved.is_sampled, "no exact centroid");
    assert_eq!(curved.findings, [], "and no flaw from sampling");
    let largest = report(&with(SOUND, "Type='mamdani'\n", "Type='mamdani'\nDefuzzMethod='mom'\n"));
    let jumps = &one(&largest, Kind::Jump).jumps;
    assert!(largest.is_sampled && jumps.len() == 2, "from term to term: {jumps:#?}");
    near(jumps[0].inputs[0], 1.0, 1e-9, "where `low` and `mid` are equal");
}

#[test]
fn a_line_has_points_beside_its_jumps() {
    let step = system(&with(&with(SOUND, "'trimf',[0 2 4]", "'trapmf',[0 2 3 3]"), "[2 4 4]", "[3 4 4]"));
    let Course { points, jumps } = along(&step, 0, 0, &[0.0]).expect("runs");
    assert!(points.is_sorted_by(|a, b| a.0 < b.0), "in ascending order");
    assert_eq!((points[0].0, points[points.len() - 1].0, jumps.len()), (0.0, 4.0, 1), "over the range");
    assert!(points.iter().any(|(x, _)| *x > 3.0 && *x < 3.0 + 1e-9), "just beside the jump");
}

#[test]
fn many_inputs_and_rules_are_checked_in_bounded_time() {
    // Eight inputs of five terms, 400 rules: 5^8 combinations, of which most have no rule.
    let mut text = String::from("[System]\nType='mamdani'\n");
    for input in 1..=8 {
        text.push_str(&format!("[Input{input}]\nName='x{input}'\nRange=[0 4]\n"));
        for term in 0..5 {
            text.push_str(&format!("MF{}='t{term}':'trimf',[{} {term} {}]\n", term + 1, term - 1, term + 1));
        }
    }
    text.push_str("[Output1]\nName='y'\nRange=[0 1]\nMF1='a':'trimf',[0 0.2 0.4]\nMF2='b':'trimf',[0.6 0.8 1]\n[Rules]\n");
    let mut state = 1_u32;
    for _ in 0..400 {
        for _ in 0..8 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            text.push_str(&format!("{} ", (state >> 16) % 6));
        }
        text.push_str(&format!(", {} (1) : 1\n", 1 + (state >> 24) % 2));
    }
    let report = report(&text);
    let is_known = kinds(&report).contains(&Kind::NoRuleFires);
    assert!(is_known || !report.skipped.is_empty(), "found, or said that it was not looked for");
}

/// Law: what an output takes on includes what it is at the corners, also where no line goes.
/// Reference: with five inputs of three terms the rules of the corners alone conclude the outer terms, of centroid -0.5 and 0.5.
#[test]
fn the_reach_of_five_inputs_includes_the_corners() {
    let mut text = String::from("[System]\nName='five'\n");
    for number in 1..=5 {
        text += &format!(
            "[Input{number}]\nName='x{number}'\nRange=[-1 1]\nMF1='a':'trimf',[-2 -1 0]\nMF2='b':'trimf',[-1 0 1]\nMF3='c':'trimf',[0 1 2]\n"
        );
    }
    text += "[Output1]\nName='y'\nRange=[-1 1]\nMF1='a':'trimf',[-1 -.5 0]\nMF2='b':'trimf',[-.5 0 .5]\nMF3='c':'trimf',[0 .5 1]\n";
    text += "[Rules]\n1 1 1 1 1, 1 (1) : 1\n3 3 3 3 3, 3 (1) : 1\n0 2 0 0 0, 2 (1) : 1\n";
    let report = report(&text);
    near(report.outputs[0].reached.0, -0.5, 1e-9, "the lowest corner");
    near(report.outputs[0].reached.1, 0.5, 1e-9, "the highest corner");
    let words = report.outputs[0].to_string();
    assert!(words.contains("takes on at least [-0.5, 0.5]"), "{words}");
}

/// Law: where rules fire by rounding alone there is no jump, and nothing is taken on.
/// Reference: at the foot of `smf` the strengths of `b` and `not b'` fall together as d^2/8 and d^2/8, so that the output goes to the
/// mean of both numbers, 1.5; just beside the foot `1 - mu` rounds to 0, and the first rule is alone, with 1.
#[test]
fn rounding_at_a_smooth_foot_is_no_jump() {
    let text = "[System]
Type='sugeno'
[Input1]
Name='b'
Range=[-2 2]
MF1='up':'smf',[-2 2]
MF2='down':'zmf',[-2 2]
[Output1]
Name='y'
Range=[0 2]
MF1='one':'constant',[1]
MF2='two':'constant',[2]
[Rules]
1, 1 (1) : 1
-2, 2 (1) : 1
";
    let found = report(text);
    let jumps: Vec<_> = found.findings.iter().flat_map(|finding| &finding.jumps).collect();
    let [jump] = jumps.as_slice() else { panic!("one jump: {jumps:?}") };
    assert_eq!(jump.inputs, [-2.0], "at the foot");
    near(jump.right, 1.5, 1e-6, "the limit, up to rounding of 1 - mu at 1e-5 of the range");
    assert_eq!(found.findings.iter().filter(|finding| finding.kind == Kind::NotMonotone).count(), 0, "level");
    near(found.outputs[0].reached.1, 1.5, 1e-6, "nothing above");
    let course = along(&system(text), 0, 0, &[0.0]).expect("runs");
    assert!(
        course.points[1..].iter().all(|(_, y)| (y - 1.5).abs() < 1e-3),
        "level: {:?}",
        &course.points[..4]
    );
}
