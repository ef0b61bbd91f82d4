//! A TOML document as a tree in which every key and value knows its place.

mod merge;
mod set;

use std::collections::BTreeMap;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

pub(super) use merge::lay_over;
pub(super) use set::set;

/// A stretch of one of the texts that a scenario is made of: its file, a robot file, a `--set` argument.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Place {
    /// Index of the text.
    pub(super) source: usize,
    /// Bytes of the text.
    pub(super) span: Range<usize>,
}

/// A value and its place.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) value: Value,
    pub(super) place: Place,
}

/// A TOML value.
#[derive(Debug, Clone)]
pub(super) enum Value {
    String(String),
    Integer(i128),
    Float(f64),
    Boolean(bool),
    Datetime,
    Array(Vec<Node>),
    Table(Table),
}

/// A TOML table.
pub(super) type Table = BTreeMap<String, Entry>;

/// A value in a table with the place of its key.
#[derive(Debug, Clone)]
pub(super) struct Entry {
    pub(super) key: Place,
    pub(super) node: Node,
}

/// Parses a TOML document: the tree, and every syntax error as its message and bytes.
///
/// With errors the tree is that of the text before the first of them; what follows is anyone's guess.
pub(super) fn parse(source: usize, text: &str) -> (Node, Vec<(String, Range<usize>)>) {
    let (document, errors) = DeTable::parse_recoverable(text);
    let table = document.into_inner();
    let end = text.len();
    let errors = errors.iter().map(|error| {
        let span = error.span().unwrap_or(0..0);
        (error.message().to_owned(), span.start.min(end)..span.end.min(end))
    });
    (Node { value: from_table(source, table), place: Place { source, span: 0..0 } }, errors.collect())
}

/// Parses a TOML value that starts at byte `offset` of its text.
fn parse_value(source: usize, offset: usize, text: &str) -> Option<Node> {
    let value = DeValue::parse(text).ok()?;
    let mut node = from_value(source, value.span(), value.into_inner());
    shift(&mut node, offset);
    Some(node)
}

fn from_table(source: usize, table: DeTable<'_>) -> Value {
    let entries = table.into_iter().map(|(key, value)| {
        let place = Place { source, span: key.span() };
        let node = from_value(source, value.span(), value.into_inner());
        (key.into_inner().into_owned(), Entry { key: place, node })
    });
    Value::Table(entries.collect())
}

fn from_value(source: usize, span: Range<usize>, value: DeValue<'_>) -> Node {
    let value = match value {
        DeValue::String(text) => Value::String(text.into_owned()),
        DeValue::Boolean(flag) => Value::Boolean(flag),
        DeValue::Datetime(_) => Value::Datetime,
        // An integer beyond 128 bits is beyond every range here as well: it becomes infinite.
        DeValue::Integer(digits) => i128::from_str_radix(digits.as_str(), digits.radix())
            .map_or(Value::Float(f64::INFINITY), Value::Integer),
        DeValue::Float(digits) => Value::Float(digits.as_str().parse().unwrap_or(f64::NAN)),
        DeValue::Array(items) => Value::Array(
            items.into_iter().map(|item| from_value(source, item.span(), item.into_inner())).collect(),
        ),
        DeValue::Table(table) => from_table(source, table),
    };
    Node { value, place: Place { source, span } }
}

fn shift(node: &mut Node, offset: usize) {
    let moved = |place: &mut Place| place.span = place.span.start + offset..place.span.end + offset;
    moved(&mut node.place);
    match &mut node.value {
        Value::Array(items) => items.iter_mut().for_each(|item| shift(item, offset)),
        Value::Table(table) => {
            for entry in table.values_mut() {
                moved(&mut entry.key);
                shift(&mut entry.node, offset);
            }
        }
        _ => {}
    }
}

impl Node {
    /// The value at a dotted key, in which a number counts the entries of an array from zero.
    pub(super) fn find(&self, key: &str) -> Option<&Self> {
        if key.is_empty() {
            return Some(self);
        }
        key.split('.').try_fold(self, |node, segment| node.child(segment))
    }

    /// The place of a dotted key, or of the nearest parent that exists.
    pub(super) fn place_of(&self, key: &str) -> Place {
        let mut place = &self.place;
        let mut node = self;
        for segment in key.split('.') {
            let Some(next) = node.child(segment) else { break };
            node = next;
            place = &node.place;
        }
        place.clone()
    }

    /// The finite number at a dotted key.
    pub(super) fn number(&self, key: &str) -> Option<f64> {
        self.find(key)?.as_number()
    }

    /// The value as a finite number.
    pub(super) fn as_number(&self) -> Option<f64> {
        match self.value {
            #[expect(clippy::cast_precision_loss, reason = "integers serve as floats, rounded to nearest")]
            Value::Integer(value) => Some(value as f64),
            Value::Float(value) => value.is_finite().then_some(value),
            _ => None,
        }
    }

    /// The value as text.
    pub(super) fn as_str(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// The value as a table.
    pub(super) fn as_table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The value as an array; empty for anything else.
    pub(super) fn items(&self) -> &[Self] {
        match &self.value {
            Value::Array(items) => items,
            _ => &[],
        }
    }

    /// What the value is, for a message.
    pub(super) const fn type_name(&self) -> &'static str {
        match self.value {
            Value::String(_) => "a string",
            Value::Integer(_) | Value::Float(_) => "a number",
            Value::Boolean(_) => "a truth value",
            Value::Datetime => "a date or time",
            Value::Array(_) => "an array",
            Value::Table(_) => "a table",
        }
    }

    /// The same tree as JSON; numbers keep their value to the bit.
    pub(super) fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::String(text) => text.as_str().into(),
            Value::Integer(value) => u64::try_from(*value)
                .map(serde_json::Value::from)
                .or_else(|_| i64::try_from(*value).map(serde_json::Value::from))
                .unwrap_or_else(|_| self.as_number().into()),
            Value::Float(value) => (*value).into(),
            Value::Boolean(flag) => (*flag).into(),
            Value::Datetime => serde_json::Value::Null,
            Value::Array(items) => items.iter().map(Self::to_json).collect(),
            Value::Table(table) => {
                table.iter().map(|(key, entry)| (key.clone(), entry.node.to_json())).collect()
            }
        }
    }

    fn child(&self, segment: &str) -> Option<&Self> {
        match &self.value {
            Value::Table(table) => table.get(segment).map(|entry| &entry.node),
            Value::Array(items) => items.get(segment.parse::<usize>().ok()?),
            _ => None,
        }
    }
}

const fn is_table(node: &Node) -> bool {
    matches!(node.value, Value::Table(_))
}
