//! Law: an engine of several inputs and outputs computes what the definitions of its operators, connectives, shapes and
//! defuzzifications say.
//!
//! Why: firmware gets what a `.fis` file means, whatever it uses.
//!
//! Reference: a second implementation in this file, straight from the definitions: rule after rule, sample after sample, with the
//! shapes written as formulas over the whole line, no merging, no early exit.
//!
//! Tolerance: 1e-12 of the output range, a few hundred rounding errors of sums over up to 201 samples; where all that fires is weak, the
//! output is known to the rounding of a degree over the largest of them. A half of the area or a
//! maximum that rounding decides may be another sample: such a one has to be as good up to 1e-12, and they are counted.

#![expect(
    clippy::unwrap_used,
    reason = "the helpers are part of the tests: what fails in them fails the test"
)]

use mm_control::fuzzy::{
    Aggregation, And, Connective, Consequent, Defuzzifier, FuzzyError, Implication, Inference, Mamdani,
    MamdaniTables, MembershipFunction, Operators, Or, Rule, Sampling, Sugeno, SugenoOutput, SugenoTables,
    SugenoVariable, Variable,
};

/// Uniform numbers in [0, 1) from a 64-bit linear congruential generator.
struct Lcg(u64);

impl Lcg {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).unwrap()) / 4_294_967_296.0
    }
    fn below(&mut self, bound: i16) -> i16 {
        (0..bound).rev().find(|k| self.uniform() < 1.0 / (f64::from(*k) + 1.0)).unwrap_or(0)
    }
    fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[usize::try_from(self.below(i16::try_from(choices.len()).unwrap())).unwrap()]
    }
}

/// Any of the thirteen shapes around [-1, 1].
fn shape(random: &mut Lcg) -> MembershipFunction<f64> {
    let mut p = [0.0; 4].map(|_: f64| 3.0 * random.uniform() - 1.5);
    p.sort_by(f64::total_cmp);
    let [a, b, c, d] = p;
    let (s, t) = (0.1 + random.uniform(), 0.1 + random.uniform());
    match random.below(13) {
        0 => MembershipFunction::Triangle([a, b, c]),
        1 => MembershipFunction::Trapezoid(p),
        2 => MembershipFunction::LinearS([a, b]),
        3 => MembershipFunction::LinearZ([a, b]),
        4 => MembershipFunction::Gaussian([s, a]),
        5 => MembershipFunction::Gaussian2([s, b, t, c]),
        6 => MembershipFunction::Bell([s, 1.0 + 3.0 * t, b]),
        7 => MembershipFunction::Sigmoid([10.0 * (s - t), b]),
        8 => MembershipFunction::SigmoidDifference([9.0 * s, b, 8.0 * t, c]),
        9 => MembershipFunction::SigmoidProduct([9.0 * s, b, -8.0 * t, c]),
        10 => MembershipFunction::S([a, c]),
        11 => MembershipFunction::Z([b, d]),
        _ => MembershipFunction::Pi(p),
    }
}

/// The definitions of the shapes.
fn degree(shape: &MembershipFunction<f64>, x: f64) -> f64 {
    let ramp = |x: f64, a: f64, b: f64| ((x - a) / (b - a)).clamp(0.0, 1.0);
    let gauss = |x: f64, s: f64, c: f64| libm::exp(-(x - c) * (x - c) / (2.0 * s * s));
    let sigmoid = |x: f64, a: f64, c: f64| -> f64 { 1.0 / (1.0 + libm::exp(-a * (x - c))) };
    let spline = |x: f64, a: f64, b: f64| {
        let u = ramp(x, a, b);
        if u < 0.5 { 2.0 * u * u } else { 1.0 - 2.0 * (1.0 - u) * (1.0 - u) }
    };
    match *shape {
        MembershipFunction::Triangle([a, b, c]) => ramp(x, a, b).min(ramp(-x, -c, -b)),
        MembershipFunction::Trapezoid([a, b, c, d]) => ramp(x, a, b).min(ramp(-x, -d, -c)),
        MembershipFunction::LinearS([a, b]) => ramp(x, a, b),
        MembershipFunction::LinearZ([a, b]) => 1.0 - ramp(x, a, b),
        MembershipFunction::Gaussian([s, c]) => gauss(x, s, c),
        MembershipFunction::Gaussian2([s, b, t, c]) => gauss(x.min(b), s, b) * gauss(x.max(c), t, c),
        MembershipFunction::Bell([a, b, c]) => {
            1.0 / (1.0 + libm::exp(b * libm::log((x - c) * (x - c) / (a * a))))
        }
        MembershipFunction::Sigmoid([a, c]) => sigmoid(x, a, c),
        MembershipFunction::SigmoidDifference([a, b, c, d]) => (sigmoid(x, a, b) - sigmoid(x, c, d)).abs(),
        MembershipFunction::SigmoidProduct([a, b, c, d]) => sigmoid(x, a, b) * sigmoid(x, c, d),
        MembershipFunction::S([a, b]) => spline(x, a, b),
        MembershipFunction::Z([a, b]) => 1.0 - spline(x, a, b),
        MembershipFunction::Pi([a, b, c, d]) => spline(x, a, b) * (1.0 - spline(x, c, d)),
    }
}

