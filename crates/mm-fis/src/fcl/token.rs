//! Words, numbers and signs of an FCL text.

use crate::read::{Piece, Report};

/// What a token is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    /// Without a sign: that is a token of its own.
    Number,
    /// `:=`, `..` or a single character.
    Sign,
}

/// A token and where it stands.
#[derive(Debug, Clone, Copy)]
pub(super) struct Token<'a> {
    pub(super) kind: Kind,
    pub(super) piece: Piece<'a>,
}

/// Splits a text into tokens, leaving out `(* *)`, `/* */` and `//` comments.
pub(super) fn tokens<'a>(text: &'a str, report: &mut Report) -> Vec<Token<'a>> {
    let bare = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut rest = Piece::new(bare, text.len() - bare.len());
    let mut tokens = Vec::new();
    loop {
        rest = rest.trim_start();
        let Some(first) = rest.text.chars().next() else { return tokens };
        let comment = [("(*", "*)"), ("/*", "*/")].into_iter().find(|(open, _)| rest.text.starts_with(open));
        if let Some((open, close)) = comment {
            let Some(end) = rest.text.get(2..).and_then(|inside| inside.find(close)) else {
                report.add_expected(
                    rest.split_at(2).0,
                    format!("an unclosed comment `{open}`"),
                    format!("`{close}`"),
                );
                return tokens;
            };
            rest = rest.split_at(end + 4).1;
        } else if rest.text.starts_with("//") {
            let end = rest.text.find(['\n', '\r']).unwrap_or(rest.text.len());
            rest = rest.split_at(end).1;
        } else {
            let (kind, length) = measure(rest.text, first);
            let (piece, tail) = rest.split_at(length);
            tokens.push(Token { kind, piece });
            rest = tail;
        }
    }
}

/// Kind and length in bytes of the token that a text starts with.
fn measure(text: &str, first: char) -> (Kind, usize) {
    let digit_follows = |prefix: &str| {
        text.strip_prefix(prefix).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    if first.is_ascii_digit() || digit_follows(".") {
        (Kind::Number, number_length(text))
    } else if first.is_alphabetic() || first == '_' {
        let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_'));
        (Kind::Word, end.unwrap_or(text.len()))
    } else if text.starts_with(":=") || text.starts_with("..") {
        (Kind::Sign, 2)
    } else {
        (Kind::Sign, first.len_utf8())
    }
}

/// `12`, `12.5`, `.5`, `12.`, `1e-3`; the dots of `0..10` are no part of a number.
fn number_length(text: &str) -> usize {
    let digits = |from: usize| {
        let rest = text.get(from..).unwrap_or_default();
        from + rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len())
    };
    let starts = |from: usize, what: &str| text.get(from..).is_some_and(|rest| rest.starts_with(what));
    let mut end = digits(0);
    if starts(end, ".") && !starts(end, "..") {
        end = digits(end + 1);
    }
    let exponent = text.get(end..).unwrap_or_default();
    if exponent.starts_with(['e', 'E']) {
        let sign = usize::from(exponent.get(1..).is_some_and(|rest| rest.starts_with(['+', '-'])));
        let stop = digits(end + 1 + sign);
        if stop > end + 1 + sign {
            end = stop;
        }
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dots_signs_and_comments() {
        let text = "(* a *)x1:=(-1.5..+.5e-3) // b\n3.;/* c\n*/ 2e 1..2";
        let mut report = Report::new();
        let words: Vec<_> = tokens(text, &mut report).iter().map(|token| token.piece.text).collect();
        let expected =
            ["x1", ":=", "(", "-", "1.5", "..", "+", ".5e-3", ")", "3.", ";", "2", "e", "1", "..", "2"];
        assert_eq!(words, expected, "{text}");
        assert!(report.is_empty(), "nothing to report");
        assert_eq!(tokens("x (* y", &mut report).len(), 1, "up to the unclosed comment");
        assert!(!report.is_empty(), "an unclosed comment");
    }
}
