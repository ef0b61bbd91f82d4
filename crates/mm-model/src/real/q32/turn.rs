//! Sine and cosine, and angles brought to one turn.

use super::Q32;
use super::wide::{upper, wide};

/// `2^32 / (2 pi)`, whole part and the 32 bits after it.
const TURNS: u32 = 683_565_275;
const TURNS_BELOW: u32 = 2_475_754_826;

/// `2 pi 2^29`; what is cut off is 0.1305, [`RADIANS_BELOW`] in 1/256.
const RADIANS: u32 = 3_373_259_426;
const RADIANS_BELOW: u32 = 33;

/// The angle in units of 2^-64 turns, whole turns left out, to within 2^-64 turns for each radian and 2^-63 turns.
#[inline]
fn turns(angle: i64) -> u64 {
    // A negative angle is its magnitude the other way round.
    let magnitude = angle.unsigned_abs();
    let (high, low) = ((magnitude >> 32) as u32, magnitude as u32);
    let whole = (u64::from(high.wrapping_mul(TURNS)) << 32).wrapping_add(wide(low, TURNS));
    let below = wide(high, TURNS_BELOW).wrapping_add(u64::from(upper(low, TURNS_BELOW)));
    let turns = whole.wrapping_add(below);
    if angle < 0 { turns.wrapping_neg() } else { turns }
}

/// Radians in units of 2^-61 of an angle in units of 2^-64 turns, for up to half a turn; error 2^-35.
#[inline]
fn radians(turns: u64) -> u64 {
    let (high, low) = ((turns >> 32) as u32, turns as u32);
    wide(high, RADIANS) + u64::from(upper(low, RADIANS)) + (wide(high, RADIANS_BELOW) >> 8)
}

/// The same direction in [-pi, pi).
#[inline]
pub(super) fn wrapped(angle: i64) -> i64 {
    let turns = turns(angle).cast_signed();
    let magnitude = ((radians(turns.unsigned_abs()) + (1 << 28)) >> 29).cast_signed();
    let angle = if turns < 0 { -magnitude } else { magnitude };
    if angle >= Q32::PI_RAW { -Q32::PI_RAW } else { angle }
}

/// Sine and cosine of an angle, all in units of 2^-32.
///
/// The angle is turned back to at most an eighth of a turn from the nearest quarter. Constant cost.
///
/// # Source
/// Polynomials in the square of the angle, through the Chebyshev nodes of [0, (pi/4)^2].
#[inline(never)]
pub(super) fn sin_cos(angle: i64) -> (i64, i64) {
    let turns = turns(angle);
    let quarter = ((turns >> 61) as u32).wrapping_add(1) >> 1;
    let rest = turns.wrapping_sub(u64::from(quarter) << 62).cast_signed();
    let y = radians(rest.unsigned_abs());
    let short = ((y + (1 << 28)) >> 29) as u32;
    let square = ((wide(short, short) + (1 << 31)) >> 32) as u32;
    let (sin, cos) = (sin_kernel(y, short, square), cos_kernel(square));
    let sin = if rest < 0 { -sin } else { sin };
    let (sin, cos) = if quarter & 1 == 0 { (sin, cos) } else { (cos, -sin) };
    if quarter & 2 == 0 { (sin, cos) } else { (-sin, -cos) }
}

/// `y - y^3 P(y^2)` for y in [0, pi/4], in units of 2^-61, 2^-32 and 2^-32 for its square. Error of the polynomial: 2^-36.
#[inline]
fn sin_kernel(y: u64, short: u32, square: u32) -> i64 {
    // In units of 2^-34.
    const P: [u32; 4] = [2_863_311_530, 143_165_551, 3_408_501, 46_815];
    let [p0, p1, p2, p3] = P;
    let p = p0 - upper(square, p1 - upper(square, p2 - upper(square, p3)));
    let less = upper(upper(square, short), p);
    (((y >> 27) - u64::from(less) + 2) >> 2).cast_signed()
}

/// `1 - y^2 Q(y^2)` for the square of y in [0, (pi/4)^2], in units of 2^-32. Error of the polynomial: 2^-42.
#[inline]
fn cos_kernel(square: u32) -> i64 {
    // In units of 2^-32.
    const Q: [u32; 5] = [1 << 31, 178_956_971, 5_965_231, 106_515, 1_170];
    let [q0, q1, q2, q3, q4] = Q;
    let q = q0 - upper(square, q1 - upper(square, q2 - upper(square, q3 - upper(square, q4))));
    let less = (wide(square, q) + (1 << 31)) >> 32;
    (1 << 32) - less.cast_signed()
}
