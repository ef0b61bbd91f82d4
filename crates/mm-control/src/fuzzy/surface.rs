//! A fuzzy system as a table of knots, for a loop that cannot afford the rules.

use super::{FuzzyError, FuzzySystem};
use mm_model::Real;

/// A piecewise-linear table of a fuzzy system over its input range, of `KNOTS` equally spaced knots.
///
/// Equation: with `u = (x - middle) / step` and `i = floor(|u|)`, `y = y_i + (|u| - i) (y_(i+1) - y_i)`, the knots
/// counted from the middle one towards the side of `x`.
///
/// Convention: `KNOTS` is odd, so that one knot lies in the middle of the range and counting starts there: a
/// table of an odd map is exactly odd, and exactly 0 in the middle. Outside the range the knot at the end
/// holds; a NaN gives what the system gives for it.
///
/// Cost: one multiplication into the table, two loads, one interpolation; `KNOTS + 5` numbers of memory.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH_F32, Surface};
///
/// let surface = Surface::<f32, 65>::from_engine(&Curve::<f32>::try_new(&SMOOTH_F32)?)?;
/// assert_eq!(surface.evaluate(0.0), 0.0);
/// assert_eq!(surface.evaluate(0.3), -surface.evaluate(-0.3));
/// assert_eq!(surface.evaluate(7.0), surface.evaluate(1.0));
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Surface<T, const KNOTS: usize> {
    knots: [T; KNOTS],
    lo: T,
    hi: T,
    middle: T,
    per_step: T,
    /// Distance from the middle to either end, in steps.
    reach: T,
    at_nan: T,
}

impl<T: Real, const KNOTS: usize> Surface<T, KNOTS> {
    const CENTRE: usize = KNOTS / 2;

    /// Tabulates `engine` over its input range.
    ///
    /// Cost: `KNOTS` evaluations of the engine.
    ///
    /// # Errors
    /// [`FuzzyError::OutOfRange`] (`knots`) unless `KNOTS` is odd and at least 3; [`FuzzyError::NonFinite`]
    /// (`input_range`, `engine`) or [`FuzzyError::Inverted`] (`input_range`) for a system that is no proper one.
    pub fn from_engine<E: FuzzySystem<T>>(engine: &E) -> Result<Self, FuzzyError> {
        let (lo, hi) = engine.input_range();
        let (middle, half) = Self::checked((lo, hi))?;
        let reach = Self::reach();
        let mut knots = [T::ZERO; KNOTS];
        let mut steps_from_middle = -reach;
        for knot in &mut knots {
            let x = middle + half * (steps_from_middle / reach);
            *knot = engine.evaluate(x.clamp_to(lo, hi));
            if !knot.is_finite() {
                return Err(FuzzyError::NonFinite("engine"));
            }
            steps_from_middle += T::ONE;
        }
        let at_nan = engine.evaluate(T::from_f64(f64::NAN));
        if !at_nan.is_finite() {
            return Err(FuzzyError::NonFinite("engine"));
        }
        Ok(Self { knots, lo, hi, middle, per_step: reach / half, reach, at_nan })
    }

    /// The table of known knots over a range of inputs; a NaN gives the one in the middle.
    ///
    /// # Errors
    /// As [`from_engine`](Self::from_engine), `knots` for one that is infinite or NaN.
    pub fn from_knots(knots: &[T; KNOTS], (lo, hi): (T, T)) -> Result<Self, FuzzyError> {
        let (middle, half) = Self::checked((lo, hi))?;
        let reach = Self::reach();
        if !knots.iter().all(|knot| knot.is_finite()) {
            return Err(FuzzyError::NonFinite("knots"));
        }
        let at_nan = knots.get(Self::CENTRE).copied().unwrap_or(T::ZERO);
        Ok(Self { knots: *knots, lo, hi, middle, per_step: reach / half, reach, at_nan })
    }

    /// Middle and half width of the range of a table that can be.
    fn checked((lo, hi): (T, T)) -> Result<(T, T), FuzzyError> {
        if KNOTS < 3 || KNOTS.is_multiple_of(2) {
            return Err(FuzzyError::OutOfRange("knots"));
        }
        if !(lo.is_finite() && hi.is_finite()) {
            return Err(FuzzyError::NonFinite("input_range"));
        }
        if lo >= hi {
            return Err(FuzzyError::Inverted("input_range"));
        }
        Ok((T::HALF * lo + T::HALF * hi, T::HALF * hi - T::HALF * lo))
    }

    /// The distance from the middle to either end, in steps.
    fn reach() -> T {
        (0..Self::CENTRE).fold(T::ZERO, |n, _| n + T::ONE)
    }

    /// The knots from the lower to the upper end of the input range.
    #[must_use]
    pub const fn knots(&self) -> &[T; KNOTS] {
        &self.knots
    }

    /// Smallest output.
    #[must_use]
    pub fn min_output(&self) -> T {
        self.knots.iter().copied().reduce(T::min).unwrap_or(T::ZERO)
    }

    /// Largest output.
    #[must_use]
    pub fn max_output(&self) -> T {
        self.knots.iter().copied().reduce(T::max).unwrap_or(T::ZERO)
    }

    /// Largest magnitude of the slope between two neighbouring knots, in output per input.
    ///
    /// A Lipschitz constant of the table: `|y(p) - y(r)| <= slope_bound |p - r|` up to rounding.
    #[must_use]
    pub fn slope_bound(&self) -> T {
        let pairs = self.knots.iter().zip(self.knots.iter().skip(1));
        self.per_step * pairs.fold(T::ZERO, |most, (left, right)| most.max((*right - *left).abs()))
    }
}

impl<T: super::Bundled> Surface<T, 65> {
    /// The default surface of the control law: [`SMOOTH`](super::SMOOTH) tabulated, from knots in flash.
    ///
    /// # Errors
    /// None in practice: the knots are proper.
    pub fn smooth() -> Result<Self, FuzzyError> {
        Self::from_knots(T::SMOOTH_KNOTS, (-T::ONE, T::ONE))
    }
}

impl<T: Real, const KNOTS: usize> FuzzySystem<T> for Surface<T, KNOTS> {
    #[inline]
    fn evaluate(&self, x: T) -> T {
        let u = (x - self.middle) * self.per_step;
        let distance = u.abs().min(self.reach);
        let (i, fraction) = distance.split_index();
        // Past either end there is no knot, whichever way the index wraps.
        let (near, far) = if u >= T::ZERO {
            (Self::CENTRE.wrapping_add(i), Self::CENTRE.wrapping_add(i).wrapping_add(1))
        } else if u < T::ZERO {
            (Self::CENTRE.wrapping_sub(i), Self::CENTRE.wrapping_sub(i).wrapping_sub(1))
        } else {
            return self.at_nan;
        };
        match (self.knots.get(near), self.knots.get(far)) {
            (Some(&from), Some(&to)) => from + fraction * (to - from),
            (Some(&end), None) => end,
            _ => T::ZERO,
        }
    }

    fn input_range(&self) -> (T, T) {
        (self.lo, self.hi)
    }
}
