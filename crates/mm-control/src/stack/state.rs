//! What a stack remembers, and what it is made of.

use mm_model::Velocity;

use crate::estimator::{Estimator, Memory};
use crate::laws::{Gains, LawMemory};
use crate::observer::ObserverState;
use crate::outer::OuterParams;

/// What the stack remembers between updates.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: mm_model::Real + serde::Deserialize<'de>"
    ))
)]
pub struct ControlState<T, const N: usize> {
    /// integral(nu - nu_c).
    pub(super) integral: Velocity<T, N>,
    pub(super) observer: ObserverState<T, N>,
    pub(super) memory: LawMemory<T, N>,
    /// Whether the observer holds for one update: the last torque was limited, or another stack took over.
    pub(super) held: bool,
    /// Updates done, counted up to where the outer loop has released the base.
    pub(super) updates: u32,
    pub(super) estimator: Memory<T, N>,
}

/// Parameters of the stack, not yet checked.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: mm_model::Real + serde::Deserialize<'de>"
    ))
)]
pub struct StackParams<T, const N: usize> {
    /// Time between two updates, s.
    pub period: T,
    /// Outer loop and sliding surface.
    pub outer: OuterParams<T, N>,
    /// Inner gains.
    pub gains: Gains<T, N>,
    /// How the velocity is found from measured positions; for [`ControlStack::update_measured`](super::ControlStack::update_measured).
    pub estimator: Estimator<T>,
}
