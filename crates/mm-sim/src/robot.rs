//! Robots from and to URDF.
//!
//! The model is a base on two driven wheels with a yaw-pitch-pitch arm. [`import`] finds these in the tree of a URDF, whatever its links
//! are called and however its joints are turned, and says what of the file the model has no place for; [`export`] writes
//! one for viewers and other simulators.

mod assemble;
mod elements;
mod export;
mod import;
mod place;
mod tree;

pub use export::{export, left_out};
pub use import::{ImportOptions, Imported, import};
pub use place::UrdfError;
