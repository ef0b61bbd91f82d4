//! What all generated files have in common.

use std::fmt::Write;

/// Who made a file, for its head.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Origin<'a> {
    /// Name of the constant in Rust, and in lower case of everything in C. An identifier; anything else in it becomes `_`.
    pub name: &'a str,
    /// The command that makes the file again, for its head.
    pub command: &'a str,
}

impl Origin<'_> {
    /// The name as an identifier in upper case.
    pub(super) fn constant(&self) -> String {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
        let name: String = self.name.chars().map(letter).collect();
        if name.starts_with(|c: char| c.is_ascii_alphabetic()) { name } else { format!("FIS_{name}") }
    }

    /// The same in lower case.
    pub(super) fn prefix(&self) -> String {
        self.constant().to_ascii_lowercase()
    }

    /// The head of a file: lines, each after `mark`.
    pub(super) fn head(&self, mark: &str, system: &str, facts: &[String]) -> String {
        let mut head = String::new();
        let system = one_line(system);
        let lines = [format!("Compiled from the fuzzy system \"{system}\"; generated, not to be edited.")];
        let again = [format!("Made again by: {}", one_line(self.command))];
        for line in lines.iter().chain(facts).chain(&again) {
            let _infallible = writeln!(head, "{mark} {line}");
        }
        head
    }
}

/// A text in one line of printable ASCII that ends no comment.
pub(super) fn one_line(text: &str) -> String {
    let printable = |c: char| if (' '..='~').contains(&c) { c } else { '?' };
    text.chars()
        .map(printable)
        .collect::<String>()
        .replace("*/", "* /")
        .replace("/*", "/ *")
        .replace("??", "? ?")
}

/// Numbers in lines of up to 16, each line after `indent`.
pub(super) fn numbers(values: &[i16], indent: &str) -> String {
    let line = |line: &[i16]| {
        let values: Vec<String> = line.iter().map(i16::to_string).collect();
        format!("{indent}{},\n", values.join(", "))
    };
    values.chunks(16).map(line).collect()
}

/// A number as TOML and Rust read it back exactly.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A range likewise.
pub(super) fn range((lo, hi): (f64, f64)) -> String {
    format!("[{}, {}]", number(lo), number(hi))
}

/// Macros of C with the ends of ranges, and how numbers of 16 bits come from values and back.
pub(super) fn c_ranges(constant: &str, inputs: &[(f64, f64)], output: (f64, f64)) -> String {
    let number_of = |at: usize| if inputs.len() > 1 { (at + 1).to_string() } else { String::new() };
    let input = |(at, &ends): (usize, &(f64, f64))| (format!("INPUT{}", number_of(at)), ends);
    let named = inputs.iter().enumerate().map(input).chain([("OUTPUT".to_owned(), output)]);
    let mut text = "/* From a value x to q: (x - middle) / half * 32768, rounded, held within -32768 to 32767; from a result y to a value:\n   \
                    middle + half * y / 32768. Here middle = (MAX + MIN) / 2 and half = (MAX - MIN) / 2 of the range. */\n"
        .to_owned();
    for (name, (lo, hi)) in named {
        for (end, value) in [("MIN", lo), ("MAX", hi)] {
            let _infallible = writeln!(text, "#define {constant}_{name}_{end} ({})", number(value));
        }
    }
    text.push('\n');
    text
}

/// A string in quotes, escaped as TOML has it.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// What is known about the error of a surface.
pub(super) fn facts_of_surface(bound: f64, error: f64, at: &str, inputs: &str) -> String {
    format!("Bound {bound:.4e}, largest error {error:.4e} at {at}, in output units, over {inputs}.")
}
