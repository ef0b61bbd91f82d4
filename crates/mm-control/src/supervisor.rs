//! Supervisor: lets a stack run on plausible inputs only, and brings the robot to rest where they fail.
//!
//! ```text
//! timing, input --> plausibility --findings--> machine --mode--> Run:   the law
//!                    (range, rate,             (counts)          Hold:  the last torque
//!                     frozen, stale, clock)                      Stop:  braking law, by the measured or the predicted state
//!                                                                Fault: none, brakes on
//! ```
//! What a command is worth in every mode: the torque of the law is finite and within the limits, or the law gives an error; a held
//! torque was one of these; the torque of a stop goes through a cut that turns what is not a number into zero. So whatever comes
//! in, no torque beyond the limits and no NaN comes out, and it is never the same torque for more than `hold_periods` updates without a
//! plausible input.

mod braking;
mod decide;
mod machine;
mod outcome;
mod params;
mod plausibility;
#[cfg(test)]
mod twin;

pub use outcome::{Command, Findings, Mode, Timing};
pub use params::SupervisorParams;

use mm_model::{Configuration, Mechanism, Real, Robot, SinesOf, Torque, Velocity};
use nalgebra::Vector3;

use crate::laws::{EffectiveInertia, InnerLaw, Law};
use crate::{ControlError, ControlStack, ControlState, Input, Measurement, Output, Reference, SetupError};
use braking::Braking;
use machine::{Machine, Patience};
use plausibility::{Believed, Doubt, Plausibility};

/// A control stack under a supervisor: never an error, always a torque that can be applied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisedStack<T: Real, const N: usize, L = Law<T, N>> {
    stack: ControlStack<T, N, L>,
    plausibility: Plausibility<T, N>,
    patience: Patience,
    braking: Braking<T, N>,
}

/// What a supervised stack remembers between updates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisedState<T, const N: usize> {
    control: ControlState<T, N>,
    machine: Machine,
    /// Nothing to count and to wait for: the next update may be an ordinary one.
    settled: bool,
    /// Whether a state, and a reference, was ever believed.
    seen: bool,
    aimed: bool,
    /// Last torque given out.
    torque: Torque<T, N>,
    /// The last plausible state and reference.
    believed: Believed<T, N>,
    /// Where the model says that the robot is, if a time has passed since.
    predicted: (Configuration<T, N>, Velocity<T, N>),
    /// How far each coordinate should have moved while it did not, m and rad.
    doubt: Doubt<T, N>,
    /// Posture at the beginning of the stop, rad.
    posture: [T; N],
    /// What the law had learned of the joints' loads while no coordinate was in doubt, N m.
    load: [T; N],
    /// Time since a state was plausible, and time of early updates, s.
    since: T,
    waited: T,
}

/// What an update may do.
enum Verdict {
    /// The law may run; with what was found all the same.
    Run(Findings),
    /// It may not, and what is done instead was decided.
    Safe(Findings),
}

