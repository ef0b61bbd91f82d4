//! What a log says about its run: how it started and how it ended.

use super::urdf::RobotShape;
use crate::simulation::Ending;
use mcap::records::Metadata;

/// What a log says about its run before the first sample.
#[derive(Debug, Clone, Copy)]
pub struct LogHeader<'a> {
    /// Name of the scenario.
    pub scenario_name: &'a str,
    /// The scenario's file, TOML.
    pub scenario_text: &'a str,
    /// The edits that were laid over it, each `key=value`.
    pub edits: &'a [String],
    /// Texts of the files that the scenario names, such as a robot or waypoints: file as found, text.
    pub files: &'a [(&'a str, &'a str)],
    /// What else took part and its version: name, version. This crate's own is always there.
    pub versions: &'a [(&'a str, &'a str)],
    /// Seed of everything random.
    pub seed: u64,
    /// Kind of the controller.
    pub controller: &'a str,
    /// The robot to draw.
    pub robot: RobotShape,
    /// The desired path of the tip in the world: time in seconds, x, y and z in metres.
    pub reference: &'a [[f64; 4]],
}

/// The edits of a record `mmsim`: a JSON array of texts.
#[must_use]
pub fn edits(text: &str) -> Vec<String> {
    serde_json::from_str(text).unwrap_or_default()
}

/// Name of the records that say what was changed while the run went on.
pub(super) const CHANGES: &str = "mmsim.changes";

/// The record of a change; their keys are in the order of time as text, too.
pub(super) fn change(number: u32, text: &str) -> Metadata {
    let entry = (format!("{number:010}"), text.to_owned());
    Metadata { name: CHANGES.to_owned(), metadata: [entry].into() }
}

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// It reached its end.
    Finished,
    /// It left the bounds in which its numbers mean anything.
    Diverged,
    /// The controller refused what it was given.
    Refused,
    /// The supervisor gave the robot up.
    Faulted,
    /// It was asked to stop.
    Interrupted,
}

impl From<&Ending> for Outcome {
    fn from(ending: &Ending) -> Self {
        match ending {
            Ending::Finished => Self::Finished,
            Ending::Stopped { .. } => Self::Interrupted,
            Ending::Faulted { .. } => Self::Faulted,
            Ending::Refused { .. } => Self::Refused,
            Ending::Diverged { .. } => Self::Diverged,
        }
    }
}

impl Outcome {
    /// The word for it in the file.
    #[must_use]
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Diverged => "diverged",
            Self::Refused => "refused",
            Self::Faulted => "fault",
            Self::Interrupted => "interrupted",
        }
    }

    /// The record `mmsim.result`.
    pub(super) fn metadata(self, digest: &str, samples: u32, end_ns: u64) -> Metadata {
        let entries = [
            ("outcome", self.as_str().to_owned()),
            ("digest", digest.to_owned()),
            ("samples", samples.to_string()),
            ("end_ns", end_ns.to_string()),
        ];
        named("mmsim.result", entries)
    }
}

impl LogHeader<'_> {
    /// The record `mmsim`.
    pub(super) fn metadata(&self) -> Metadata {
        let fixed = [
            ("version", crate::VERSION.to_owned()),
            ("scenario", self.scenario_name.to_owned()),
            ("controller", self.controller.to_owned()),
            ("seed", self.seed.to_string()),
            ("edits", serde_json::to_string(self.edits).unwrap_or_default()),
        ];
        let mut record = named("mmsim", fixed);
        for (name, version) in self.versions {
            record.metadata.insert(format!("version.{name}"), (*version).to_owned());
        }
        record
    }
}

fn named<const N: usize>(name: &str, entries: [(&str, String); N]) -> Metadata {
    let metadata = entries.map(|(key, value)| (key.to_owned(), value)).into();
    Metadata { name: name.to_owned(), metadata }
}
