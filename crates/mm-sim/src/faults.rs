//! What goes wrong between the sensors and the controller: faults of a scenario, at work.

use std::collections::VecDeque;
use std::ops::Range;

use crate::random::Stream;

/// Numbers that reach the controller in a period.
///
/// Configuration (x, y, heading, joints), velocity (forward, yaw rate, joints), wheel angles (right, left), reference (position, velocity,
/// acceleration), time since the last update, age.
pub const NUMBERS: usize = 24;

/// The numbers of one period.
pub type Numbers = [f64; NUMBERS];

/// Places of the parts in [`Numbers`].
pub mod place {
    use std::ops::Range;

    /// Configuration.
    pub const CONFIGURATION: Range<usize> = 0..6;
    /// Velocity.
    pub const VELOCITY: Range<usize> = 6..11;
    /// Wheel angles.
    pub const WHEELS: Range<usize> = 11..13;
    /// Reference.
    pub const REFERENCE: Range<usize> = 13..22;
    /// Time since the last update.
    pub const CLOCK: usize = 22;
    /// Age of the input.
    pub const AGE: usize = 23;
}

/// How a fault corrupts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// Not a number.
    Nan,
    /// Infinite.
    Infinite,
    /// The amplitudes are added.
    Offset,
    /// They are added in one period of so many, from the first on.
    Spike(u64),
    /// Normal noise with the amplitudes as standard deviations, of this seed.
    Noise(u64),
    /// Multiplied.
    Scale(f64),
    /// What it was in the last period before the fault; in the first, as it is.
    Stuck,
    /// What it was so many periods ago.
    Delay(usize),
    /// No input comes.
    Drop,
    /// It comes twice.
    Duplicate,
    /// The controller does not run.
    Stall,
}

/// One fault.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// How.
    pub kind: Kind,
    /// On which numbers; none for a fault of the update itself.
    pub on: Vec<usize>,
    /// How large, one for each number.
    pub amplitudes: Numbers,
    /// From this time on, s.
    pub from: f64,
    /// Up to, and without, this time, s.
    pub to: f64,
}

impl Fault {
    /// The numbers from `first` on, or the `channel`-th of each `stride` of them.
    #[must_use]
    pub fn places(range: Range<usize>, stride: usize, channel: Option<usize>) -> Vec<usize> {
        let first = range.start;
        range
            .filter(|place| channel.is_none_or(|channel| (place - first) % stride.max(1) == channel))
            .collect()
    }
}

/// How an update comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coming {
    /// As it should.
    Once,
    /// Twice.
    Twice,
    /// Not, and the controller knows.
    Missing,
    /// Not, and the controller does not run.
    Stalled,
}

/// Faults at work.
#[derive(Debug, Clone)]
pub struct Faults<'a> {
    all: Vec<(&'a Fault, State)>,
}

#[derive(Debug, Clone)]
struct State {
    held: Numbers,
    past: VecDeque<Numbers>,
    periods: u64,
    noise: Stream,
}

impl<'a> Faults<'a> {
    /// Faults before the first period.
    #[must_use]
    pub fn new(all: &'a [Fault]) -> Self {
        let state = |fault: &Fault| State {
            held: [0.0; NUMBERS],
            past: VecDeque::new(),
            periods: 0,
            noise: Stream::new(if let Kind::Noise(seed) = fault.kind { seed } else { 0 }, STREAM),
        };
        Self { all: all.iter().map(|fault| (fault, state(fault))).collect() }
    }

    /// Corrupts the numbers of the period that begins at `t`, and says how the update comes.
    pub fn corrupt(&mut self, t: f64, numbers: &mut Numbers) -> Coming {
        let mut coming = Coming::Once;
        for (fault, state) in &mut self.all {
            // Periods begin at multiples of the period, up to rounding.
            let active = t + 1e-9 >= fault.from && t + 1e-9 < fault.to;
            let comes = state.apply(fault, active, numbers);
            if comes != Coming::Once {
                coming = comes;
            }
        }
        coming
    }
}

impl State {
    fn apply(&mut self, fault: &Fault, active: bool, numbers: &mut Numbers) -> Coming {
        let clean = *numbers;
        if let Kind::Delay(length) = fault.kind {
            self.past.push_back(clean);
            while self.past.len() > length + 1 {
                self.past.pop_front();
            }
        }
        if !active {
            self.held = clean;
            return Coming::Once;
        }
        if self.periods == 0 && fault.from <= 0.0 {
            self.held = clean;
        }
        let amplitude = |place: usize| fault.amplitudes.get(place).copied().unwrap_or(0.0);
        let is_spike = |every: u64| self.periods.is_multiple_of(every.max(1));
        for &place in &fault.on {
            let Some(number) = numbers.get_mut(place) else { continue };
            let at = |other: &Numbers| other.get(place).copied().unwrap_or(0.0);
            *number = match fault.kind {
                Kind::Nan => f64::NAN,
                Kind::Infinite => f64::INFINITY,
                Kind::Offset => *number + amplitude(place),
                Kind::Spike(every) if is_spike(every) => *number + amplitude(place),
                Kind::Noise(_) => *number + amplitude(place) * self.noise.next_normal(),
                Kind::Scale(factor) => *number * factor,
                Kind::Stuck => at(&self.held),
                Kind::Delay(_) => self.past.front().map_or(*number, at),
                Kind::Spike(_) | Kind::Drop | Kind::Duplicate | Kind::Stall => *number,
            };
        }
        self.periods += 1;
        match fault.kind {
            Kind::Drop => Coming::Missing,
            Kind::Duplicate => Coming::Twice,
            Kind::Stall => Coming::Stalled,
            _ => Coming::Once,
        }
    }
}

/// Number of the stream of the noise of faults, apart from those of sensors and disturbances.
const STREAM: u64 = 0x6661_756C_7473_0001;
