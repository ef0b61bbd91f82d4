//! Fuzzy inference without allocation: Mamdani and Sugeno systems over borrowed tables, and tables made from them.
//!
//! ```text
//! MamdaniTables --try_new--> Mamdani ---------> outputs       any number of inputs and outputs
//! (a const in flash,         Curve ----------> one number     one input, one output
//! or a parsed file)            \--from_engine--> Surface      uniform knots: a lookup
//! SugenoTables ---try_new--> Sugeno ----------> outputs
//! ```
//!
//! | item | role |
//! |---|---|
//! | [`MembershipFunction`] | a linguistic term: triangle, trapezoid, Gaussian and ten more shapes |
//! | [`Variable`], [`Rule`], [`MamdaniTables`], [`SugenoTables`] | a system, borrowed |
//! | [`Operators`], [`Defuzzifier`], [`Sampling`] | how it infers |
//! | [`Mamdani`], [`Sugeno`], [`Inference`] | the checked engines, and what they met |
//! | [`Curve`] | a Mamdani engine as a function of one number |
//! | [`Surface`] | the same map from a table of knots, for a fast loop |
//! | [`FuzzySystem`] | what these have in common, for a control law that takes either |
//! | [`THESIS`] | the rule base printed in Appendix C of the thesis |
//! | [`SMOOTH`] | a monotone one without a jump, the default of the control law |
//!
//! Sign: both rule bases oppose their input, a positive sliding variable gives a negative output.
//!
//! Not modelled: scaling of input and output (a matter of the control law that uses the engine), type-2 sets,
//! custom membership functions.

mod activation;
mod bundled;
mod curve;
mod engine;
mod error;
mod exact;
mod firing;
pub mod fixed;
mod membership;
mod sampled;
mod smooth;
mod smooth_knots;
mod sugeno;
mod surface;
mod tables;
mod thesis;

pub use bundled::Bundled;
pub use curve::{Curve, FuzzySystem};
pub use engine::Mamdani;
pub use error::FuzzyError;
pub use membership::MembershipFunction;
pub use smooth::{SMOOTH, SMOOTH_F32, SMOOTH_Q32};
pub use sugeno::Sugeno;
pub use surface::Surface;
pub use tables::{
    Aggregation, And, Connective, Consequent, Defuzzifier, Implication, Inference, MamdaniTables, Operators,
    Or, Rule, Sampling, SugenoOutput, SugenoTables, SugenoVariable, Variable,
};
pub use thesis::{THESIS, THESIS_F32, THESIS_Q32};
