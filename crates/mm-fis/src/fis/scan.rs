//! Values within a line: quoted and bare words, numbers, vectors.

use super::lines::starts_comment;
use crate::read::{Piece, Report};

/// What is left of a line.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scanner<'a> {
    rest: Piece<'a>,
}

/// A number and where it stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Number<'a> {
    pub(crate) value: f64,
    pub(crate) place: Piece<'a>,
}

impl<'a> Scanner<'a> {
    pub(super) const fn new(rest: Piece<'a>) -> Self {
        Self { rest }
    }

    /// What is left, without leading blanks.
    pub(super) fn rest(&self) -> Piece<'a> {
        self.rest.trim_start()
    }

    /// Whether nothing but a comment is left.
    pub(super) fn is_done(&self) -> bool {
        ends(self.rest.text)
    }

    /// The next character that is not a blank, if it is this one; takes it.
    pub(super) fn takes(&mut self, expected: char) -> bool {
        let rest = self.rest();
        let found = rest.text.starts_with(expected);
        if found {
            self.rest = rest.split_at(expected.len_utf8()).1;
        }
        found
    }

    /// Takes the longest part, behind blanks, of which every character is `wanted`; it may be empty.
    pub(super) fn part(&mut self, wanted: impl Fn(char) -> bool) -> Piece<'a> {
        let rest = self.rest();
        let end = rest.text.find(|c| !wanted(c)).unwrap_or(rest.text.len());
        let (part, rest) = rest.split_at(end);
        self.rest = rest;
        part
    }

    /// Reports what is left unless it is a comment.
    pub(super) fn finish(&self, report: &mut Report) -> Option<()> {
        if self.is_done() {
            return Some(());
        }
        let rest = self.rest();
        report.add_found(rest, "the end of the line");
        None
    }

    /// Takes a word, in quotes or bare, that ends where `ends` says that what follows may follow.
    ///
    /// A doubled quote within quotes is one; so is a single one that nothing of that kind follows, as in `'it's'`.
    pub(super) fn word(
        &mut self,
        ends: impl Fn(&str) -> bool,
        report: &mut Report,
    ) -> Option<(String, Piece<'a>)> {
        let start = self.rest();
        let Some(quote) = start.text.chars().next().and_then(quote) else {
            return Some(self.bare(start, ends));
        };
        let open = start.text.chars().next().map_or(0, char::len_utf8);
        let inside = start.split_at(open).1;
        let Some(end) = closing(inside.text, &quote, ends) else {
            report.add_expected(start, "an unclosed quote", format!("`{}` at the end", quote.close));
            return None;
        };
        let (word, rest) = inside.split_at(end);
        let close = rest.text.chars().next().map_or(0, char::len_utf8);
        self.rest = rest.split_at(close).1;
        let text = if quote.doubles {
            word.text.replace(&format!("{0}{0}", quote.close), &quote.close.to_string())
        } else {
            word.text.to_owned()
        };
        Some((text, word))
    }

    fn bare(&mut self, start: Piece<'a>, ends: impl Fn(&str) -> bool) -> (String, Piece<'a>) {
        let end = start.text.char_indices().map(|(at, _)| at).find(|&at| {
            let rest = start.text.get(at..).unwrap_or_default();
            starts_comment(rest) || ends(rest)
        });
        let (word, rest) = start.split_at(end.unwrap_or(start.text.len()));
        self.rest = rest;
        (word.trim_end().text.to_owned(), word.trim_end())
    }

    /// Takes `[1 2, 3]`.
    pub(super) fn vector(&mut self, report: &mut Report) -> Option<Vec<Number<'a>>> {
        self.vector_of(number, report)
    }

    /// The same of numbers that may be infinite.
    pub(super) fn unbounded_vector(&mut self, report: &mut Report) -> Option<Vec<Number<'a>>> {
        self.vector_of(unbounded, report)
    }

    fn vector_of(
        &mut self,
        number: impl Fn(Piece<'a>, &mut Report) -> Option<Number<'a>>,
        report: &mut Report,
    ) -> Option<Vec<Number<'a>>> {
        if !self.takes('[') {
            report.add_expected(self.rest(), self.found(), "`[`");
            return None;
        }
        let mut numbers = Vec::new();
        while !self.takes(']') {
            if self.is_done() {
                report.add_expected(self.rest().end(), "found the end of the line", "`]`");
                return None;
            }
            let comma = !numbers.is_empty() && self.takes(',');
            if comma && self.rest().text.starts_with(']') {
                report.add_expected(self.rest(), "a comma before `]`", "a number");
                return None;
            }
            let word = self.part(|c| !c.is_whitespace() && !",[];:'\"".contains(c));
            if word.is_empty() {
                report.add_expected(self.rest(), self.found(), "a number or `]`");
                return None;
            }
            numbers.push(number(word, report)?);
        }
        Some(numbers)
    }

    /// The next character as a message shows it.
    pub(super) fn found(&self) -> String {
        let rest = self.rest();
        match rest.text.chars().next() {
            Some(c) if !starts_comment(rest.text) => {
                format!("found {}", rest.split_at(c.len_utf8()).0.shown())
            }
            _ => "found the end of the line".to_owned(),
        }
    }
}

