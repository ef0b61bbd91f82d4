//! What the readers have in common: the document they return and how they report.

mod error;
mod nearest;
mod source;

pub use error::{Problem, ReadError};
pub(crate) use nearest::nearest;
pub(crate) use source::{Piece, Report};

use crate::System;

/// A system as read, with remarks on the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// The system; an engine takes it.
    pub system: System,
    /// Where the engine does not do what the text says although the system can be used: to be shown as warnings.
    pub notes: Vec<Problem>,
}
