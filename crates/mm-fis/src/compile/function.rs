//! A system as the function of one of its outputs.

use mm_control::fuzzy::FuzzyError;

use crate::{Accuracy, System};

impl System {
    /// Hands one output as a function of all inputs to `work`, for [`CompiledSurface`](super::CompiledSurface) and its like.
    ///
    /// # Errors
    /// As [`with_engine`](Self::with_engine); [`FuzzyError::OutOfRange`] (`outputs`) for an output that does not exist.
    pub fn with_function<R>(
        &self,
        accuracy: Accuracy,
        output: usize,
        work: impl FnOnce(&(dyn Fn(&[f64]) -> f64 + Sync)) -> R,
    ) -> Result<R, FuzzyError> {
        if output >= self.outputs.len() {
            return Err(FuzzyError::OutOfRange("outputs"));
        }
        self.with_engine(accuracy, |engine| {
            work(&|inputs| {
                let mut numbers = vec![0.0; self.outputs.len() + engine.workspace_len()];
                let (outputs, workspace) = numbers.split_at_mut(self.outputs.len());
                match engine.infer(inputs, outputs, workspace) {
                    Ok(_met) => outputs[output],
                    // Another number of inputs than the system has: no table will be made of that.
                    Err(_) => f64::NAN,
                }
            })
        })
    }
}
