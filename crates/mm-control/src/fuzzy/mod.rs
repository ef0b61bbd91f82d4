//! Fuzzy inference: Mamdani rule tables, their exact centroid, and a lookup table of the result.
//!
//! ```text
//! MamdaniTables --try_new--> Mamdani --from_engine--> Surface
//! (const arrays              (min, max and            (uniform knots:
//! in flash)                  exact centroid)          a lookup)
//! ```
//!
//! | item | role |
//! |---|---|
//! | [`MembershipFunction`] | a linguistic term: the trapezoid (a, b, c, d) |
//! | [`Rule`], [`MamdaniTables`], [`RuleBase`] | the rule table, borrowed or owned |
//! | [`Mamdani`] | the checked engine, one input to one output |
//! | [`Surface`] | the same map from a table of knots, for a fast loop |
//! | [`FuzzySystem`] | what both have in common, for a control law that takes either |
//! | [`THESIS`] | the rule base printed in Appendix C of the thesis |
//! | [`SMOOTH`] | a monotone one without a jump, the default of the control law |
//!
//! Sign: both rule bases oppose their input, a positive sliding variable gives a negative output.
//!
//! Not modelled: several inputs or outputs, Sugeno consequents, membership functions other than trapezoids,
//! scaling of input and output (a matter of the control law that uses the engine).

mod centroid;
mod engine;
mod error;
mod membership;
mod smooth;
mod surface;
mod thesis;

pub use engine::{FuzzySystem, MAX_OUTPUT_TERMS, Mamdani, MamdaniTables, Rule, RuleBase};
pub use error::FuzzyError;
pub use membership::MembershipFunction;
pub use smooth::SMOOTH;
pub use surface::Surface;
pub use thesis::THESIS;
