//! Conversions and elementary functions; see the parent for the laws.

use super::{Q32, Random, Real, extremes};

const UNIT: f64 = 1.0 / 4_294_967_296.0;

/// The largest error over some numbers, in units of 2^-32, of which `allowed` may depend on the result.
fn check(
    name: &str,
    inputs: impl Iterator<Item = Q32>,
    ours: impl Fn(Q32) -> Q32,
    exact: impl Fn(f64) -> f64,
    allowed: impl Fn(f64) -> f64,
) {
    let mut worst: f64 = 0.0;
    for x in inputs {
        let (y, reference) = (ours(x).to_f64(), exact(x.to_f64()));
        let error = (y - reference).abs() / UNIT;
        assert!(error <= allowed(reference), "{name} of {x}: {y} for {reference}, {error} units");
        worst = worst.max(error / allowed(reference));
    }
    println!("{name}: {worst:.3} of what is allowed");
}

/// Numbers of every magnitude up to `most`, and a fine grid around zero.
fn numbers(most: f64, count: usize) -> impl Iterator<Item = Q32> {
    let mut random = Random(6);
    let drawn = core::iter::repeat_with(move || random.number())
        .filter(move |q| q.to_f64().abs() <= most)
        .take(count);
    let grid = (-20_000..=20_000_i32).map(move |k| Q32::from_f64(most.min(8.0) * f64::from(k) / 20_000.0));
    drawn.chain(grid)
}

#[test]
fn double_precision_comes_and_goes() {
    let mut random = Random(7);
    for q in extremes().chain(core::iter::repeat_with(|| random.number()).take(100_000)) {
        // The conversion of integers, which rounds to the nearest even, and an exact scale.
        #[expect(clippy::cast_precision_loss, reason = "rounding to the nearest is the reference")]
        let expected = q.raw as f64 * UNIT;
        assert_eq!(q.to_f64().to_bits(), expected.to_bits(), "{}", q.raw);
        if q.raw.unsigned_abs() < 1 << 53 {
            assert_eq!(Q32::from_f64(expected).raw, q.raw);
        }
    }
    for _ in 0..200_000 {
        let value = f64::from_bits(random.word());
        let scaled = (value / UNIT).round_ties_even();
        let expected = if value.is_nan() {
            f64::NAN
        } else if scaled >= 2.0_f64.powi(60) {
            f64::INFINITY
        } else if scaled < -(2.0_f64.powi(60)) {
            f64::NEG_INFINITY
        } else {
            scaled * UNIT + 0.0
        };
        let ours = Q32::from_f64(value).to_f64();
        assert!(
            ours.to_bits() == expected.to_bits() || (ours.is_nan() && expected.is_nan()),
            "{value:e}: {ours} for {expected}"
        );
    }
    for value in [2.0_f64.powi(28), -(2.0_f64.powi(28)), 2.0_f64.powi(28) * (1.0 - f64::EPSILON)] {
        let finite = value < 0.0 || value < 2.0_f64.powi(28);
        assert_eq!(Q32::from_f64(value).is_finite(), finite, "{value}");
    }
}

#[test]
fn sine_and_cosine() {
    check("sin", numbers(1048576.0, 400_000), |x| x.sin_cos().0, libm::sin, |_| 1.5);
    check("cos", numbers(1048576.0, 400_000), |x| x.sin_cos().1, libm::cos, |_| 1.5);
    // Beyond 2^21 the reference does not hold the angle exactly any more; only those that it does.
    let far = || numbers(3e8, 100_000).map(|q| Q32::from_f64(q.to_f64()));
    check("sin, far", far(), |x| x.sin_cos().0, libm::sin, |_| 3.5);
    check("cos, far", far(), |x| x.sin_cos().1, libm::cos, |_| 3.5);
}

/// sin^2 + cos^2 = 1 to the errors of both, and nothing above 1.
#[test]
fn sine_and_cosine_lie_on_the_circle() {
    for x in numbers(1048576.0, 100_000) {
        let (sin, cos) = x.sin_cos();
        assert!(sin.abs() <= Q32::ONE && cos.abs() <= Q32::ONE, "{x}");
        let (sin, cos) = (sin.to_f64(), cos.to_f64());
        assert!((sin * sin + cos * cos - 1.0).abs() <= 2.0 * 1.5 * 1.5 * UNIT, "{x}");
        let (odd, even) = (-x).sin_cos();
        assert!(odd == -x.sin_cos().0 && even == x.sin_cos().1, "{x}");
    }
}

