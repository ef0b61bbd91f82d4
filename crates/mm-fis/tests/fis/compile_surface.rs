//! Compiled surfaces against the functions they were made from.
//!
//! Law: at every one of the 65,536 inputs the surface is within the bound asked for, in output units; a jump is kept on its side; an odd function
//! gives an exactly odd table; what cannot be met is refused with what can. Reference: the function itself in f64, called anew here. Tolerance:
//! the bound, times 1 + 1e-9 for the rounding of the comparison.
#![expect(clippy::expect_used, clippy::panic, reason = "helpers outside of test functions")]

use crate::compile_support::{random, smooth, thesis};
use mm_control::fuzzy::fixed::Evaluate;
use mm_fis::compile::{CompileError, CompiledSurface, Request};
use mm_fis::{Accuracy, System};

/// Compiles the first output of a system of one input and checks every input.
fn compiled(system: &System, request: &Request) -> CompiledSurface {
    system
        .with_engine(Accuracy::Exact, |engine| {
            let f = |x: f64| {
                let (mut y, mut workspace) = ([0.0], vec![0.0; engine.workspace_len()]);
                let _met = engine.infer(&[x], &mut y, &mut workspace).expect("lengths fit");
                y[0]
            };
            let ranges = (system.inputs[0].range, system.outputs[0].range);
            let compiled = CompiledSurface::compile(&system.name, &f, ranges, request)
                .unwrap_or_else(|error| panic!("{}: {error}", system.name));
            verify(&compiled, &f);
            compiled
        })
        .expect("a proper system")
}

fn verify(compiled: &CompiledSurface, f: &dyn Fn(f64) -> f64) {
    let surface = compiled.surface();
    assert!(surface.check(), "{}: {surface:?}", compiled.name);
    let ((lo, hi), (bottom, top)) = (compiled.input_range, compiled.output_range);
    let mut worst = 0.0_f64;
    for q in i16::MIN..=i16::MAX {
        let x = 0.5 * (lo + hi) + 0.5 * (hi - lo) * (f64::from(q) / 32768.0);
        let y = 0.5 * (bottom + top) + 0.5 * (top - bottom) * (f64::from(surface.evaluate(q)) / 32768.0);
        worst = worst.max((y - f(x)).abs());
    }
    println!(
        "{}: {} knots, {} sections, {} bytes, odd {}, error {worst:.3e} of {:.3e}, jumps {:?}",
        compiled.name,
        compiled.knots.len(),
        compiled.sections.len(),
        compiled.bytes(),
        compiled.odd,
        compiled.bound,
        compiled.jumps,
    );
    assert!(worst <= compiled.bound * (1.0 + 1e-9), "{}: {worst} exceeds {}", compiled.name, compiled.bound);
    assert!(
        (worst - compiled.error).abs() <= 1e-9 * compiled.bound,
        "{}: the report says {}",
        compiled.name,
        compiled.error
    );
}

#[test]
fn shipped_systems_within_several_bounds() {
    for (bound, knots) in [(1e-2, 140), (1.0 / 1024.0, 700), (1e-4, 5000)] {
        for system in [thesis(), smooth()] {
            let compiled = compiled(&system, &Request { bound: Some(bound), ..Request::default() });
            assert!(compiled.odd, "{}", system.name);
            assert!(
                compiled.knots.len() <= knots,
                "{}: {} knots for {bound}",
                system.name,
                compiled.knots.len()
            );
            let surface = compiled.surface();
            assert_eq!(surface.evaluate(0), 0, "{}", system.name);
            assert!(
                (1..=32767).all(|q| surface.evaluate(-q) == -surface.evaluate(q)),
                "{} is odd",
                system.name
            );
        }
    }
}

#[test]
fn the_jump_of_the_thesis_is_exact_on_its_sides() {
    let compiled = compiled(&thesis(), &Request::default());
    let surface = compiled.surface();
    let near = surface.evaluate(1);
    assert!((f64::from(near) / 32768.0 + 0.8889).abs() < 1e-3, "just above zero: {near}");
    assert_eq!([-1, 0].map(|q| surface.evaluate(q)), [-near, 0], "at and below zero");
    assert_eq!(compiled.jumps.len(), 1, "{:?}", compiled.jumps);
    assert!(compiled.jumps[0].at.abs() < 1e-9, "found at {}", compiled.jumps[0].at);
}

#[test]
fn random_systems_of_every_kind() {
    for seed in 0..12 {
        compiled(&random(seed, 1, 1), &Request { bits: 12 + (seed % 5) as u32, ..Request::default() });
    }
}

#[test]
fn functions_with_jumps_and_slopes() {
    let stairs = |x: f64| (7.0 * x).floor() / 4.0;
    let spike = |x: f64| if (x - 0.25).abs() < 1e-12 { 1.0 } else { -0.5 };
    let steep = |x: f64| (80.0 * x).clamp(-0.9, 0.9);
    let wide = |x: f64| 3.0 + 5.0 * x * x;
    let functions: [(&str, &dyn Fn(f64) -> f64); 4] =
        [("stairs", &stairs), ("spike", &spike), ("steep", &steep), ("wide", &wide)];
    for (name, f) in functions {
        let ranges = ((-1.0, 1.0), (-1.0, 1.0));
        let compiled = CompiledSurface::compile(name, f, ranges, &Request::default()).expect(name);
        verify(&compiled, f);
        match name {
            "stairs" => assert_eq!(compiled.sections.len(), 14, "one for each step"),
            "spike" => assert_eq!(compiled.surface().evaluate(8192), 32767, "the point itself"),
            "steep" => assert!(compiled.jumps.is_empty(), "a slope is no jump: {:?}", compiled.jumps),
            _ => assert_eq!(compiled.output_range, (-8.0, 8.0), "widened about its middle"),
        }
    }
}

#[test]
fn what_cannot_be_met_is_refused_with_what_can() {
    let f = |x: f64| 0.7 * x * x * x;
    let compile =
        |request: &Request| CompiledSurface::compile("cube", &f, ((-1.0, 1.0), (-1.0, 1.0)), request);
    let coarse = compile(&Request { bits: 8, bound: Some(1e-3), ..Request::default() });
    let Err(CompileError::Bound { reachable, .. }) = coarse else { panic!("{coarse:?}") };
    assert!((3.8e-3..4.5e-3).contains(&reachable), "half a step of 8 bits is 3.9e-3: {reachable}");
    let few = compile(&Request { max_knots: 5, bound: Some(1e-3), ..Request::default() });
    let Err(CompileError::Bound { reachable, .. }) = few else { panic!("{few:?}") };
    assert!(reachable > 5e-3, "{reachable}");
    let request = Request { max_knots: 5, bound: Some(reachable), ..Request::default() };
    verify(&compile(&request).expect("it said so"), &f);
    for (request, name) in [
        (Request { bits: 7, ..Request::default() }, "bits"),
        (Request { bound: Some(0.0), ..Request::default() }, "bound"),
        (Request { bound: Some(f64::NAN), ..Request::default() }, "bound"),
    ] {
        let refused = compile(&request);
        assert!(matches!(refused, Err(CompileError::Request { name: n, .. }) if n == name), "{refused:?}");
    }
    let hole = |x: f64| if x > 0.5 { f64::NAN } else { x };
    let refused = CompiledSurface::compile("hole", &hole, ((-1.0, 1.0), (-1.0, 1.0)), &Request::default());
    assert!(matches!(refused, Err(CompileError::NotFinite { .. })), "{refused:?}");
}