/// A rule without slices.
struct OwnedRule {
    inputs: Vec<i16>,
    outputs: Vec<i16>,
    weight: f64,
    connective: Connective,
}

/// A random rule over inputs and outputs with the given numbers of terms.
fn rule(random: &mut Lcg, inputs: &[i16], outputs: &[i16], negated: bool) -> OwnedRule {
    let mut index = |terms: &i16, negated: bool| {
        let index = random.below(*terms + 1);
        if negated && random.uniform() < 0.3 { -index } else { index }
    };
    OwnedRule {
        inputs: inputs.iter().map(|terms| index(terms, true)).collect(),
        outputs: outputs.iter().map(|terms| index(terms, negated)).collect(),
        weight: random.pick(&[1.0, 0.25, 0.8]),
        connective: random.pick(&[Connective::And, Connective::Or]),
    }
}

fn borrowed(rules: &[OwnedRule]) -> Vec<Rule<'_, f64>> {
    fn one(rule: &OwnedRule) -> Rule<'_, f64> {
        let OwnedRule { inputs, outputs, weight, connective } = rule;
        Rule { inputs, outputs, weight: *weight, connective: *connective }
    }
    rules.iter().map(one).collect()
}

/// Variables of one range.
fn variables(terms: &[Vec<MembershipFunction<f64>>], range: (f64, f64)) -> Vec<Variable<'_, f64>> {
    terms.iter().map(|terms| Variable { range, terms }).collect()
}

/// Firing strength by the definition: fold over the inputs that play a part.
fn strength(rule: &Rule<'_, f64>, inputs: &[Variable<'_, f64>], x: &[f64], operators: Operators) -> f64 {
    let degrees = rule.inputs.iter().zip(inputs).zip(x).filter(|((index, _), _)| **index != 0).map(
        |((index, variable), x)| {
            let x = x.clamp(variable.range.0, variable.range.1);
            let own = degree(&variable.terms[usize::from(index.unsigned_abs()) - 1], x);
            if *index < 0 { 1.0 - own } else { own }
        },
    );
    rule.weight
        * match (rule.connective, operators.and, operators.or) {
            (Connective::And, And::Min, _) => degrees.fold(1.0, f64::min),
            (Connective::And, And::Prod, _) => degrees.product(),
            (Connective::Or, _, Or::Max) => degrees.fold(0.0, f64::max),
            (Connective::Or, _, Or::Probor) => 1.0 - degrees.map(|d| 1.0 - d).product::<f64>(),
        }
}

/// The samples of a range.
fn samples((lo, hi): (f64, f64), sampling: Sampling) -> Vec<f64> {
    match sampling {
        Sampling::Ends(n) => (0..n).map(|k| lo + (hi - lo) * f64::from(k) / f64::from(n - 1)).collect(),
        Sampling::Midpoints(n) => {
            (0..n).map(|k| lo + (hi - lo) * (f64::from(k) + 0.5) / f64::from(n)).collect()
        }
    }
}

