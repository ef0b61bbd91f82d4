//! Law: an FCL text means what IEC 61131-7 says; the system made of it does that exactly, or it is refused, or a note says where
//! it differs.
//!
//! Reference: the standard's formulas, worked out here by hand from the degrees. Tolerance: 1e-12, a few roundings of numbers up
//! to 30.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a helper that cannot read its text has failed the test"
)]

use mm_control::fuzzy::{Aggregation, And, Connective, MembershipFunction as Mf, Or};
use mm_fis::{Accuracy, Document, Kind, Shape, System, read_fcl};

const TIPPER: &str = include_str!("../corpus/good/tipper.fcl");

fn read(text: &str) -> Document {
    read_fcl(text).unwrap_or_else(|error| panic!("{error}"))
}

fn evaluate(system: &System, inputs: &[f64]) -> f64 {
    let infer = |engine: &mm_fis::Engine<'_>| {
        let mut outputs = [0.0];
        let _ = engine.infer(inputs, &mut outputs, &mut vec![0.0; engine.workspace_len()]).unwrap();
        outputs[0]
    };
    system.with_engine(Accuracy::Exact, infer).unwrap()
}

/// Two inputs from 0 to 10, falling and rising, with the given rule block.
fn text(terms: &str, method: &str, rules: &str) -> String {
    format!(
        "FUNCTION_BLOCK b VAR_INPUT x : REAL; y : REAL; END_VAR VAR_OUTPUT z : REAL; END_VAR
         FUZZIFY x TERM lo := (0, 1) (10, 0); TERM hi := (0, 0) (10, 1); TERM mid := TRIAN 0 5 10; END_FUZZIFY
         FUZZIFY y TERM lo := (0, 1) (10, 0); TERM hi := (0, 0) (10, 1); END_FUZZIFY
         DEFUZZIFY z {terms} METHOD : {method}; END_DEFUZZIFY
         RULEBLOCK r {rules} END_RULEBLOCK END_FUNCTION_BLOCK"
    )
}

const SETS: &str = "TERM a := TRIAN 0 5 10; TERM b := TRIAN 20 25 30;";

#[test]
fn the_tipper_of_jfuzzylogic() {
    let Document { system, notes } = read(TIPPER);
    assert_eq!(system.name, "tipper", "name");
    assert_eq!((system.kind, system.and, system.or), (Kind::Mamdani, And::Min, Or::Max), "operators");
    assert_eq!(system.inputs[0].terms[0].shape, Shape::Set(Mf::LinearZ([0.0, 4.0])), "poor");
    assert_eq!(system.inputs[1].range, (0.0, 9.0), "where the terms of food end");
    assert_eq!(system.rules[0].connective, Connective::Or, "first rule");
    assert_eq!(system.rules[0].inputs, [1, 1], "first rule");
    // Service fully good: the triangle of average, symmetric about 15.
    assert!((evaluate(&system, &[5.0, 5.0]) - 15.0).abs() < 1e-12, "average");
    let notes: Vec<_> = notes.iter().map(ToString::to_string).collect();
    assert_eq!(
        notes,
        [
            "line 28, column 13: DEFAULT 0 where no rule fires, as at service = 9, food = 3: the output is 15, the middle of its range"
        ]
    );
}

#[test]
fn brackets_become_rules_that_fire_as_strongly() {
    let rules =
        "AND : MIN; ACCU : MAX; RULE 1 : IF (x IS lo OR y IS lo) AND NOT (x IS mid AND y IS lo) THEN z IS a;
                 RULE 2 : IF x IS mid OR x IS hi THEN z IS b WITH .5;";
    let refused = read_fcl(&text(SETS, "COG", rules)).unwrap_err();
    assert!(refused.to_string().contains("one input with two terms in one AND"), "{refused}");

    let rules =
        "AND : MIN; ACCU : MAX; RULE 1 : IF (x IS lo OR x IS hi) AND (y IS lo OR NOT (y IS hi)) THEN z IS a;
                 RULE 2 : IF NOT (x IS lo OR y IS NOT lo) THEN z IS b WITH .5;";
    let system = read(&text(SETS, "COG", rules)).system;
    let inputs: Vec<_> = system.rules.iter().map(|rule| (rule.inputs.as_slice(), rule.weight)).collect();
    assert_eq!(
        inputs,
        [(&[1, 1][..], 1.0), (&[1, -2], 1.0), (&[2, 1], 1.0), (&[2, -2], 1.0), (&[-1, 1], 0.5)],
        "taken apart"
    );
}

