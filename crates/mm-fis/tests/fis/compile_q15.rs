//! The rule engine in fixed point against the exact one in double precision.
//!
//! Law: for a system with its breakpoints as stored, the output of the Q15 engine is within 2 units (2^-15 of half the output's range) of the exact
//! centroid, at every one of the 65,536 inputs; a mirrored system gives an exactly odd map. Reference: `Mamdani` in f64 with the exact
//! centroid, which shares no code with the integer engine. Tolerance: 0.5 units from rounding the quotient, 0.5 from cutting the area
//! to 16 bits, 0.5 reserve for strengths and areas, and saturation at 32767 (one unit at the upper end). Run in the dev profile, every
//! operation is overflow-checked by the compiler as well: a wrong bound would panic.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "numbers small by construction"
)]
#![expect(clippy::expect_used, clippy::panic, reason = "helpers outside of test functions")]

use crate::compile_support::{Random, random, smooth, thesis};
use mm_control::fuzzy::fixed::{Curve, Engine, Evaluate};
use mm_control::fuzzy::{Aggregation, Implication, MembershipFunction as Mf};
use mm_fis::compile::{CompileError, Q15, value_of};
use mm_fis::{Accuracy, Defuzzification, Kind, Shape, System};

const TOLERANCE: f64 = 2.0;

/// Largest error in units over the given inputs, and where.
fn largest_error(system: &System, points: impl Iterator<Item = Vec<i16>>) -> (f64, Vec<i16>) {
    let q15 = Q15::compile(system).unwrap_or_else(|error| panic!("{}: {error}", system.name));
    let stored = system.as_stored();
    let half = |(lo, hi): (f64, f64)| (0.5 * lo + 0.5 * hi, 0.5 * hi - 0.5 * lo);
    q15.with_tables(|tables| {
        let engine = Engine::try_new(tables).expect("checked by the compiler");
        let mut words = vec![0; engine.workspace_len()];
        let mut got = vec![0; system.outputs.len()];
        stored
            .with_engine(Accuracy::Exact, |exact| {
                let mut numbers = vec![0.0; exact.workspace_len()];
                let mut expected = vec![0.0; system.outputs.len()];
                let mut worst = (0.0, Vec::new());
                for point in points {
                    engine.infer(&point, &mut got, &mut words).expect("lengths fit");
                    let x: Vec<f64> = (point.iter().zip(&system.inputs))
                        .map(|(&q, input)| value_of(input.range, q))
                        .collect();
                    let _met = exact.infer(&x, &mut expected, &mut numbers).expect("lengths fit");
                    for ((&got, &y), output) in got.iter().zip(&expected).zip(&system.outputs) {
                        let (middle, half) = half(output.range);
                        let error = (f64::from(got) - (y - middle) / half * 32768.0).abs();
                        if error > worst.0 {
                            worst = (error, point.clone());
                        }
                    }
                }
                worst
            })
            .expect("a proper system")
    })
}

fn all() -> impl Iterator<Item = Vec<i16>> {
    (i16::MIN..=i16::MAX).map(|q| vec![q])
}

#[test]
fn shipped_systems_at_every_input() {
    for system in [thesis(), smooth()] {
        let (error, at) = largest_error(&system, all());
        println!("{}: {error:.3} units at {at:?}", system.name);
        assert!(error <= TOLERANCE, "{}: {error} units at {at:?}", system.name);
    }
}

#[test]
fn random_systems_of_one_input_at_every_input() {
    for seed in 0..24 {
        let system = random(seed, 1, 1);
        let (error, at) = largest_error(&system, all());
        println!("{}: {error:.3} units at {at:?}", system.name);
        assert!(error <= TOLERANCE, "{}: {error} units at {at:?}", system.name);
    }
}

#[test]
fn random_systems_of_several_inputs_and_outputs() {
    for seed in 0..12 {
        let (inputs, outputs) = if seed % 3 == 2 { (3, 1) } else { (2, 2) };
        let system = random(100 + seed, inputs, outputs);
        let mut source = Random::new(seed);
        let points = (0..20_000).map(|k: usize| {
            if k < 4096 && inputs == 2 {
                let at = |k: usize| (k as i32 * 1040 - 32768).clamp(-32768, 32767) as i16;
                vec![at(k % 64), at(k / 64)]
            } else {
                (0..inputs).map(|_| source.word() as i16).collect()
            }
        });
        let (error, at) = largest_error(&system, points);
        println!("{}: {error:.3} units at {at:?}", system.name);
        assert!(error <= TOLERANCE, "{}: {error} units at {at:?}", system.name);
    }
}

#[test]
fn mirrored_systems_are_exactly_odd() {
    for system in [thesis(), smooth()] {
        let q15 = Q15::compile(&system).expect("shipped");
        assert!(q15.odd, "{} is its own mirror image", system.name);
        q15.with_tables(|tables| {
            let curve = Curve::<8>::try_new(tables).expect("small");
            assert_eq!(curve.evaluate(0), 0, "{}", system.name);
            for q in 1..=i16::MAX {
                assert_eq!(curve.evaluate(-q), -curve.evaluate(q), "{} at {q}", system.name);
            }
            let end = i32::from(curve.evaluate(i16::MIN)) - i32::from(curve.evaluate(-i16::MAX));
            assert!(end.abs() <= 1, "{}: the lowest input is answered as its neighbour is", system.name);
        });
    }
    let mut lopsided = smooth();
    lopsided.rules[0].weight = 0.5;
    assert!(!Q15::compile(&lopsided).expect("still a row").odd, "one weight differs");
}

#[test]
fn what_the_engine_has_no_place_for_is_named() {
    type Change = fn(&mut System);
    let cases: [(Change, &str); 9] = [
        (|s| s.kind = Kind::Sugeno, "Sugeno"),
        (|s| s.defuzzification = Defuzzification::Bisector, "centroid"),
        (|s| s.aggregation = Aggregation::Probor, "probabilistic sum"),
        (|s| s.implication = Implication::Prod, "`t1` of output `out1`"),
        (|s| s.rules[2].outputs[0] = -1, "rule 3"),
        (|s| s.inputs[0].terms[3].shape = Shape::Set(Mf::Gaussian([1.0, 0.0])), "`t3` of input `in1`"),
        (
            |s| s.outputs[0].terms[0].shape = Shape::Set(Mf::Triangle([-1.5, -1.2, -0.7])),
            "`t0` of output `out1`",
        ),
        (
            |s| s.outputs[0].terms[6].shape = Shape::Set(Mf::Triangle([-0.2, 1.0, 1.2])),
            "`t4` of output `out1`",
        ),
        (|s| s.rules.iter_mut().for_each(|rule| rule.weight = 0.0), "none of them ever fires"),
    ];
    for (change, part) in cases {
        let mut system = smooth();
        change(&mut system);
        let refused = Q15::compile(&system);
        assert!(matches!(refused, Err(CompileError::Unsupported { .. })), "{part}: {refused:?}");
        let message = refused.map(|_| ()).expect_err(part).to_string();
        assert!(
            message.contains(part) && message.contains("compiled surface"),
            "{message} does not name {part}"
        );
    }
}
