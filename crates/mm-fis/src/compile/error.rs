//! Why a system could not be compiled.

use mm_control::fuzzy::FuzzyError;

/// Why a system could not be compiled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CompileError {
    /// The rule engine in fixed point has no place for a part of the system; a surface has.
    #[error("the Q15 engine cannot take {part}: {reason}; a compiled surface of one or two inputs can")]
    Unsupported {
        /// The part, with its name.
        part: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// The system itself is refused.
    #[error("the system is refused: {0}")]
    System(#[from] FuzzyError),
    /// The request makes no sense.
    #[error("`{name}` is {value}: expected {expected}")]
    Request {
        /// Which number.
        name: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        expected: &'static str,
    },
    /// The function gave no finite number.
    #[error("the system gives {value} at {at:?}: a table can hold finite numbers only")]
    NotFinite {
        /// Where.
        at: Vec<f64>,
        /// What it gave.
        value: f64,
    },
    /// No table within the limit on knots, at the resolution of the output, meets the bound.
    #[error("no table of at most {max_knots} knots meets the bound {bound:e}; {reachable:e} can be met")]
    Bound {
        /// What was asked for, in output units.
        bound: f64,
        /// A bound that is met, all else being the same, in output units; it has two decimal digits and was tried.
        reachable: f64,
        /// The limit on knots.
        max_knots: usize,
    },
    /// The limit on knots is below what any table takes.
    #[error("no table has at most {max_knots} knots: it takes {least}")]
    Knots {
        /// The limit on knots.
        max_knots: usize,
        /// How many the smallest table has.
        least: usize,
    },
    /// A generated file could not be read back.
    #[error("{0}")]
    Read(String),
}
