//! The counting.

use core::fmt;
use core::hint::black_box;

/// Time that advances by the same number of ticks with every instruction.
pub trait Clock {
    /// Ticks since any moment, modulo 2^24.
    fn ticks(&self) -> u32;
    /// Spends exactly this many instructions, an even number, and any fixed number in addition.
    fn spend(&self, instructions: u32);
}

/// How deep the stack goes.
pub trait Depth {
    /// Measures from here on.
    fn begin(&mut self);
    /// Most bytes that were in use since, beyond those in use then.
    fn deepest(&self) -> u32;
}

/// Where nothing is known of the stack.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoDepth;

impl Depth for NoDepth {
    fn begin(&mut self) {}

    fn deepest(&self) -> u32 {
        0
    }
}

/// Instructions that evaluations of one kind took, and what they gave.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    /// Number of evaluations, one an input.
    pub evaluations: u32,
    /// Instructions of all of them.
    pub total: u32,
    /// Least instructions of one.
    pub min: u32,
    /// Most instructions of one.
    pub max: u32,
    /// Number of the input, from 0, that took the most.
    pub worst: u32,
    /// The outputs' bits as the digits of a number with base 31, modulo 2^32: their order counts, and opposites do not cancel.
    pub checksum: u32,
}

impl Count {
    /// Before the first evaluation.
    #[must_use]
    pub fn none() -> Self {
        Self { min: u32::MAX, ..Self::default() }
    }

    /// Counts an evaluation.
    pub fn add(&mut self, instructions: u32) {
        if instructions > self.max {
            (self.max, self.worst) = (instructions, self.evaluations);
        }
        self.min = self.min.min(instructions);
        self.total = self.total.wrapping_add(instructions);
        self.evaluations += 1;
    }

    /// Takes a number of an output into the checksum.
    pub const fn note(&mut self, bits: u32) {
        self.checksum = self.checksum.wrapping_mul(31).wrapping_add(bits);
    }
}

impl fmt::Display for Count {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { evaluations, total, min, max, worst, checksum } = *self;
        let mean = (total + evaluations / 2).checked_div(evaluations).unwrap_or(0);
        write!(
            f,
            "evaluations={evaluations} total={total} min={min} mean={mean} max={max} worst={worst} checksum={checksum:08x}"
        )
    }
}

/// The clock does not advance evenly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Miscounted {
    /// Length of a loop, in instructions.
    pub expected: u32,
    /// What the clock made of it.
    pub counted: u32,
}

/// A clock and what is known of it.
#[derive(Debug, Clone, Copy)]
pub struct Counter<C> {
    clock: C,
    /// Ticks of [`REFERENCE`] instructions.
    reference: u32,
}

/// Length of the loop that the clock is calibrated with.
const REFERENCE: u32 = 10_000;

/// Other lengths, which the calibrated clock has to find.
const PROBES: [u32; 6] = [2, 4, 10, 100, 1_000, 20_000];

impl<C: Clock> Counter<C> {
    /// Calibrates the clock and verifies it.
    ///
    /// # Errors
    /// [`Miscounted`], where the length of a loop is not found exactly.
    pub fn calibrated(clock: C) -> Result<Self, Miscounted> {
        let mut counter = Self { clock, reference: 0 };
        let empty = counter.looped(0);
        counter.reference = counter.looped(REFERENCE).wrapping_sub(empty);
        for expected in PROBES {
            let counted = counter.instructions(counter.looped(expected).wrapping_sub(empty));
            if counted != expected {
                return Err(Miscounted { expected, counted });
            }
        }
        Ok(counter)
    }

    /// Evaluates a system at every input; the checksum is of what `bits` makes of the outputs.
    ///
    /// Counted is what an evaluation takes beyond a function that hands back its input, called from the same place.
    pub fn count<S, X: Copy>(
        &self,
        system: &S,
        inputs: impl Iterator<Item = X> + Clone,
        evaluate: fn(&S, X) -> X,
        bits: fn(X) -> u32,
    ) -> Count {
        let mut count = Count::none();
        let overhead = inputs.clone().take(2).map(|x| self.timed(system, x, nothing).0).last().unwrap_or(0);
        for input in inputs {
            let (ticks, output) = self.timed(system, input, evaluate);
            count.add(self.instructions(ticks.wrapping_sub(overhead)));
            count.note(bits(output));
        }
        count
    }

    /// Instructions between two readings of the clock with some work between them, and what the work gave.
    #[inline(always)]
    pub fn timed_work<R>(&self, work: impl FnOnce() -> R) -> (u32, R) {
        let start = self.clock.ticks();
        let result = work();
        let end = self.clock.ticks();
        (self.instructions(elapsed(start, end)), result)
    }

    /// Ticks of 10,000 instructions, for a comparison with what is known of the clock.
    #[must_use]
    pub const fn reference(&self) -> u32 {
        self.reference
    }

    /// Ticks of one call with what is around it, and its output. There is one place of it for all functions of a kind.
    #[inline(never)]
    fn timed<S, X: Copy>(&self, system: &S, input: X, evaluate: fn(&S, X) -> X) -> (u32, X) {
        let (system, input, evaluate) = (black_box(system), black_box(input), black_box(evaluate));
        let start = self.clock.ticks();
        let output = evaluate(system, input);
        let end = self.clock.ticks();
        (elapsed(start, end), black_box(output))
    }

    /// Ticks of a loop.
    #[inline(never)]
    fn looped(&self, instructions: u32) -> u32 {
        self.between(|| self.clock.spend(black_box(instructions)))
    }

    #[inline(always)]
    fn between(&self, work: impl FnOnce()) -> u32 {
        let start = self.clock.ticks();
        work();
        elapsed(start, self.clock.ticks())
    }

    /// Ticks as instructions, to the nearest whole number: a reading is rounded to a tick, and an instruction takes many.
    #[expect(clippy::cast_possible_truncation, reason = "2^24 ticks are fewer instructions")]
    fn instructions(&self, ticks: u32) -> u32 {
        let (ticks, reference) = (u64::from(ticks), u64::from(self.reference));
        (ticks * u64::from(REFERENCE) + reference / 2).checked_div(reference).unwrap_or(0) as u32
    }
}

/// Hands back its input.
fn nothing<S, X>(_system: &S, x: X) -> X {
    x
}

/// Ticks from one reading to another.
const fn elapsed(start: u32, end: u32) -> u32 {
    end.wrapping_sub(start) & 0x00ff_ffff
}
