//! Sine and cosine in single precision without any double-precision operation.
//!
//! The angle is brought to `x = n pi/2 + y` with `|y| <= pi/4`, `y` as a sum of two numbers; two polynomials give
//! `sin y` and `cos y`, and `n mod 4` says which is which. Up to [`MODERATE`] the reduction subtracts `n` times a
//! `pi/2` split in three (Cody and Waite), beyond it multiplies the mantissa by the relevant 96 bits of `2/pi` in
//! integers (Payne and Hanek).

/// Largest angle for the reduction by subtraction: up to here `n < 128` has 7 bits.
const MODERATE: f32 = 199.0;

/// Below this angle, 2^-12, the angle and 1 are the sine and cosine to within 0.5 ulp.
const TINY: f32 = 1.0 / 4096.0;

/// `pi/2` in three parts: 12 and 17 bits, whose products with `n` are exact, and the rest to 2^-63.
const HALF_PI_HIGH: f32 = 1.570_800_8;
const HALF_PI_MIDDLE: f32 = -4.454_457_7e-6;
const HALF_PI_LOW: f32 = 2.563_344e-12;

/// 32 zeros and the first 224 bits of `2/pi` after the binary point.
const TWO_OVER_PI: [u32; 8] =
    [0, 0xA2F9_836E, 0x4E44_1529, 0xFC27_57D1, 0xF534_DDC0, 0xDB62_9599, 0x3C43_9041, 0xFE51_63AB];

const TWO_POW_MINUS_24: f32 = 1.0 / 16_777_216.0;

/// `pi/2` times 2^31.
const HALF_PI_Q31: u64 = 0xC90F_DAA2;

const SIGN: u32 = 0x8000_0000;

/// An angle less a multiple of a quarter turn: `quarter pi/2 + high + low`, where `low` is below an ulp of `high`.
struct Reduced {
    quarter: u32,
    high: f32,
    low: f32,
}

/// Sine and cosine of an angle in radians.
///
/// Error: at most 0.84 ulp for every finite angle, which the tests prove by trying all of them. The sine is exactly
/// odd, with `sin(-0) = -0`, the cosine exactly even. An infinite or NaN angle gives two NaN.
///
/// Cost: about twice as much beyond 199 rad as up to there; single-precision and integer operations only, none of them
/// fused.
///
/// # Source
/// W. J. Cody, W. Waite, Software Manual for the Elementary Functions, 1980; M. H. Payne, R. N. Hanek, Radian
/// reduction for trigonometric functions, SIGNUM Newsletter 18(1), 1983. Polynomials: minimax, fitted for this
/// function with each coefficient rounded in turn.
pub(super) fn sin_cos(x: f32) -> (f32, f32) {
    let sign = x.to_bits() & SIGN;
    let magnitude = f32::from_bits(x.to_bits() & !SIGN);
    if magnitude < TINY {
        return (x, 1.0);
    }
    if magnitude <= MODERATE { turned(sign, &reduce_moderate(magnitude)) } else { beyond(sign, magnitude) }
}

/// Sine and cosine beyond [`MODERATE`], apart so that the usual way needs no stack.
#[cold]
#[inline(never)]
fn beyond(sign: u32, magnitude: f32) -> (f32, f32) {
    if magnitude.is_finite() { turned(sign, &reduce_large(magnitude)) } else { (f32::NAN, f32::NAN) }
}

/// Sine and cosine of a reduced angle of that sign.
#[inline(always)]
fn turned(sign: u32, reduced: &Reduced) -> (f32, f32) {
    let (sin, cos) = (sin_kernel(reduced), cos_kernel(reduced));
    let (sin, cos) = if reduced.quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sin_sign = sign ^ ((reduced.quarter & 2) << 30);
    let cos_sign = (reduced.quarter.wrapping_add(1) & 2) << 30;
    (f32::from_bits(sin.to_bits() ^ sin_sign), f32::from_bits(cos.to_bits() ^ cos_sign))
}

