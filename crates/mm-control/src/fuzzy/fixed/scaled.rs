//! A fixed-point system between floating-point numbers, for a control law.
#![expect(clippy::arithmetic_side_effects, reason = "floating-point arithmetic of T has none")]

use mm_model::Real;

use super::curve::Evaluate;
use crate::fuzzy::{FuzzyError, FuzzySystem};

/// Largest input and output of an adapted system, in steps.
const MOST: u32 = 32767;

/// A fixed-point system of one input and one output with its ranges: what a control law takes.
///
/// Equation: `q = round(32768 (x - middle) / half)` of the input range, held to -32767..=32767, and back in the output range.
///
/// Convention: halves are rounded away from the middle, so that an odd system stays exactly odd where both ranges are centred on 0. A NaN gives
/// the middle of the output range. The lower end of the input is met to one step, as the upper one is.
///
/// Cost: two multiplications and the conversions besides the system's own, in the precision of `T` alone.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::FuzzySystem;
/// use mm_control::fuzzy::fixed::{SMOOTH_SURFACE, Scaled};
///
/// let system = Scaled::<f32, _>::try_new(SMOOTH_SURFACE, (-1.0, 1.0), (-4.0 / 3.0, 4.0 / 3.0))?;
/// assert_eq!(system.evaluate(0.0), 0.0);
/// assert_eq!(system.evaluate(0.3), -system.evaluate(-0.3));
/// assert!((system.evaluate(5.0) + 1.0).abs() < 2e-3);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scaled<T, E> {
    system: E,
    input_range: (T, T),
    input_middle: T,
    steps_per_unit: T,
    output_middle: T,
    unit_per_step: T,
}

impl<T: Real, E: Evaluate> Scaled<T, E> {
    /// Puts a system between the ranges it was compiled for.
    ///
    /// # Errors
    /// [`FuzzyError::NonFinite`] or [`FuzzyError::Inverted`] for a range (`input_range`, `output_range`), [`FuzzyError::OutOfRange`] for
    /// an input range too narrow to be divided into steps.
    pub fn try_new(system: E, input_range: (T, T), output_range: (T, T)) -> Result<Self, FuzzyError> {
        let (input_middle, input_half) = middle_and_half(input_range, "input_range")?;
        let (output_middle, output_half) = middle_and_half(output_range, "output_range")?;
        let steps = T::from_u32(32768);
        let steps_per_unit = steps / input_half;
        if !steps_per_unit.is_finite() {
            return Err(FuzzyError::OutOfRange("input_range"));
        }
        let unit_per_step = output_half / steps;
        Ok(Self { system, input_range, input_middle, steps_per_unit, output_middle, unit_per_step })
    }

    /// The system behind it.
    #[must_use]
    pub const fn system(&self) -> &E {
        &self.system
    }
}

impl<T: Real, E: Evaluate> FuzzySystem<T> for Scaled<T, E> {
    #[inline]
    fn evaluate(&self, x: T) -> T {
        let u = (x - self.input_middle) * self.steps_per_unit;
        let magnitude = magnitude_in_steps(u);
        // At most 32767, so that it has a negative.
        let q = if u < T::ZERO { magnitude.wrapping_neg() } else { magnitude };
        let y = if u.abs() >= T::ZERO { self.system.evaluate(q) } else { 0 };
        let size = T::from_u32(u32::from(y.unsigned_abs())) * self.unit_per_step;
        if y < 0 { self.output_middle - size } else { self.output_middle + size }
    }

    fn input_range(&self) -> (T, T) {
        self.input_range
    }
}

/// A magnitude rounded to whole steps and held to 32767.
#[inline]
fn magnitude_in_steps<T: Real>(u: T) -> i16 {
    // A NaN fails the comparison of `min` and becomes the largest one, and is answered apart.
    let (whole, _) = (u.abs().min(T::from_u32(MOST)) + T::HALF).split_index();
    i16::try_from(whole).unwrap_or(i16::MAX)
}

fn middle_and_half<T: Real>((lo, hi): (T, T), name: &'static str) -> Result<(T, T), FuzzyError> {
    crate::fuzzy::tables::check_range((lo, hi), name)?;
    Ok((T::HALF * lo + T::HALF * hi, T::HALF * hi - T::HALF * lo))
}
