//! Reads FCL, the Fuzzy Control Language of IEC 61131-7.

mod block;
mod build;
mod condition;
mod describe;
mod expand;
mod function;
mod names;
mod parser;
mod points;
mod range;
mod term;
mod token;

use crate::read::Report;
use crate::{Document, ReadError};

/// Reads a function block in the Fuzzy Control Language of IEC 61131-7, as jFuzzyLogic and fuzzylite write it.
///
/// # Errors
/// [`ReadError`] with every problem of the text, each with its place.
pub fn read_fcl(text: &str) -> Result<Document, ReadError> {
    let (mut report, mut notes) = (Report::new(), Report::new());
    let tokens = token::tokens(text, &mut report);
    let mut parser = parser::Parser::new(text, tokens);
    let block = block::block(&mut parser, &mut report);
    let system = block.and_then(|block| build::system(&block, &mut report, &mut notes));
    let system = report.finish(text, system)?;
    Ok(Document { system, notes: notes.locate(text) })
}
