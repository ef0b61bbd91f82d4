//! The shipped rule bases in fixed point against the exact ones.
//!
//! Laws, at all 65,536 inputs: the Q15 engine is within 2 units (2^-15 of half the output's range) of the exact centroid of the system with its
//! breakpoints rounded as stored; the compiled surface is within 2^-10 of half the range of the exact system as printed; both are exactly
//! odd, and 0 at 0. The adapter for control laws adds no more than the rounding of its input and output. Reference: `Curve` in f64. Tolerances:
//! those of the laws, and one step of input and output for the adapter. The dev profile checks every operation for overflow meanwhile.
#![expect(clippy::expect_used, clippy::panic, reason = "helpers outside of test functions")]

use mm_control::fuzzy::fixed::{
    Curve, Engine, Evaluate, Premise, Rule, SMOOTH_Q15, SMOOTH_SURFACE, Scaled, Slot, Surface1, THESIS_Q15,
    THESIS_SURFACE, Tables, Term, Trigger,
};
use mm_control::fuzzy::{
    And, Connective, FuzzyError, FuzzySystem, MamdaniTables, MembershipFunction as Mf, Or, SMOOTH, THESIS,
    Variable,
};
use mm_model::Real;

type Exact<'a> = mm_control::fuzzy::Curve<'a, f64>;

struct Shipped {
    name: &'static str,
    exact: MamdaniTables<'static, f64>,
    tables: Tables<'static>,
    surface: Surface1<'static>,
}

fn shipped() -> [Shipped; 2] {
    [
        Shipped { name: "thesis", exact: THESIS, tables: THESIS_Q15, surface: THESIS_SURFACE },
        Shipped { name: "smooth", exact: SMOOTH, tables: SMOOTH_Q15, surface: SMOOTH_SURFACE },
    ]
}

fn at(range: (f64, f64), q: f64) -> f64 {
    0.5 * (range.0 + range.1) + 0.5 * (range.1 - range.0) * (q / 32768.0)
}

/// The terms with their breakpoints rounded to 2^-15 of half the range.
fn stored(variable: &Variable<'_, f64>) -> Vec<Mf<f64>> {
    let (lo, hi) = variable.range;
    let round = |x: f64| at(variable.range, ((x - 0.5 * (lo + hi)) / (0.5 * (hi - lo)) * 32768.0).round());
    let term = |term: &Mf<f64>| match *term {
        Mf::Triangle(p) => Mf::Triangle(p.map(round)),
        Mf::Trapezoid(p) => Mf::Trapezoid(p.map(round)),
        other => panic!("{other:?} is in no shipped system"),
    };
    variable.terms.iter().map(term).collect()
}

/// Largest difference in steps of the output over all inputs.
fn largest_error(system: &dyn Evaluate, exact: &Exact<'_>, output: (f64, f64)) -> f64 {
    let input = exact.input_range();
    let error = |q: i16| {
        let y = exact.evaluate(at(input, q.into()));
        (f64::from(system.evaluate(q)) - (y - at(output, 0.0)) / (0.5 * (output.1 - output.0)) * 32768.0)
            .abs()
    };
    (i16::MIN..=i16::MAX).map(error).fold(0.0, f64::max)
}

#[test]
fn engine_is_within_two_units_of_the_exact_centroid() {
    for Shipped { name, exact, tables, .. } in shipped() {
        let (input, output) = (exact.inputs[0], exact.outputs[0]);
        let (input_terms, output_terms) = (stored(&input), stored(&output));
        let rounded = MamdaniTables {
            inputs: &[Variable { terms: &input_terms, ..input }],
            outputs: &[Variable { terms: &output_terms, ..output }],
            ..exact
        };
        let curve = Curve::<8>::try_new(&tables).expect("shipped");
        let error =
            largest_error(&curve, &Exact::try_new(&rounded).expect("as proper as before"), output.range);
        println!("{name}: {error:.3} units");
        assert!(error <= 2.0, "{name}: {error} units");
    }
}

#[test]
fn surface_is_within_its_bound_of_the_system_as_printed() {
    for Shipped { name, exact, surface, .. } in shipped() {
        assert!(surface.check(), "{name}");
        let error =
            largest_error(&surface, &Exact::try_new(&exact).expect("shipped"), exact.outputs[0].range);
        println!("{name}: {error:.3} units");
        assert!(error <= 32.0, "{name}: {error} units, 2^-10 of half the range are 32");
    }
}

