//! What is asked of a compiled surface.

use super::CompileError;

/// What a surface is to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Request {
    /// Largest error, in output units. `None` for 2^-10 of half the output's range with one input; with two for the first of 2^-8, 2^-7, 2^-6
    /// ... of it that can be met.
    pub bound: Option<f64>,
    /// Bits of a knot, 8 to 16: knots are multiples of 2^(16 - bits) units.
    pub bits: u32,
    /// Bits to which each of two inputs is rounded, 8 to 12; without effect for one input.
    pub input_bits: u32,
    /// Most knots.
    pub max_knots: usize,
}

impl Default for Request {
    /// The bound by the number of inputs, knots of 16 bits, two inputs of 10 bits, 16,384 knots.
    fn default() -> Self {
        Self { bound: None, bits: 16, input_bits: 10, max_knots: 16_384 }
    }
}

impl Request {
    pub(super) fn check(&self) -> Result<(), CompileError> {
        let refuse = |name, value, expected| Err(CompileError::Request { name, value, expected });
        if let Some(bound) = self.bound.filter(|bound| !(bound.is_finite() && *bound > 0.0)) {
            return refuse("bound", bound, "a finite number above 0");
        }
        if !(8..=16).contains(&self.bits) {
            return refuse("bits", self.bits.into(), "8 to 16");
        }
        if !(8..=12).contains(&self.input_bits) {
            return refuse("input_bits", self.input_bits.into(), "8 to 12");
        }
        Ok(())
    }

    /// Distance of two values of a knot, in steps.
    pub(super) const fn knot_step(&self) -> i32 {
        1 << (16 - self.bits)
    }
}

/// Checks that a range is finite and has width.
pub(super) fn check_range(name: &'static str, (lo, hi): (f64, f64)) -> Result<(), CompileError> {
    if lo.is_finite() && hi.is_finite() && (hi - lo).is_finite() && lo < hi {
        return Ok(());
    }
    let value = if lo.is_finite() { hi } else { lo };
    Err(CompileError::Request { name, value, expected: "a finite lower end below a finite upper end" })
}
