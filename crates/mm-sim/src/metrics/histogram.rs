//! Percentiles of a magnitude in constant memory.

/// Bits of the mantissa that tell bins apart: 256 bins an octave.
const MANTISSA_BITS: u32 = 8;
/// Shift that leaves exponent and those bits.
const SHIFT: u32 = 52 - MANTISSA_BITS;
/// Smallest exponent that is told from zero: 2^-40.
const LOWEST: u64 = (1023 - 40) << MANTISSA_BITS;
/// Octaves covered: up to 2^40.
const OCTAVES: usize = 80;
const BINS: usize = OCTAVES << MANTISSA_BITS;

/// A histogram of magnitudes with logarithmic bins, each 0.4 % wide, cut straight out of the floating-point format.
///
/// A percentile is interpolated within its bin, so that it is off by less than 0.4 %, by 0.1 % typically. Magnitudes below 1e-12 count as
/// zero.
#[derive(Debug, Clone)]
pub(super) struct MagnitudeHistogram {
    bins: Vec<u32>,
    zeros: u64,
    count: u64,
}

impl Default for MagnitudeHistogram {
    fn default() -> Self {
        Self { bins: vec![0; BINS], zeros: 0, count: 0 }
    }
}

impl MagnitudeHistogram {
    /// Counts the magnitude of a number.
    #[inline]
    pub(super) fn add(&mut self, value: f64) {
        self.count += 1;
        let key = (value.to_bits() & !(1 << 63)) >> SHIFT;
        let bin = key.checked_sub(LOWEST).and_then(|bin| usize::try_from(bin).ok());
        match bin {
            None => self.zeros += 1,
            Some(bin) => {
                if let Some(count) = self.bins.get_mut(bin.min(BINS - 1)) {
                    *count = count.saturating_add(1);
                }
            }
        }
    }

    /// The magnitude below which a fraction of the numbers lies; none if there are none.
    #[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
    pub(super) fn percentile(&self, fraction: f64) -> Option<f64> {
        if self.count == 0 {
            return None;
        }
        let rank = fraction * self.count as f64;
        let mut below = self.zeros as f64;
        if rank <= below {
            return Some(0.0);
        }
        for (bin, &count) in self.bins.iter().enumerate() {
            let here = f64::from(count);
            if count > 0 && below + here >= rank {
                let edge = |bin: usize| f64::from_bits((LOWEST + bin as u64) << SHIFT);
                let (lo, hi) = (edge(bin), edge(bin + 1));
                return Some(lo + (hi - lo) * ((rank - below) / here));
            }
            below += here;
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::MagnitudeHistogram;

    #[test]
    fn percentile_agrees_with_sorting() {
        let mut histogram = MagnitudeHistogram::default();
        let mut all = Vec::new();
        for i in 0..50_000_u64 {
            let value = crate::random::noise_at(7, f64::from(u32::try_from(i).unwrap())).powi(3) * 20.0;
            histogram.add(value);
            all.push(value.abs());
        }
        all.sort_by(f64::total_cmp);
        for (fraction, index) in [(0.5, 25_000), (0.9, 45_000), (0.99, 49_500)] {
            let (got, exact) = (histogram.percentile(fraction).unwrap(), all[index]);
            assert!((got / exact - 1.0).abs() < 4e-3, "{fraction}: {got} instead of {exact}");
        }
    }

    #[test]
    fn zeros_and_nothing_are_zero() {
        let mut histogram = MagnitudeHistogram::default();
        assert_eq!(histogram.percentile(0.99), None, "nothing was added");
        for _ in 0..10 {
            histogram.add(0.0);
        }
        assert_eq!(histogram.percentile(0.99), Some(0.0), "only zeros were added");
    }
}
