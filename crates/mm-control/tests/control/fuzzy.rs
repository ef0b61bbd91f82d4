//! Law: a rule engine returns the exact centroid of its clipped and joined output terms; the two rule bases have
//! the values and the shape that their documentation states; a surface stays close to its engine.
//!
//! Why: the centroid is an integral of a piecewise-linear function, so a plain midpoint quadrature of the same
//! definition, written here without the code under test, must agree with it.
//!
//! Reference: the definition of min-max Mamdani inference; Appendix C of the thesis for the numbers.
//!
//! Tolerance: 1e-6 of the output range for the quadrature of 1e6 points, whose own error is about 1e-6 at the
//! steepest side; a few rounding errors everywhere else.

#![expect(
    clippy::unwrap_used,
    reason = "the helpers are part of the tests: what fails in them fails the test"
)]

mod centroid;
mod surface;

use mm_control::fuzzy::{
    Aggregation, Connective, Curve, Defuzzifier, FuzzyError, FuzzySystem, Mamdani, MamdaniTables,
    MembershipFunction, Operators, Rule, SMOOTH, SMOOTH_F32, Sampling, Surface, THESIS, THESIS_F32, Variable,
};
use proptest::prelude::*;

/// Uniform numbers in [0, 1) from a 64-bit linear congruential generator.
struct Lcg(u64);

impl Lcg {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / 4_294_967_296.0
    }
    fn index(&mut self, below: usize) -> usize {
        (0..below)
            .rev()
            .find(|i| self.uniform() < 1.0 / f64::from(u32::try_from(i + 1).unwrap()))
            .unwrap_or(0)
    }
}

/// `n` inputs from `lo` to `hi`, mirrored bit by bit when the range is.
fn inputs(half: f64, n: i32) -> impl Iterator<Item = f64> {
    (-n..=n).map(move |k| half * f64::from(k) / f64::from(n))
}

#[test]
#[expect(clippy::float_cmp, reason = "zero, the clamped ends and the oddness are exact")]
fn thesis_values() {
    let engine = Curve::<f64>::try_new(&THESIS).unwrap();
    let near = |x: f64, y: f64, tolerance: f64| {
        let got = engine.evaluate(x);
        assert!((got - y).abs() <= tolerance, "f({x}) = {got}, not {y}");
    };
    assert_eq!(engine.evaluate(0.0), 0.0, "both terms at zero hold fully");
    // The triangle (2/3, 1, 1) has its centroid at 8/9; with the printed foot 0.6666 at (0.6666 + 2) / 3.
    near(-1e-12, (0.6666 + 2.0) / 3.0, 1e-9);
    near(1e-12, -(0.6666 + 2.0) / 3.0, 1e-9);
    // At the ends only the triangle (0, 0.3334, 0.6666) is left, with its centroid at a third of 1.
    near(-1.4, 1.0 / 3.0, 1e-15);
    near(1.4, -1.0 / 3.0, 1e-15);
    near(-0.1, 0.876, 5e-4);
    for x in [1.5, 4.6, 100.0, f64::MAX, f64::INFINITY] {
        assert_eq!(engine.evaluate(x), engine.evaluate(1.4), "{x} counts as the upper end");
        assert_eq!(engine.evaluate(-x), engine.evaluate(-1.4), "{} counts as the lower end", -x);
    }
    assert_eq!(engine.evaluate(f64::NAN), 0.0, "NaN gives zero");
    for x in inputs(1.5, 3000) {
        assert_eq!(engine.evaluate(-x), -engine.evaluate(x), "odd at {x}");
    }
}

