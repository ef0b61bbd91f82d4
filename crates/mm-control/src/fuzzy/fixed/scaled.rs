//! A map of whole numbers between ranges of floating-point numbers.
#![expect(
    clippy::arithmetic_side_effects,
    reason = "this is the border to floating-point numbers, whose arithmetic has no side effects"
)]

use super::Evaluate;
use crate::fuzzy::{FuzzyError, FuzzySystem};
use mm_model::Real;

/// A [`Curve`](super::Curve) or [`Surface1`](super::Surface1) with floating-point numbers in and out, for a control law.
///
/// Equation: `y = m_y + h_y E(q) / 32768` with `q = round(32768 (x - m_x) / h_x)`, m the middles of the ranges and h half their
/// widths.
///
/// Convention: an input beyond its range counts as the nearer end, of which the upper one is a unit short (32767). A NaN counts as the
/// middle of the range.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::FuzzySystem;
/// use mm_control::fuzzy::fixed::{Scaled, Section, Surface1};
///
/// let ramp = Surface1 {
///     first: Section { start: 0, knot: 0, shift: 14 },
///     others: &[],
///     knots: &[0, 8192, 16384, 16384],
///     odd: true,
/// };
/// let map = Scaled::<f32, _>::try_new(ramp, (-2.0, 2.0), (-10.0, 10.0))?;
/// assert_eq!([1.0, -0.5, 9.0].map(|x| map.evaluate(x)), [2.5, -1.25, 5.0]);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaled<T, E> {
    map: E,
    input_range: (T, T),
    input_middle: T,
    per_input: T,
    output_middle: T,
    output_unit: T,
}

impl<T: Real, E: Evaluate> Scaled<T, E> {
    /// Puts a map between two ranges.
    ///
    /// # Errors
    /// [`FuzzyError::NonFinite`] or [`FuzzyError::Inverted`], naming `input_range` or `output_range`.
    pub fn try_new(map: E, input_range: (T, T), output_range: (T, T)) -> Result<Self, FuzzyError> {
        let parts = |(lo, hi): (T, T), name| {
            let (middle, half) = (T::HALF * lo + T::HALF * hi, T::HALF * hi - T::HALF * lo);
            if !(middle.is_finite() && half.is_finite()) {
                return Err(FuzzyError::NonFinite(name));
            }
            if half > T::ZERO { Ok((middle, half)) } else { Err(FuzzyError::Inverted(name)) }
        };
        let (input_middle, input_half) = parts(input_range, "input_range")?;
        let (output_middle, output_half) = parts(output_range, "output_range")?;
        let units = T::from_u32(32768);
        let per_input = units / input_half;
        if !per_input.is_finite() {
            return Err(FuzzyError::NonFinite("input_range"));
        }
        let output_unit = output_half / units;
        Ok(Self { map, input_range, input_middle, per_input, output_middle, output_unit })
    }

    /// The map of whole numbers.
    #[must_use]
    pub const fn map(&self) -> &E {
        &self.map
    }
}

impl<T: Real, E: Evaluate> FuzzySystem<T> for Scaled<T, E> {
    #[inline]
    fn evaluate(&self, x: T) -> T {
        let q = ((x - self.input_middle) * self.per_input).round_to_i16();
        self.output_middle + self.output_unit * T::from_i16(self.map.evaluate(q))
    }

    fn input_range(&self) -> (T, T) {
        self.input_range
    }
}
