//! Fuzzy systems from files, for the engines of [`mm_control::fuzzy`].
//!
//! ```text
//! .fis, .fcl --read--> System --with_engine--> Mamdani, Sugeno     evaluate
//!                        | \---write---> .fis
//!                        \---compile--> Rust, C, TOML              fixed-point tables for firmware
//! ```

mod bundled;
pub mod check;
pub mod compile;
mod coverage;
mod engine;
mod fcl;
mod fis;
mod read;
mod system;
mod write;

pub use bundled::{bundled, bundled_text};
pub use engine::{Accuracy, Engine};
pub use fcl::read_fcl;
pub use fis::read_fis;
pub use read::{Document, Problem, ReadError, read};
pub use system::{Defuzzification, Kind, Rule, Shape, System, Term, Variable};
pub use write::write_fis;
