//! What is wrong with a scenario, where, and how it should be.

use std::fmt;
use std::path::{Path, PathBuf};

use super::tree::Place;
use crate::snippet::{Message, boundary};

/// Problems that are shown; a file with more of them is not meant as a scenario.
const MAX_SHOWN: usize = 30;

/// A named text that a scenario is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    /// The file as given, or `--set`.
    pub(super) name: String,
    pub(super) text: String,
    /// Where the files are that it names: that of the scenario and of what it includes; none for the working directory.
    pub(super) folder: Option<PathBuf>,
}

impl Source {
    /// A text that names files, if it names any, from the working directory.
    pub(super) fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into(), folder: None }
    }

    /// The same of a file that names others from its folder.
    pub(super) fn within(mut self, folder: &Path) -> Self {
        self.folder = Some(folder.to_owned());
        self
    }

    /// Whether it is what the scenario says itself: its file, what that includes, an edit.
    pub(super) fn is_own(&self) -> bool {
        self.folder.is_some() || self.name == super::SET_NAME
    }
}

/// One thing that is wrong with a scenario.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    key: String,
    message: String,
    expected: Option<String>,
    nearest: Option<String>,
    place: Option<Place>,
}

impl Problem {
    pub(super) fn new(key: &str, message: impl Into<String>, place: Place) -> Self {
        Self {
            key: key.to_owned(),
            message: message.into(),
            expected: None,
            nearest: None,
            place: Some(place),
        }
    }

    pub(super) fn without_place(message: impl Into<String>) -> Self {
        Self { key: String::new(), message: message.into(), expected: None, nearest: None, place: None }
    }

    pub(super) fn expected(mut self, expected: impl Into<String>) -> Self {
        self.expected = Some(expected.into());
        self
    }

    pub(super) fn nearest(mut self, nearest: Option<impl Into<String>>) -> Self {
        self.nearest = nearest.map(Into::into);
        self
    }

    /// Whether it lies in a text before a byte of it.
    pub(super) fn is_before(&self, source: usize, byte: usize) -> bool {
        self.place.as_ref().is_some_and(|place| place.source == source && place.span.end <= byte)
    }

    pub(super) fn boxed(self) -> Box<Self> {
        Box::new(self)
    }

    /// The dotted key that the problem is at; empty when it is the text as a whole.
    #[must_use]
    pub fn key(&self) -> &str {
        &self.key
    }

    /// What was found.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What would have been right.
    #[must_use]
    pub fn expected_text(&self) -> Option<&str> {
        self.expected.as_deref()
    }

    /// The known name nearest to an unknown one.
    #[must_use]
    pub fn nearest_name(&self) -> Option<&str> {
        self.nearest.as_deref()
    }

    fn title(&self) -> String {
        if self.key.is_empty() { self.message.clone() } else { format!("`{}`: {}", self.key, self.message) }
    }
}

/// All that is wrong with a scenario.
///
/// Displays as one paragraph a problem, each with the file as given, line, column, the text there, what was
/// found and what was expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScenarioError {
    sources: Vec<Source>,
    problems: Vec<Problem>,
}

impl ScenarioError {
    /// Gathers problems in the order of their places.
    pub(super) fn new(sources: &[Source], mut problems: Vec<Problem>) -> Self {
        problems.sort_by_key(|problem| problem.place.as_ref().map(|place| (place.source, place.span.start)));
        Self { sources: sources.to_vec(), problems }
    }

    /// The problems, in the order of their places.
    #[must_use]
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// The problems for somebody who does not see the texts: keys, what was found and what was expected, without places.
    #[cfg(feature = "live")]
    pub(crate) fn in_words(&self) -> String {
        let words = |problem: &Problem| match &problem.expected {
            Some(expected) => format!("{}, expected {expected}", problem.title()),
            None => problem.title(),
        };
        self.problems.iter().map(words).collect::<Vec<_>>().join("; ")
    }

    /// The name of the text, the line and the column, both from one, that a problem is at.
    #[must_use]
    pub fn location(&self, problem: &Problem) -> Option<(&str, usize, usize)> {
        let place = problem.place.as_ref()?;
        let source = self.sources.get(place.source)?;
        let before = source.text.get(..boundary(&source.text, place.span.start))?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line = before.matches('\n').count() + 1;
        let column = before.get(line_start..)?.chars().count() + 1;
        Some((&source.name, line, column))
    }

    fn message<'a>(&'a self, problem: &'a Problem) -> Message<'a> {
        let place = problem.place.as_ref().and_then(|place| Some((place, self.sources.get(place.source)?)));
        let is_set = place.is_some_and(|(_, source)| source.name == super::SET_NAME);
        let file = self.sources.first().filter(|_| is_set);
        Message {
            is_warning: false,
            title: problem.title(),
            expected: problem.expected.as_deref(),
            nearest: problem.nearest.as_deref(),
            place: place
                .map(|(place, source)| (source.name.as_str(), source.text.as_str(), place.span.clone())),
            remark: file.map(|file| format!("given over {}", file.name)),
        }
    }
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().take(MAX_SHOWN).enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            write!(f, "{}", self.message(problem))?;
        }
        match self.problems.len().saturating_sub(MAX_SHOWN) {
            0 => Ok(()),
            more => write!(f, "\n\nand {more} more"),
        }
    }
}

impl std::error::Error for ScenarioError {}
