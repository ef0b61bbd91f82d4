//! Ranges in steps of 2^-15 of their half.

/// A range, its middle and half of its width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scale {
    middle: f64,
    half: f64,
}

impl Scale {
    pub(super) fn of((lo, hi): (f64, f64)) -> Self {
        Self { middle: 0.5 * lo + 0.5 * hi, half: 0.5 * hi - 0.5 * lo }
    }

    /// What a position in steps stands for.
    pub(super) fn value(self, steps: f64) -> f64 {
        self.middle + self.half * (steps / 32768.0)
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
