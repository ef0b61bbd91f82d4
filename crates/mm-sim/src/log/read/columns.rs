//! A flat message, decoded by its definition into columns.

use super::bytes::Bytes;

/// A field of the message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type {
    Number,
    Flag,
}

/// Names and types of the fields after the header.
#[derive(Debug, Clone)]
pub(super) struct Layout {
    names: Vec<String>,
    types: Vec<Type>,
}

impl Layout {
    /// The layout that a definition says; none if it is not that of a flat message after a header.
    pub(super) fn of(definition: &str) -> Option<Self> {
        let own = definition.lines().take_while(|line| !line.starts_with("===="));
        let mut fields = own.filter_map(|line| {
            let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
            Some((words.next()?, words.next()?))
        });
        if fields.next() != Some(("std_msgs/Header", "header")) {
            return None;
        }
        let mut layout = Self { names: Vec::new(), types: Vec::new() };
        for (kind, name) in fields {
            layout.types.push(match kind {
                "float64" => Type::Number,
                "bool" => Type::Flag,
                _ => return None,
            });
            layout.names.push(name.to_owned());
        }
        Some(layout)
    }

    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The fields of a message, flags as 0 and 1; none if it is too short.
    pub(super) fn decode(&self, data: &[u8]) -> Option<Vec<f64>> {
        let mut bytes = Bytes::of(data);
        bytes.header()?;
        let field = |kind: &Type| match kind {
            Type::Number => bytes.f64(),
            Type::Flag => bytes.boolean().map(|flag| f64::from(u8::from(flag))),
        };
        self.types.iter().map(field).collect()
    }
}

/// Columns of one length, by the names of the log's fields.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    names: Vec<String>,
    values: Vec<Vec<f64>>,
}

impl Columns {
    /// Names of the columns, in the order of the message.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// A column by its name; empty if there is none.
    #[must_use]
    pub fn get(&self, name: &str) -> &[f64] {
        let number = self.names.iter().position(|other| other == name);
        number.and_then(|number| self.values.get(number)).map_or(&[], Vec::as_slice)
    }

    /// Times of the samples, s.
    #[must_use]
    pub fn time(&self) -> &[f64] {
        self.get("t_s")
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.first().map_or(0, Vec::len)
    }

    /// Whether there are no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Adds a sample; the first one says what the columns are.
    pub(super) fn push(&mut self, names: &[String], row: &[f64]) {
        if self.names.is_empty() {
            self.names = names.to_vec();
            self.values = vec![Vec::new(); names.len()];
        }
        for (column, value) in self.values.iter_mut().zip(row) {
            column.push(*value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Layout;
    use crate::log::{control_field_names, schema};

    #[test]
    fn the_layout_is_that_of_the_writer() {
        let layout = Layout::of(&schema::control().text).expect("a flat message");
        assert_eq!(layout.names(), control_field_names().collect::<Vec<_>>(), "all fields, in order");
    }

    #[test]
    fn another_message_has_none() {
        assert!(Layout::of(&schema::path().text).is_none(), "an array of poses");
        assert!(Layout::of("float64 x\n").is_none(), "no header");
        assert!(Layout::of("").is_none(), "nothing");
    }
}