#[test]
#[expect(clippy::float_cmp, reason = "zero, saturation and oddness are exact")]
fn smooth_is_odd_strictly_falling_and_saturates() {
    let engine = Curve::<f64>::try_new(&SMOOTH).unwrap();
    let values: Vec<f64> = inputs(1.0, 5000).map(|x| engine.evaluate(x)).collect();
    let steepest =
        values.windows(2).map(|y| 5000.0 * (y[1] - y[0])).fold((-f64::MAX, f64::MAX), |(m, n), slope| {
            assert!(slope < 0.0, "the slope {slope} is not negative");
            (m.max(slope), n.min(slope))
        });
    assert!((steepest.1 + 2.0).abs() < 0.01, "steepest at zero: {}", steepest.1);
    assert!((steepest.0 + 2.0 / 3.0).abs() < 0.01, "flattest slope {}", steepest.0);
    for (y, mirrored) in values.iter().zip(values.iter().rev()) {
        assert_eq!(*y, -*mirrored, "the map is odd");
    }
    assert_eq!(engine.evaluate(0.0), 0.0, "zero at zero");
    let slope = (engine.evaluate(1e-7) - engine.evaluate(-1e-7)) / 2e-7;
    assert!((slope + 2.0).abs() < 1e-5, "slope at zero {slope}");
    let edge = engine.evaluate(1.0);
    assert!((edge + 1.0).abs() <= 4.0 * f64::EPSILON, "edge value {edge}");
    for x in [1.0 + 1e-9, 2.0, 1e300, f64::INFINITY] {
        assert_eq!(engine.evaluate(x), edge, "saturated at {x}");
    }
}

#[test]
fn changed_rules_change_the_output() {
    let unchanged = Curve::<f64>::try_new(&THESIS).unwrap();
    let mut rules = THESIS.rules.to_vec();
    rules[5].outputs = &[2];
    let tables = MamdaniTables { rules: &rules, ..THESIS };
    let changed = Curve::<f64>::try_new(&tables).unwrap();
    let distance = (changed.evaluate(0.25) - unchanged.evaluate(0.25)).abs();
    assert!(distance > 0.2, "PS to NM instead of NB moves the output by {distance}");
    let mut rules = THESIS.rules.to_vec();
    rules[6].weight = 0.5;
    let tables = MamdaniTables { rules: &rules, ..THESIS };
    let changed = Curve::<f64>::try_new(&tables).unwrap();
    let distance = (changed.evaluate(0.8) - unchanged.evaluate(0.8)).abs();
    assert!(distance > 0.01, "half the weight moves the output by {distance}");
}

#[test]
#[expect(clippy::float_cmp, reason = "the middle of the range is exact")]
fn silence_gives_the_middle() {
    let tables = MamdaniTables {
        inputs: &[Variable { range: (-1.0, 1.0), terms: &[MembershipFunction::Triangle([0.0, 0.5, 1.0])] }],
        outputs: &[Variable { range: (3.0, 7.0), terms: &[MembershipFunction::Triangle([4.0, 4.0, 4.0])] }],
        rules: &[Rule { inputs: &[1], outputs: &[1], weight: 1.0, connective: Connective::And }],
        operators: Operators::default(),
        defuzzifier: Defuzzifier::Centroid,
    };
    let engine = Curve::<f64>::try_new(&tables).unwrap();
    assert_eq!(engine.evaluate(-0.5), 5.0, "no rule fires");
    assert_eq!(engine.evaluate(0.5), 5.0, "a singleton has no area");
    assert_eq!(engine.evaluate(f64::NAN), 5.0, "NaN gives the middle");
}

