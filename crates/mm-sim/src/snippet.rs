//! A message about a place in a text, with the text there and what was expected.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

/// Longest expectation that stands beside the caret; a longer one gets its own line.
const MAX_LABEL: usize = 48;

/// A message; displays as a paragraph.
#[derive(Debug, Clone, Default)]
pub(crate) struct Message<'a> {
    /// Whether it is only a warning.
    pub(crate) is_warning: bool,
    /// What was found.
    pub(crate) title: String,
    /// What would have been right.
    pub(crate) expected: Option<&'a str>,
    /// The known name nearest to an unknown one.
    pub(crate) nearest: Option<&'a str>,
    /// Name of the text, the text, and the bytes that the message is about.
    pub(crate) place: Option<(&'a str, &'a str, Range<usize>)>,
    /// A remark on the place.
    pub(crate) remark: Option<String>,
}

impl fmt::Display for Message<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let level = if self.is_warning { Level::WARNING } else { Level::ERROR };
        let mut group = Group::with_title(level.primary_title(self.title.as_str()));
        let mut label = self.expected.map(|expected| format!("expected {expected}"));
        if let Some((name, text, span)) = &self.place {
            let short = label.as_deref().is_some_and(|label| label.chars().count() <= MAX_LABEL);
            let beside = if short { label.take() } else { None };
            group = group.element(
                Snippet::source(*text)
                    .path(*name)
                    .annotation(AnnotationKind::Primary.span(first_line(text, span)).label(beside)),
            );
        }
        if let Some(remark) = &self.remark {
            group = group.element(Level::NOTE.message(remark));
        }
        if let Some(label) = label {
            group = group.element(Level::NOTE.message(label));
        }
        if let Some(nearest) = self.nearest {
            group = group.element(Level::HELP.message(format!("the nearest known name is `{nearest}`")));
        }
        f.write_str(&Renderer::plain().render(&[group]))
    }
}

/// The part of a place on its first line, so that a caret never runs over a whole table, in whole characters.
fn first_line(text: &str, span: &Range<usize>) -> Range<usize> {
    let start = boundary(text, span.start);
    let stop = boundary(text, span.end).max(start);
    let length = text.get(start..stop).and_then(|part| part.find(['\r', '\n'])).unwrap_or(stop - start);
    start..start + length
}

/// The last start of a character, or the end of the text, at or before a byte.
pub(crate) fn boundary(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}
