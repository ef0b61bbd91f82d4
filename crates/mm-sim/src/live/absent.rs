//! What stands in for the server in a build without it: there is none, and nobody can make one.

use super::{LiveError, Options};
use crate::experiment::Experiment;
use crate::scenario::Loaded;
use crate::simulation::{Retuned, Sample};

/// A served run: none in this build.
#[expect(missing_copy_implementations, reason = "the one that serves is not copied either")]
#[derive(Debug)]
pub enum Live {}

impl Live {
    /// Serves a run.
    ///
    /// # Errors
    /// [`LiveError::Absent`].
    pub fn start(_prepared: (&Loaded, &Experiment), _options: Options) -> Result<Self, LiveError> {
        Err(LiveError::Absent)
    }

    /// Where viewers connect.
    #[must_use]
    pub const fn url(&self) -> String {
        match *self {}
    }

    /// Waits until somebody watches.
    pub const fn wait_for_viewer(&self, _asked_to_stop: fn() -> bool) {
        match *self {}
    }

    /// Shows a sample when its time has come.
    pub const fn show(&mut self, _sample: &Sample<'_>, _asked_to_stop: fn() -> bool) {
        match *self {}
    }

    /// The controller that a viewer asked for.
    pub const fn retuned(&mut self) -> Option<Box<Retuned>> {
        match *self {}
    }

    /// What viewers changed, and when.
    #[must_use]
    pub const fn changes(&self) -> &[String] {
        match *self {}
    }
}
