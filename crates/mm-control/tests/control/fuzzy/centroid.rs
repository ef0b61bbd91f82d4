//! The exact centroid against a quadrature of the definition.

use super::{Lcg, inputs};
use mm_control::fuzzy::{
    Aggregation, Connective, Curve, Defuzzifier, FuzzySystem, Implication, MamdaniTables, MembershipFunction,
    Operators, Rule, Sampling, THESIS, Variable,
};

/// Degree of `y` in the trapezoid, as the minimum of its two sides.
fn degree_of(shape: &MembershipFunction<f64>, y: f64) -> f64 {
    let [a, b, c, d] = shape.corners(-100.0, 100.0).unwrap();
    let left = if y >= b { 1.0 } else { (y - a) / (b - a) };
    let right = if y <= c { 1.0 } else { (d - y) / (d - c) };
    left.min(right).clamp(0.0, 1.0)
}

/// Degree of the term that a rule names, or of its complement.
fn named_degree(variable: &Variable<'_, f64>, index: i16, y: f64) -> f64 {
    let degree = degree_of(&variable.terms[usize::from(index.unsigned_abs()) - 1], y);
    if index < 0 { 1.0 - degree } else { degree }
}

/// The one output of a system of one input, by the midpoint rule with `n` points and by rule after rule; the middle of
/// the range without area.
fn quadrature(tables: &MamdaniTables<'_, f64>, x: f64, n: u32) -> f64 {
    let (input, output) = (&tables.inputs[0], &tables.outputs[0]);
    let x = x.clamp(input.range.0, input.range.1);
    let fired: Vec<_> = tables
        .rules
        .iter()
        .map(|rule| (rule.outputs[0], rule.weight * named_degree(input, rule.inputs[0], x)))
        .filter(|(_, strength)| *strength > 0.0)
        .collect();
    let (lo, hi) = output.range;
    let step = (hi - lo) / f64::from(n);
    let (mut area, mut moment) = (0.0, 0.0);
    for k in 0..n {
        let y = lo + (f64::from(k) + 0.5) * step;
        let shaped = fired.iter().map(|&(index, strength)| {
            let degree = named_degree(output, index, y);
            if tables.operators.implication == Implication::Min {
                degree.min(strength)
            } else {
                degree * strength
            }
        });
        let m = if tables.operators.aggregation == Aggregation::Sum {
            shaped.sum()
        } else {
            shaped.fold(0.0, f64::max)
        };
        area += m;
        moment += m * y;
    }
    if area > 0.0 { moment / area } else { 0.5 * (lo + hi) }
}

/// A random piecewise-linear term around the range [-1, 1], every third time with a doubled breakpoint.
fn random_term(random: &mut Lcg) -> MembershipFunction<f64> {
    let mut p = [0.0; 4].map(|_: f64| 3.0 * random.uniform() - 1.5);
    p.sort_by(f64::total_cmp);
    match random.index(6) {
        0 => p[1] = p[0],
        1 => p[2] = p[3],
        _ => {}
    }
    match random.index(6) {
        0 => MembershipFunction::LinearS([p[0], p[1]]),
        1 => MembershipFunction::LinearZ([p[2], p[3]]),
        2 | 3 => MembershipFunction::Triangle([p[0], p[1], p[3]]),
        _ => MembershipFunction::Trapezoid(p),
    }
}

/// A partition of [-1, 1] by `count` triangles from neighbour to neighbour, as most rule bases have it.
fn random_partition(random: &mut Lcg, count: usize) -> Vec<MembershipFunction<f64>> {
    let mut peaks: Vec<f64> = (0..count + 2).map(|_| 2.0 * random.uniform() - 1.0).collect();
    peaks.sort_by(f64::total_cmp);
    peaks.windows(3).map(|p| MembershipFunction::Triangle([p[0], p[1], p[2]])).collect()
}

#[test]
fn centroid_agrees_with_quadrature_on_random_systems() {
    let mut random = Lcg(2026);
    let mut worst = 0.0_f64;
    let systems = if cfg!(debug_assertions) { 40 } else { 240 };
    for system in 0..systems {
        let input_terms: Vec<_> = (0..3).map(|_| random_term(&mut random)).collect();
        let count = 1 + random.index(7);
        // Every other system is a row of terms, which has a way of its own to its centroid.
        let output_terms = if system % 2 == 0 {
            random_partition(&mut random, count)
        } else {
            (0..count).map(|_| random_term(&mut random)).collect()
        };
        let operators = Operators {
            implication: if system % 3 == 0 { Implication::Prod } else { Implication::Min },
            aggregation: if system % 5 == 0 { Aggregation::Sum } else { Aggregation::Max },
            ..Operators::default()
        };
        let index = |random: &mut Lcg, count: usize| {
            let index = i16::try_from(random.index(count) + 1).unwrap();
            if system % 7 == 0 && random.index(3) == 0 { -index } else { index }
        };
        let pairs: Vec<_> = (0..6).map(|_| [index(&mut random, 3), index(&mut random, count)]).collect();
        let rules: Vec<_> = pairs
            .iter()
            .map(|pair| Rule {
                inputs: &pair[..1],
                outputs: &pair[1..],
                weight: random.uniform(),
                connective: Connective::And,
            })
            .collect();
        let tables = MamdaniTables {
            inputs: &[Variable { range: (-1.0, 1.0), terms: &input_terms }],
            outputs: &[Variable { range: (-1.25, 1.0), terms: &output_terms }],
            rules: &rules,
            operators,
            defuzzifier: Defuzzifier::Centroid,
        };
        let engine = Curve::<f64>::try_new(&tables).unwrap();
        let x = 2.0 * random.uniform() - 1.0;
        let error = (engine.evaluate(x) - quadrature(&tables, x, 1_000_000)).abs();
        worst = worst.max(error);
        assert!(error < 1e-6, "system {system} at {x}: off by {error:e}: {tables:?}");
    }
}

#[test]
fn centroid_agrees_with_quadrature_on_the_thesis() {
    let engine = Curve::<f64>::try_new(&THESIS).unwrap();
    for x in inputs(1.5, 12) {
        let error = (engine.evaluate(x) - quadrature(&THESIS, x, 1_000_000)).abs();
        assert!(error < 1e-9, "at {x}: off by {error:e}");
    }
}

#[test]
fn sampling_at_101_points_moves_the_output() {
    let sampled = MamdaniTables { defuzzifier: Defuzzifier::SampledCentroid(Sampling::Ends(101)), ..THESIS };
    let y = Curve::<f64>::try_new(&sampled).unwrap().evaluate(-1e-12);
    // What a `.fis` tool with its usual 101 samples makes of the triangle (0.6666, 1, 1.334).
    let samples = (0_i16..=100).map(|k| -1.0 + 0.02 * f64::from(k));
    let (area, moment) = samples.fold((0.0, 0.0), |(area, moment), y| {
        let degree = degree_of(&MembershipFunction::Triangle([0.6666, 1.0, 1.334]), y);
        (area + degree, moment + degree * y)
    });
    assert!((y - moment / area).abs() < 1e-12, "sampled centroid {y}, by hand {}", moment / area);
    assert!((y - 0.8954).abs() < 1e-4, "sampled centroid {y}");
}
