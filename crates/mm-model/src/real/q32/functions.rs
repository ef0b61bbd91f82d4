//! Inverse circular functions, exponential and power: for setup and for curved fuzzy terms, in the arithmetic of [`Q32`].

use super::Q32;
use crate::Real;

/// `ln 2` in units of 2^-57.
const LN_2: i64 = 99_893_036_290_645_747;

/// The inverse of a whole number, for constants.
const fn one_over(n: i64) -> Q32 {
    Q32::from_raw(((1 << 32) + n / 2) / n)
}

/// 1/25, 1/23, ... 1/3.
const ODD: [Q32; 12] = {
    [
        one_over(25),
        one_over(23),
        one_over(21),
        one_over(19),
        one_over(17),
        one_over(15),
        one_over(13),
        one_over(11),
        one_over(9),
        one_over(7),
        one_over(5),
        one_over(3),
    ]
};

/// 1/11, 1/10, ... 1/1.
const WHOLE: [Q32; 11] = [
    one_over(11),
    one_over(10),
    one_over(9),
    one_over(8),
    one_over(7),
    one_over(6),
    one_over(5),
    one_over(4),
    one_over(3),
    one_over(2),
    one_over(1),
];

/// Angle of the point (x, y) in (-pi, pi].
///
/// The ratio of the smaller to the larger coordinate is at most 1; above tan(pi/8) it is turned back by pi/4.
pub(super) fn atan2(y: Q32, x: Q32) -> Q32 {
    if !y.in_range() || !x.in_range() {
        return Q32::NAN;
    }
    if x == Q32::ZERO && y == Q32::ZERO {
        return Q32::ZERO;
    }
    let (width, height) = (x.raw.unsigned_abs(), y.raw.unsigned_abs());
    let steep = height > width;
    let (short, long) = if steep { (width, height) } else { (height, width) };
    // Only their ratio matters: as large as their sum allows.
    let up = long.leading_zeros() - 3;
    let scaled = |magnitude: u64| Q32::from_raw((magnitude << up >> 2).cast_signed());
    let (short, long) = (scaled(short), scaled(long));
    // tan(pi/8) = 0.41421.
    let turned = short.raw > (long.raw >> 13) * 3393;
    let ratio = if turned { (short - long) / (short + long) } else { short / long };
    let (half_pi, quarter_pi) = (Q32::PI * Q32::HALF, Q32::PI * Q32::HALF * Q32::HALF);
    let angle = if turned { quarter_pi + small_atan(ratio) } else { small_atan(ratio) };
    let angle = if steep { half_pi - angle } else { angle };
    let angle = if x < Q32::ZERO { Q32::PI - angle } else { angle };
    if y < Q32::ZERO { -angle } else { angle }
}

/// Series of the inverse tangent up to tan(pi/8): the first term left out is below 2^-36.
fn small_atan(t: Q32) -> Q32 {
    let square = t * t;
    let mut sum = Q32::ZERO;
    for per in ODD {
        sum = per - square * sum;
    }
    t - t * square * sum
}

/// Angle in [0, pi] whose cosine is `x`: twice the angle whose tangent is sqrt((1 - x)/(1 + x)), which is exact at both ends.
pub(super) fn acos(x: Q32) -> Q32 {
    if !(x >= -Q32::ONE && x <= Q32::ONE) {
        return Q32::NAN;
    }
    Q32::TWO * atan2((Q32::ONE - x).sqrt(), (Q32::ONE + x).sqrt())
}

/// Power of Euler's number: `2^n e^r` with r at most ln 2 / 2, by its series.
pub(super) fn exp(x: Q32) -> Q32 {
    if !x.in_range() {
        return if x == Q32::NEG_INFINITY { Q32::ZERO } else { x };
    }
    if x > Q32::from_raw(20 << 32) {
        return Q32::INFINITY;
    }
    if x < Q32::from_raw(-(23 << 32)) {
        return Q32::ZERO;
    }
    // The nearest whole number to x / ln 2; one beside it would do as well.
    let n = ((x.raw >> 16) * 94_548 + (1 << 31)) >> 32;
    let r = Q32::from_raw(x.raw - ((n * LN_2 + (1 << 24)) >> 25));
    let mut sum = Q32::ONE;
    for per in WHOLE {
        sum = Q32::ONE + r * per * sum;
    }
    if n >= 0 {
        Q32::signed(false, sum.raw.cast_unsigned() << (n & 31))
    } else {
        let down = -n & 63;
        Q32::from_raw((sum.raw + (1 << (down - 1))) >> down)
    }
}

/// Natural logarithm of a number above zero: `n ln 2 + 2 atanh((m - 1)/(m + 1))` with m between sqrt(1/2) and sqrt(2).
fn ln(x: Q32) -> Q32 {
    let raw = x.raw.cast_unsigned();
    // m with its leading bit at 2^32 or, from sqrt(2) on, at 2^31.
    let top = 63 - i64::from(raw.leading_zeros());
    let mantissa = if top >= 32 { raw >> (top - 32) } else { raw << (32 - top) };
    let large = mantissa > 6_074_000_999;
    let n = top - 32 + i64::from(large);
    let m = Q32::from_raw(mantissa.cast_signed());
    let m = if large { m * Q32::HALF } else { m };
    let s = (m - Q32::ONE) / (m + Q32::ONE);
    let square = s * s;
    let sum = ODD.iter().skip(6).fold(Q32::ZERO, |sum, &per| per + square * sum);
    let sum = Q32::ONE + square * sum;
    Q32::from_raw((n * LN_2 + (1 << 24)) >> 25) + Q32::TWO * s * sum
}

/// Power: by squaring for whole exponents up to 64, else `exp(y ln x)`; a negative base needs a whole exponent.
pub(super) fn powf(x: Q32, y: Q32) -> Q32 {
    if y == Q32::ZERO || x == Q32::ONE {
        return Q32::ONE;
    }
    if !x.in_range() || !y.in_range() {
        return Q32::NAN;
    }
    let whole = y.floor() == y;
    let odd = whole && (y.raw >> 32) & 1 != 0;
    if x == Q32::ZERO {
        return if y > Q32::ZERO { Q32::ZERO } else { Q32::INFINITY };
    }
    if x < Q32::ZERO && !whole {
        return Q32::NAN;
    }
    let magnitude = if whole && y.abs() <= Q32::from_raw(64 << 32) {
        let power = whole_power(x.abs(), (y.raw >> 32).unsigned_abs());
        if y < Q32::ZERO { Q32::ONE / power } else { power }
    } else {
        exp(y * ln(x.abs()))
    };
    if x < Q32::ZERO && odd { -magnitude } else { magnitude }
}

fn whole_power(x: Q32, mut exponent: u64) -> Q32 {
    let (mut power, mut base) = (Q32::ONE, x);
    for _ in 0..7 {
        if exponent & 1 != 0 {
            power *= base;
        }
        exponent >>= 1;
        if exponent == 0 {
            break;
        }
        base *= base;
    }
    power
}
