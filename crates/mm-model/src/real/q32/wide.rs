//! Products of 32-bit words, which everything else is made of.

/// Whether the core multiplies 32-bit words to 32 bits only, as ARMv6-M does.
// Of the Arm microcontrollers, those without compare-and-swap are those without `umull`.
pub(super) const NARROW: bool = cfg!(all(target_arch = "arm", not(target_has_atomic = "32")));

/// The whole product of two words.
///
/// Cores that have a widening multiplication do it by that; an ARMv6-M core has none and would call a product of 64-bit words
/// instead, of which most is zero.
#[inline(always)]
pub(super) fn wide(a: u32, b: u32) -> u64 {
    if NARROW { wide_by_halves(a, b) } else { u64::from(a).wrapping_mul(u64::from(b)) }
}

/// The same from four products of 16-bit halves.
#[inline(always)]
pub(super) fn wide_by_halves(a: u32, b: u32) -> u64 {
    let (low_a, high_a, low_b, high_b) = (a & 0xFFFF, a >> 16, b & 0xFFFF, b >> 16);
    let low = low_a.wrapping_mul(low_b);
    let high = high_a.wrapping_mul(high_b);
    let (one, other) = (low_a.wrapping_mul(high_b), high_a.wrapping_mul(low_b));
    let both = (u64::from(high) << 32) | u64::from(low);
    both.wrapping_add(u64::from(one) << 16).wrapping_add(u64::from(other) << 16)
}

/// The product of a signed and an unsigned word.
#[inline(always)]
pub(super) fn wide_mixed(a: i32, b: u32) -> i64 {
    // As an unsigned word, a negative `a` is too large by 2^32.
    let excess = if a < 0 { b } else { 0 };
    (wide(a.cast_unsigned(), b).wrapping_sub(u64::from(excess) << 32)).cast_signed()
}

/// The product of two signed words.
#[inline(always)]
pub(super) fn wide_signed(a: i32, b: i32) -> i64 {
    if NARROW {
        let (magnitude_a, magnitude_b) = (a.unsigned_abs(), b.unsigned_abs());
        let magnitude = wide_by_halves(magnitude_a, magnitude_b).cast_signed();
        if (a ^ b) < 0 { magnitude.wrapping_neg() } else { magnitude }
    } else {
        i64::from(a).wrapping_mul(i64::from(b))
    }
}

/// Numbers with upper words in [-2^13, 2^13), multiplied: `a b / 2^32`, rounded to the nearest, ties up, which has no overflow.
#[inline(always)]
pub(super) fn small_product(a: i64, b: i64) -> i64 {
    if NARROW { small_product_by_halves(a, b) } else { small_product_by_words(a, b) }
}

/// By the four products of words; of the uppermost only the lower word counts.
#[inline(always)]
pub(super) fn small_product_by_words(a: i64, b: i64) -> i64 {
    let (high_a, low_a, high_b, low_b) = ((a >> 32) as i32, a as u32, (b >> 32) as i32, b as u32);
    let lowest = (wide(low_a, low_b).wrapping_add(1 << 31)) >> 32;
    let middle = lowest
        .wrapping_add(wide(high_a.cast_unsigned(), low_b))
        .wrapping_add(wide(low_a, high_b.cast_unsigned()));
    // As unsigned words, negative ones were too large by 2^32.
    let excess =
        (low_b & (high_a >> 31).cast_unsigned()).wrapping_add(low_a & (high_b >> 31).cast_unsigned());
    let top = high_a.wrapping_mul(high_b).cast_unsigned().wrapping_sub(excess);
    middle.wrapping_add(u64::from(top) << 32).cast_signed()
}

/// By nine products that fit one word: an upper word has 14 bits, a half of a lower one 16.
#[inline(always)]
pub(super) fn small_product_by_halves(a: i64, b: i64) -> i64 {
    let (high_a, low_a, high_b, low_b) = ((a >> 32) as i32, a as u32, (b >> 32) as i32, b as u32);
    let (a0, a1, b0, b1) = (low_a & 0xFFFF, low_a >> 16, low_b & 0xFFFF, low_b >> 16);
    let (one, other) = (a0.wrapping_mul(b1), a1.wrapping_mul(b0));
    let carried = (a0.wrapping_mul(b0) >> 16)
        .wrapping_add(one & 0xFFFF)
        .wrapping_add(other & 0xFFFF)
        .wrapping_add(0x8000);
    let mixed = |x: u32, y: u32| {
        high_a.wrapping_mul(y.cast_signed()).wrapping_add(high_b.wrapping_mul(x.cast_signed()))
    };
    let (lower, upper) = (mixed(a0, b0), mixed(a1, b1));
    let lowest =
        a1.wrapping_mul(b1).wrapping_add(one >> 16).wrapping_add(other >> 16).wrapping_add(carried >> 16);
    let top = i64::from(high_a.wrapping_mul(high_b)) << 32;
    let sum = top.wrapping_add(i64::from(upper) << 16).wrapping_add(i64::from(lower));
    sum.wrapping_add(i64::from(lowest))
}

/// The upper word of the product of two words.
#[inline(always)]
pub(super) fn upper(a: u32, b: u32) -> u32 {
    (wide(a, b) >> 32) as u32
}

/// The lower 64 bits of the product of a double word and a word.
#[inline(always)]
pub(super) fn lower(a: u64, b: u32) -> u64 {
    let carried = ((a >> 32) as u32).wrapping_mul(b);
    wide(a as u32, b).wrapping_add(u64::from(carried) << 32)
}
