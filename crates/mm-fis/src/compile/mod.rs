//! The compiler: from a fuzzy system to tables for machines without a floating-point unit.

mod error;
mod q15;
mod row;
mod steps;

pub use error::CompileError;
pub use q15::{OutputRow, OwnedRule, OwnedTrigger, Q15};
pub use row::Shape as SlotShape;

fn unsupported(part: impl Into<String>, reason: &'static str) -> CompileError {
    CompileError::Unsupported { part: part.into(), reason }
}
