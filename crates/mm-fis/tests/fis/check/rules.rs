//! Rules that never fire, repeat or contradict one another.

use super::{PLANE, SOUND, kinds, one, report, with};
use mm_fis::check::FindingKind as Kind;

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
