//! A supervised stack, its memory, and the order and time of its updates.

use core::hint::black_box;

use mm_control::supervisor::{Mode, Timing};
use mm_control::{Input, SupervisedStack, SupervisedState};
use mm_model::Torque;

use crate::frame::Kind;
use crate::{Clock, Command, Pace, Scalar, Seen, Setup, Stages, Tick};

/// Ticks that may be left out between two in lockstep: a longer silence needs a reset. Also the most that are made up for at once.
const LONGEST_GAP: u32 = 1000;

/// What the actuators are to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Applied {
    /// Torque of right wheel, left wheel and joints, N m; exact in either precision.
    pub torque: [f64; 5],
    /// What the supervisor does.
    pub mode: Mode,
    /// Whether mechanical brakes shall hold the robot.
    pub brake: bool,
}

impl Applied {
    /// Nothing, with brakes on.
    pub(super) const fn nothing() -> Self {
        Self { torque: [0.0; 5], mode: Mode::Stop, brake: true }
    }
}

/// How a request stands to those before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    /// It comes after them, this far.
    Next(u32),
    /// It is the last one again.
    Again,
    /// It is older than the last one.
    Stale,
    /// Too many are missing before it.
    Gap,
}

/// The target's time.
#[derive(Debug, Clone, Copy)]
pub(super) struct Time {
    ticks_per_second: u32,
    /// Ticks since it was switched on.
    now: u64,
    seen: u32,
}

impl Time {
    pub(super) const fn new(ticks_per_second: u32) -> Self {
        Self { ticks_per_second, now: 0, seen: 0 }
    }

    /// Looks at the clock.
    pub(super) fn see(&mut self, clock: &impl Clock) {
        let ticks = clock.ticks();
        self.now += u64::from(between(self.seen, ticks));
        self.seen = ticks;
    }

    /// Time since a moment, s.
    fn since<T: Scalar>(&self, moment: u64) -> T {
        let ticks = u32::try_from(self.now.saturating_sub(moment)).unwrap_or(u32::MAX);
        T::from_u32(ticks) / T::from_u32(self.ticks_per_second)
    }
}

/// Ticks from one reading of a clock to another.
const fn between(before: u32, after: u32) -> u32 {
    after.wrapping_sub(before) & 0x00ff_ffff
}

/// A supervised stack at work.
#[derive(Debug)]
pub(super) struct Engine<T: Scalar> {
    stack: SupervisedStack<T, 3>,
    state: SupervisedState<T, 3>,
    period: T,
    pace: Pace,
    /// The same in ticks of the clock.
    period_ticks: u64,
    last: Option<u32>,
    /// When the last update was due, and when the last input was, by its number; in ticks of the clock.
    updated: u64,
    due: u64,
    torque: Torque<T, 3>,
    mode: Mode,
    brake: bool,
    missed: u32,
}

