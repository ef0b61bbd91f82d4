//! The two precisions that a target can compute in.

use mm_control::fuzzy::Bundled;
use serde::{Serialize, de::DeserializeOwned};

use crate::Kind;

/// A number that stacks compute in and frames carry: `f32` or `f64`.
pub trait Scalar: Bundled + Serialize + DeserializeOwned {
    /// The frame that carries a setup of such numbers.
    const SETUP: Kind;
    /// The frame that carries a tick.
    const TICK: Kind;
    /// The frame that carries a command.
    const COMMAND: Kind;
    /// Hands the number's bytes to `take`, lowest first.
    fn each_byte(self, take: impl FnMut(&[u8]));
}

impl Scalar for f32 {
    const SETUP: Kind = Kind::Setup32;
    const TICK: Kind = Kind::Tick32;
    const COMMAND: Kind = Kind::Command32;
    fn each_byte(self, mut take: impl FnMut(&[u8])) {
        take(&self.to_le_bytes());
    }
}

impl Scalar for f64 {
    const SETUP: Kind = Kind::Setup64;
    const TICK: Kind = Kind::Tick64;
    const COMMAND: Kind = Kind::Command64;
    fn each_byte(self, mut take: impl FnMut(&[u8])) {
        take(&self.to_le_bytes());
    }
}
