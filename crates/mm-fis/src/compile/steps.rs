//! Ranges in steps of 2^-15 of their half.

/// What the 16-bit number `q` stands for in a range: `middle + half q / 32768`, and exactly the lower end for -32768.
#[must_use]
pub fn value_of(range: (f64, f64), q: i16) -> f64 {
    Scale::of(range).value(q.into())
}

/// A range, its middle and half of its width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    lo: f64,
    hi: f64,
    middle: f64,
    half: f64,
}

impl Scale {
    pub(super) fn of((lo, hi): (f64, f64)) -> Self {
        Self { lo, hi, middle: 0.5 * lo + 0.5 * hi, half: 0.5 * hi - 0.5 * lo }
    }

    /// What a position in steps stands for; the ends are exactly those of the range, so that a vertical side there stays on its side.
    pub(super) fn value(self, steps: f64) -> f64 {
        let value = self.middle + self.half * (steps / 32768.0);
        if steps.abs() > 32768.0 {
            value
        } else if steps <= -32768.0 {
            self.lo
        } else if steps >= 32768.0 {
            self.hi
        } else {
            value.clamp(self.lo, self.hi)
        }
    }

    /// Position of a value in steps, not rounded.
    pub(super) fn steps(self, value: f64) -> f64 {
        (value - self.middle) / self.half * 32768.0
    }

    /// A difference in steps as one of values.
    pub(super) fn difference(self, steps: f64) -> f64 {
        self.half * steps / 32768.0
    }

    /// A difference of values in steps.
    pub(super) fn difference_in_steps(self, difference: f64) -> f64 {
        difference / self.half * 32768.0
    }
}
