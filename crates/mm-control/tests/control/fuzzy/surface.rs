//! Tabulated surfaces against their engines, and by hand.

use super::inputs;
use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH, Surface};

#[test]
#[expect(clippy::float_cmp, reason = "oddness, zero and the clamped ends are exact")]
fn surface_stays_close_to_its_engine() {
    let engine = Curve::<f64>::try_new(&SMOOTH).unwrap();
    let surface = Surface::<f64, 65>::from_engine(&engine).unwrap();
    let mut worst = 0.0_f64;
    for x in inputs(1.1, 10_007) {
        let y = surface.evaluate(x);
        worst = worst.max((y - engine.evaluate(x)).abs());
        assert_eq!(surface.evaluate(-x), -y, "odd at {x}");
        assert!(y >= surface.min_output() && y <= surface.max_output(), "{y} within the bounds at {x}");
    }
    let bound = surface.slope_bound();
    assert!((bound - 1.7277).abs() < 1e-4, "slope bound {bound}");
    assert!(worst < 2e-3, "65 knots are off by {worst:e}");
    assert_eq!(surface.evaluate(0.0), 0.0, "zero at zero");
    assert_eq!(surface.evaluate(f64::NAN), 0.0, "NaN gives the middle of the output's range");
    assert_eq!(surface.evaluate(f64::INFINITY), surface.evaluate(1.0), "clamped above");
    assert_eq!(surface.max_output(), engine.evaluate(-1.0), "largest output at the end");
    assert_eq!(surface.min_output(), engine.evaluate(1.0), "smallest output at the end");
}

/// A system whose table can be worked out by hand.
struct Parabola;

impl FuzzySystem<f64> for Parabola {
    fn evaluate(&self, x: f64) -> f64 {
        if x.is_nan() { 7.0 } else { x * x }
    }
    fn input_range(&self) -> (f64, f64) {
        (1.0, 3.0)
    }
}

#[test]
#[expect(clippy::float_cmp, reason = "small whole numbers")]
fn surface_by_hand() {
    let surface = Surface::<f64, 3>::from_engine(&Parabola).unwrap();
    assert_eq!(surface.knots(), &[1.0, 4.0, 9.0], "squares of 1, 2, 3");
    assert_eq!((surface.evaluate(1.5), surface.evaluate(2.5)), (2.5, 6.5), "half way");
    assert_eq!((surface.evaluate(0.0), surface.evaluate(9.0)), (1.0, 9.0), "clamped");
    assert_eq!(surface.evaluate(f64::NAN), 7.0, "what the system gives for NaN");
    assert_eq!(surface.slope_bound(), 5.0, "from 4 to 9");
    assert_eq!((surface.min_output(), surface.max_output()), (1.0, 9.0), "bounds");
}