/// One output by the definitions, the ends between which rounding may put it, and how precisely it is known.
fn mamdani(tables: &MamdaniTables<'_, f64>, output: usize, x: &[f64]) -> (f64, (f64, f64), f64) {
    let variable = &tables.outputs[output];
    let (lo, hi) = variable.range;
    let set = |y: f64| {
        let shaped = tables.rules.iter().filter(|rule| rule.outputs[output] != 0).map(|rule| {
            let w = strength(rule, tables.inputs, x, tables.operators);
            let index = rule.outputs[output];
            let own = degree(&variable.terms[usize::from(index.unsigned_abs()) - 1], y);
            let own = if index < 0 { 1.0 - own } else { own };
            if tables.operators.implication == Implication::Min { own.min(w) } else { own * w }
        });
        match tables.operators.aggregation {
            Aggregation::Max => shaped.fold(0.0, f64::max),
            Aggregation::Sum => shaped.sum(),
            Aggregation::Probor => 1.0 - shaped.map(|m| 1.0 - m).product::<f64>(),
        }
    };
    let (Defuzzifier::SampledCentroid(sampling)
    | Defuzzifier::Bisector(sampling)
    | Defuzzifier::MeanOfMaximum(sampling)
    | Defuzzifier::SmallestOfMaximum(sampling)
    | Defuzzifier::LargestOfMaximum(sampling)) = tables.defuzzifier
    else {
        // The exact centroid has a test of its own.
        return (f64::NAN, (f64::NAN, f64::NAN), 0.0);
    };
    let points = samples(variable.range, sampling);
    let degrees: Vec<f64> = points.iter().map(|&y| set(y)).collect();
    let area: f64 = degrees.iter().sum();
    if area <= 0.0 {
        return (0.5 * (lo + hi), (lo, hi), 1e-12);
    }
    let most = degrees.iter().copied().fold(0.0, f64::max);
    let near_top = |slack: f64| -> Vec<f64> {
        points.iter().zip(&degrees).filter(|(_, m)| **m >= most - slack).map(|(y, _)| *y).collect()
    };
    let (top, loose) = (near_top(1e-15), near_top(1e-12));
    let reaches = |part: f64| {
        let mut sum = 0.0;
        let mut found = points.iter().zip(&degrees).filter(|(_, m)| {
            sum += **m;
            sum >= part * area
        });
        *found.next().unwrap().0
    };
    let by = |better: fn(f64, f64) -> bool| {
        let best = |list: &[f64]| {
            list.iter().copied().reduce(|a, b| if better(b.abs(), a.abs()) { b } else { a }).unwrap()
        };
        (best(&top), (loose[0], *loose.last().unwrap()))
    };
    let (value, ends) = match tables.defuzzifier {
        Defuzzifier::Centroid | Defuzzifier::SampledCentroid(_) => {
            let centroid = points.iter().zip(&degrees).map(|(y, m)| y * m).sum::<f64>() / area;
            (centroid, (centroid, centroid))
        }
        Defuzzifier::Bisector(_) => (reaches(0.5), (reaches(0.5 - 1e-12), reaches(0.5 + 1e-12))),
        Defuzzifier::MeanOfMaximum(_) => {
            let mean = top.iter().sum::<f64>() / f64::from(u32::try_from(top.len()).unwrap());
            (mean, (loose[0], *loose.last().unwrap()))
        }
        Defuzzifier::SmallestOfMaximum(_) => by(|new, old| new < old),
        Defuzzifier::LargestOfMaximum(_) => by(|new, old| new > old),
    };
    (value, ends, 1e-12 + 16.0 * f64::EPSILON / most)
}

#[test]
fn random_systems_follow_the_definitions() {
    let mut random = Lcg(4);
    let systems = if cfg!(debug_assertions) { 150 } else { 1500 };
    let mut seen = [0_u32; 6];
    for system in 0..systems {
        let input_terms: Vec<Vec<_>> = (0..1 + random.below(3))
            .map(|_| (0..1 + random.below(4)).map(|_| shape(&mut random)).collect())
            .collect();
        let output_terms: Vec<Vec<_>> = (0..1 + random.below(2))
            .map(|_| (0..1 + random.below(4)).map(|_| shape(&mut random)).collect())
            .collect();
        let counts = |terms: &[Vec<MembershipFunction<f64>>]| -> Vec<i16> {
            terms.iter().map(|terms| i16::try_from(terms.len()).unwrap()).collect()
        };
        let negated = random.uniform() < 0.3;
        let owned: Vec<_> = (0..1 + random.below(8))
            .map(|_| rule(&mut random, &counts(&input_terms), &counts(&output_terms), negated))
            .collect();
        let (inputs, outputs) =
            (variables(&input_terms, (-1.0, 1.0)), variables(&output_terms, (-1.25, 1.0)));
        let sampling = random.pick(&[
            Sampling::Ends(101),
            Sampling::Midpoints(100),
            Sampling::Ends(2),
            Sampling::Ends(201),
        ]);
        let kind = usize::try_from(random.below(5)).unwrap();
        seen[kind] += 1;
        let defuzzifier = [
            Defuzzifier::SampledCentroid(sampling),
            Defuzzifier::Bisector(sampling),
            Defuzzifier::MeanOfMaximum(sampling),
            Defuzzifier::SmallestOfMaximum(sampling),
            Defuzzifier::LargestOfMaximum(sampling),
        ][kind];
        let operators = Operators {
            and: random.pick(&[And::Min, And::Prod]),
            or: random.pick(&[Or::Max, Or::Probor]),
            implication: random.pick(&[Implication::Min, Implication::Prod]),
            aggregation: random.pick(&[Aggregation::Max, Aggregation::Sum, Aggregation::Probor]),
        };
        let rules = borrowed(&owned);
        let tables =
            MamdaniTables { inputs: &inputs, outputs: &outputs, rules: &rules, operators, defuzzifier };
        let engine = Mamdani::try_new(&tables).unwrap();
        let mut workspace = vec![f64::NAN; engine.workspace_len()];
        for _ in 0..8 {
            let x: Vec<f64> = inputs.iter().map(|_| 2.4 * random.uniform() - 1.2).collect();
            let mut y = vec![f64::NAN; outputs.len()];
            let met = engine.infer(&x, &mut y, &mut workspace).unwrap();
            assert_eq!(met.clamped, x.iter().any(|x| x.abs() > 1.0), "system {system} at {x:?}");
            for (output, y) in y.iter().enumerate() {
                let (expected, (least, most), tolerance) = mamdani(&tables, output, &x);
                let tied = (y - expected).abs() > tolerance;
                let possible = *y >= least - tolerance && *y <= most + tolerance;
                assert!(
                    possible && !(tied && kind == 0),
                    "system {system}, output {output} at {x:?}: {y}, not {expected}: {tables:?}"
                );
                seen[5] += u32::from(tied);
            }
        }
    }
    assert!(seen[..5].iter().all(|&count| count > 10), "a defuzzification was hardly tried: {seen:?}");
    assert!(seen[5] * 50 < 8 * systems, "more than one in fifty outputs is tied: {seen:?}");
}

