//! What is wrong with a text, where, and how it should be.

use std::fmt;
use std::ops::Range;

/// One thing that is wrong with a text, or worth a remark.
///
/// Displays as one line: `line 7, column 12: ...`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    pub(super) span: Range<usize>,
    pub(super) line: usize,
    pub(super) column: usize,
    pub(super) message: String,
    pub(super) expected: Option<String>,
    pub(super) nearest: Option<String>,
}

impl Problem {
    /// The bytes of the text that the problem is at: within the text, on character boundaries, never past the end of its
    /// line; empty where something is missing.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Line, from 1.
    #[must_use]
    pub const fn line(&self) -> usize {
        self.line
    }

    /// Column in characters, from 1.
    #[must_use]
    pub const fn column(&self) -> usize {
        self.column
    }

    /// What was found.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What would have been right.
    #[must_use]
    pub fn expected(&self) -> Option<&str> {
        self.expected.as_deref()
    }

    /// The known name nearest to an unknown one.
    #[must_use]
    pub fn nearest(&self) -> Option<&str> {
        self.nearest.as_deref()
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)?;
        if let Some(expected) = &self.expected {
            write!(f, "; expected {expected}")?;
        }
        if let Some(nearest) = &self.nearest {
            write!(f, "; the nearest known name is `{nearest}`")?;
        }
        Ok(())
    }
}

/// Why a text was refused.
///
/// Displays one line a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ReadError {
    pub(super) problems: Vec<Problem>,
    pub(super) left_off: usize,
}

impl ReadError {
    /// The problems, at least one, in the order of their places; of a text with very many, the first hundred found.
    #[must_use]
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// How many problems there are beyond [`problems`](Self::problems).
    #[must_use]
    pub const fn left_off(&self) -> usize {
        self.left_off
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                f.write_str("\n")?;
            }
            write!(f, "{problem}")?;
        }
        match self.left_off {
            0 => Ok(()),
            more => write!(f, "\nand {more} more"),
        }
    }
}

impl std::error::Error for ReadError {}
