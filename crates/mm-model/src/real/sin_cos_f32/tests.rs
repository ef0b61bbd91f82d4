//! Law: every finite angle gives its sine and cosine to [`BOUND`] ulp, with the symmetries of both.
//!
//! Reference: libm's `f64` sine and cosine, whose own error, below 1 ulp of `f64`, is 2^-29 ulp here. Without debug
//! assertions the test tries every finite non-negative angle, with them a sample. The symmetries are tried on a
//! sixteenth of the angles: the code sets the sign bit aside before it looks at the magnitude. To stay within a minute the full run reduces large angles by its own 128-bit arithmetic, which another
//! test holds against libm.

use super::{TWO_OVER_PI, sin_cos};

/// Largest error in units in the last place.
const BOUND: f64 = 0.84;

const TWO_POW_MINUS_64: f64 = 1.0 / (4_294_967_296.0 * 4_294_967_296.0);

const INFINITY_BITS: u32 = 0x7F80_0000;

/// Distance of `got` from `reference`, in ulp of `f32` at the reference.
fn ulps(got: f32, reference: f64) -> f64 {
    let exponent = ((reference.to_bits() >> 52) & 0x7FF).max(1023 - 126);
    let per_ulp = f64::from_bits((2 * 1023 + 23 - exponent) << 52);
    (f64::from(got) - reference).abs() * per_ulp
}

/// The reference, with what it remembers of the binade it is in.
#[derive(Default)]
struct Reference {
    quick: bool,
    exponent: u32,
    turns: u128,
}

impl Reference {
    fn sin_cos(&mut self, x: f32) -> (f64, f64) {
        let wide = f64::from(x);
        if self.quick && x < 1.0 / 8192.0 {
            let square = wide * wide;
            (wide - wide * square / 6.0, 1.0 - square / 2.0)
        } else if self.quick && x >= 2_097_152.0 {
            self.sin_cos_of_large(x)
        } else {
            libm::sincos(wide)
        }
    }

    /// Sine and cosine of a number of at least 2^21, from its fraction of a turn.
    #[expect(clippy::cast_sign_loss, reason = "each part fits")]
    fn sin_cos_of_large(&mut self, x: f32) -> (f64, f64) {
        let exponent = x.to_bits() >> 23;
        if exponent != self.exponent {
            self.exponent = exponent;
            self.turns = turns_of_power(exponent);
        }
        let turn = self.turns.wrapping_mul(u128::from((x.to_bits() & 0x7F_FFFF) | 0x80_0000));
        let quarter = turn.wrapping_add(1 << 125) >> 126;
        let rest = turn.wrapping_sub(quarter << 126).cast_signed();
        // Two halves, since the conversion of 128 bits at once is a slow one.
        let (upper, lower) = ((rest >> 64) as i64 as f64, (rest & 0xFFFF_FFFF_FFFF_FFFF) as u64 as f64);
        let (sin, cos) =
            libm::sincos((upper + lower * TWO_POW_MINUS_64) * TWO_POW_MINUS_64 * core::f64::consts::TAU);
        // Without branches: the quarter is as good as random, and a wrong guess costs more than the rest.
        let quarter = quarter as u64;
        let (sin, cos) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
        let (sin_sign, cos_sign) = ((quarter & 2) << 62, ((quarter + 1) & 2) << 62);
        (f64::from_bits(sin.to_bits() ^ sin_sign), f64::from_bits(cos.to_bits() ^ cos_sign))
    }
}

/// The last bit of a mantissa with this exponent field as a fraction of a turn, in 128 bits and modulo 1.
fn turns_of_power(exponent: u32) -> u128 {
    let start = exponent - 120;
    let word = |i: u32| TWO_OVER_PI.get(i as usize).map_or(0, |w| u128::from(*w));
    let (first, shift) = (start / 32, start % 32);
    let window = (0..4).fold(0, |bits, i| (bits << 32) | word(first + i));
    (window << shift) | ((word(first + 4) << shift) >> 32)
}

/// Largest errors of sine and cosine over the bit patterns `first, first + step, ..` of non-negative angles.
fn worst(first: u32, step: usize, quick: bool) -> (f64, f64) {
    let mut worst = (0.0_f64, 0.0_f64);
    let mut reference = Reference { quick, ..Reference::default() };
    for bits in (first..INFINITY_BITS).step_by(step) {
        let x = f32::from_bits(bits);
        let (sin, cos) = sin_cos(x);
        let (sin_ref, cos_ref) = reference.sin_cos(x);
        let errors = (ulps(sin, sin_ref), ulps(cos, cos_ref));
        assert!(errors.0 <= BOUND && errors.1 <= BOUND, "{x:e}: off by {errors:?} ulp, ({sin}, {cos})");
        worst = (worst.0.max(errors.0), worst.1.max(errors.1));
        if bits & 30 == 0 {
            let (odd, even) = sin_cos(-x);
            let mirrored = (odd.to_bits() ^ sin.to_bits() == super::SIGN) && even.to_bits() == cos.to_bits();
            assert!(mirrored, "{x:e}: not odd and even: ({odd}, {even}) against ({sin}, {cos})");
        }
    }
    worst
}

fn worst_of_two_threads(step: usize, quick: bool) -> (f64, f64) {
    let other = std::thread::spawn(move || worst(1, 2 * step, quick));
    let this = worst(0, 2 * step, quick);
    let other = other.join().expect("the other half must hold as well");
    (this.0.max(other.0), this.1.max(other.1))
}

#[test]
#[cfg(not(debug_assertions))]
fn every_finite_angle_is_within_the_bound() {
    let started = std::time::Instant::now();
    let worst = worst_of_two_threads(1, true);
    println!("largest errors {worst:?} ulp, {:?}", started.elapsed());
    assert!(worst.0.max(worst.1) > BOUND - 0.01, "the bound {BOUND} is too generous: {worst:?}");
}

#[test]
fn sampled_angles_are_within_the_bound() {
    let worst = worst_of_two_threads(1999, false);
    println!("largest sampled errors {worst:?} ulp");
}

#[test]
fn quick_reference_agrees_with_libm() {
    let mut quick = Reference { quick: true, ..Reference::default() };
    let mut plain = Reference::default();
    for bits in (1..INFINITY_BITS).step_by(19_997) {
        let x = f32::from_bits(bits);
        let (got, want) = (quick.sin_cos(x), plain.sin_cos(x));
        let near = |got: f64, want: f64| (got - want).abs() <= 1e-14 * want.abs();
        assert!(near(got.0, want.0) && near(got.1, want.1), "{x:e}: {got:?} against {want:?}");
    }
}

#[test]
fn special_angles() {
    let bits = |x: f32| (sin_cos(x).0.to_bits(), sin_cos(x).1.to_bits());
    assert_eq!(bits(0.0), (0.0_f32.to_bits(), 1.0_f32.to_bits()), "zero");
    assert_eq!(bits(-0.0), ((-0.0_f32).to_bits(), 1.0_f32.to_bits()), "the sine keeps the sign of zero");
    for x in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let (sin, cos) = sin_cos(x);
        assert!(sin.is_nan() && cos.is_nan(), "{x} gives ({sin}, {cos})");
    }
}