#[test]
fn sugeno_follows_the_definition() {
    let mut random = Lcg(5);
    for system in 0..300 {
        let input_terms: Vec<Vec<_>> = (0..1 + random.below(3))
            .map(|_| (0..1 + random.below(4)).map(|_| shape(&mut random)).collect())
            .collect();
        let factors: Vec<Vec<f64>> =
            (0..4).map(|_| (0..=input_terms.len()).map(|_| 4.0 * random.uniform() - 2.0).collect()).collect();
        let terms: Vec<_> = factors
            .iter()
            .enumerate()
            .map(|(k, f)| if k % 2 == 0 { Consequent::Linear(f) } else { Consequent::Constant(f[0]) })
            .collect();
        let counts: Vec<_> = input_terms.iter().map(|terms| i16::try_from(terms.len()).unwrap()).collect();
        let owned: Vec<_> = (0..6).map(|_| rule(&mut random, &counts, &[4, 4], false)).collect();
        let rules = borrowed(&owned);
        let inputs: Vec<_> = input_terms.iter().map(|terms| Variable { range: (-1.0, 1.0), terms }).collect();
        let outputs = [SugenoVariable { range: (-3.0, 5.0), terms: &terms }; 2];
        let operators =
            Operators { and: random.pick(&[And::Min, And::Prod]), or: Or::Probor, ..Operators::default() };
        let output = random.pick(&[SugenoOutput::WeightedAverage, SugenoOutput::WeightedSum]);
        let tables = SugenoTables {
            inputs: &inputs,
            outputs: &outputs,
            rules: &rules,
            and: operators.and,
            or: operators.or,
            output,
        };
        let engine = Sugeno::try_new(&tables).unwrap();
        let mut workspace = vec![0.0; engine.workspace_len()];
        let x: Vec<f64> = inputs.iter().map(|_| 2.4 * random.uniform() - 1.2).collect();
        let mut y = [0.0; 2];
        let met = engine.infer(&x, &mut y, &mut workspace).unwrap();
        let mut silent = false;
        for (output, y) in y.iter().enumerate() {
            let parts: Vec<(f64, f64)> = rules
                .iter()
                .filter(|rule| rule.outputs[output] != 0)
                .map(|rule| {
                    let position = usize::try_from(rule.outputs[output] - 1).unwrap();
                    let f = &factors[position];
                    let linear: f64 =
                        f.iter().zip(&x).map(|(f, x)| f * x.clamp(-1.0, 1.0)).sum::<f64>() + f[x.len()];
                    let z = if position % 2 == 0 { linear } else { f[0] };
                    (strength(rule, &inputs, &x, operators), z)
                })
                .collect();
            let weight: f64 = parts.iter().map(|(w, _)| w).sum();
            let sum: f64 = parts.iter().map(|(w, z)| w * z).sum();
            let expected = match tables.output {
                SugenoOutput::WeightedSum => sum,
                SugenoOutput::WeightedAverage if weight > 0.0 => sum / weight,
                SugenoOutput::WeightedAverage => 1.0,
            };
            silent |= weight <= 0.0;
            assert!(
                (y - expected).abs() < 1e-12,
                "system {system}, output {output} at {x:?}: {y}, not {expected}"
            );
        }
        assert_eq!(met.unfired, silent, "system {system} at {x:?}");
    }
}

