//! What the compiler writes: Rust, C and TOML.
//!
//! Laws: the constants committed in mm-control are, byte for byte, what the compiler makes of the shipped systems (MMSIM_BLESS=1 writes them anew);
//! the C function gives the same bits as the evaluation in Rust at all 65,536 inputs, from a compiler that is told to warn of everything;
//! a TOML file reads back to what was written. No tolerance: all of it is exact.
#![expect(clippy::expect_used, reason = "helpers outside of test functions")]

use std::path::PathBuf;
use std::process::Command;

use crate::compile_support::{random, smooth, thesis};
use mm_control::fuzzy::fixed::{Engine, Evaluate};
use mm_fis::compile::{CompileError, CompiledSurface, Origin, Q15, Request};
use mm_fis::{Accuracy, System};

const AGAIN: &str = "MMSIM_BLESS=1 cargo test -p mm-fis --test fis compile_emit";

fn surface(system: &System, request: &Request) -> CompiledSurface {
    let compile = |engine: &mm_fis::Engine<'_>| {
        let f = |x: f64| {
            let (mut y, mut workspace) = ([0.0], vec![0.0; engine.workspace_len()]);
            let _met = engine.infer(&[x], &mut y, &mut workspace).expect("lengths fit");
            y[0]
        };
        CompiledSurface::compile(&system.name, &f, (system.inputs[0].range, system.outputs[0].range), request)
    };
    system.with_engine(Accuracy::Exact, compile).expect("a proper system").expect("within the bound")
}

#[test]
fn committed_constants_are_what_the_compiler_makes() {
    for system in [thesis(), smooth()] {
        let upper = system.name.to_uppercase();
        let table = surface(&system, &Request::default());
        let rules = Q15::compile(&system).expect("shipped");
        let (table_name, rules_name) = (format!("{upper}_SURFACE"), format!("{upper}_Q15"));
        let made = [
            (
                table.to_rust(&Origin { name: &table_name, command: AGAIN }, "crate"),
                table_name.to_lowercase(),
            ),
            (
                rules.to_rust(&Origin { name: &rules_name, command: AGAIN }, "crate"),
                rules_name.to_lowercase(),
            ),
        ];
        for (text, file) in made {
            let directory = "../mm-control/src/fuzzy/fixed/bundled";
            let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(directory).join(format!("{file}.rs"));
            if std::env::var_os("MMSIM_BLESS").is_some() {
                std::fs::create_dir_all(path.parent().expect("a directory")).expect("made");
                std::fs::write(&path, &text).expect("written");
            }
            let committed = std::fs::read_to_string(&path).expect("committed").replace("\r\n", "\n");
            assert!(committed == text, "{} is not what the compiler makes now: {AGAIN}", path.display());
        }
    }
}

/// The surfaces for which C is compiled: odd and not, one section and many, the largest steps and the smallest.
fn surfaces() -> Vec<CompiledSurface> {
    let coarse = Request { bits: 10, bound: Some(0.01), ..Request::default() };
    let stairs = |x: f64| (5.0 * x).floor() / 4.0 + 0.1 * x;
    let ends = |x: f64| if x < 0.3 { 1.0 } else { -1.0 };
    let odd_ends = |x: f64| if x == 0.0 { 0.0 } else { -x.signum() };
    let line = |x: f64| x;
    let ranges = ((-1.0, 1.0), (-1.0, 1.0));
    let compile = |name: &str, f: &dyn Fn(f64) -> f64| {
        CompiledSurface::compile(name, f, ranges, &Request::default()).expect("within the bound")
    };
    vec![
        surface(&thesis(), &Request::default()),
        surface(&smooth(), &coarse),
        surface(&random(0, 1, 1), &Request::default()),
        compile("stairs", &stairs),
        compile("ends", &ends),
        compile("odd ends */ of a name", &odd_ends),
        compile("line", &line),
    ]
}

