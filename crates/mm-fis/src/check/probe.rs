//! An engine that is asked for one point after another.

use crate::{Engine, System};

/// An engine with the room that it works in.
pub(super) struct Probe<'a> {
    engine: &'a Engine<'a>,
    workspace: Vec<f64>,
    count: usize,
}

impl<'a> Probe<'a> {
    pub(super) fn new(engine: &'a Engine<'a>, system: &System) -> Self {
        Self { engine, workspace: vec![0.0; engine.workspace_len()], count: system.outputs.len() }
    }

    /// The outputs for these inputs.
    pub(super) fn at(&mut self, inputs: &[f64]) -> Vec<f64> {
        let mut outputs = vec![0.0; self.count];
        // The lengths are those of the system, so that nothing is refused.
        let _met = self.engine.infer(inputs, &mut outputs, &mut self.workspace);
        outputs
    }
}