#[test]
fn both_are_exactly_odd_and_saturate_at_the_lowest_input() {
    for Shipped { name, tables, surface, .. } in shipped() {
        let curve = Curve::<8>::try_new(&tables).expect("shipped");
        let systems: [(&str, &dyn Evaluate); 2] = [("engine", &curve), ("surface", &surface)];
        for (kind, system) in systems {
            assert_eq!(system.evaluate(0), 0, "{name}, {kind}");
            for q in 1..=i16::MAX {
                assert_eq!(system.evaluate(-q), -system.evaluate(q), "{name}, {kind} at {q}");
            }
            let end = system.evaluate(i16::MIN);
            assert!(
                end.abs_diff(system.evaluate(-i16::MAX)) <= 40,
                "{name}, {kind} at the lowest input: {end}"
            );
        }
    }
    let near = THESIS_SURFACE.evaluate(1);
    assert!((f64::from(near) / 32768.0 + 0.8889).abs() < 1e-3, "beside the jump: {near}");
}

fn scaled_follows_the_exact_system<T: Real>(tolerance: f64) {
    for Shipped { name, exact, tables, surface } in shipped() {
        let (input, output) = (exact.inputs[0].range, exact.outputs[0].range);
        let near = |(lo, hi): (f64, f64)| (T::from_f64(lo), T::from_f64(hi));
        let curve = Curve::<8>::try_new(&tables).expect("shipped");
        let engine = Scaled::<T, _>::try_new(curve, near(input), near(output)).expect("proper ranges");
        let table = Scaled::<T, _>::try_new(surface, near(input), near(output)).expect("proper ranges");
        let exact = Exact::try_new(&exact).expect("shipped");
        for k in -3000..=3000 {
            let x = f64::from(k) / 2000.0;
            let systems: [&dyn FuzzySystem<T>; 2] = [&engine, &table];
            for system in systems {
                let (y, opposite) = (system.evaluate(T::from_f64(x)), system.evaluate(T::from_f64(-x)));
                assert!(y + opposite == T::ZERO, "{name} is odd at {x}");
                let error = (y.to_f64() - exact.evaluate(x)).abs();
                assert!(error <= tolerance, "{name} at {x}: off by {error}");
            }
        }
        for far in [T::from_f64(1e30), T::from_f64(f64::INFINITY)] {
            assert!(engine.evaluate(far) == engine.evaluate(near(input).1), "{name} holds beyond its range");
        }
        assert!(table.evaluate(T::from_f64(f64::NAN)) == T::ZERO, "{name} answers NaN with the middle");
    }
}

#[test]
fn adapted_to_floating_point_in_both_precisions() {
    // The bound of the surface, and one step of 3e-5 of the input at the steepest slope, which is below 12.
    scaled_follows_the_exact_system::<f64>(1.4e-3);
    scaled_follows_the_exact_system::<f32>(1.4e-3);
}

#[test]
fn ranges_that_are_none_are_refused() {
    let scaled = |input, output| Scaled::try_new(SMOOTH_SURFACE, input, output).map(|_| ());
    assert_eq!(scaled((1.0, 1.0), (0.0, 1.0)), Err(FuzzyError::Inverted("input_range")), "no width");
    assert_eq!(scaled((0.0, 1.0), (0.0, f64::NAN)), Err(FuzzyError::NonFinite("output_range")), "NaN");
    assert_eq!(scaled((0.0, 1e-310), (0.0, 1.0)), Err(FuzzyError::OutOfRange("input_range")), "too narrow");
}

const ALWAYS: Rule<'static> =
    Rule { premises: &[], slots: &[0], weight: 1 << 30, connective: Connective::And };
const WHOLE: Slot = Slot::cut([-32768, -32768, 32768, 32768], None, 13);