#[test]
fn the_c_function_gives_the_same_bits() {
    let cc = ["cc", "gcc", "clang"].into_iter().find(|cc| Command::new(cc).arg("--version").output().is_ok());
    let cc = cc.expect("a C compiler: cc, gcc or clang");
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let surfaces = surfaces();
    let mut program = "#include <stdio.h>\n".to_owned();
    let mut calls = String::new();
    for (number, surface) in surfaces.iter().enumerate() {
        let name = format!("table_{number}");
        let header = surface.to_c(&Origin { name: &name, command: AGAIN });
        std::fs::write(directory.join(format!("{name}.h")), header).expect("written");
        program += &format!("#include \"{name}.h\"\n");
        calls += &format!(
            "    for (q = -32768; q <= 32767; q++) {{ printf(\"%d\\n\", {name}_evaluate((int16_t)q)); }}\n"
        );
    }
    program += &format!("int main(void)\n{{\n    long q;\n{calls}    return 0;\n}}\n");
    let (source, binary) = (directory.join("tables.c"), directory.join("tables"));
    std::fs::write(&source, program).expect("written");
    let flags = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-O1", "-o"];
    let built = Command::new(cc).args(flags).args([&binary, &source]).output().expect("the compiler runs");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(&binary).output().expect("the program runs");
    let text = String::from_utf8(ran.stdout).expect("numbers");
    let mut lines = text.lines().map(|line| line.parse::<i16>().expect("a number"));
    for surface in &surfaces {
        for q in i16::MIN..=i16::MAX {
            assert_eq!(lines.next(), Some(surface.surface().evaluate(q)), "{} at {q}", surface.name);
        }
    }
    assert_eq!(lines.next(), None, "nothing more");
}

#[test]
fn toml_reads_back_to_what_was_written() {
    let origin = Origin { name: "x", command: "mmsim fis compile\nfirst" };
    for surface in surfaces() {
        let text = surface.to_toml(&origin);
        assert_eq!(CompiledSurface::from_toml(&text), Ok(surface), "{text}");
    }
    let mut strange = random(7, 2, 2);
    strange.name = "a \"name\"\nof two lines".to_owned();
    for system in [thesis(), smooth(), random(1, 1, 1), random(5, 1, 1), random(3, 3, 2), strange] {
        let q15 = Q15::compile(&system).expect("of the kinds it takes");
        let text = q15.to_toml(&origin);
        let read = Q15::from_toml(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(read, q15, "{text}");
        read.with_tables(|tables| assert!(Engine::try_new(tables).is_ok(), "{}", system.name));
    }
}

#[test]
fn broken_toml_is_refused_with_a_reason() {
    let origin = Origin { name: "x", command: "none" };
    let text = surface(&smooth(), &Request::default()).to_toml(&origin);
    let broken = [
        (text.replace("surface1", "surface9"), "expected \"surface1\""),
        (text.replace("odd = true", "odd = 3"), "line"),
        (text.replace("start = ", "beginning = "), "unknown field `beginning`"),
        (text.replace("shift = ", "shift = 1"), "do not find their knots"),
        (text.replace("knots = [", "knots = [ 40000,"), "i16"),
    ];
    for (text, reason) in broken {
        let Err(CompileError::Read(message)) = CompiledSurface::from_toml(&text) else {
            panic!("{reason}: read")
        };
        assert!(message.contains(reason), "{message} does not say {reason}");
    }
    let text = Q15::compile(&thesis()).expect("shipped").to_toml(&origin);
    let broken = [
        ("slots = [3]", "slots = [99]", "rules.slots"),
        ("\"min\"", "\"least\"", "\"prod\""),
        ("scale = ", "scale = 1", "outputs.scale"),
    ];
    for (from, to, reason) in broken {
        let message = Q15::from_toml(&text.replace(from, to)).expect_err(reason).to_string();
        assert!(message.contains(reason), "{message} does not say {reason}");
    }
}
