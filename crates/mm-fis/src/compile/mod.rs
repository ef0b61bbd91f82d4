//! The compiler: from a fuzzy system to tables for machines without a floating-point unit.
//!
//! ```text
//! System --Q15::compile----------------> rule engine in fixed point   piecewise-linear Mamdani systems
//! any f(x), f(x, y) --CompiledSurface--> table of knots               every system, within a bound
//! ```

mod emit1;
mod emit2;
mod emit_q15;
mod error;
mod fit;
mod function;
mod jumps;
mod q15;
mod reach;
mod request;
mod row;
mod steps;
mod surface1;
mod surface2;
mod table;
mod text;

pub use error::CompileError;
pub use jumps::Jump;
pub use q15::{OutputRow, OwnedRule, OwnedTrigger, Q15};
pub use request::Request;
pub use row::Shape as SlotShape;
pub use steps::value_of;
pub use surface1::CompiledSurface;
pub use surface2::CompiledSurface2;
pub use table::{Language, Table, TableError, quantized};
pub use text::Origin;

fn unsupported(part: impl Into<String>, reason: &'static str) -> CompileError {
    CompileError::Unsupported { part: part.into(), reason }
}
