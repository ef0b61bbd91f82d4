//! A rule engine of one input and one output as a function of a number.

use super::{Engine, Tables};
use crate::fuzzy::FuzzyError;

/// A map from one 16-bit number to another: a [`Curve`] or a [`Surface1`](super::Surface1).
pub trait Evaluate {
    /// Output for the input `q`, both in units of 2^-15 of half their range, from its middle.
    #[must_use]
    fn evaluate(&self, q: i16) -> i16;
}

/// An [`Engine`] of one input and one output that brings its workspace: `WORK` words on the stack while it evaluates.
///
/// Cost: clearing the workspace besides that of the engine; `WORK` need not exceed [`Engine::workspace_len`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curve<'a, const WORK: usize = 8> {
    engine: Engine<'a>,
}

impl<'a, const WORK: usize> Curve<'a, WORK> {
    /// Checks the tables and takes them.
    ///
    /// # Errors
    /// As [`Engine::try_new`]; [`FuzzyError::Length`] (`inputs`, `outputs`) unless there is one each, and
    /// [`FuzzyError::TooMany`] (`workspace`) where `WORK` is too small.
    pub fn try_new(tables: &'a Tables<'a>) -> Result<Self, FuzzyError> {
        let engine = Engine::try_new(tables)?;
        if tables.inputs.len() != 1 {
            return Err(FuzzyError::Length("inputs"));
        }
        if tables.outputs.len() != 1 {
            return Err(FuzzyError::Length("outputs"));
        }
        if engine.workspace_len() > WORK {
            return Err(FuzzyError::TooMany("workspace"));
        }
        Ok(Self { engine })
    }

    /// The engine behind it.
    #[must_use]
    pub const fn engine(&self) -> &Engine<'a> {
        &self.engine
    }
}

impl<const WORK: usize> Evaluate for Curve<'_, WORK> {
    #[inline]
    fn evaluate(&self, q: i16) -> i16 {
        let (mut output, mut workspace) = ([0], [0; WORK]);
        // The lengths were checked at construction, so there is nothing left to refuse.
        let _checked = self.engine.infer_cleared(&[q], &mut output, &mut workspace);
        let [y] = output;
        y
    }
}
