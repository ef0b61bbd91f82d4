//! `mmsim fis compile`.

use super::{TIP, fis, rows, thesis};
use crate::common::command::Folder;
use mm_control::fuzzy::Defuzzifier;
use mm_control::fuzzy::fixed::Evaluate as _;
use mm_fis::compile::{CompiledSurface, Q15};

#[test]
fn compile_writes_what_the_library_makes() {
    let folder = Folder::new("fis-compile");
    for (file, part) in [
        ("table.rs", "pub const THESIS_SURFACE: Surface1<'static>"),
        ("table.h", "#ifndef THESIS_SURFACE_H"),
        ("table.c", "thesis_surface_evaluate"),
        ("table.toml", "knots = ["),
    ] {
        let run = fis(&folder, 0, &["compile", "thesis", "--bits", "16", "-o", file]);
        assert_eq!(run.stdout, "", "the result is in the file");
        for report in
            [file, "knots of 16 bits", "jump at `input1` = 0", "largest error", "over all 65,536 inputs"]
        {
            assert!(run.stderr.contains(report), "{report:?} in {}", run.stderr);
        }
        let text = std::fs::read_to_string(folder.path(file)).expect("the result");
        assert!(text.contains(part), "{part:?} in {file}:\n{text}");
        assert!(
            text.contains(&format!("Made again by: mmsim fis compile thesis --bits 16 -o {file}")),
            "{text}"
        );
        let again = fis(&folder, 0, &["compile", "thesis", "--quiet", "-o", file]);
        assert_eq!(
            (again.stderr.as_str(), std::fs::read_to_string(folder.path(file)).ok()),
            ("", Some(text)),
            "again"
        );
    }
    let text = std::fs::read_to_string(folder.path("table.toml")).expect("the table");
    let table = CompiledSurface::from_toml(&text).expect("what was written is read");
    let run = fis(&folder, 0, &["eval", "thesis", "--engine", "surface", "-1.4", "-0.3", "0", "0.3", "0.7"]);
    for row in rows(&run.stdout) {
        #[expect(clippy::cast_possible_truncation, reason = "within the range")]
        let q = (row[0] / 1.4 * 32768.0).round() as i16;
        let expected = f64::from(table.surface().evaluate(q)) / 32768.0;
        assert_eq!(row[1], expected, "the command's surface is the file's, at {}", row[0]);
        assert!((row[1] - thesis(Defuzzifier::Centroid, row[0])).abs() <= table.bound, "within the bound");
    }
    let run = fis(&folder, 0, &["compile", "thesis", "--to", "q15", "--lang", "toml"]);
    assert!(run.stderr.contains("units of the last place"), "{}", run.stderr);
    assert_eq!(Q15::from_toml(&run.stdout).expect("read back").inputs[0].len(), 8, "eight input terms");
    let run = fis(&folder, 0, &["compile", "thesis", "--to", "q15", "--name", "rules"]);
    assert!(run.stdout.contains("pub const RULES: Tables<'static>"), "{}", run.stdout);
}

#[test]
fn compile_and_the_engines_of_two_inputs() {
    let folder = Folder::new("fis-compile-2");
    folder.write("tip.fis", TIP);
    let coarse = ["--bound", "0.5", "--input-bits", "8"];
    let run = fis(&folder, 0, &[&["compile", "tip.fis", "-o", "tip.h"], coarse.as_slice()].concat());
    assert!(run.stderr.contains("inputs of 8 bits"), "{}", run.stderr);
    assert!(std::fs::read_to_string(folder.path("tip.h")).expect("it").contains("tip_surface_evaluate"), "C");
    let exact = rows(&fis(&folder, 0, &["eval", "tip.fis", "3", "8"]).stdout)[0][2];
    let of =
        |args: &[&str]| rows(&fis(&folder, 0, &[&["eval", "tip.fis", "3", "8"], args].concat()).stdout)[0][2];
    let surface = of(&[&["--engine", "surface"], coarse.as_slice()].concat());
    assert!(
        (surface - exact).abs() < 0.6 && (surface - exact).abs() > 0.0,
        "the table's {surface}, exactly {exact}"
    );
    let rules = of(&["--engine", "q15"]);
    assert!(
        (rules - exact).abs() < 0.01 && (rules - exact).abs() > 0.0,
        "fixed point {rules}, exactly {exact}"
    );
    let run = fis(&folder, 2, &["compile", "tip.fis", "--bound", "1e-6", "--input-bits", "8"]);
    assert!(run.stderr.contains("ask for less (--bound"), "{}", run.stderr);
    let two =
        TIP.replace("[Rules]", "[Output2]\nName='smile'\nRange=[0 1]\nMF1='wide':'trimf',[0 0.5 1]\n[Rules]");
    let two = two.replace(", 1 (", ", 1 1 (").replace(", 2 (", ", 2 0 (").replace(", 3 (", ", 3 0 (");
    folder.write("two.fis", &two);
    let run = fis(&folder, 2, &["compile", "two.fis"]);
    assert!(run.stderr.contains("choose with --which: 1 `tip`, 2 `smile`"), "{}", run.stderr);
    for which in ["2", "smile"] {
        let run = fis(&folder, 0, &["compile", "two.fis", "--which", which, "--input-bits", "8"]);
        assert!(run.stderr.contains("surface of output `smile`"), "{}", run.stderr);
    }
    fis(&folder, 2, &["compile", "two.fis", "--which", "3"]);
}

#[test]
fn compile_refuses_what_it_cannot_write() {
    let folder = Folder::new("fis-compile-bad");
    for (args, code, part) in [
        (&["thesis", "-o", "table.txt"] as &[&str], 2, "expected .rs, .h, .c or .toml, or --lang"),
        (&["thesis", "--to", "q15", "-o", "table.c"], 2, "for C, compile a surface"),
        (&["thesis", "--bits", "17"], 2, "17"),
        (&["thesis", "--bound", "0"], 2, "expected a number above 0"),
        (
            &["thesis", "--bound", "-1"],
            2,
            "invalid value '-1' for '--bound <ERROR>': expected a number above 0",
        ),
        (
            &["thesis", "-o", "table.h", "--lang", "rust"],
            2,
            "--lang rust contradicts the ending of table.h: expected .rs",
        ),
        (&["thesis", "-o", "no/such/folder.rs"], 1, "cannot write no/such/folder.rs"),
    ] {
        let run = fis(&folder, code, &[&["compile"], args].concat());
        assert!(run.stderr.contains(part) && run.stdout.is_empty(), "{part:?} in {}", run.stderr);
    }
    let left = std::fs::read_dir(folder.path("")).expect("the folder").count();
    assert_eq!(left, 0, "nothing is left behind");
}