/// Reduces an angle in [0, [`MODERATE`]] by subtraction.
///
/// `x - n pi/2` loses nothing in the first step and, where the result is small, nothing in the second; what the
/// second step does round off is kept.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "the number of quarter turns is between 0 and 127"
)]
#[inline]
fn reduce_moderate(x: f32) -> Reduced {
    let quarter = (x * core::f32::consts::FRAC_2_PI + 0.5) as u32;
    let n = quarter as f32;
    let first = x - n * HALF_PI_HIGH;
    let middle = n * HALF_PI_MIDDLE;
    let second = first - middle;
    let rounded_off = (first - second) - middle;
    let rest = n * HALF_PI_LOW - rounded_off;
    let high = second - rest;
    Reduced { quarter, high, low: (second - high) - rest }
}

/// Reduces a finite angle above [`MODERATE`] in integers.
///
/// With `x = m 2^e`, only the bits of `2/pi` from weight `2^(1-e)` on matter: those above turn `x` by whole turns.
/// 96 of them times the 24 bits of `m` give the fraction of a turn to 2^-64, which leaves enough correct bits even for
/// the angle closest to a multiple of a quarter turn.
#[inline]
fn reduce_large(x: f32) -> Reduced {
    let bits = x.to_bits();
    let mantissa = u64::from((bits & 0x007F_FFFF) | 0x0080_0000);
    // The exponent field counts 2^e from 150; the window starts at bit e + 30 of the table.
    let start = (bits >> 23).wrapping_sub(120);
    let word = (start >> 5) as usize;
    let Some(&[a, b, c, d]) = TWO_OVER_PI.get(word..word.saturating_add(4)) else {
        return Reduced { quarter: 0, high: f32::NAN, low: f32::NAN };
    };
    let shift = start & 31;
    let window = |upper: u32, lower: u32| {
        let both = (u64::from(upper) << 32) | u64::from(lower);
        (both << shift) >> 32
    };
    let high = mantissa.wrapping_mul(window(a, b)) << 32;
    let low = (mantissa.wrapping_mul(window(c, d))) >> 32;
    let turn = high.wrapping_add(mantissa.wrapping_mul(window(b, c))).wrapping_add(low);

    // The nearest quarter, and the signed distance from it in units of 2^-64 turns.
    let quarter = turn.wrapping_add(1 << 61) >> 62;
    let distance = turn.wrapping_sub(quarter << 62);
    let negative = distance >> 63 != 0;
    let distance = if negative { distance.wrapping_neg() } else { distance };

    // Times pi/2, with the leading bit at the top: the angle is `product 2^(-61 - zeros - more)` then.
    let zeros = distance.leading_zeros();
    let leading = (distance << (zeros & 63)) >> 32;
    let product = leading.wrapping_mul(HALF_PI_Q31);
    let more = product.leading_zeros();
    let product = product << (more & 63);
    let exponent = 127_u32.wrapping_sub(61).wrapping_add(40).wrapping_sub(zeros).wrapping_sub(more);
    let scale = f32::from_bits(exponent << 23);
    let (top, rest) = ((product >> 40) as u32, ((product >> 16) & 0x00FF_FFFF) as u32);
    let scale = if negative { -scale } else { scale };
    Reduced {
        quarter: quarter as u32,
        high: top as f32 * scale,
        low: rest as f32 * (scale * TWO_POW_MINUS_24),
    }
}

/// Sine on [-pi/4, pi/4]: `y + y^3 P(y^2)`, relative error 2^-27.9 before rounding.
#[inline]
fn sin_kernel(y: &Reduced) -> f32 {
    const P: [f32; 3] = [-0.166_666_55, 0.008_332_188, -0.000_195_180_95];
    let [p0, p1, p2] = P;
    let square = y.high * y.high;
    let cube = square * y.high;
    y.high + (cube * (p0 + square * (p1 + square * p2)) + (y.low - 0.5 * square * y.low))
}

/// Cosine on [-pi/4, pi/4]: `1 - y^2/2 + y^4 Q(y^2)`, relative error 2^-33 before rounding.
#[inline]
fn cos_kernel(y: &Reduced) -> f32 {
    const Q: [f32; 3] = [0.041_666_646, -0.001_388_731, 0.000_024_432_327];
    let [q0, q1, q2] = Q;
    let square = y.high * y.high;
    let half = 0.5 * square;
    let head = 1.0 - half;
    let rounded_off = (1.0 - head) - half;
    head + (rounded_off + (square * square * (q0 + square * (q1 + square * q2)) - y.high * y.low))
}

#[cfg(test)]
mod tests;
