//! Division by a reciprocal of one word and three digits of the quotient.

use super::wide::{lower, upper, wide, wide_mixed};

/// `dividend 2^32 / divisor`, rounded to the nearest, ties up; `None` for a zero divisor and where 2^60 is reached.
///
/// Both are at most 2^60. They are shifted up to n and m in [2^60, 2^61); floor(2^62 n/m) comes in digits of 26, 26 and 10 bits,
/// each from the upper word of what is left, times the reciprocal of the upper word of m. A digit may be off by one
/// either way: the next one, which is signed, makes up for it, and the last is compared with the exact remainder.
#[inline]
pub(super) fn quotient(dividend: u64, divisor: u64) -> Option<u64> {
    if divisor == 0 {
        return None;
    }
    if dividend == 0 {
        return Some(0);
    }
    let (up, up_divisor) = (dividend.leading_zeros() - 3, divisor.leading_zeros() - 3);
    let (n, m) = (dividend << up, divisor << up_divisor);
    // The result is n/m 2^exponent, with n/m between 1/2 and 2.
    let exponent = 32 + up_divisor.cast_signed() - up.cast_signed();
    if exponent > 60 {
        return None;
    }
    if exponent < -1 {
        return Some(0);
    }
    let down = (62 - exponent).cast_unsigned() & 63;
    let result = (ratio(n, m) + (1 << (down - 1))) >> down;
    (result < 1 << 60).then_some(result)
}

/// floor(2^62 n/m) for n and m in [2^60, 2^61).
#[inline]
fn ratio(n: u64, m: u64) -> u64 {
    let per = reciprocal((m >> 29) as u32);
    let first = upper((n >> 29) as u32, per) >> 5;
    let rest = (n << 26).wrapping_sub(lower(m, first)).cast_signed();
    let second = digit(rest, per, 2);
    let rest = (rest << 26).wrapping_sub(times(m, second));
    let third = digit(rest, per, 18);
    let rest = (rest << 10).wrapping_sub(times(m, third));
    let digits = (i64::from(second) << 10) + i64::from(third);
    let estimate = (u64::from(first) << 36).wrapping_add_signed(digits);
    if rest < 0 {
        estimate - 1
    } else if rest.cast_unsigned() >= m {
        estimate + 1
    } else {
        estimate
    }
}

/// The next digit for a remainder of at most 2^62: its upper word times the reciprocal.
#[inline]
fn digit(rest: i64, per: u32, down: u32) -> i32 {
    let estimate = (wide_mixed((rest >> 32) as i32, per) >> 32) as i32;
    estimate >> down
}

/// The lower 64 bits of `m digit`.
#[inline]
fn times(m: u64, digit: i32) -> i64 {
    let product = lower(m, digit.unsigned_abs()).cast_signed();
    if digit < 0 { product.wrapping_neg() } else { product }
}

/// 2^63 / d for a word with its top bit set, to within 2^-28 of itself: a straight line and three Newton steps.
#[inline]
fn reciprocal(d: u32) -> u32 {
    // 48/17 and 32/17 in units of 2^-30: with them the line is within 1/17 of 1/x over [1/2, 1).
    const OFFSET: u32 = 3_031_741_620;
    const SLOPE: u32 = 2_021_161_080;
    let mut y = OFFSET - upper(SLOPE, d);
    for _ in 0..3 {
        let correction = (1_u32 << 31).wrapping_sub(upper(y, d));
        y = (wide(y, correction) >> 30) as u32;
    }
    // At x = 1/2 the result may reach 2, which the word just does not hold.
    if y >= 1 << 31 { u32::MAX } else { y << 1 }
}
