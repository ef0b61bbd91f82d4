//! Square root, digit by digit.

/// The square root of `raw 2^32`, rounded to the nearest, for `raw` up to 2^60.
#[inline(never)]
pub(super) fn root(raw: u64) -> u64 {
    // 92 bits under the root, two for each bit of the result; the remainder stays below twice the root.
    let (mut root, mut rest) = (0_u64, 0_u64);
    let mut under = raw << 4;
    for _ in 0..46 {
        rest = (rest << 2) | (under >> 62);
        under <<= 2;
        let trial = (root << 2) | 1;
        root <<= 1;
        if rest >= trial {
            rest -= trial;
            root |= 1;
        }
    }
    // Past the middle between two roots the remainder is larger than the root.
    root + u64::from(rest > root)
}
