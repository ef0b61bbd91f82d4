//! Numbers and names in sentences.

use std::fmt;

/// Significant digits of a number in a sentence; the fields of a finding carry it in full.
const DIGITS: usize = 6;

/// A number with at most six significant digits, without zeros at its end.
pub(super) struct Short(pub(super) f64);

impl fmt::Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let exponential = format!("{:.*e}", DIGITS.saturating_sub(1), self.0);
        // A number of so many digits is read back to itself, and written in the shortest way.
        let value = exponential.parse::<f64>().unwrap_or(self.0) + 0.0;
        let size = value.abs();
        if size == 0.0 || (1e-4..1e7).contains(&size) { write!(f, "{value}") } else { write!(f, "{value:e}") }
    }
}

/// An interval, or the place where it has no width.
pub(super) struct Span(pub(super) f64, pub(super) f64);

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(from, to) = *self;
        if from < to {
            write!(f, "on [{}, {}]", Short(from), Short(to))
        } else {
            write!(f, "at {}", Short(from))
        }
    }
}

/// Joins the first few of many, and says how many more there are.
pub(super) fn list(items: &[String], most: usize) -> String {
    let more = items.len().saturating_sub(most);
    let mut shown: Vec<&str> = items.iter().take(most).map(String::as_str).collect();
    let rest = format!("{more} more");
    if more > 0 {
        shown.push(&rest);
    }
    match shown.split_last() {
        None => String::new(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, others)) => format!("{} and {last}", others.join(", ")),
    }
}

/// Names in backquotes, joined.
pub(super) fn names(names: &[String]) -> String {
    list(&names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>(), 12)
}

/// `is` or `are`, and the like.
pub(super) const fn by_count<'a>(count: usize, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 { one } else { many }
}

#[cfg(test)]
mod tests {
    use super::{Short, Span, list};

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0 / 3.0, "0.333333"),
            (-1.4, "-1.4"),
            (1e-9, "1e-9"),
            (123_456_789.0, "1.23457e8"),
            (0.1 + 0.2, "0.3"),
            (40.0, "40"),
        ] {
            assert_eq!(Short(value).to_string(), text, "{value:e}");
        }
        assert_eq!(Span(1.0, 2.5).to_string(), "on [1, 2.5]", "an interval");
        assert_eq!(Span(1.0, 1.0).to_string(), "at 1", "a place");
    }

    #[test]
    fn lists_end_in_and() {
        let items: Vec<String> = ["a", "b", "c"].map(str::to_owned).to_vec();
        assert_eq!(list(&items, 5), "a, b and c", "all");
        assert_eq!(list(&items, 2), "a, b and 1 more", "some");
        assert_eq!(list(&items[..1], 2), "a", "one");
        assert_eq!(list(&[], 2), "", "none");
    }
}
