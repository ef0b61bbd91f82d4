//! Fuzzy inference for machines without a floating-point unit: whole numbers from the input to the output.
//!
//! ```text
//! system --compile--> Tables   --try_new--> Engine, Curve     rules, within 2 units of the exact centroid
//!         (mm-fis) -> Surface1                                a table of knots for one input, within the bound asked for
//!                  -> Surface2                                the same for two
//! ```
//!
//! | item | role |
//! |---|---|
//! | [`Tables`], [`Trigger`], [`Term`], [`Rule`], [`Slot`] | a rule base |
//! | [`Engine`] | the checked engine, any number of inputs and outputs |
//! | [`Curve`] | the engine as a function of one number |
//! | [`Surface1`], [`Surface2`] | tables of knots |
//! | [`Scaled`] | any of them between floating-point numbers, for a control law |
//! | [`THESIS_Q15`], [`SMOOTH_Q15`], [`THESIS_SURFACE`], [`SMOOTH_SURFACE`] | the shipped rule bases, compiled |
//! | [`Evaluate`] | what curves and surfaces of one input have in common |
//!
//! Units: an input or output is an `i16` q that stands for `middle + half q / 32768` of its range.
//!
//! Every operation names its overflow rule: `wrapping_`, `saturating_`, `checked_`, or a plain operator with the bound that keeps it from
//! overflowing, which the dev profile checks in every test.
#![deny(clippy::arithmetic_side_effects, clippy::as_conversions, clippy::float_arithmetic)]

mod bundled;
mod curve;
mod engine;
mod firing;
mod grade;
mod scaled;
mod slot;
mod slow;
mod surface1;
mod surface2;
mod term;

pub use bundled::{SMOOTH_Q15, SMOOTH_SURFACE, THESIS_Q15, THESIS_SURFACE};
pub use curve::{Curve, Evaluate};
pub use engine::{Engine, Premise, Rule, Tables, Trigger};
pub use scaled::Scaled;
pub use slot::Slot;
pub use surface1::{Section, Surface1};
pub use surface2::Surface2;
pub use term::Term;