const fn trigger<'a>(rules: &'a [Rule<'a>]) -> Trigger<'a> {
    Trigger { term: Term::new([0, 1, 2, 3]), rules }
}

fn refused(inputs: &[&[Trigger<'_>]], rest: &[Rule<'_>], outputs: &[&[Slot]]) -> Option<FuzzyError> {
    let tables = Tables { inputs, rest, outputs, and: And::Min, or: Or::Max, odd: false };
    Engine::try_new(&tables).err()
}

#[test]
fn tables_made_badly_are_refused() {
    let good = [trigger(&[ALWAYS])];
    assert_eq!(refused(&[&good], &[ALWAYS], &[&[WHOLE]]), None, "good ones are taken");
    let strange = Premise { input: 0, term: 7, not: false };
    let cases: [(Rule<'_>, &str); 4] = [
        (Rule { weight: (1 << 30) + 1, ..ALWAYS }, "rules.weight"),
        (Rule { slots: &[1], ..ALWAYS }, "rules.slots"),
        (Rule { premises: &[strange], ..ALWAYS }, "rules.premises"),
        (Rule { connective: Connective::Or, ..ALWAYS }, "rules.connective"),
    ];
    for (rule, field) in cases {
        let error = refused(&[&[trigger(&[rule])]], &[], &[&[WHOLE]]);
        assert_eq!(error, Some(FuzzyError::OutOfRange(field)), "{rule:?}");
    }
    assert_eq!(refused(&[], &[ALWAYS], &[&[WHOLE]]), Some(FuzzyError::Empty("inputs")), "nothing in");
    assert_eq!(refused(&[&[]], &[ALWAYS], &[&[WHOLE]]), Some(FuzzyError::Empty("inputs.terms")), "no term");
    assert_eq!(refused(&[&good], &[ALWAYS], &[]), Some(FuzzyError::Empty("outputs")), "nothing out");
    assert_eq!(refused(&[&good], &[ALWAYS], &[&[]]), Some(FuzzyError::Empty("outputs.slots")), "no slot");
    let scale = Some(FuzzyError::OutOfRange("outputs.scale"));
    let large = [Slot::cut([-32768, -32768, 32768, 32768], None, 14)];
    assert_eq!(refused(&[&good], &[ALWAYS], &[&large]), scale, "2^30 for one slot");
    assert_eq!(refused(&[&good], &[ALWAYS], &[&[WHOLE; 17]]), scale, "17 times 2^29");
    let turned = Slot::cut([0, 10, 20, 30], Some([100, 200, 20_000, 30_000]), 13);
    assert_eq!(refused(&[&good], &[ALWAYS], &[&[turned]]), scale, "a row out of order");
}

#[test]
fn what_passes_the_check_never_overflows() {
    // Corners, weights and rules without any sense, at the limits of what is accepted; the dev profile panics at an overflow.
    let mut word = 1_u64;
    let mut next = move |n: i32| {
        word ^= word << 13;
        word ^= word >> 7;
        word ^= word << 17;
        i32::try_from(word % u64::try_from(n).expect("positive")).expect("small")
    };
    let mut taken = 0;
    for _ in 0..400 {
        let mut corners = |reach: i32| core::array::from_fn(|_| next(2 * reach) - reach);
        let terms: [Term; 3] =
            core::array::from_fn(|k| Term::new(corners([1 << 15, 1 << 17, i32::MAX / 2][k])));
        let rows: [[i32; 4]; 3] = core::array::from_fn(|_| {
            let mut own: [i32; 4] = corners(1 << 15);
            own.sort_unstable();
            own
        });
        let slots = [
            Slot::cut(rows[0], None, 13),
            Slot::cut(rows[1], Some(rows[0]), 13),
            Slot::cut(rows[2], Some(rows[1]), 13),
            Slot::scaled(rows[0], 13),
        ];
        let weight = if next(2) == 0 { 1 << 30 } else { next(1 << 30).unsigned_abs() };
        let premises = [Premise { input: 0, term: 1, not: next(2) == 0 }];
        let rules = [
            Rule { premises: &premises, slots: &[0], weight, connective: Connective::And },
            Rule { premises: &[], slots: &[1, 3], weight, connective: Connective::And },
        ];
        let or = [Rule { premises: &premises, slots: &[2], weight, connective: Connective::Or }];
        let triggers = terms.map(|term| Trigger { term, rules: &rules });
        let (and, odd) = (if next(2) == 0 { And::Min } else { And::Prod }, next(2) == 0);
        let tables = Tables { inputs: &[&triggers], rest: &or, outputs: &[&slots], and, or: Or::Probor, odd };
        let Ok(curve) = Curve::<8>::try_new(&tables) else { continue };
        taken += 1;
        for q in (i16::MIN..=i16::MAX).step_by(97) {
            let _anything = curve.evaluate(q);
        }
    }
    assert!(taken > 50, "only {taken} of 400 were taken");
}
