//! Numbers as bits.

use mm_link::Scalar;

/// A number whose bits are recorded: `f32` or `f64`.
pub trait Word: Scalar {
    /// Its name in Rust.
    const NAME: &'static str;
    /// Bytes that it takes.
    const BYTES: u8;
    /// The nearest number.
    fn nearest(value: f64) -> Self;
    /// Its bits, in the lower half where it has 32.
    fn bits(self) -> u64;
    /// The number of these bits.
    fn of_bits(bits: u64) -> Self;
}

impl Word for f32 {
    const NAME: &'static str = "f32";
    const BYTES: u8 = 4;

    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is asked for")]
    fn nearest(value: f64) -> Self {
        value as Self
    }

    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }

    #[expect(clippy::cast_possible_truncation, reason = "the upper half is empty")]
    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
    }
}

impl Word for f64 {
    const NAME: &'static str = "f64";
    const BYTES: u8 = 8;

    fn nearest(value: f64) -> Self {
        value
    }

    fn bits(self) -> u64 {
        self.to_bits()
    }

    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits)
    }
}
