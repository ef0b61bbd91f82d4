//! What is wrong with a scenario, where, and how it should be.

use std::fmt;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::tree::Place;

/// Longest expectation that stands beside the caret; a longer one gets its own line.
const MAX_LABEL: usize = 48;

/// Problems that are shown; a file with more of them is not meant as a scenario.
const MAX_SHOWN: usize = 30;

/// A named text that a scenario is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Source {
    /// The file as given, or `--set`.
    pub(super) name: String,
    pub(super) text: String,
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

    fn render(&self, problem: &Problem) -> String {
        let mut group = Group::with_title(Level::ERROR.primary_title(problem.title()));
        let mut label = problem.expected.as_deref().map(|expected| format!("expected {expected}"));
        if let Some((place, source)) =
            problem.place.as_ref().and_then(|place| Some((place, self.sources.get(place.source)?)))
        {
            let short = label.as_deref().is_some_and(|label| label.chars().count() <= MAX_LABEL);
            let beside = if short { label.take() } else { None };
            group = group.element(
                Snippet::source(source.text.as_str())
                    .path(source.name.as_str())
                    .annotation(AnnotationKind::Primary.span(first_line(&source.text, place)).label(beside)),
            );
            if source.name == super::SET_NAME
                && let Some(file) = self.sources.first()
            {
                group = group.element(Level::NOTE.message(format!("given over {}", file.name)));
            }
        }
        if let Some(label) = label {
            group = group.element(Level::NOTE.message(label));
        }
        if let Some(nearest) = &problem.nearest {
            group = group.element(Level::HELP.message(format!("the nearest known name is `{nearest}`")));
        }
        Renderer::plain().render(&[group])
    }
}

/// The part of a place on its first line, so that a caret never runs over a whole table, in whole characters.
fn first_line(text: &str, place: &Place) -> std::ops::Range<usize> {
    let start = boundary(text, place.span.start);
    let stop = boundary(text, place.span.end).max(start);
    let length = text.get(start..stop).and_then(|part| part.find(['\r', '\n'])).unwrap_or(stop - start);
    start..start + length
}

/// The last start of a character, or the end of the text, at or before a byte.
fn boundary(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

impl fmt::Display for ScenarioError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().take(MAX_SHOWN).enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            f.write_str(&self.render(problem))?;
        }
        match self.problems.len().saturating_sub(MAX_SHOWN) {
            0 => Ok(()),
            more => write!(f, "\n\nand {more} more"),
        }
    }
}

impl std::error::Error for ScenarioError {}