#[test]
fn bad_tables_are_refused_by_name() {
    let (input, output) = (THESIS.inputs[0], THESIS.outputs[0]);
    let with_input =
        |input: Variable<'static, f64>| Mamdani::try_new(&MamdaniTables { inputs: &[input], ..THESIS }).err();
    let with_output = |output: Variable<'static, f64>| {
        Mamdani::try_new(&MamdaniTables { outputs: &[output], ..THESIS }).err()
    };
    let with_rule = |inputs: &[i16], outputs: &[i16], weight: f64| {
        let rules = [Rule { inputs, outputs, weight, connective: Connective::And }];
        Mamdani::try_new(&MamdaniTables { rules: &rules, ..THESIS }).err()
    };
    let cases = [
        (with_input(Variable { range: (1.0, -1.0), ..input }), FuzzyError::Inverted("inputs.range")),
        (
            with_input(Variable { range: (0.0, f64::INFINITY), ..input }),
            FuzzyError::NonFinite("inputs.range"),
        ),
        (with_input(Variable { range: (-1e308, 1e308), ..input }), FuzzyError::NonFinite("inputs.range")),
        (with_input(Variable { terms: &[], ..input }), FuzzyError::Empty("inputs.terms")),
        (
            with_input(Variable { terms: &[MembershipFunction::Trapezoid([0.0, 2.0, 1.0, 3.0])], ..input }),
            FuzzyError::Inverted("inputs.terms"),
        ),
        (with_output(Variable { range: (1.0, 1.0), ..output }), FuzzyError::Inverted("outputs.range")),
        (with_output(Variable { terms: &[], ..output }), FuzzyError::Empty("outputs.terms")),
        (
            with_output(Variable { terms: &[MembershipFunction::Triangle([0.0, f64::NAN, 1.0])], ..output }),
            FuzzyError::NonFinite("outputs.terms"),
        ),
        (
            with_output(Variable { terms: &[MembershipFunction::Gaussian([1.0, 0.0]); 7], ..output }),
            FuzzyError::Curved("outputs.terms"),
        ),
        (with_rule(&[9], &[1], 1.0), FuzzyError::OutOfRange("rules.inputs")),
        (with_rule(&[-9], &[1], 1.0), FuzzyError::OutOfRange("rules.inputs")),
        (with_rule(&[1, 1], &[1], 1.0), FuzzyError::Length("rules.inputs")),
        (with_rule(&[1], &[8], 1.0), FuzzyError::OutOfRange("rules.outputs")),
        (with_rule(&[1], &[], 1.0), FuzzyError::Length("rules.outputs")),
        (with_rule(&[1], &[1], 1.5), FuzzyError::OutOfRange("rules.weight")),
        (with_rule(&[1], &[1], f64::NAN), FuzzyError::NonFinite("rules.weight")),
        (Mamdani::try_new(&MamdaniTables { rules: &[], ..THESIS }).err(), FuzzyError::Empty("rules")),
        (Mamdani::try_new(&MamdaniTables { inputs: &[], ..THESIS }).err(), FuzzyError::Empty("inputs")),
        (Mamdani::try_new(&MamdaniTables { outputs: &[], ..THESIS }).err(), FuzzyError::Empty("outputs")),
    ];
    for (refused, error) in cases {
        assert_eq!(refused, Some(error), "another refusal");
    }
    let probor = Operators { aggregation: Aggregation::Probor, ..Operators::default() };
    let refused = Mamdani::try_new(&MamdaniTables { operators: probor, ..THESIS }).err();
    assert_eq!(refused, Some(FuzzyError::Curved("operators.aggregation")), "a product of pieces is no line");
    let once = Defuzzifier::Bisector(Sampling::Ends(1));
    let refused = Mamdani::try_new(&MamdaniTables { defuzzifier: once, ..THESIS }).err();
    assert_eq!(refused, Some(FuzzyError::OutOfRange("defuzzifier.points")), "one sample is no range");
    let even = Surface::<f64, 64>::from_engine(&Curve::<f64>::try_new(&THESIS).unwrap()).err();
    assert_eq!(even, Some(FuzzyError::OutOfRange("knots")), "an even number of knots");
    assert_eq!(
        Curve::<f64, 6>::try_new(&THESIS).err(),
        Some(FuzzyError::TooMany("workspace")),
        "seven output terms need seven numbers"
    );
}

#[test]
fn single_precision_agrees_with_double() {
    for (single, double) in [(&THESIS_F32, &THESIS), (&SMOOTH_F32, &SMOOTH)] {
        let (single, double) =
            (Curve::<f32>::try_new(single).unwrap(), Curve::<f64>::try_new(double).unwrap());
        let mut worst = 0.0_f64;
        for k in -1500_i16..=1500 {
            let x = f32::from(k) / 1024.0;
            let (y, reference) = (single.evaluate(x), double.evaluate(f64::from(x)));
            worst = worst.max((f64::from(y) - reference).abs());
        }
        assert!(worst < 1e-5, "single precision is off by {worst:e}");
    }
}

#[test]
fn a_mirrored_system_of_many_terms_is_odd_to_rounding() {
    // Five wide terms, all of which fire at once.
    let triangle = |b: f64| MembershipFunction::Triangle([b - 1.5, b, b + 1.5]);
    let (inputs, outputs) =
        ([-1.0, -0.5, 0.0, 0.5, 1.0].map(triangle), [1.0, 0.5, 0.0, -0.5, -1.0].map(triangle));
    let indices: [[i16; 1]; 5] = [[1], [2], [3], [4], [5]];
    let rules =
        indices.each_ref().map(|i| Rule { inputs: i, outputs: i, weight: 1.0, connective: Connective::And });
    for aggregation in [Aggregation::Max, Aggregation::Sum] {
        let tables = MamdaniTables {
            inputs: &[Variable { range: (-1.0, 1.0), terms: &inputs }],
            outputs: &[Variable { range: (-2.5, 2.5), terms: &outputs }],
            rules: &rules,
            operators: Operators { aggregation, ..Operators::default() },
            defuzzifier: Defuzzifier::Centroid,
        };
        let curve = Curve::<f64>::try_new(&tables).unwrap();
        for k in -500_i16..=500 {
            let x = f64::from(k) / 500.0;
            let sum = curve.evaluate(x) + curve.evaluate(-x);
            assert!(sum.abs() <= 4.0 * f64::EPSILON, "{aggregation:?} at {x}: {sum:e}");
        }
    }
}