#[test]
fn the_remainder_of_turns() {
    let exact =
        |x: f64| x - core::f64::consts::TAU * ((x + core::f64::consts::PI) / core::f64::consts::TAU).floor();
    for x in numbers(1048576.0, 200_000) {
        let (ours, reference) = (x.wrap_to_pi(), exact(x.to_f64()));
        let apart = (ours.to_f64() - reference).abs();
        // At the seam either side is right.
        let apart = apart.min(core::f64::consts::TAU - apart);
        // The reference rounds turns of 2^20 rad to 2^-33.
        assert!(apart <= 1.5 * UNIT, "{x}: {ours} for {reference}");
        assert!(ours >= -Q32::PI && ours < Q32::PI, "{x}: {ours}");
    }
}

#[test]
fn inverse_circular_functions() {
    let mut random = Random(8);
    for _ in 0..200_000 {
        let (y, x) = (random.number(), random.number());
        let (ours, exact) = (y.atan2(x).to_f64(), libm::atan2(y.to_f64(), x.to_f64()));
        assert!((ours - exact).abs() <= 6.0 * UNIT, "atan2({y}, {x}): {ours} for {exact}");
    }
    check("acos", numbers(1.0, 200_000), Real::acos, libm::acos, |_| 12.0);
    let outside = [Q32::ONE + Q32::EPSILON, -Q32::ONE - Q32::EPSILON];
    assert!(outside.iter().all(|x| x.acos().is_nan()), "acos outside [-1, 1]");
}

#[test]
fn exponential_and_power() {
    let most = 2.0_f64.powi(28);
    check("exp", numbers(19.4, 200_000), Real::exp, libm::exp, |y| 4.0 + 4.0 * y);
    for x in [19.5, 25.0, 1e8] {
        assert_eq!(Q32::from_f64(x).exp(), Q32::INFINITY, "exp({x})");
        assert_eq!(Q32::from_f64(-x - 4.0).exp(), Q32::ZERO, "exp(-{x})");
    }
    assert_eq!(Q32::NEG_INFINITY.exp(), Q32::ZERO);
    let mut random = Random(9);
    for _ in 0..200_000 {
        let (x, y) = (random.number(), random.number());
        if y.abs() > Q32::from_u32(40) {
            continue;
        }
        let exact = libm::pow(x.to_f64(), y.to_f64());
        let ours = x.powf(y).to_f64();
        if exact.is_nan() || exact.abs() > most / 2.0 {
            assert!(exact.is_nan() == ours.is_nan(), "{x}^{y}: {ours} for {exact}");
            continue;
        }
        // The error of the logarithm, times the exponent, times the power.
        let allowed = 8.0 + 8.0 * exact.abs() * (1.0 + y.to_f64().abs());
        if y.floor() != y {
            assert!((ours - exact).abs() / UNIT <= allowed, "{x}^{y}: {ours} for {exact}");
        }
    }
    for n in 0..=64_u32 {
        for k in -64..=64_i32 {
            let base = f64::from(k) / 64.0;
            let (ours, exact) =
                (Q32::from_f64(base).powf(Q32::from_u32(n)).to_f64(), libm::pow(base, f64::from(n)));
            assert!((ours - exact).abs() <= f64::from(n) * UNIT, "{base}^{n}: {ours} for {exact}");
        }
    }
}

#[test]
fn whole_part_and_rest() {
    for q in extremes() {
        let exact = i128::from(q.raw) >> 32;
        assert_eq!(i128::from(q.floor().raw), exact << 32, "{q}");
        if q.raw >= 0 {
            let (whole, rest) = q.split_index();
            assert_eq!(
                (whole as i128, i128::from(rest.raw)),
                (exact, i128::from(q.raw) & 0xFFFF_FFFF),
                "{q}"
            );
        }
    }
    assert_eq!(Q32::from_f64(-1.5).split_index(), (0, Q32::from_f64(-1.5)));
    assert_eq!(Q32::INFINITY.split_index().0, usize::MAX);
    assert_eq!(Q32::NAN.split_index().0, 0);
}
