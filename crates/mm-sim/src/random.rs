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

/// A stream of random numbers, drawn one after the other: SplitMix64.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stream(u64);

impl Stream {
    /// The stream `number` of a seed; streams of different numbers or seeds have nothing in common.
    #[must_use]
    pub const fn new(seed: u64, number: u64) -> Self {
        Self(split_mix(split_mix(seed) ^ number))
    }

    /// The next 64 random bits.
    pub const fn next_bits(&mut self) -> u64 {
        let bits = split_mix(self.0);
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        bits
    }

    /// The next normal number, of mean 0 and standard deviation 1.
    ///
    /// Method: the sum of twelve uniform numbers in (0, 1) less six (Irwin and Hall), which has exactly that mean and variance;
    /// the uniform numbers are the 16-bit quarters of three words. No logarithm, no rejection, the same bits everywhere. The tails end at
    /// 6, and the fourth moment is 2.9 instead of 3.
    pub fn next_normal(&mut self) -> f64 {
        let mut sum = 0_u32;
        for _ in 0..3 {
            let bits = self.next_bits();
            for quarter in [bits, bits >> 16, bits >> 32, bits >> 48] {
                sum += u32::from((quarter & 0xFFFF) as u16);
            }
        }
        // Each uniform number is a quarter plus one half, over 2^16.
        (f64::from(sum) + 6.0) / 65_536.0 - 6.0
    }
}
