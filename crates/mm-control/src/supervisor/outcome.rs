//! What goes in and out of a supervised update besides the input: time, mode, findings, command.

use mm_model::{Real, Torque};

use crate::Output;

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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Mode {
    /// The law decides.
    #[default]
    Run,
    /// The last torque of the law is held.
    Hold,
    /// The robot is brought to rest and its weight held.
    Stop,
    /// No torque, brakes on; left by [`SupervisedStack::reset`](crate::SupervisedStack::reset) only.
    Fault,
}

/// What the clock of the caller says of an update.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Timing<T> {
    /// Time since the update before, s; the period for the first.
    pub elapsed: T,
    /// Age of the input beyond what the stack was built for, s.
    pub age: T,
}

impl Mode {
    /// Name of the mode.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Run => "run",
            Self::Hold => "hold",
            Self::Stop => "stop",
            Self::Fault => "fault",
        }
    }
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
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

    /// Every finding with its name, in the order of the constants.
    pub const ALL: [(Self, &'static str); 10] = [
        (Self::STATE_NOT_FINITE, "state-not-finite"),
        (Self::STATE_RANGE, "state-range"),
        (Self::STATE_RATE, "state-rate"),
        (Self::STATE_FROZEN, "state-frozen"),
        (Self::STALE, "stale"),
        (Self::REFERENCE, "reference"),
        (Self::EARLY, "early"),
        (Self::LATE, "late"),
        (Self::MISSED, "missed"),
        (Self::REFUSED, "refused"),
    ];

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

    /// Whether any of `other` was found.
    #[must_use]
    pub const fn any_of(self, other: Self) -> bool {
        self.0 & other.0 != 0
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
