//! Law: any system that an engine could take is written as a `.fis` text that reads back to an equal system, and writing that one
//! gives the same text.
//!
//! Reference: the system itself. Tolerance: none, numbers are written in the shortest digits that give the same bits.

use mm_control::fuzzy::{Aggregation, And, Connective, Implication, MembershipFunction as Mf, Or};
use mm_fis::{Defuzzification, Kind, Rule, Shape, System, Term, Variable, read_fis, write_fis};
use proptest::prelude::*;
use proptest::sample::select;

/// Any number a file can hold, the awkward ones often.
fn number() -> impl Strategy<Value = f64> {
    let awkward = vec![
        0.0,
        -0.0,
        1.0,
        0.1,
        1.0 / 3.0,
        1e-5,
        1e16,
        5e-324,
        f64::MIN_POSITIVE,
        1e150,
        -1e150,
        123_456.789,
    ];
    prop_oneof![select(awkward), -1e3..1e3, any::<f64>().prop_filter("finite", |x| x.abs() < 1e300)]
}

fn name() -> impl Strategy<Value = String> {
    prop_oneof!["[a-z][a-z0-9_]{0,8}", "[ '\"%#/:=,;\\[\\]()a\u{e4}\u{98df}\u{2019}\t]{0,8}"]
}

fn ascending<const N: usize>() -> impl Strategy<Value = [f64; N]> {
    proptest::array::uniform(number()).prop_map(|mut numbers: [f64; N]| {
        numbers.sort_by(f64::total_cmp);
        numbers
    })
}

fn width() -> impl Strategy<Value = f64> {
    number().prop_filter("a width", |x| x.abs() > 0.0)
}

fn set() -> impl Strategy<Value = Mf<f64>> {
    let four = || proptest::array::uniform4(number());
    let two = || proptest::array::uniform2(number());
    prop_oneof![
        ascending().prop_map(Mf::Triangle),
        ascending().prop_map(Mf::Trapezoid),
        ascending().prop_map(Mf::LinearS),
        ascending().prop_map(Mf::LinearZ),
        (width(), number()).prop_map(|(s, c)| Mf::Gaussian([s, c])),
        (width(), number(), width(), number()).prop_map(|(s, c, t, d)| Mf::Gaussian2([s, c, t, d])),
        (width(), number(), number()).prop_map(|(a, b, c)| Mf::Bell([a, b, c])),
        two().prop_map(Mf::Sigmoid),
        four().prop_map(Mf::SigmoidDifference),
        four().prop_map(Mf::SigmoidProduct),
        two().prop_map(Mf::S),
        two().prop_map(Mf::Z),
        four().prop_map(Mf::Pi),
    ]
}

fn variable(shape: BoxedStrategy<Shape>) -> impl Strategy<Value = Variable> {
    let term = (name(), shape).prop_map(|(name, shape)| Term { name, shape });
    let range = ascending().prop_filter("a range", |[low, high]| low < high && (high - low).is_finite());
    (name(), range, proptest::collection::vec(term, 1..5)).prop_map(|(name, [low, high], terms)| Variable {
        name,
        range: (low, high),
        terms,
    })
}

fn indices(variables: &[Variable], negative: bool) -> impl Strategy<Value = Vec<i16>> + use<> {
    let counts: Vec<_> =
        variables.iter().map(|variable| i16::try_from(variable.terms.len()).unwrap_or(1)).collect();
    counts.into_iter().map(|count| if negative { -count..=count } else { 0..=count }).collect::<Vec<_>>()
}

fn system() -> impl Strategy<Value = System> {
    let shapes = (any::<bool>(), 1_usize..4, 1_usize..3);
    let variables = shapes.prop_flat_map(|(sugeno, inputs, outputs)| {
        let set = set().prop_map(Shape::Set).boxed();
        let linear = proptest::collection::vec(number(), inputs + 1).prop_map(Shape::Linear);
        let consequent = prop_oneof![number().prop_map(Shape::Constant), linear].boxed();
        let output = if sugeno { consequent } else { set.clone() };
        let kind = if sugeno { Kind::Sugeno } else { Kind::Mamdani };
        let inputs = proptest::collection::vec(variable(set), inputs);
        (Just(kind), inputs, proptest::collection::vec(variable(output), outputs))
    });
    let rules = variables.prop_flat_map(|(kind, inputs, outputs)| {
        let connective = select(vec![Connective::And, Connective::Or]);
        let (left, right) = (indices(&inputs, true), indices(&outputs, kind == Kind::Mamdani));
        let rule = (left, right, 0.0..=1.0, connective)
            .prop_map(|(inputs, outputs, weight, connective)| Rule { inputs, outputs, weight, connective });
        (Just(kind), Just(inputs), Just(outputs), proptest::collection::vec(rule, 1..6))
    });
    let operators = (
        select(vec![And::Min, And::Prod]),
        select(vec![Or::Max, Or::Probor]),
        select(vec![Implication::Min, Implication::Prod]),
        select(vec![Aggregation::Max, Aggregation::Sum, Aggregation::Probor]),
        0_usize..10,
    );
    (name(), rules, operators).prop_map(|(name, (kind, inputs, outputs, rules), operators)| {
        let (and, or, implication, aggregation, defuzzification) = operators;
        let defuzzifications: &[Defuzzification] = match kind {
            Kind::Mamdani => &[
                Defuzzification::Centroid,
                Defuzzification::Bisector,
                Defuzzification::MeanOfMaximum,
                Defuzzification::SmallestOfMaximum,
                Defuzzification::LargestOfMaximum,
            ],
            Kind::Sugeno => &[Defuzzification::WeightedAverage, Defuzzification::WeightedSum],
        };
        let defuzzification = defuzzifications[defuzzification % defuzzifications.len()];
        System { name, kind, and, or, implication, aggregation, defuzzification, inputs, outputs, rules }
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(4), ..ProptestConfig::default() })]

    #[test]
    fn what_is_written_is_read_back_equal(system in system()) {
        let text = write_fis(&system);
        let again = read_fis(&text).map(|document| document.system);
        prop_assert_eq!(again.as_ref(), Ok(&system), "{}", text);
        prop_assert_eq!(again.as_ref().map(write_fis), Ok(text), "idempotent");
    }
}

#[test]
fn a_line_break_in_a_name_becomes_a_blank() {
    let text = "[System]\n[Input1]\nRange=[0 1]\nMF1='a':'smf',[0 1]\n[Output1]\nRange=[0 1]\nMF1='b':'smf',[0 1]\n[Rules]\n1, 1 (1) : 1";
    let mut system = read_fis(text).unwrap().system;
    system.name = "two\r\nlines".to_owned();
    assert_eq!(read_fis(&write_fis(&system)).unwrap().system.name, "two  lines", "no file can hold it");
}
