//! Inputs that no rule answers.

use super::{PLANE, SOUND, kinds, near, one, report, system, with};
use mm_fis::check::{FindingKind as Kind, Severity, check};

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
