//! The two precisions that a target can compute in.

use mm_control::fuzzy::Bundled;
use serde::{Serialize, de::DeserializeOwned};

/// A number that stacks compute in and frames carry: `f32` or `f64`.
pub trait Scalar: Bundled + Serialize + DeserializeOwned {}

impl Scalar for f32 {}
impl Scalar for f64 {}
