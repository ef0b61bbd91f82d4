//! An engine that is asked for one point after another.

use crate::{Engine, System};

/// An engine with the room that it works in.
pub(super) struct Probe<'a> {
    engine: &'a Engine<'a>,
    workspace: Vec<f64>,
    /// Widths of the outputs' ranges.
    widths: Vec<f64>,
}

impl<'a> Probe<'a> {
    pub(super) fn new(engine: &'a Engine<'a>, system: &System) -> Self {
        let widths = system.outputs.iter().map(|output| output.range.1 - output.range.0).collect();
        Self { engine, workspace: vec![0.0; engine.workspace_len()], widths }
    }

    /// The outputs for these inputs.
    pub(super) fn at(&mut self, inputs: &[f64]) -> Vec<f64> {
        let mut outputs = vec![0.0; self.widths.len()];
        // The lengths are those of the system, so that nothing is refused.
        let _met = self.engine.infer(inputs, &mut outputs, &mut self.workspace);
        outputs
    }

    /// Widths of the outputs' ranges.
    pub(super) fn widths(&self) -> &[f64] {
        &self.widths
    }
}
