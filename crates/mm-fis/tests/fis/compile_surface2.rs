//! Compiled surfaces of two inputs against the functions they were made from.
//!
//! Law: at every pair of inputs, rounded to the bits asked for, the surface is within the bound of the function at the rounded point; an odd function gives
//! an exactly odd table; C gives the same bits as Rust. Reference: the function in f64, called anew at all (2^bits + 1)^2 points. Tolerance:
//! the bound, times 1 + 1e-9 for the rounding of the comparison.
#![expect(clippy::expect_used, reason = "helpers outside of test functions")]
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "numbers small by construction"
)]

use std::path::PathBuf;
use std::process::Command;

use crate::compile_support::{Random, random};
use mm_fis::Accuracy;
use mm_fis::compile::{CompileError, CompiledSurface2, Origin, Request};

type Function<'a> = dyn Fn(&[f64]) -> f64 + Sync + 'a;

const SQUARE: ([(f64, f64); 2], (f64, f64)) = ([(-1.0, 1.0), (-1.0, 1.0)], (-1.0, 1.0));

fn bits(input_bits: u32) -> Request {
    Request { input_bits, ..Request::default() }
}

fn verify(compiled: &CompiledSurface2, f: &Function<'_>) {
    let surface = compiled.surface();
    assert!(surface.check(), "{}", compiled.name);
    let points = 1 << compiled.input_bits;
    let at = |(lo, hi): (f64, f64), share: f64| 0.5 * (lo + hi) + 0.5 * (hi - lo) * share;
    let share = |index: i32| 2.0 * f64::from(index) / f64::from(points) - 1.0;
    let input = |index: i32| (index * (65536 / points) - 32768).min(32767) as i16;
    let mut worst = 0.0_f64;
    for i in 0..=points {
        for j in 0..=points {
            let x = [at(compiled.input_ranges[0], share(i)), at(compiled.input_ranges[1], share(j))];
            let y = at(compiled.output_range, f64::from(surface.evaluate(input(i), input(j))) / 32768.0);
            worst = worst.max((y - f(&x)).abs());
        }
    }
    println!(
        "{}: {} knots, odd {}, {worst:.3e} of {:.3e}",
        compiled.name,
        compiled.knots.len(),
        compiled.odd,
        compiled.bound
    );
    assert!(worst <= compiled.bound * (1.0 + 1e-9), "{}: {worst} exceeds {}", compiled.name, compiled.bound);
    assert!((worst - compiled.error).abs() <= 1e-9, "{}: the report says {}", compiled.name, compiled.error);
}