impl<T: Scalar> Engine<T> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a positive number of ticks; the cast saturates"
    )]
    pub(super) fn new(stack: &SupervisedStack<T, 3>, setup: &Setup<T>, time: &Time) -> Self {
        let period = setup.stack.period;
        Self {
            state: stack.initial_state(),
            stack: *stack,
            period,
            pace: setup.pace,
            period_ticks: (period.to_f64() * f64::from(time.ticks_per_second) + 0.5) as u64,
            last: None,
            updated: time.now,
            due: time.now,
            torque: Torque::zero(),
            mode: Mode::Stop,
            brake: true,
            missed: 0,
        }
    }

    /// One update.
    pub(super) fn tick(
        &mut self,
        seq: u32,
        gap: u32,
        tick: &Tick<T>,
        (time, clock): (&Time, &impl Clock),
    ) -> Command<T> {
        let timing = match (self.pace, self.last) {
            (Pace::Lockstep, _) => {
                for _ in 1..gap {
                    self.miss(self.period);
                }
                tick.timing
            }
            (Pace::RealTime, None) => {
                self.due = time.now;
                Timing { elapsed: self.period, age: tick.timing.age }
            }
            (Pace::RealTime, Some(_)) => {
                let late = self.late(gap, time);
                Timing { elapsed: time.since(self.updated), age: tick.timing.age + late }
            }
        };
        (self.updated, self.last) = (time.now, Some(seq));
        let nothing = between(clock.ticks(), clock.ticks());
        let begin = clock.ticks();
        let command = self.update(black_box(timing), black_box(tick));
        let took = between(begin, clock.ticks());
        Command { cost: took.saturating_sub(nothing), ..self.keep(&command) }
    }

    /// How much later a tick comes than its number says, s, by the target's own clock: the input is older by that much.
    ///
    /// What ticks are late adds up over all of them, or a wire that delays each a little more than the one before would never be
    /// noticed. A thousandth of a period is forgiven each period, since two clocks never run alike.
    fn late(&mut self, gap: u32, time: &Time) -> T {
        let due = self.due + u64::from(gap) * self.period_ticks;
        let forgiven = u64::from(gap) * (self.period_ticks / 1_024 + 1);
        self.due = (due + forgiven).min(time.now);
        if time.now > due { time.since(due) } else { T::ZERO }
    }

    #[inline(never)]
    fn update(&mut self, timing: Timing<T>, tick: &Tick<T>) -> mm_control::Command<T, 3> {
        let Self { stack, state, .. } = self;
        match &tick.seen {
            Seen::State { q, nu } => {
                let input = Input { q: *q, nu: *nu, reference: tick.reference };
                stack.update(state, timing, &input)
            }
            Seen::Measured(measurement) => stack.update_measured(state, timing, measurement, &tick.reference),
        }
    }

    fn miss(&mut self, elapsed: T) {
        let command = self.stack.missed(&mut self.state, elapsed);
        self.missed = self.missed.wrapping_add(1);
        self.keep(&command);
    }

    fn keep(&mut self, command: &mm_control::Command<T, 3>) -> Command<T> {
        let mm_control::Command { torque, mode, findings, brake, .. } = *command;
        (self.torque, self.mode, self.brake) = (torque, mode, brake);
        let stages = command.output.as_ref().map_or_else(Stages::default, Stages::of);
        Command { torque, mode, findings, brake, stages, cost: 0 }
    }

    pub(super) const fn missed(&self) -> u32 {
        self.missed
    }
}

/// An engine of either precision.
pub(super) trait Driven {
    /// How a request stands to those before it. Numbers may begin anew after 2^32.
    fn order(&self, seq: u32, kind: Kind) -> Order;
    /// Periods that have gone by without an input, where the target's clock counts.
    fn keep_pace(&mut self, time: &Time) -> u32;
    /// Starts anew, at the operator's wish.
    fn reset(&mut self, seq: u32, time: &Time);
    /// Number of the last tick or reset.
    fn last(&self) -> Option<u32>;
    /// What the actuators are to do.
    fn applied(&self) -> Applied;
}

impl<T: Scalar> Driven for Engine<T> {
    fn order(&self, seq: u32, kind: Kind) -> Order {
        let Some(last) = self.last else { return Order::Next(1) };
        match seq.wrapping_sub(last) {
            0 => Order::Again,
            gap if gap >= 1 << 31 => Order::Stale,
            gap if gap > LONGEST_GAP
                && matches!((kind, self.pace), (Kind::Tick32 | Kind::Tick64, Pace::Lockstep)) =>
            {
                Order::Gap
            }
            gap => Order::Next(gap),
        }
    }

    fn keep_pace(&mut self, time: &Time) -> u32 {
        if self.pace != Pace::RealTime || self.last.is_none() {
            return 0;
        }
        let before = self.missed;
        // Half a period of grace; no more at once than a bus that was blocked for a second may leave behind.
        for _ in 0..LONGEST_GAP {
            if time.now.saturating_sub(self.updated) < self.period_ticks + self.period_ticks / 2 {
                break;
            }
            self.updated += self.period_ticks;
            self.miss(self.period);
        }
        self.missed.wrapping_sub(before)
    }

    fn reset(&mut self, seq: u32, time: &Time) {
        self.stack.reset(&mut self.state);
        self.due = time.now;
        (self.torque, self.mode, self.brake) = (Torque::zero(), Mode::Stop, true);
        self.last = Some(seq);
    }

    fn last(&self) -> Option<u32> {
        self.last
    }

    fn applied(&self) -> Applied {
        let Torque { right, left, joints: [a, b, c] } = self.torque;
        let torque = [right, left, a, b, c].map(T::to_f64);
        Applied { torque, mode: self.mode, brake: self.brake }
    }
}
