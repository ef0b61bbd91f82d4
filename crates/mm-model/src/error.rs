//! Why parameters were refused.

use core::fmt;

/// Why a parameter was refused. The payload is the parameter's name, with its unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ParamError {
    /// The number is infinite or NaN.
    NonFinite(&'static str),
    /// The number has to be above zero.
    NonPositive(&'static str),
    /// The number has to be zero or above.
    Negative(&'static str),
    /// The number lies outside the range that its documentation gives.
    OutOfRange(&'static str),
    /// The lower bound is not below the upper one.
    Inverted(&'static str),
    /// The mass matrix would not be positive definite in some posture, for want of this inertia.
    NotPositiveDefinite(&'static str),
}

impl ParamError {
    /// Name of the parameter, with its unit.
    #[must_use]
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::NonFinite(name)
            | Self::NonPositive(name)
            | Self::Negative(name)
            | Self::OutOfRange(name)
            | Self::Inverted(name)
            | Self::NotPositiveDefinite(name) => name,
        }
    }

    /// What is expected of the parameter, as the end of "must ...".
    #[must_use]
    pub const fn expectation(&self) -> &'static str {
        match self {
            Self::NonFinite(_) => "be a finite number",
            Self::NonPositive(_) => "be above zero",
            Self::Negative(_) => "be zero or above",
            Self::OutOfRange(_) => "lie in its documented range",
            Self::Inverted(_) => "have its lower bound below its upper bound",
            Self::NotPositiveDefinite(_) => "be above zero for the mass matrix to be positive definite",
        }
    }
}

impl fmt::Display for ParamError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} must {}", self.parameter(), self.expectation())
    }
}

impl core::error::Error for ParamError {}

/// Checks shared by everything that parses parameters.
pub mod check {
    use super::ParamError;
    use crate::Real;

    /// Passes a finite number.
    ///
    /// # Errors
    /// [`ParamError::NonFinite`] otherwise.
    pub fn finite<T: Real>(value: T, name: &'static str) -> Result<T, ParamError> {
        if value.is_finite() { Ok(value) } else { Err(ParamError::NonFinite(name)) }
    }

    /// Passes a finite number above zero whose reciprocal is finite too.
    ///
    /// # Errors
    /// [`ParamError::NonFinite`] or [`ParamError::NonPositive`] otherwise.
    pub fn positive<T: Real>(value: T, name: &'static str) -> Result<T, ParamError> {
        let divides = finite(value, name)? > T::ZERO && (T::ONE / value).is_finite();
        if divides { Ok(value) } else { Err(ParamError::NonPositive(name)) }
    }

    /// Passes a finite number that is zero or above.
    ///
    /// # Errors
    /// [`ParamError::NonFinite`] or [`ParamError::Negative`] otherwise.
    pub fn non_negative<T: Real>(value: T, name: &'static str) -> Result<T, ParamError> {
        if finite(value, name)? >= T::ZERO { Ok(value) } else { Err(ParamError::Negative(name)) }
    }
}
