//! Scenarios as texts, to be made again elsewhere.

use std::path::PathBuf;

use super::diagnostic::Source;
use super::{Files, Loaded, ScenarioError, assemble};

impl Loaded {
    /// Returns the edits that were laid over the file, in their order.
    #[must_use]
    pub fn edits(&self) -> &[String] {
        &self.sets
    }

    /// Returns everything that the scenario is made of.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        let texts = self.sources.iter().map(|source| (source.name.clone(), source.text.clone()));
        Snapshot { texts: texts.collect(), folder: self.folder.clone(), sets: self.sets.clone() }
    }
}

/// Every text that a scenario is made of: with it the scenario can be made again where none of its files is.
#[derive(Debug, Clone, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Snapshot {
    /// Name and text: the file, the edits, the files that they name.
    texts: Vec<(String, String)>,
    folder: PathBuf,
    sets: Vec<String>,
}

impl Snapshot {
    /// Makes the scenario again.
    ///
    /// # Errors
    ///
    /// As [`load`](super::load), where the texts are not those of a scenario that was loaded.
    pub fn restore(&self) -> Result<Loaded, ScenarioError> {
        let source = |(name, text): &(String, String)| Source::new(name, text);
        let known: Vec<Source> = self.texts.iter().map(source).collect();
        let (name, text) = known.first().map_or(("", ""), |first| (&first.name, &first.text));
        let files = Files { folder: &self.folder, known: &known, settled: self.sets.len() };
        assemble((name, text), &files, &self.sets)
    }
}
