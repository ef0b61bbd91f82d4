//! Random numbers that depend on their seed and index alone.

/// One step of SplitMix64: a well-mixed 64-bit number of a counter.
///
/// # Source
/// G. L. Steele, D. Lea, C. H. Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.
#[must_use]
pub const fn split_mix(counter: u64) -> u64 {
    let z = counter.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The `index`-th number of a stream, uniform in [-1, 1). An integrator may ask for any of them in any order.
#[must_use]
pub fn noise_at(seed: u64, index: f64) -> f64 {
    let bits = split_mix(split_mix(seed) ^ index.to_bits());
    // 53 bits are what a number in [0, 1) holds.
    #[expect(clippy::cast_precision_loss, reason = "a 53-bit number is exact in f64")]
    let unit = (bits >> 11) as f64 / 9_007_199_254_740_992.0;
    2.0 * unit - 1.0
}
