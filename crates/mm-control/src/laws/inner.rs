//! What every inner law is: a force for the tracking problem of an instant.

use mm_model::{Mechanism, Real, Robot, Velocity};

use super::{Drive, LawMemory, RobustForce, Tracking};

/// An inner law, as [`ControlStack`](crate::ControlStack) takes it.
///
/// [`Law`](super::Law) is one of all that are here, chosen while the program runs. Firmware that needs one law names its type instead and
/// links that one alone: `ControlStack<f32, 3, Bfsmc<f32, 3, Surface<f32, 65>>>`. A law of a user's own implements one of the first two
/// methods and gets outer loop, observer, limits and supervisor with it.
///
/// A law keeps no state in itself: what it remembers it returns in [`Drive::memory`], which the stack drops while a torque is limited.
pub trait InnerLaw<T: Real, const N: usize>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The force that a switching law opposes to the sliding variable, on top of the equivalent control; none for a law that is no function
    /// of s alone.
    #[must_use]
    #[inline(always)]
    fn switching_force(&self, _s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        None
    }

    /// The force that the law applies, before the learned part of a momentum observer and the limits; asked of a law without
    /// [`switching_force`](Self::switching_force) only.
    #[must_use]
    fn drive(&self, at: &Tracking<'_, T, N>, _memory: &LawMemory<T, N>) -> Drive<T, N> {
        at.switching(self.switching_force(&at.sliding).unwrap_or_else(RobustForce::zero))
    }

    /// Whether the law is to be used with the momentum observer, if that has a bandwidth.
    #[must_use]
    #[inline]
    fn learns(&self) -> bool {
        false
    }
}