fn examples() -> Vec<CompiledSurface2> {
    let functions: [(&str, &Function<'_>, u32); 4] = [
        ("plane", &|x: &[f64]| 0.3 * x[0] - 0.6 * x[1], 8),
        ("bowl", &|x: &[f64]| 0.4 * x[0] * x[0] + 0.5 * x[1] * x[1] - 0.2, 9),
        ("odd", &|x: &[f64]| 0.7 * x[0] * (1.0 + x[1] * x[1]) / 2.0 - 0.3 * x[1], 8),
        ("beyond", &|x: &[f64]| 2.0 + x[0] * x[1], 8),
    ];
    let compile = |(name, f, input_bits): (&str, &Function<'_>, u32)| {
        let compiled = CompiledSurface2::compile(name, f, SQUARE, &bits(input_bits)).expect(name);
        verify(&compiled, f);
        compiled
    };
    functions.into_iter().map(compile).collect()
}

#[test]
fn functions_within_the_bound_at_every_point() {
    let compiled = examples();
    let sizes: Vec<usize> = compiled.iter().map(|compiled| compiled.knots.len()).collect();
    assert_eq!(sizes[0], 4, "a plane needs its corners alone: {sizes:?}");
    assert!(sizes.iter().all(|&size| size <= 33 * 33), "{sizes:?}");
    assert_eq!(compiled[3].output_range, (-3.0, 3.0), "widened");
    let odd = compiled[2].surface();
    assert!(compiled[2].odd, "found to be odd");
    let mut random = Random::new(3);
    for _ in 0..100_000 {
        let [p, r] = [0, 1].map(|_| (random.below(256) as i32 - 128) * 256);
        let [a, b] = [p, r].map(|q| q.clamp(-32512, 32512) as i16);
        assert_eq!(odd.evaluate(-a, -b), -odd.evaluate(a, b), "at {a}, {b}");
    }
    assert_eq!(odd.evaluate(0, 0), 0, "the middle");
}

#[test]
fn a_fuzzy_system_of_two_inputs() {
    // Systems with narrow terms jump, and a surface that jumps is refused; the second one does not.
    let mut done = 0;
    for seed in 100..103 {
        let system = random(seed, 2, 1);
        let ranges = ([system.inputs[0].range, system.inputs[1].range], system.outputs[0].range);
        let request = Request { bound: Some(0.02 * (ranges.1.1 - ranges.1.0)), ..bits(8) };
        let outcome = system.with_function(Accuracy::Exact, 0, |f| {
            let compiled = CompiledSurface2::compile(&system.name, f, ranges, &request)?;
            verify(&compiled, f);
            Ok::<_, CompileError>(())
        });
        match outcome.expect("a proper system") {
            Ok(()) => done += 1,
            Err(CompileError::Bound { reachable, .. }) => println!("{}: jumps, {reachable:.3e}", system.name),
            Err(other) => panic!("{other}"),
        }
    }
    assert!(done >= 1, "none was smooth enough");
}

#[test]
fn what_cannot_be_met_is_refused() {
    let jump = |x: &[f64]| if x[0] + x[1] > 0.1 { 0.5 } else { -0.5 };
    let request = Request { bound: Some(0.01), ..bits(8) };
    let refused = CompiledSurface2::compile("jump", &jump, SQUARE, &request);
    assert!(matches!(refused, Err(CompileError::Bound { .. })), "{refused:?}");
    let hole = |x: &[f64]| if x[0] > 0.5 { f64::INFINITY } else { x[1] };
    let refused = CompiledSurface2::compile("hole", &hole, SQUARE, &bits(8));
    assert!(matches!(refused, Err(CompileError::NotFinite { .. })), "{refused:?}");
    let refused = CompiledSurface2::compile("plane", &|x| x[0], SQUARE, &bits(13));
    assert!(matches!(refused, Err(CompileError::Request { name: "input_bits", .. })), "{refused:?}");
}

#[test]
fn the_bound_in_a_refusal_is_met_and_without_one_there_is_a_table() {
    for file in ["tipper", "pendulum", "fan"] {
        let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("tests/systems/{file}.fis"));
        let text = std::fs::read_to_string(path).expect("a file of the tests");
        let system = mm_fis::read(file, &text).expect("a proper file").system;
        let ranges = ([system.inputs[0].range, system.inputs[1].range], system.outputs[0].range);
        let half = 0.5 * (ranges.1.1 - ranges.1.0);
        let accuracy = Accuracy::Sampled(mm_control::fuzzy::Sampling::Ends(101));
        let work = |f: &Function<'_>| {
            let compile = |bound| {
                let request = Request { bound, max_knots: 300, ..bits(8) };
                CompiledSurface2::compile(file, f, ranges, &request)
            };
            let refused = compile(Some(1e-3 * half));
            let Err(CompileError::Bound { reachable, .. }) = refused else { panic!("{file}: {refused:?}") };
            verify(&compile(Some(reachable)).expect("the refusal says so"), f);
            verify(&compile(None).expect("a bound is found"), f);
        };
        system.with_function(accuracy, 0, work).expect("a proper system");
    }
    let few = Request { max_knots: 3, ..bits(8) };
    let refused = CompiledSurface2::compile("plane", &|x| x[0], SQUARE, &few);
    assert_eq!(refused, Err(CompileError::Knots { max_knots: 3, least: 4 }));
}

fn origin(name: &str) -> Origin<'_> {
    Origin { name, command: "cargo test" }
}

#[test]
fn c_and_toml_say_the_same() {
    let examples = examples();
    for surface in &examples {
        let text = surface.to_toml(&origin("x"));
        assert_eq!(CompiledSurface2::from_toml(&text).as_ref(), Ok(surface), "{}", surface.name);
        let short = text.replacen("    ", "    7, ", 1);
        assert!(CompiledSurface2::from_toml(&short).is_err(), "one knot more");
        assert!(
            surface.to_rust(&origin("x"), "mm_control").contains("pub const X: Surface2"),
            "{}",
            surface.name
        );
    }
    let cc = ["cc", "gcc", "clang"].into_iter().find(|cc| Command::new(cc).arg("--version").output().is_ok());
    let cc = cc.expect("a C compiler: cc, gcc or clang");
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let (mut program, mut calls) = ("#include <stdio.h>\n".to_owned(), String::new());
    for (number, surface) in examples.iter().enumerate() {
        let name = format!("plane_{number}");
        std::fs::write(directory.join(format!("{name}.h")), surface.to_c(&origin(&name))).expect("written");
        program += &format!("#include \"{name}.h\"\n");
        calls += &format!(
            "    for (a = -32768; a <= 32767; a += 163) for (b = -32768; b <= 32767; b += 211)\n        \
             printf(\"%d\\n\", {name}_evaluate((int16_t)a, (int16_t)b));\n"
        );
    }
    program += &format!("int main(void)\n{{\n    long a, b;\n{calls}    return 0;\n}}\n");
    let (source, binary) = (directory.join("planes.c"), directory.join("planes"));
    std::fs::write(&source, program).expect("written");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-O1", "-o"];
    let built = Command::new(cc).args(flags).args([&binary, &source]).output().expect("the compiler runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(&binary).output().expect("the program runs");
    let text = String::from_utf8(ran.stdout).expect("numbers");
    let mut lines = text.lines().map(|line| line.parse::<i16>().expect("a number"));
    for surface in &examples {
        for a in (i16::MIN..=i16::MAX).step_by(163) {
            for b in (i16::MIN..=i16::MAX).step_by(211) {
                assert_eq!(
                    lines.next(),
                    Some(surface.surface().evaluate(a, b)),
                    "{} at {a}, {b}",
                    surface.name
                );
            }
        }
    }
}