/// Whether only blanks and a comment follow.
pub(super) fn ends(text: &str) -> bool {
    let text = text.trim_start();
    text.is_empty() || starts_comment(text)
}

/// A kind of quotes.
struct Quote {
    close: char,
    /// The other character that closes it.
    other: char,
    doubles: bool,
}

/// Straight quotes, and the curly ones that word processors make of them.
fn quote(c: char) -> Option<Quote> {
    Some(match c {
        '\'' | '"' => Quote { close: c, other: c, doubles: true },
        '\u{2018}' | '\u{2019}' => Quote { close: '\u{2019}', other: '\u{2018}', doubles: false },
        '\u{201c}' | '\u{201d}' => Quote { close: '\u{201d}', other: '\u{201c}', doubles: false },
        _ => return None,
    })
}

/// Where the quote ends: at the first that what may follow follows, or else at the first at all.
fn closing(text: &str, quote: &Quote, ends: impl Fn(&str) -> bool) -> Option<usize> {
    let mut first = None;
    let mut doubled = false;
    for (at, c) in text.char_indices() {
        if c != quote.close && c != quote.other {
            continue;
        }
        if doubled {
            doubled = false;
            continue;
        }
        let behind = text.get(at + c.len_utf8()..).unwrap_or_default();
        if quote.doubles && behind.starts_with(c) {
            doubled = true;
            continue;
        }
        if ends(behind) {
            return Some(at);
        }
        first = first.or(Some(at));
    }
    first
}

/// Reads a finite number.
pub(crate) fn number<'a>(word: Piece<'a>, report: &mut Report) -> Option<Number<'a>> {
    let bare = word.text.trim_start_matches(['+', '-']);
    let unfinite = ["inf", "infinity", "nan"].iter().any(|name| bare.eq_ignore_ascii_case(name));
    let digits = word.text.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
    match word.text.parse::<f64>() {
        Ok(value) if value.is_finite() && digits => Some(Number { value, place: word }),
        Ok(_) if digits || unfinite => {
            report.add_found(word, "a finite number");
            None
        }
        _ => {
            report.add_found(word, "a number");
            None
        }
    }
}

/// Reads a number or `Inf`, with or without a sign.
fn unbounded<'a>(word: Piece<'a>, report: &mut Report) -> Option<Number<'a>> {
    let bare = word.text.strip_prefix(['+', '-']).unwrap_or(word.text);
    if bare.eq_ignore_ascii_case("inf") {
        let value = if word.text.starts_with('-') { f64::NEG_INFINITY } else { f64::INFINITY };
        return Some(Number { value, place: word });
    }
    number(word, report)
}
