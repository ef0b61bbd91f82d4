//! Fuzzy systems from files, for the engines of [`mm_control::fuzzy`].
//!
//! ```text
//! .fis, .fcl --read--> System --with_engine--> Mamdani, Sugeno     evaluate
//!                        | \---write---> .fis
//!                        \---compile--> Rust, C, TOML              fixed-point tables for firmware
//! ```

mod engine;
mod system;

pub use engine::{Accuracy, Engine};
pub use system::{Defuzzification, Kind, Rule, Shape, System, Term, Variable};
