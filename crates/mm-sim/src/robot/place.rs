//! What is wrong with a URDF, and where.

use std::fmt;
use std::ops::Range;

use crate::snippet::Message;

/// Why a URDF cannot be imported; displays with the place in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UrdfError {
    name: String,
    text: String,
    problem: Box<Problem>,
}

/// What is wrong, and with which element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) message: String,
    pub(super) expected: String,
    pub(super) nearest: Option<String>,
    pub(super) at: At,
}

/// The part of the file that a problem is about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum At {
    /// The robot as a whole.
    Robot,
    /// A link, by its name.
    Link(String),
    /// A joint, by its name.
    Joint(String),
    /// A byte of the text.
    Byte(usize),
}

impl Problem {
    pub(super) fn new(at: At, message: impl Into<String>, expected: impl Into<String>) -> Self {
        Self { message: message.into(), expected: expected.into(), nearest: None, at }
    }

    pub(super) fn joint(name: &str, message: impl Into<String>, expected: impl Into<String>) -> Self {
        let message = format!("joint `{name}`: {}", message.into());
        Self::new(At::Joint(name.to_owned()), message, expected)
    }

    pub(super) fn link(name: &str, message: impl Into<String>, expected: impl Into<String>) -> Self {
        let message = format!("link `{name}`: {}", message.into());
        Self::new(At::Link(name.to_owned()), message, expected)
    }
}

impl UrdfError {
    pub(super) fn new(name: &str, text: &str, problem: Problem) -> Self {
        Self { name: name.to_owned(), text: text.to_owned(), problem: Box::new(problem) }
    }

    /// What was found.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.problem.message
    }

    /// The bytes of the text that it is about.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        let named = |tag: &str, name: &str| self.element(tag, Some(name)).or_else(|| self.element(tag, None));
        let span = match &self.problem.at {
            At::Robot => self.element("robot", None),
            At::Link(name) => named("link", name),
            At::Joint(name) => named("joint", name),
            At::Byte(byte) => Some(*byte..*byte),
        };
        span.unwrap_or(0..0)
    }

    /// The start tag of the first element of a kind and a name.
    fn element(&self, tag: &str, name: Option<&str>) -> Option<Range<usize>> {
        let document = roxmltree::Document::parse(&self.text).ok()?;
        let is_it = |node: &roxmltree::Node<'_, '_>| {
            node.has_tag_name(tag) && name.is_none_or(|name| node.attribute("name") == Some(name))
        };
        let start = document.descendants().find(is_it)?.range().start;
        let length = self.text.get(start..)?.find('>').map_or(0, |end| end + 1);
        Some(start..start + length)
    }
}

impl fmt::Display for UrdfError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Problem { message, expected, nearest, .. } = &*self.problem;
        let message = Message {
            title: message.clone(),
            expected: Some(expected),
            nearest: nearest.as_deref(),
            place: Some((&self.name, &self.text, self.span())),
            ..Message::default()
        };
        write!(f, "{message}")
    }
}

impl std::error::Error for UrdfError {}