#[test]
fn singletons_are_weighted_by_their_rules() {
    let terms = "TERM a := 2; TERM b := 6; DEFAULT := 3;";
    let rules = "AND : PROD; RULE 1 : IF x IS lo AND y IS lo THEN z IS a; RULE 2 : IF x IS hi THEN z IS b;";
    let system = read(&text(terms, "COGS", rules)).system;
    assert_eq!((system.kind, system.or), (Kind::Sugeno, Or::Probor), "the pair of PROD");
    // Degrees 0.75 * 0.5 and 0.25.
    let expected = (0.375 * 2.0 + 0.25 * 6.0) / 0.625;
    assert!((evaluate(&system, &[2.5, 5.0]) - expected).abs() < 1e-12, "weighted average");
    let (low, high) = system.outputs[0].range;
    assert!((0.5 * low + 0.5 * high - 3.0).abs() < 1e-12, "the default is the middle of the range");
    let notes = read(&text(&format!("{terms} RANGE := (0 .. 5);"), "COGS", rules)).notes;
    assert_eq!(notes.len(), 1, "{notes:?}");
    assert!(notes[0].message().starts_with("a singleton outside its RANGE"), "{}", notes[0]);
}

#[test]
fn linear_functions_are_read_and_others_refused() {
    let rules = "RULE 1 : IF x IS lo THEN z IS a; RULE 2 : IF x IS hi THEN z IS b;";
    let terms = "TERM a := FUNCTION 2 * (x - 1) / 4 - -y; TERM b := Linear 1 2 3;";
    let system = read(&text(terms, "COGS", rules)).system;
    assert_eq!(system.outputs[0].terms[0].shape, Shape::Linear(vec![0.5, 1.0, -0.5]), "a");
    let curved = read_fcl(&text("TERM a := FUNCTION x * y; TERM b := 1;", "COGS", rules)).unwrap_err();
    assert!(curved.to_string().contains("`x * y`, which is not linear"), "{curved}");
}

#[test]
fn what_the_engine_cannot_do_is_refused() {
    let both = "RULE 1 : IF x IS lo THEN z IS a; RULE 2 : IF y IS lo THEN z IS a;";
    let numbers = "TERM a := 1; TERM b := 2;";
    for (terms, method, rules, message) in [
        (numbers, "COGS", format!("ACCU : MAX; {both}"), "several rules that conclude one singleton"),
        (SETS, "COG", format!("ACCU : BSUM; {both}"), "ACCU : BSUM, which the engine does not have"),
        (SETS, "COGS", both.to_owned(), "a set, but its METHOD is that of singletons"),
        (numbers, "COG", both.to_owned(), "a singleton, but its METHOD is one of sets"),
        ("TERM a := TRIAN -1 0 1;", "LM", both.to_owned(), "METHOD : LM over a range with 0 inside"),
        (SETS, "COG", format!("AND : BDIF; {both}"), "unknown AND `BDIF`; expected `MIN` or `PROD`"),
        (SETS, "COG", "RULE 1 : IF x IS lo OR y IS lo AND x IS hi THEN z IS a;".to_owned(), "AND behind OR"),
        (SETS, "COG", "RULE 1 : IF x IS very lo THEN z IS a;".to_owned(), "hedges are not supported"),
        (SETS, "COG", "RULE 1 : IF x IS lov THEN z IS a;".to_owned(), "the nearest known name is `lo`"),
        (
            SETS,
            "COG",
            "OR : ASUM; ACCU : MAX; RULE 1 : IF (x IS lo OR y IS lo) AND y IS hi THEN z IS a;".to_owned(),
            "one input with two terms",
        ),
        (
            SETS,
            "COG",
            "ACCU : NSUM; RULE 1 : IF x IS lo OR x IS hi THEN z IS a;".to_owned(),
            "a condition that takes several rules",
        ),
    ] {
        let refused = read_fcl(&text(terms, method, &rules)).unwrap_err();
        assert!(refused.to_string().contains(message), "{refused}");
    }
}

#[test]
fn accumulation_that_only_scales_is_a_sum() {
    let rules = "ACCU : NSUM; RULE 1 : IF x IS lo THEN z IS a;";
    let Document { system, notes } = read(&text(SETS, "COG", rules));
    assert_eq!(system.aggregation, Aggregation::Sum, "normalized sum");
    assert!(notes.is_empty(), "nothing to note: {notes:?}");
    let (low, high) =
        (text("TERM a := TRIAN 1 2 3;", "LM", rules), text("TERM a := TRIAN -3 -2 -1;", "LM", rules));
    for (text, name) in [(low, "SmallestOfMaximum"), (high, "LargestOfMaximum")] {
        assert_eq!(format!("{:?}", read(&text).system.defuzzification), name, "leftmost");
    }
}
