//! What a supervisor needs of the stack besides its update.

use mm_model::{Configuration, Force, Mechanism, Real, Robot, Torque, Velocity};

use super::checks::supervise;
use super::{ControlStack, ControlState};
use crate::estimator::{Estimate, Measurement, Memory};
use crate::laws::InnerLaw;
use crate::{ControlError, Input, Output, Reference};

impl<T: Real, const N: usize> ControlState<T, N> {
    /// What is learned of the forces that the model misses, on the side of the applied force.
    pub(crate) const fn learned(&self) -> &Force<T, N> {
        self.observer.learned()
    }
}

impl<T: Real, const N: usize, L: InnerLaw<T, N>> ControlStack<T, N, L>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Update period, s.
    pub(crate) const fn period(&self) -> T {
        self.period
    }

    /// [`update_measured`](Self::update_measured) if `trusted` says so of the estimated velocity; else an error.
    #[inline(never)]
    pub(crate) fn update_measured_if(
        &self,
        state: &mut ControlState<T, N>,
        measurement: &Measurement<T, N>,
        reference: &Reference<T>,
        trusted: impl FnOnce(&Velocity<T, N>) -> bool,
    ) -> Result<Output<T, N>, ControlError> {
        let Estimate { q, nu, memory } =
            self.estimator.estimate(&self.robot, &state.estimator, measurement)?;
        let input = Input { q, nu, reference: *reference };
        supervise(&input)?;
        if !trusted(&nu) {
            return Err(ControlError::Overflow);
        }
        let sines = self.robot.sines(&q);
        let mut next = ControlState { estimator: memory, ..*state };
        let output = self.control(&mut next, &input, &sines)?;
        self.foresee(&mut next, &sines.posture, &nu, &output.torque);
        if !next.estimator.is_finite() {
            return Err(ControlError::Overflow);
        }
        *state = next;
        Ok(output)
    }

    /// The estimated configuration and velocity, without an update: the law's memory stays as it is.
    pub(crate) fn estimate(
        &self,
        state: &mut ControlState<T, N>,
        measurement: &Measurement<T, N>,
    ) -> Result<(Configuration<T, N>, Velocity<T, N>), ControlError> {
        let Estimate { q, nu, memory } =
            self.estimator.estimate(&self.robot, &state.estimator, measurement)?;
        if !(q.is_finite() && nu.is_finite() && memory.is_finite()) {
            return Err(ControlError::Overflow);
        }
        state.estimator = memory;
        Ok((q, nu))
    }

    /// Tells an estimator that wants to know which acceleration the model expects under a torque.
    pub(crate) fn foresee(
        &self,
        state: &mut ControlState<T, N>,
        posture: &<Robot<T, N> as Mechanism<T, N>>::Posture,
        nu: &Velocity<T, N>,
        torque: &Torque<T, N>,
    ) {
        if self.estimator.wants_model() {
            let inertia = self.robot.inertia(posture);
            let force = self.robot.force_of(torque);
            state.estimator.foresee(&self.robot.acceleration(&inertia, nu, &force));
        }
    }

    /// Forgets what was measured: the next measurement gives velocity zero.
    pub(crate) const fn forget_measured(&self, state: &mut ControlState<T, N>) {
        state.estimator = Memory::initial();
    }

    /// The state before the first update, but for what the estimator knows.
    pub(crate) fn restarted(&self, state: &ControlState<T, N>) -> ControlState<T, N> {
        ControlState { estimator: state.estimator, ..self.initial_state() }
    }
}
