//! From and to double precision by the bits alone: no floating-point operation, also where a constant does not fold.

use core::fmt;

use super::Q32;

const MANTISSA: u64 = (1 << 52) - 1;

impl Q32 {
    /// The number nearest to `value`, ties to the even one; infinite from 2^28 on. Usable in constants.
    #[must_use]
    pub const fn from_f64(value: f64) -> Self {
        let bits = value.to_bits();
        let negative = bits >> 63 != 0;
        let (exponent, mantissa) = ((bits >> 52) & 0x7FF, bits & MANTISSA);
        if exponent == 0x7FF && mantissa != 0 {
            return Self::NAN;
        }
        // value = (mantissa | 2^52) 2^(exponent - 1075); 2^28 has the exponent 1051.
        if exponent >= 1051 {
            return if exponent == 1051 && mantissa == 0 && negative {
                Self::MIN
            } else {
                Self::infinite(negative)
            };
        }
        let mantissa = mantissa | (1 << 52);
        let magnitude = if exponent >= 1043 {
            mantissa << (exponent - 1043)
        } else if exponent >= 1043 - 53 {
            let down = 1043 - exponent;
            let (kept, lost, half) = (mantissa >> down, mantissa & ((1 << down) - 1), 1 << (down - 1));
            kept + (lost > half || (lost == half && kept & 1 != 0)) as u64
        } else {
            0
        };
        Self::signed(negative, magnitude)
    }

    /// The nearest number in double precision; exact below 2^21.
    #[must_use]
    pub const fn to_f64(self) -> f64 {
        if self.is_nan() {
            return f64::NAN;
        }
        if !self.in_range() {
            return if self.raw < 0 { f64::NEG_INFINITY } else { f64::INFINITY };
        }
        let magnitude = self.raw.unsigned_abs();
        if magnitude == 0 {
            return 0.0;
        }
        // Leading bit to 2^63, then 53 bits of it, rounded; a carry goes into the exponent by itself.
        let zeros = magnitude.leading_zeros();
        let top = magnitude << zeros;
        let (kept, lost) = (top >> 11, top & 0x7FF);
        let kept = kept + (lost > 0x400 || (lost == 0x400 && kept & 1 != 0)) as u64;
        let exponent = 1023 + 31 - zeros as u64;
        let bits = ((exponent - 1) << 52) + kept;
        f64::from_bits(bits | ((self.raw < 0) as u64) << 63)
    }
}

impl From<u16> for Q32 {
    fn from(value: u16) -> Self {
        Self::from_raw((value as i64) << 32)
    }
}

impl fmt::Display for Q32 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.to_f64(), f)
    }
}

impl fmt::Debug for Q32 {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.to_f64(), f)
    }
}
