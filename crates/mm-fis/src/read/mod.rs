//! What the readers have in common: the document they return and how they report.

mod error;
mod nearest;
mod source;

pub use error::{Problem, ReadError};
pub(crate) use nearest::nearest;
pub(crate) use source::{Piece, Report, one_of};

use crate::System;

/// A system as read, with remarks on the text.
#[derive(Debug, Clone, PartialEq)]
pub struct Document {
    /// The system; an engine takes it.
    pub system: System,
    /// Where the engine does not do what the text says although the system can be used: to be shown as warnings.
    pub notes: Vec<Problem>,
}

/// Reads a `.fis` or FCL text: by the ending of `name` where it is `.fis` or `.fcl`, else by what it starts with.
///
/// # Errors
/// As [`read_fis`](crate::read_fis) and [`read_fcl`](crate::read_fcl).
pub fn read(name: &str, text: &str) -> Result<Document, ReadError> {
    let ending = name.rsplit_once('.').map(|(_, ending)| ending.to_lowercase());
    let fcl = match ending.as_deref() {
        Some("fcl") => true,
        Some("fis") => false,
        _ => {
            // Whichever comes first; in a comment neither is likely.
            let block = text.to_ascii_uppercase().find("FUNCTION_BLOCK");
            block.is_some_and(|block| text.find('[').is_none_or(|section| block < section))
        }
    };
    if fcl { crate::read_fcl(text) } else { crate::read_fis(text) }
}
