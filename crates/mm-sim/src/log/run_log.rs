//! The log of one run: what a recorder writes, sample by sample.

use std::path::Path;

use super::convert::{Converter, with_header};
use super::timely::TimelyWriter;
use super::{LogError, LogWriter, Outcome};
use crate::experiment::Experiment;
use crate::scenario::Loaded;
use crate::simulation::{Recorder, Sample};

/// A log that takes the samples of a run.
#[derive(Debug)]
pub struct RunLog {
    writer: TimelyWriter,
    converter: Converter,
}

impl RunLog {
    /// The path that stands for standard output.
    pub const STDOUT: &str = "-";

    /// Makes the file of a scenario's run, with what is known before it begins.
    ///
    /// # Errors
    /// The file cannot be made or written.
    pub fn create(loaded: &Loaded, experiment: &Experiment, path: &Path) -> Result<Self, LogError> {
        let writer = with_header(loaded, experiment, |header| {
            if path == Self::STDOUT { LogWriter::to_stdout(header) } else { LogWriter::create(path, header) }
        })?;
        Ok(Self { writer: TimelyWriter::new(writer), converter: Converter::new(experiment) })
    }

    /// Writes down what somebody changed while the run goes on.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn note_change(&self, change: &str) -> Result<(), LogError> {
        self.writer.note_change(change)
    }

    /// Ends the file of a run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self, outcome: Outcome, summary: &str, digest: &str) -> Result<(), LogError> {
        self.writer.finish_as(outcome, summary, digest)
    }
}

impl Recorder for RunLog {
    type Error = LogError;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, LogError> {
        let converted = self.converter.converted(sample);
        self.writer.write(&converted)?;
        Ok(true)
    }
}