impl<T: Real, const N: usize, L: InnerLaw<T, N>> SupervisedStack<T, N, L>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// A stack and the limits of plausibility.
    ///
    /// # Errors
    /// The first parameter that does not work, by name.
    pub fn try_new(stack: ControlStack<T, N, L>, params: SupervisorParams<T, N>) -> Result<Self, SetupError> {
        params.check()?;
        let (robot, period) = (stack.robot(), stack.period());
        let EffectiveInertia(inertia) = EffectiveInertia::of(robot);
        Ok(Self {
            plausibility: Plausibility::new(&params, robot, period),
            patience: Patience::of(&params),
            braking: Braking::new(&inertia, params.braking_rate, (period, params.hold_periods)),
            stack,
        })
    }

    /// The state before the first update.
    #[must_use]
    pub fn initial_state(&self) -> SupervisedState<T, N> {
        SupervisedState {
            control: self.stack.initial_state(),
            machine: Machine::default(),
            settled: false,
            seen: false,
            aimed: false,
            torque: Torque::zero(),
            believed: Believed {
                q: Configuration::zero(),
                nu: Velocity::zero(),
                reference: Vector3::new(T::ZERO, T::ZERO, T::ZERO),
            },
            predicted: (Configuration::zero(), Velocity::zero()),
            doubt: Doubt::none(),
            posture: [T::ZERO; N],
            load: [T::ZERO; N],
            since: T::ZERO,
            waited: T::ZERO,
        }
    }

    /// The stack.
    #[must_use]
    pub const fn stack(&self) -> &ControlStack<T, N, L> {
        &self.stack
    }

    /// The limits.
    #[must_use]
    pub const fn params(&self) -> &SupervisorParams<T, N> {
        self.plausibility.params()
    }

    /// One update from configuration and velocity.
    ///
    /// The first update takes its input as it is, if every number is in its range: there is nothing to compare it with. The law gives the
    /// same bits as [`ControlStack::update`] with the same inputs. Cost of a good input besides the law: see `docs/supervisor.md`.
    #[inline]
    pub fn update(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        input: &Input<T, N>,
    ) -> Command<T, N> {
        match self.judge(state, timing, input) {
            Verdict::Run(findings) => {
                let sines = self.stack.robot().sines(&input.q);
                let ran = self.stack.control(&mut state.control, input, &sines);
                self.concluded(state, findings, ran)
            }
            Verdict::Safe(findings) => self.safe(state, findings),
        }
    }

    /// The same update for a caller that knows the sines of `input.q`; see [`ControlStack::update_with_sines`].
    #[inline]
    pub fn update_with_sines(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        input: &Input<T, N>,
        sines: &SinesOf<T, N>,
    ) -> Command<T, N> {
        match self.judge(state, timing, input) {
            Verdict::Run(findings) => {
                let ran = self.stack.control(&mut state.control, input, sines);
                self.concluded(state, findings, ran)
            }
            Verdict::Safe(findings) => self.safe(state, findings),
        }
    }

    /// One update from measured positions; see [`ControlStack::update_measured`].
    ///
    /// The measured positions are checked before they reach the estimator, the estimated velocity before it reaches the law. In a stop
    /// the estimator goes on, so that there is something to brake by.
    pub fn update_measured(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        measurement: &Measurement<T, N>,
        reference: &Reference<T>,
    ) -> Command<T, N> {
        match self.judge_measured(state, timing, measurement, reference) {
            Verdict::Run(findings) => {
                let mut slow = true;
                let ran = self.stack.update_measured_if(&mut state.control, measurement, reference, |nu| {
                    slow = self.plausibility.within_speed(nu);
                    slow
                });
                if let Ok(output) = &ran {
                    state.believed.nu = output.signals.nu;
                }
                let fast = if slow { Findings::NONE } else { Findings::STATE_RANGE };
                self.concluded(state, findings.and(fast), ran)
            }
            Verdict::Safe(findings) => self.safe(state, findings),
        }
    }

    /// The update of a period in which no input came, `elapsed` s after the update before.
    pub fn missed(&self, state: &mut SupervisedState<T, N>, elapsed: T) -> Command<T, N> {
        let findings = self.judge_missed(state, elapsed);
        self.safe(state, findings)
    }

    /// Makes the memory of another supervised stack this one's, before its first update with it; see [`ControlStack::take_over`].
    ///
    /// The mode, the last command and what was believed of the robot stay as they are.
    pub fn take_over(&self, state: &mut SupervisedState<T, N>, from: &Self) {
        self.stack.take_over(&mut state.control, &from.stack);
    }

    /// Starts anew from any mode: the operator's decision that the robot may move again.
    pub fn reset(&self, state: &mut SupervisedState<T, N>) {
        *state = self.initial_state();
    }

    /// The command after the law ran, or refused to.
    #[inline(always)]
    fn concluded(
        &self,
        state: &mut SupervisedState<T, N>,
        findings: Findings,
        ran: Result<Output<T, N>, ControlError>,
    ) -> Command<T, N> {
        match ran {
            Ok(output) => {
                state.torque = output.torque;
                state.machine.ran();
                Command {
                    torque: output.torque,
                    mode: Mode::Run,
                    findings,
                    brake: false,
                    output: Some(output),
                }
            }
            Err(_) => self.refused(state, findings),
        }
    }
}

impl<T: Real, const N: usize> SupervisedState<T, N> {
    /// Configuration and velocity: measured, or predicted from the last that were.
    fn whereabouts(&self) -> (Configuration<T, N>, Velocity<T, N>) {
        if self.since > T::ZERO { self.predicted } else { (self.believed.q, self.believed.nu) }
    }

    /// What the supervisor did with the last update.
    #[must_use]
    pub const fn mode(&self) -> Mode {
        self.machine.mode
    }
}
