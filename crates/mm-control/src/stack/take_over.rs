//! Other gains while the robot moves: one stack goes on where another was.

use mm_model::{Mechanism, Real, Robot};

use super::{ControlStack, ControlState};
use crate::laws::InnerLaw;
use crate::observer::ObserverState;

impl<T: Real, const N: usize, L: InnerLaw<T, N>> ControlStack<T, N, L>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Makes the memory of another stack this one's, before its first update with it.
    ///
    /// Integrators, estimator and the memory of a law of the same kind stay as they are. The observer keeps its d_hat, which under another
    /// bandwidth or robot stands for one update: it is stored as momentum, d_hat/L, so that taking it as it is would multiply d_hat by the ratio
    /// of the bandwidths and push the robot. A stack that does not learn, or takes over from one that did not, has learned nothing.
    ///
    /// For the same observer the memory stays as it is, bit by bit.
    pub fn take_over(&self, state: &mut ControlState<T, N>, from: &Self) {
        match (&self.observer, &from.observer) {
            (Some(to), Some(of)) if to.bandwidth == of.bandwidth && self.robot == from.robot => {}
            // As after an update whose torque was limited: d_hat holds and its momentum is found anew.
            (Some(_), Some(_)) => state.held = true,
            _ => state.observer = ObserverState::initial(),
        }
    }
}
