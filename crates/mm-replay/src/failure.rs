//! Why a replay ended early.

use core::fmt;

use mm_control::{ControlError, SetupError};

use crate::Signal;

/// Name of a run, at most 40 bytes.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Name {
    bytes: [u8; 40],
    length: u8,
}

impl Name {
    /// A name, cut to 40 bytes.
    #[must_use]
    pub fn new(text: &str) -> Self {
        let mut name = Self::blank(u8::try_from(text.len()).unwrap_or(u8::MAX));
        for (to, from) in name.bytes.iter_mut().zip(text.bytes()) {
            *to = from;
        }
        name
    }

    pub(crate) fn blank(length: u8) -> Self {
        Self { bytes: [0; 40], length: length.min(40) }
    }

    pub(crate) const fn length(&self) -> u8 {
        self.length
    }

    pub(crate) fn as_bytes(&self) -> &[u8] {
        self.bytes.get(..usize::from(self.length)).unwrap_or_default()
    }

    pub(crate) fn room(&mut self) -> &mut [u8] {
        self.bytes.get_mut(..usize::from(self.length)).unwrap_or_default()
    }
}

impl fmt::Display for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(core::str::from_utf8(self.as_bytes()).unwrap_or("?"))
    }
}

impl fmt::Debug for Name {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

/// Two numbers that should be the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Difference {
    /// Name of the run.
    pub name: Name,
    /// Name of the precision.
    pub precision: &'static str,
    /// Number of the tick in the run.
    pub tick: u32,
    /// Which number.
    pub signal: Signal,
    /// Its bits here.
    pub here: u64,
    /// Its bits in the recording.
    pub recorded: u64,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, precision, tick, signal, here, recorded } = self;
        write!(f, "{name} {precision}: tick {tick}: {signal} is {here:#x}, recorded {recorded:#x}")
    }
}

/// Why a replay ended early.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Failure {
    /// The file is not as it should be.
    Format(&'static str),
    /// The setup makes no stack.
    Setup(SetupError),
    /// The stack refused an input.
    Refused {
        /// Name of the run.
        name: Name,
        /// Number of the tick in the run.
        tick: u32,
        /// Why.
        error: ControlError,
    },
    /// A bit differs.
    Differs(Difference),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(what) => f.write_str(what),
            Self::Setup(error) => write!(f, "the setup makes no stack: {error}"),
            Self::Refused { name, tick, error } => write!(f, "{name}: tick {tick}: refused: {error}"),
            Self::Differs(difference) => difference.fmt(f),
        }
    }
}

impl core::error::Error for Failure {}
