//! An output of a system of one input or of two as a compiled surface.

use mm_control::fuzzy::fixed::Evaluate as _;
use mm_control::fuzzy::{FuzzyError, Sampling};

use super::{CompileError, CompiledSurface, CompiledSurface2, Origin, Request, value_of};
use crate::{Accuracy, System};

/// Samples of an output set where an exact centroid is not to be had: for a table of one input, and of two.
const SAMPLES_OF_ONE: u32 = 2001;
const SAMPLES_OF_TWO: u32 = 401;

/// A compiled surface of one input or of two.
#[derive(Debug, Clone, PartialEq)]
pub enum Table {
    /// Of one input.
    One(CompiledSurface),
    /// Of two.
    Two(CompiledSurface2),
}

/// A language in which a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// A constant over the types of `mm_control::fuzzy::fixed`.
    Rust,
    /// A C99 header with a table and an inline function.
    C,
    /// All numbers, for other programs.
    Toml,
}

/// Why there is no table of an output.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TableError {
    /// The system is refused.
    #[error(transparent)]
    System(#[from] FuzzyError),
    /// It cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A table has one input or two.
    #[error("a compiled surface has one input or two, this system has {0}")]
    Inputs(usize),
}

impl System {
    /// How its outputs are best known: exactly or, where the output sets are curved, by this many samples.
    #[must_use]
    pub fn best_accuracy(&self, samples: u32) -> Accuracy {
        let is_curved = matches!(self.with_engine(Accuracy::Exact, |_| ()), Err(FuzzyError::Curved(_)));
        if is_curved { Accuracy::Sampled(Sampling::Ends(samples)) } else { Accuracy::Exact }
    }
}

impl Table {
    /// Compiles an output of a system, counted from 0.
    ///
    /// # Errors
    /// A system that is refused or has more than two inputs, a request that cannot be met.
    pub fn compile(system: &System, output: usize, request: &Request) -> Result<Self, TableError> {
        let range = system.outputs.get(output).ok_or(FuzzyError::OutOfRange("outputs"))?.range;
        let name = &system.name;
        match system.inputs.as_slice() {
            [input] => system.with_function(system.best_accuracy(SAMPLES_OF_ONE), output, |f| {
                let f = |x: f64| f(&[x]);
                Ok(Self::One(CompiledSurface::compile(name, &f, (input.range, range), request)?))
            })?,
            [first, second] => system.with_function(system.best_accuracy(SAMPLES_OF_TWO), output, |f| {
                let ranges = ([first.range, second.range], range);
                Ok(Self::Two(CompiledSurface2::compile(name, f, ranges, request)?))
            })?,
            inputs => Err(TableError::Inputs(inputs.len())),
        }
    }

    /// Whether a system had to be sampled for it.
    #[must_use]
    pub fn is_sampled(system: &System) -> bool {
        system.best_accuracy(SAMPLES_OF_ONE) != Accuracy::Exact
    }

    /// Its output for inputs in 16 bits; 0 for another number of inputs.
    #[must_use]
    pub fn evaluate(&self, inputs: &[i16]) -> f64 {
        match (self, inputs) {
            (Self::One(table), [x]) => value_of(table.output_range, table.surface().evaluate(*x)),
            (Self::Two(table), [x, y]) => value_of(table.output_range, table.surface().evaluate(*x, *y)),
            _ => 0.0,
        }
    }

    /// Its inputs' ranges.
    #[must_use]
    pub fn input_ranges(&self) -> &[(f64, f64)] {
        match self {
            Self::One(table) => core::slice::from_ref(&table.input_range),
            Self::Two(table) => &table.input_ranges,
        }
    }

    /// Bytes in flash.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::One(table) => table.bytes(),
            Self::Two(table) => table.bytes(),
        }
    }

    /// Largest error over all inputs, in output units.
    #[must_use]
    pub const fn error(&self) -> f64 {
        match self {
            Self::One(table) => table.error,
            Self::Two(table) => table.error,
        }
    }

    /// The table in a language; Rust refers to `mm_control` under that name.
    #[must_use]
    pub fn written(&self, language: Language, origin: &Origin<'_>) -> String {
        const ROOT: &str = "mm_control";
        match (self, language) {
            (Self::One(table), Language::Rust) => table.to_rust(origin, ROOT),
            (Self::One(table), Language::C) => table.to_c(origin),
            (Self::One(table), Language::Toml) => table.to_toml(origin),
            (Self::Two(table), Language::Rust) => table.to_rust(origin, ROOT),
            (Self::Two(table), Language::C) => table.to_c(origin),
            (Self::Two(table), Language::Toml) => table.to_toml(origin),
        }
    }
}

/// The 16-bit number nearest to a value in a range; not a number is 0.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "clamped; not a number becomes 0")]
pub fn quantized((lo, hi): (f64, f64), x: f64) -> i16 {
    let (middle, half) = (0.5 * lo + 0.5 * hi, 0.5 * hi - 0.5 * lo);
    ((x - middle) / half * 32768.0).round().clamp(-32768.0, 32767.0) as i16
}