/// Two inputs, one rule, for the odd cases.
const PLAIN: MamdaniTables<'static, f64> = MamdaniTables {
    inputs: &[
        Variable { range: (0.0, 1.0), terms: &[MembershipFunction::LinearS([0.0, 1.0])] },
        Variable { range: (0.0, 1.0), terms: &[MembershipFunction::LinearS([0.5, 1.0])] },
    ],
    outputs: &[Variable { range: (2.0, 6.0), terms: &[MembershipFunction::Triangle([4.0, 5.0, 6.0])] }],
    rules: &[Rule { inputs: &[1, 1], outputs: &[1], weight: 1.0, connective: Connective::And }],
    operators: Operators {
        and: And::Min,
        or: Or::Max,
        implication: Implication::Min,
        aggregation: Aggregation::Max,
    },
    defuzzifier: Defuzzifier::Centroid,
};

#[test]
#[expect(clippy::float_cmp, reason = "the middle of a range and untouched outputs are exact")]
fn odd_inputs_have_defined_results() {
    let engine = Mamdani::try_new(&PLAIN).unwrap();
    let infer = |x: [f64; 2]| {
        let (mut y, mut workspace) = ([f64::NAN], [f64::NAN; 3]);
        let met = engine.infer(&x, &mut y, &mut workspace).unwrap();
        (y[0], met)
    };
    let inside = Inference::default();
    assert_eq!(infer([0.9, 0.8]).1, inside, "nothing to say");
    assert_eq!(infer([0.9, 0.4]), (4.0, Inference { unfired: true, ..inside }), "no rule fires");
    assert_eq!(infer([f64::NAN, 0.8]), (4.0, Inference { nan: true, unfired: true, ..inside }), "NaN");
    assert_eq!(
        infer([0.9, 7.0]),
        (infer([0.9, 1.0]).0, Inference { clamped: true, ..inside }),
        "above the range"
    );
    assert_eq!(infer([f64::INFINITY, 1.0]).0, infer([1.0, 1.0]).0, "infinity is above the range");

    let (mut y, mut workspace) = ([7.0], [0.0; 3]);
    assert_eq!(engine.infer(&[0.5], &mut y, &mut workspace), Err(FuzzyError::Length("inputs")), "one input");
    let short = engine.infer(&[0.5, 0.5], &mut y, &mut workspace[..2]);
    assert_eq!(short, Err(FuzzyError::Length("workspace")), "a workspace of two");
    let none = engine.infer(&[0.5, 0.5], &mut [], &mut workspace);
    assert_eq!(none, Err(FuzzyError::Length("outputs")), "no outputs");
    assert_eq!(y, [7.0], "a refusal leaves the outputs");
    assert_eq!(engine.workspace_len(), 3, "two degrees, one strength");
}

#[test]
#[expect(clippy::float_cmp, reason = "the same operations give the same bits")]
fn a_rule_without_inputs_fires_always_or_never() {
    for (connective, fires) in [(Connective::And, true), (Connective::Or, false)] {
        let rules = [Rule { inputs: &[0, 0], outputs: &[1], weight: 0.5, connective }];
        let tables = MamdaniTables { rules: &rules, ..PLAIN };
        let (mut y, mut workspace) = ([0.0], [0.0; 3]);
        let met = Mamdani::try_new(&tables).unwrap().infer(&[0.0, 0.0], &mut y, &mut workspace).unwrap();
        assert_eq!(met.unfired, !fires, "{connective:?}");
        assert_eq!(
            y[0],
            if fires { 5.0 } else { 4.0 },
            "{connective:?}: the centre of the term, or the middle"
        );
        let single = [PLAIN.inputs[0]];
        let rules = [Rule { inputs: &[0], outputs: &[1], weight: 0.5, connective }];
        let tables = MamdaniTables { inputs: &single, rules: &rules, ..PLAIN };
        let met = Mamdani::try_new(&tables).unwrap().infer(&[0.0], &mut y, &mut workspace).unwrap();
        assert_eq!(met.unfired, !fires, "one input, {connective:?}");
    }
}
