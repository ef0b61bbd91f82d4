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
/// Points become triangles, trapezoids and shoulders; `COG`, `COA`, `MM` centroid, bisector and mean of maximum; `LM` and `RM`, over a
/// range on one side of 0, the smallest and the largest of maximum; `COGS` a Sugeno system. Of AND and OR, one that is said alone
/// brings its pair by De Morgan's law. A condition with brackets becomes several rules where their largest strength is
/// that of the condition: `OR : MAX`, `ACCU : MAX`, sets.
///
/// Noted, where the engine does otherwise: a `DEFAULT` other than the middle of the range, unless some rule always fires; a
/// missing METHOD or ACCU; AND and OR that are no pair; a singleton outside its RANGE.
///
/// Refused with its place: other polygons, shapes, operators and methods; rules that share a singleton unless `ACCU` adds;
/// an AND behind an OR without brackets, which tools read in two ways; hedges; several function blocks; what is misspelt. The file
/// `docs/fis.md` has the whole list.
///
/// # Errors
/// [`ReadError`] with every problem of the text.
///
/// # Source
/// IEC 61131-7:2000, Programmable controllers, Fuzzy control programming. P. Cingolani, J. Alcala-Fdez, jFuzzyLogic, Int. J.
/// Computational Intelligence Systems 6 (2013) 61-75.
///
/// # Examples
/// ```
/// let text = "FUNCTION_BLOCK fan VAR_INPUT t : REAL; END_VAR VAR_OUTPUT v : REAL; END_VAR
///     FUZZIFY t TERM cold := (10, 1) (30, 0); TERM hot := (10, 0) (30, 1); END_FUZZIFY
///     DEFUZZIFY v TERM off := 0; TERM on := 100; METHOD : COGS; END_DEFUZZIFY
///     RULEBLOCK r ACCU : MAX;
///       RULE 1 : IF t IS cold THEN v IS off; RULE 2 : IF t IS hot THEN v IS on;
///     END_RULEBLOCK END_FUNCTION_BLOCK";
/// let system = mm_fis::read_fcl(text)?.system;
/// assert_eq!(system.inputs[0].range, (10.0, 30.0));
/// # Ok::<(), mm_fis::ReadError>(())
/// ```
pub fn read_fcl(text: &str) -> Result<Document, ReadError> {
    let (mut report, mut notes) = (Report::new(), Report::new());
    let tokens = token::tokens(text, &mut report);
    let mut parser = parser::Parser::new(text, tokens);
    let block = block::block(&mut parser, &mut report);
    let system = block.and_then(|block| build::system(&block, &mut report, &mut notes));
    let system = report.finish(text, system)?;
    Ok(Document { system, notes: notes.locate(text) })
}
