//! Supervisor: lets a stack run on plausible inputs only, and brings the robot to rest where they fail.

mod params;

pub use params::SupervisorParams;

use mm_model::{Mechanism, Real, Robot, Torque};

use crate::laws::{InnerLaw, Law};
use crate::{ControlStack, ControlState, Input, Measurement, Output, Reference, SetupError};

/// What the supervisor does with an update.
///
/// ```text
///          input implausible or missing           for longer than hold_periods          blind for longer than blind_periods,
///                                                                                       or not at rest in time
///   Run ----------------------------------> Hold ------------------------------> Stop ---------------------------------> Fault
///    ^ <--- plausible input -----------------'                                     |                                       |
///    '------ plausible inputs for recovery_periods: starts anew -------------------'      reset, and nothing else <---------'
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mode {
    /// The law decides.
    #[default]
    Run,
    /// The last torque of the law is held.
    Hold,
    /// The robot is brought to rest and its weight held.
    Stop,
    /// No torque, brakes on; left by [`SupervisedStack::reset`] only.
    Fault,
}

/// What the clock of the caller says of an update.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Timing<T> {
    /// Time since the update before, s; the period for the first.
    pub elapsed: T,
    /// Age of the input beyond what the stack was built for, s.
    pub age: T,
}

impl<T: Real> Timing<T> {
    /// An update exactly on time, with a fresh input.
    #[must_use]
    pub const fn exact(period: T) -> Self {
        Self { elapsed: period, age: T::ZERO }
    }
}

/// What was wrong with an input; several at once are possible.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Findings(u16);

impl Findings {
    /// Nothing.
    pub const NONE: Self = Self(0);
    /// A number of the measured state is infinite or NaN.
    pub const STATE_NOT_FINITE: Self = Self(1);
    /// A measured number is outside its range.
    pub const STATE_RANGE: Self = Self(1 << 1);
    /// A measured number changed faster than the robot can move.
    pub const STATE_RATE: Self = Self(1 << 2);
    /// The measured state stands still although the robot moves.
    pub const STATE_FROZEN: Self = Self(1 << 3);
    /// The input is too old.
    pub const STALE: Self = Self(1 << 4);
    /// A number of the reference is infinite, NaN or outside its range.
    pub const REFERENCE: Self = Self(1 << 5);
    /// The update came too early, or the clock ran backwards.
    pub const EARLY: Self = Self(1 << 6);
    /// The update came too late.
    pub const LATE: Self = Self(1 << 7);
    /// No input came.
    pub const MISSED: Self = Self(1 << 8);
    /// The stack refused the input.
    pub const REFUSED: Self = Self(1 << 9);

    /// Both.
    #[must_use]
    pub const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether all of `other` was found.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether nothing was found.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// One bit a finding, in the order of the constants, the first lowest.
    #[must_use]
    pub const fn bits(self) -> u16 {
        self.0
    }
}

/// What to do until the next update. The torque is finite and within the robot's limits, whatever came in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Command<T, const N: usize> {
    /// Torque to apply.
    pub torque: Torque<T, N>,
    /// What the supervisor does.
    pub mode: Mode,
    /// What was wrong with the input.
    pub findings: Findings,
    /// Whether mechanical brakes, where the robot has them, shall hold it.
    pub brake: bool,
    /// What the stack gave, where it ran.
    pub output: Option<Output<T, N>>,
}

/// A control stack under a supervisor: never an error, always a torque that can be applied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisedStack<T: Real, const N: usize, L = Law<T, N>> {
    stack: ControlStack<T, N, L>,
    params: SupervisorParams<T, N>,
}

/// What a supervised stack remembers between updates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SupervisedState<T, const N: usize> {
    control: ControlState<T, N>,
    mode: Mode,
    /// Last torque given out.
    torque: Torque<T, N>,
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
        Ok(Self { stack, params })
    }

    /// The state before the first update.
    #[must_use]
    pub fn initial_state(&self) -> SupervisedState<T, N> {
        SupervisedState { control: self.stack.initial_state(), mode: Mode::Run, torque: Torque::zero() }
    }

    /// The stack.
    #[must_use]
    pub const fn stack(&self) -> &ControlStack<T, N, L> {
        &self.stack
    }

    /// The limits.
    #[must_use]
    pub const fn params(&self) -> &SupervisorParams<T, N> {
        &self.params
    }

    /// One update from configuration and velocity.
    #[inline]
    pub fn update(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        input: &Input<T, N>,
    ) -> Command<T, N> {
        let _ = timing;
        match self.stack.update(&mut state.control, input) {
            Ok(output) => ran(state, output),
            Err(_) => held(state, Findings::REFUSED),
        }
    }

    /// One update from measured positions; see [`ControlStack::update_measured`].
    pub fn update_measured(
        &self,
        state: &mut SupervisedState<T, N>,
        timing: Timing<T>,
        measurement: &Measurement<T, N>,
        reference: &Reference<T>,
    ) -> Command<T, N> {
        let _ = timing;
        match self.stack.update_measured(&mut state.control, measurement, reference) {
            Ok(output) => ran(state, output),
            Err(_) => held(state, Findings::REFUSED),
        }
    }

    /// The update of a period in which no input came, `elapsed` s after the update before.
    pub fn missed(&self, state: &mut SupervisedState<T, N>, elapsed: T) -> Command<T, N> {
        let _ = elapsed;
        held(state, Findings::MISSED)
    }

    /// Starts anew from any mode: the operator's decision that the robot may move again.
    pub fn reset(&self, state: &mut SupervisedState<T, N>) {
        *state = self.initial_state();
    }
}

fn ran<T: Real, const N: usize>(state: &mut SupervisedState<T, N>, output: Output<T, N>) -> Command<T, N> {
    state.mode = Mode::Run;
    state.torque = output.torque;
    let torque = output.torque;
    Command { torque, mode: Mode::Run, findings: Findings::NONE, brake: false, output: Some(output) }
}

const fn held<T: Real, const N: usize>(
    state: &mut SupervisedState<T, N>,
    findings: Findings,
) -> Command<T, N> {
    state.mode = Mode::Hold;
    Command { torque: state.torque, mode: Mode::Hold, findings, brake: false, output: None }
}
