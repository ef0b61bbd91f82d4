//! Why a controller refused its parameters or an update.

use core::fmt;

use mm_model::ParamError;

use crate::fuzzy::FuzzyError;

/// Why the parameters of a controller were refused.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum SetupError {
    /// A number of the robot or of the controller; the payload names it.
    Param(ParamError),
    /// The rule base of a fuzzy part.
    Fuzzy(FuzzyError),
    /// The Riccati equation of `lqr` was not solved: its weights are too far apart.
    Riccati,
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Param(error) => error.fmt(f),
            Self::Fuzzy(error) => write!(f, "fuzzy rule base: {error}"),
            Self::Riccati => {
                f.write_str("the Riccati equation was not solved: acceptable values too far apart")
            }
        }
    }
}

impl core::error::Error for SetupError {}

impl From<ParamError> for SetupError {
    fn from(error: ParamError) -> Self {
        Self::Param(error)
    }
}

impl From<FuzzyError> for SetupError {
    fn from(error: FuzzyError) -> Self {
        Self::Fuzzy(error)
    }
}

/// Why an update was refused. The controller's state is as it was before the call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ControlError {
    /// The input named by the payload is infinite or NaN.
    NonFinite(&'static str),
    /// The torque computed from finite inputs, or the state after it, is infinite or NaN: the inputs are absurdly large.
    Overflow,
    /// A measurement was given to a stack that has no estimator.
    NoEstimator,
}

impl fmt::Display for ControlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite(input) => write!(f, "{input} is infinite or not a number"),
            Self::Overflow => f.write_str("the torque overflowed: an input is far beyond any robot"),
            Self::NoEstimator => {
                f.write_str("the stack has no estimator: it cannot take a measurement alone")
            }
        }
    }
}

impl core::error::Error for ControlError {}
