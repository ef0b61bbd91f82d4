//! Laws, each with its reference:
//!
//! - sum, difference, product, quotient, root: the exact result in 128-bit integers, rounded to the nearest, infinite beyond the range.
//!   Tolerance none.
//! - special words: arithmetic in `f64` on the class of each operand (zero, finite, infinite, NaN), but for quotients by an
//!   infinity, which are NaN here. Overflow is never left again.
//! - functions: libm in `f64` at the same number. Tolerance: the table in the documentation of [`Q32`], in units of 2^-32.
//!
//! Operands are random with all magnitudes alike likely, and every pair of a list of extremes.

mod functions;
mod special;

use super::wide::{
    small_product_by_halves, small_product_by_words, wide, wide_by_halves, wide_mixed, wide_signed,
};
use super::{Q32, Real, divide, root};

/// A generator of 64-bit words (Steele, Lea and Flood, SplitMix).
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A number with a random count of bits.
    pub(super) fn number(&mut self) -> Q32 {
        let magnitude = (self.word() >> 4) >> (self.word() % 60);
        Q32::signed(self.word() & 1 == 0, magnitude)
    }
}

/// Where carries, signs and ends of ranges are.
fn extremes() -> impl Iterator<Item = Q32> + Clone {
    let powers = (0..61).map(|k| 1_i64 << k);
    let raws = powers.flat_map(|p| [p - 1, p, p + 1, -p - 1, -p, 1 - p]);
    raws.chain([0, 0xFFFF_FFFF, 0x1_FFFF_FFFF, 0x0FFF_FFFF_0000_0000])
        .map(|raw| Q32 { raw })
        .filter(|q| q.in_range())
}

/// All pairs of extremes, and as many random ones again and more.
fn pairs() -> impl Iterator<Item = (Q32, Q32)> {
    let mut random = Random(1);
    let drawn = (0..400_000).map(move |_| (random.number(), random.number()));
    extremes().flat_map(|a| extremes().map(move |b| (a, b))).chain(drawn)
}

/// The word of an exact result, or the infinity of its sign.
fn settled(exact: i128) -> i64 {
    match i64::try_from(exact) {
        Ok(raw) if (Q32 { raw }).in_range() => raw,
        _ => Q32::infinite(exact < 0).raw,
    }
}

/// Numerator over denominator to the nearest, ties away from zero.
fn nearest(numerator: i128, denominator: i128) -> i128 {
    let magnitude = (2 * numerator.abs() + denominator.abs()) / (2 * denominator.abs());
    if (numerator < 0) == (denominator < 0) { magnitude } else { -magnitude }
}

#[test]
fn sums_and_differences_are_exact() {
    for (a, b) in pairs() {
        let (x, y) = (i128::from(a.raw), i128::from(b.raw));
        assert_eq!((a + b).raw, settled(x + y), "{x} + {y}");
        assert_eq!((a - b).raw, settled(x - y), "{x} - {y}");
        assert_eq!((-a).raw, settled(-x), "-{x}");
        assert_eq!(a.abs().raw, settled(x.abs()), "|{x}|");
    }
}

#[test]
fn products_are_rounded_to_the_nearest() {
    for (a, b) in pairs() {
        let (x, y) = (i128::from(a.raw), i128::from(b.raw));
        assert_eq!((a * b).raw, settled((x * y + (1 << 31)) >> 32), "{x} * {y}");
    }
}

/// Both ways to multiply small numbers, of which a core uses one.
#[test]
fn small_products_are_the_same_by_words_and_by_halves() {
    let small = |q: &Q32| (-(1 << 45)..1 << 45).contains(&q.raw);
    for (a, b) in pairs().filter(|(a, b)| small(a) && small(b)) {
        let exact = (i128::from(a.raw) * i128::from(b.raw) + (1 << 31)) >> 32;
        assert_eq!(i128::from(small_product_by_words(a.raw, b.raw)), exact, "{a} * {b} by words");
        assert_eq!(i128::from(small_product_by_halves(a.raw, b.raw)), exact, "{a} * {b} by halves");
    }
}

#[test]
fn quotients_are_rounded_to_the_nearest() {
    for (a, b) in pairs().filter(|(_, b)| b.raw != 0) {
        let (x, y) = (i128::from(a.raw), i128::from(b.raw));
        let exact = nearest(x << 32, y);
        // A quotient of -2^28, the one finite magnitude of 2^60 words, is taken for infinite.
        let expected = if exact == -(1 << 60) { Q32::NEG_INFINITY.raw } else { settled(exact) };
        assert_eq!((a / b).raw, expected, "{x} / {y}");
    }
}

/// Operands whose quotient is next to a whole number, or to the middle between two.
#[test]
fn quotients_next_to_a_step_are_right() {
    let mut random = Random(2);
    for _ in 0..400_000 {
        let divisor = random.number().raw.unsigned_abs().max(1);
        let quotient = u128::from(random.number().raw.unsigned_abs());
        let twice = u128::from(divisor) * (2 * quotient + 1);
        for dividend in [twice >> 33, (twice >> 33) + 1, (u128::from(divisor) * quotient) >> 32] {
            if dividend == 0 || dividend >= 1 << 60 {
                continue;
            }
            let exact = ((dividend << 33) + u128::from(divisor)) / (2 * u128::from(divisor));
            let expected = u64::try_from(exact).ok().filter(|&word| word < 1 << 60);
            let dividend = u64::try_from(dividend).unwrap();
            assert_eq!(divide::quotient(dividend, divisor), expected, "{dividend} / {divisor}");
        }
    }
}

#[test]
fn roots_are_rounded_to_the_nearest() {
    let mut random = Random(3);
    let drawn = core::iter::repeat_with(|| random.number()).take(200_000);
    for q in extremes().chain(drawn).filter(|q| q.raw >= 0) {
        let (under, root) =
            (u128::from(q.raw.unsigned_abs()) << 32, u128::from(root::root(q.raw.unsigned_abs())));
        // (root - 1/2)^2 <= under < (root + 1/2)^2, both times 4.
        assert!(4 * under < (2 * root + 1).pow(2), "{q:?}");
        assert!(root == 0 || 4 * under >= (2 * root - 1).pow(2), "{q:?}");
    }
}

#[test]
fn products_of_words_are_whole() {
    let mut random = Random(4);
    let words = [0, 1, 2, 0x7FFF, 0x8000, 0xFFFF, 0x1_0000, 0x7FFF_FFFF, 0x8000_0000, 0xFFFF_FFFF_u32];
    let drawn = core::iter::repeat_with(move || ((random.word() >> 32) as u32, random.word() as u32));
    for (a, b) in words.into_iter().flat_map(|a| words.map(|b| (a, b))).chain(drawn.take(100_000)) {
        assert_eq!(wide_by_halves(a, b), u64::from(a) * u64::from(b), "{a} * {b} by halves");
        assert_eq!(wide(a, b), u64::from(a) * u64::from(b), "{a} * {b}");
        let (signed_a, signed_b) = (a.cast_signed(), b.cast_signed());
        assert_eq!(wide_mixed(signed_a, b), i64::from(signed_a) * i64::from(b), "{signed_a} * {b}");
        assert_eq!(
            wide_signed(signed_a, signed_b),
            i64::from(signed_a) * i64::from(signed_b),
            "{signed_a} * {signed_b}"
        );
    }
}
