//! The state machine: which mode follows which, by counting.

use super::{Mode, SupervisorParams};

/// What an update brought, as far as the mode depends on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Brought {
    /// Whether the law may run on it.
    pub(super) plausible: bool,
    /// Whether the measured state, at least, is to be believed.
    pub(super) sees: bool,
    /// Updates that are missing before it, beyond what a torque is held for.
    pub(super) overdue: bool,
}

/// Mode and counters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Machine {
    pub(super) mode: Mode,
    /// Updates since the law ran, or plausible inputs in a row of this stop.
    count: u32,
    /// Updates since a state was last believed.
    blind: u32,
    /// Updates of this stop before the robot was at rest, the first included.
    braking: u32,
    /// Whether it came to rest in this stop.
    pub(super) at_rest: bool,
}

/// What the machine needs to know of the parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Patience {
    hold: u32,
    recovery: u32,
    blind: u32,
    stop: u32,
}

impl Patience {
    pub(super) const fn of<T, const N: usize>(params: &SupervisorParams<T, N>) -> Self {
        Self {
            hold: params.hold_periods,
            recovery: params.recovery_periods,
            blind: params.blind_periods,
            stop: params.stop_periods,
        }
    }
}

impl Machine {
    /// The machine after an update.
    ///
    /// A hold ends with the first plausible input or after `hold` updates. A stop ends with `recovery` plausible inputs in a row;
    /// without a state for `blind` updates, or without rest in `stop` updates, it is a fault. Every path from a run of bad inputs
    /// leads through at most `hold` updates of a held torque: the count is cleared by [`ran`](Self::ran) alone, after the law has.
    #[must_use]
    pub(super) fn after(self, brought: Brought, patience: &Patience) -> Self {
        let blind = if brought.sees { 0 } else { self.blind.saturating_add(1) };
        let next = Self { blind, ..self };
        match self.mode {
            Mode::Fault => next,
            Mode::Run | Mode::Hold if brought.overdue => next.stopped(),
            Mode::Run | Mode::Hold if brought.plausible => Self { mode: Mode::Run, ..next },
            Mode::Run | Mode::Hold => {
                let count = self.count.saturating_add(1);
                if count > patience.hold { next.stopped() } else { Self { mode: Mode::Hold, count, ..next } }
            }
            Mode::Stop => next.in_stop(brought, patience),
        }
    }

    fn in_stop(self, brought: Brought, patience: &Patience) -> Self {
        let good = brought.plausible && !brought.overdue;
        let count = if good { self.count.saturating_add(1) } else { 0 };
        let braking = self.braking.saturating_add(u32::from(!self.at_rest));
        if good && count >= patience.recovery && patience.recovery < u32::MAX {
            Self::default()
        } else if self.blind > patience.blind || braking > patience.stop {
            Self { mode: Mode::Fault, ..self }
        } else {
            Self { count, braking, ..self }
        }
    }

    const fn stopped(self) -> Self {
        Self { mode: Mode::Stop, count: 0, braking: 1, at_rest: false, ..self }
    }

    /// The law ran: what was held against the inputs before is forgotten.
    #[inline]
    pub(super) const fn ran(&mut self) {
        self.count = 0;
    }
}
