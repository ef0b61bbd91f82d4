//! All experiments of section 3.7 and chapter 5 of the thesis, with their figures and its numbers beside ours.
//!
//! ```text
//! catalogue: experiments, figures, claims --plan--> runs, loaded and built --run--> data, figures, tables in a folder
//! ```
//! Adding a figure, a run or a row of the table is one line of the catalogue. Runs share the cores; what they give does not
//! depend on how many there are.

mod catalogue;
mod claims;
mod draw;
mod files;
mod measure;
mod report;
mod work;

pub use catalogue::{EXPERIMENTS, Experiment, FIGURES, Figure};
pub(crate) use claims::TABLE_5_2;
pub use measure::{Axis, Measure};
pub use report::{FigureFile, Report, Row, RunReport, SCHEMA};
pub use work::{Options, Plan, ReproduceError, Watch};
