//! Pieces of a text that know where they are, and the report on them.

use std::ops::Range;

use super::{Problem, ReadError, nearest};

/// Problems that are kept; a text with more of them is not meant as a fuzzy system.
const MAX_PROBLEMS: usize = 100;

/// Known names that a message lists.
const MAX_LISTED: usize = 25;

/// Characters of a found text that a message repeats.
const MAX_SHOWN: usize = 40;

/// A part of the text and the byte at which it starts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Piece<'a> {
    pub(crate) text: &'a str,
    pub(crate) start: usize,
}

impl<'a> Piece<'a> {
    pub(crate) const fn new(text: &'a str, start: usize) -> Self {
        Self { text, start }
    }

    pub(crate) const fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// The first `bytes` of it and the rest; all and nothing where they do not end on a character.
    pub(crate) fn split_at(self, bytes: usize) -> (Self, Self) {
        let (head, tail) = self.text.split_at_checked(bytes).unwrap_or((self.text, ""));
        (Self::new(head, self.start), Self::new(tail, self.start + head.len()))
    }

    /// Without blanks at both ends.
    pub(crate) fn trim(self) -> Self {
        self.trim_start().trim_end()
    }

    pub(crate) fn trim_start(self) -> Self {
        let text = self.text.trim_start();
        Self::new(text, self.start + (self.text.len() - text.len()))
    }

    pub(crate) fn trim_end(self) -> Self {
        Self::new(self.text.trim_end(), self.start)
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.text.is_empty()
    }

    /// The place just behind it.
    pub(crate) const fn end(self) -> Self {
        Self::new("", self.start + self.text.len())
    }

    /// The piece as a message shows it: in backticks, shortened, without control characters.
    pub(crate) fn shown(&self) -> String {
        shown(self.text)
    }
}

/// A found text as a message shows it.
pub(crate) fn shown(text: &str) -> String {
    if text.is_empty() {
        return "nothing".to_owned();
    }
    let mut word: String =
        text.chars().take(MAX_SHOWN).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(MAX_SHOWN).is_some() {
        word.push_str("...");
    }
    format!("`{word}`")
}

/// Collects the problems of a text.
#[derive(Debug)]
pub(crate) struct Report {
    problems: Vec<Found>,
    left_off: usize,
}

#[derive(Debug)]
struct Found {
    span: Range<usize>,
    message: String,
    expected: Option<String>,
    nearest: Option<String>,
}

impl Report {
    pub(crate) const fn new() -> Self {
        Self { problems: Vec::new(), left_off: 0 }
    }

    pub(crate) const fn is_empty(&self) -> bool {
        self.problems.is_empty()
    }

    /// Adds a problem whose message says all.
    pub(crate) fn add(&mut self, place: Piece<'_>, message: impl Into<String>) {
        self.push(place, message.into(), None, None);
    }

    /// Adds a problem with what was expected instead.
    pub(crate) fn add_expected(
        &mut self,
        place: Piece<'_>,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) {
        self.push(place, message.into(), Some(expected.into()), None);
    }

    /// Adds what was found where something else was expected.
    pub(crate) fn add_found(&mut self, place: Piece<'_>, expected: impl Into<String>) {
        self.push(place, format!("found {}", place.shown()), Some(expected.into()), None);
    }

    /// Adds an unknown name, with those that are known.
    pub(crate) fn add_unknown(&mut self, place: Piece<'_>, what: &str, known: &[&str]) {
        if self.problems.len() >= MAX_PROBLEMS {
            // Spares the search; a text may have as many of them as names.
            self.left_off += 1;
            return;
        }
        let expected = (!known.is_empty()).then(|| one_of(known));
        let near = nearest(place.text, known.iter().copied()).map(str::to_owned);
        self.push(place, format!("{what} {}", place.shown()), expected, near);
    }

    fn push(&mut self, place: Piece<'_>, message: String, expected: Option<String>, nearest: Option<String>) {
        if self.problems.len() < MAX_PROBLEMS {
            self.problems.push(Found { span: place.span(), message, expected, nearest });
        } else {
            self.left_off += 1;
        }
    }

    /// The problems with their lines and columns, in the order of their places.
    pub(crate) fn locate(mut self, text: &str) -> Vec<Problem> {
        self.problems.sort_by_key(|problem| problem.span.start);
        self.problems.into_iter().map(|found| found.locate(text)).collect()
    }

    /// Succeeds with `value` unless there are problems.
    pub(crate) fn finish<T>(mut self, text: &str, value: Option<T>) -> Result<T, ReadError> {
        if let (Some(value), true) = (value, self.is_empty()) {
            return Ok(value);
        }
        if self.is_empty() {
            self.add(Piece::new("", 0), "the text holds no system");
        }
        let left_off = self.left_off;
        Err(ReadError { problems: self.locate(text), left_off })
    }
}

impl Found {
    fn locate(self, text: &str) -> Problem {
        let (start, stop) = (boundary(text, self.span.start), boundary(text, self.span.end));
        let found = text.get(start..stop).unwrap_or_default();
        let end = start + found.find(['\n', '\r']).unwrap_or(found.len());
        let before = text.get(..start).unwrap_or_default();
        // A line ends with CR LF, CR or LF.
        let breaks =
            before.matches('\n').count() + before.matches('\r').count() - before.matches("\r\n").count();
        let line_start = before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
        let inside = before.get(line_start..).unwrap_or_default();
        let column = inside.trim_start_matches('\u{feff}').chars().count() + 1;
        Problem {
            span: start..end,
            line: breaks + 1,
            column,
            message: self.message,
            expected: self.expected,
            nearest: self.nearest,
        }
    }
}

/// The last start of a character, or the end of the text, at or before a byte.
fn boundary(text: &str, byte: usize) -> usize {
    let byte = byte.min(text.len());
    (0..=byte).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

/// `a`, `b` or `c`; of many words, the first ones.
pub(crate) fn one_of(words: &[&str]) -> String {
    let mut quoted: Vec<String> = words.iter().take(MAX_LISTED).map(|word| shown(word)).collect();
    if let Some(more) = words.len().checked_sub(MAX_LISTED).filter(|more| *more > 0) {
        quoted.push(format!("{more} more"));
    }
    match quoted.split_last() {
        None => "nothing".to_owned(),
        Some((only, [])) => only.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    }
}
