//! A record of the largest difference between two ways of computing one quantity.

use nalgebra::SMatrix;

/// Largest difference seen of one quantity, relative to a scale that the caller gives, and where.
#[derive(Debug)]
pub(crate) struct Worst {
    what: &'static str,
    difference: f64,
    case: u32,
}

impl Worst {
    pub(crate) const fn of(what: &'static str) -> Self {
        Self { what, difference: 0.0, case: 0 }
    }

    /// Takes |`a` - `b`| / `scale` into account; a NaN counts as infinitely far.
    pub(crate) fn see<const R: usize, const C: usize>(
        &mut self,
        case: u32,
        a: &SMatrix<f64, R, C>,
        b: &SMatrix<f64, R, C>,
        scale: f64,
    ) {
        let difference = (a - b).norm() / scale;
        let difference = if difference.is_nan() { f64::INFINITY } else { difference };
        if difference > self.difference {
            (self.difference, self.case) = (difference, case);
        }
    }

    /// Prints the largest difference, for the record, and fails where it is above `tolerance`.
    pub(crate) fn within(&self, tolerance: f64) {
        let Self { what, difference, case } = self;
        println!("{what}: {difference:.1e}");
        assert!(*difference <= tolerance, "{what}: {difference:e} in case {case}, allowed {tolerance:e}");
    }
}
