//! Law: the committed knots of the default fuzzy surface are, bit for bit, what tabulating the smooth rule base gives, in both precisions.
//!
//! Why: firmware that uses the table shall not link the rule engine to make it, and still compute the same bits as who does.
//! `MMSIM_BLESS=1` writes them anew. No tolerance: all of it is exact.
#![expect(clippy::expect_used, reason = "helpers outside of test functions")]

use std::fmt::{Debug, Write};
use std::path::PathBuf;

use mm_control::fuzzy::{Bundled, Curve, FuzzySystem, Surface};

const AGAIN: &str = "MMSIM_BLESS=1 cargo test -p mm-control --test control smooth_knots";

fn tabulated<T: Bundled>() -> Surface<T, 65> {
    let curve = Curve::<T>::try_new(T::SMOOTH).expect("the tables are proper");
    Surface::from_engine(&curve).expect("the system is proper")
}

/// The knots as a constant, in shortest digits that give the same bits.
fn constant<T: Bundled + Debug>(name: &str, scalar: &str) -> String {
    let surface = tabulated::<T>();
    let mut text = format!("pub(super) const {name}: [{scalar}; 65] = [\n");
    for row in surface.knots().chunks(5) {
        let row: Vec<String> = row.iter().map(|knot| format!("{knot:?}")).collect();
        writeln!(text, "    {},", row.join(", ")).expect("a string takes it");
    }
    text + "];\n"
}

#[test]
fn committed_knots_are_what_the_rules_give() {
    let text = format!(
        "//! The smooth rule base tabulated at 65 equally spaced inputs from -1 to 1; generated, not to be edited.\n\
         //!\n//! Made again by: {AGAIN}\n\n/// Knots in double precision.\n#[rustfmt::skip]\n{}\n/// Knots in single precision.\n\
         #[rustfmt::skip]\n{}",
        constant::<f64>("SMOOTH_KNOTS", "f64"),
        constant::<f32>("SMOOTH_KNOTS_F32", "f32"),
    );
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src/fuzzy/smooth_knots.rs");
    if std::env::var_os("MMSIM_BLESS").is_some() {
        std::fs::write(&path, &text).expect("written");
    }
    let committed = std::fs::read_to_string(&path).expect("committed").replace("\r\n", "\n");
    assert!(committed == text, "smooth_knots.rs is not what the rules give now: {AGAIN}");
}

/// Same knots, same constants, same answers, a NaN among the inputs.
fn compare<T: Bundled>() {
    let from_rules = tabulated::<T>();
    let from_knots = Surface::from_knots(T::SMOOTH_KNOTS, from_rules.input_range()).expect("proper knots");
    assert_eq!(from_knots, from_rules, "a table of the committed knots");
    let nan = T::from_f64(f64::NAN);
    assert_eq!(from_knots.evaluate(nan), from_rules.evaluate(nan), "at NaN");
}

#[test]
fn a_surface_of_the_knots_is_the_surface_of_the_rules() {
    compare::<f64>();
    compare::<f32>();
}

#[test]
fn improper_knots_are_refused() {
    let mut knots = *f64::SMOOTH_KNOTS;
    knots[7] = f64::INFINITY;
    assert!(Surface::from_knots(&knots, (-1.0, 1.0)).is_err(), "an infinite knot");
    assert!(Surface::from_knots(f64::SMOOTH_KNOTS, (1.0, -1.0)).is_err(), "a range upside down");
    assert!(Surface::from_knots(f64::SMOOTH_KNOTS, (-1.0, f64::NAN)).is_err(), "a range that is none");
    assert!(Surface::from_knots(&[0.0, 1.0], (-1.0, 1.0)).is_err(), "no middle knot");
}