#[test]
fn samples_far_from_zero_keep_their_digits() {
    let terms = [MembershipFunction::Triangle([1e6_f32, 1_000_010.0, 1_000_010.0])];
    let rules = [Rule { inputs: &[1], outputs: &[1], weight: 1.0, connective: Connective::And }];
    let inputs = [Variable { range: (0.0, 1.0), terms: &[MembershipFunction::LinearS([0.0, 0.1])] }];
    let at = |range, terms, defuzzifier| {
        let outputs = [Variable { range, terms }];
        let operators = Operators::default();
        let tables =
            MamdaniTables { inputs: &inputs, outputs: &outputs, rules: &rules, operators, defuzzifier };
        Curve::<f32>::try_new(&tables).unwrap().evaluate(0.5)
    };
    for points in [101, 1001] {
        let y = at((1e6, 1_000_010.0), &terms, Defuzzifier::SampledCentroid(Sampling::Ends(points)));
        // Two thirds of the way up; a unit in the last place is 0.06 there, and the samples themselves are rounded to it.
        assert!((y - 1_000_006.7).abs() < 0.3, "{points} samples: {y}");
    }
    let wide = [MembershipFunction::LinearS([0.0, 1.0])];
    let y = at((0.0, 3e38), &wide, Defuzzifier::MeanOfMaximum(Sampling::Ends(101)));
    assert!((1.4e38..1.7e38).contains(&y), "mean of the maximum over the largest numbers: {y}");
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    /// Neither crossing terms nor numbers near the ends of the exponent range may give a NaN.
    #[test]
    fn output_stays_finite_and_in_range(
        breakpoints in prop::array::uniform4(prop::array::uniform4(-2.0_f32..2.0)),
        x in any::<f32>(),
        weights in prop::array::uniform4(0.0_f32..=1.0),
        scale in prop::sample::select(vec![1e-38_f32, 1e-20, 1e-3, 1.0, 1e6, 1e30]),
    ) {
        let terms = breakpoints.map(|mut p| {
            p.sort_by(f32::total_cmp);
            MembershipFunction::Trapezoid(p.map(|p| p * scale))
        });
        let rule = |input: &'static [i16], output: &'static [i16], weight| {
            Rule { inputs: input, outputs: output, weight, connective: Connective::And }
        };
        let [w1, w2, w3, w4] = weights;
        let rules = [rule(&[1], &[4], w1), rule(&[2], &[3], w2), rule(&[3], &[2], w3), rule(&[4], &[1], w4)];
        let tables = MamdaniTables {
            inputs: &[Variable { range: (-2.0 * scale, 2.0 * scale), terms: &terms }],
            outputs: &[Variable { range: (-scale, 1.5 * scale), terms: &terms }],
            rules: &rules,
            operators: Operators::default(),
            defuzzifier: Defuzzifier::Centroid,
        };
        let sampled = MamdaniTables { defuzzifier: Defuzzifier::SampledCentroid(Sampling::Ends(11)), ..tables };
        let moderate = (1e-20..1e6).contains(&(scale * scale));
        match Curve::<f32>::try_new(&tables) {
            Ok(curve) => {
                let y = curve.evaluate(x);
                prop_assert!(y >= -scale && y <= 1.5 * scale, "f({x}) = {y}");
            }
            Err(error) => {
                prop_assert_eq!(error, FuzzyError::OutOfRange("outputs.range"));
                prop_assert!(!moderate, "a range of {scale} is refused");
            }
        }
        let y = Curve::<f32>::try_new(&sampled).unwrap().evaluate(x);
        prop_assert!(y >= -scale && y <= 1.5 * scale, "sampled, f({x}) = {y}");
    }
}
