//! Making a recording.

use core::fmt;

use mm_control::{ControlError, ControlStack, ControlState, Output, SetupError};
use mm_link::{Setup, signals};

use crate::format::{self, Entry, Head, Seen};
use crate::{Name, Word};

/// Where a recording is written.
pub trait Sink {
    /// Takes all of the bytes.
    ///
    /// # Errors
    /// [`Full`], where it cannot.
    fn write(&mut self, bytes: &[u8]) -> Result<(), Full>;
}

/// The bytes could not be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Full;

impl fmt::Display for Full {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the recording could not be written")
    }
}

impl core::error::Error for Full {}

/// A recording under way: it updates a stack with what it is given and writes both down.
#[derive(Debug, Clone)]
pub struct Recording<T: Word> {
    stack: ControlStack<T, 3>,
    state: ControlState<T, 3>,
}

impl<T: Word> Recording<T> {
    /// Begins a recording of so many ticks; `first` shows the kind of what is seen, which has to stay the same.
    ///
    /// # Errors
    /// [`Failure::Setup`](crate::Failure::Setup) as a [`SetupError`], or [`Full`].
    pub fn begin(
        name: &str,
        setup: &Setup<T>,
        first: &Seen<T>,
        ticks: u32,
        sink: &mut impl Sink,
    ) -> Result<Self, RecordError> {
        let stack = *setup.build().map_err(RecordError::Setup)?.stack();
        let mut room = [0; format::LONGEST_SETUP];
        let bytes = postcard::to_slice(setup, &mut room).map_err(|_| RecordError::Full)?;
        let length = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let head = Head { width: T::BYTES, kind: first.kind(), name: Name::new(name), setup: length, ticks };
        head.write(sink)?;
        sink.write(bytes)?;
        Ok(Self { stack, state: stack.initial_state() })
    }

    /// Updates the stack and writes the tick.
    ///
    /// # Errors
    /// What the stack refuses, or [`Full`].
    pub fn add(&mut self, entry: &Entry<T>, sink: &mut impl Sink) -> Result<Output<T, 3>, RecordError> {
        entry.write(sink)?;
        let output = update(&self.stack, &mut self.state, entry).map_err(RecordError::Refused)?;
        signals::numbers(&output).try_for_each(|value| format::number(sink, value))?;
        sink.write(&signals::outcomes(&output.status).to_le_bytes())?;
        Ok(output)
    }
}

/// One update, with whatever is seen.
pub(crate) fn update<T: Word>(
    stack: &ControlStack<T, 3>,
    state: &mut ControlState<T, 3>,
    entry: &Entry<T>,
) -> Result<Output<T, 3>, ControlError> {
    let reference = entry.reference;
    match entry.seen {
        Seen::State(q, nu) => stack.update(state, &mm_control::Input { q, nu, reference }),
        Seen::Measured(measurement) => stack.update_measured(state, &measurement, &reference),
    }
}

/// Why a recording failed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RecordError {
    /// The setup makes no stack.
    Setup(SetupError),
    /// The stack refused an input.
    Refused(ControlError),
    /// It could not be written.
    Full,
}

impl From<Full> for RecordError {
    fn from(_: Full) -> Self {
        Self::Full
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Setup(error) => write!(f, "the setup makes no stack: {error}"),
            Self::Refused(error) => write!(f, "an input was refused: {error}"),
            Self::Full => Full.fmt(f),
        }
    }
}

impl core::error::Error for RecordError {}
