//! A cursor over the tokens of an FCL text.

use super::token::{Kind, Token};
use crate::fis::{Number, number};
use crate::read::{Piece, Report, one_of};

/// The tokens from here on.
#[derive(Debug)]
pub(super) struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token<'a>>,
    next: usize,
}

impl<'a> Parser<'a> {
    pub(super) const fn new(text: &'a str, tokens: Vec<Token<'a>>) -> Self {
        Self { text, tokens, next: 0 }
    }

    pub(super) fn peek(&self) -> Option<Token<'a>> {
        self.tokens.get(self.next).copied()
    }

    /// The next token, or the end of the text.
    pub(super) fn place(&self) -> Piece<'a> {
        self.peek().map_or_else(|| Piece::new("", self.text.trim_end().len()), |token| token.piece)
    }

    /// The next token as a message shows it.
    pub(super) fn found(&self) -> String {
        self.peek().map_or_else(
            || "found the end of the text".to_owned(),
            |token| format!("found {}", token.piece.shown()),
        )
    }

    pub(super) fn advance(&mut self) -> Option<Token<'a>> {
        let token = self.peek()?;
        self.next += 1;
        Some(token)
    }

    /// Whether the next token is this word, case ignored, or this sign.
    pub(super) fn at(&self, what: &str) -> bool {
        self.peek()
            .is_some_and(|token| token.kind != Kind::Number && token.piece.text.eq_ignore_ascii_case(what))
    }

    pub(super) fn at_any(&self, what: &[&str]) -> bool {
        what.iter().any(|what| self.at(what))
    }

    pub(super) fn takes(&mut self, what: &str) -> bool {
        let found = self.at(what);
        self.next += usize::from(found);
        found
    }

    pub(super) fn expect(&mut self, what: &str, report: &mut Report) -> Option<()> {
        if self.takes(what) {
            return Some(());
        }
        report.add_expected(self.place(), self.found(), format!("`{what}`"));
        None
    }

    /// A name.
    pub(super) fn name(&mut self, what: &str, report: &mut Report) -> Option<Piece<'a>> {
        match self.peek() {
            Some(Token { kind: Kind::Word, piece }) => {
                self.next += 1;
                Some(piece)
            }
            _ => {
                report.add_expected(self.place(), self.found(), what);
                None
            }
        }
    }

    /// One of some words; another is reported with those that are known.
    pub(super) fn choice<T: Copy>(
        &mut self,
        what: &str,
        choices: &[(&'static str, bool, T)],
        report: &mut Report,
    ) -> Option<(T, Piece<'a>)> {
        let listed: Vec<&str> = choices.iter().filter(|choice| choice.1).map(|choice| choice.0).collect();
        let piece = self.name(&one_of(&listed), report)?;
        let found = choices.iter().find(|choice| choice.0.eq_ignore_ascii_case(piece.text));
        if found.is_none() {
            report.add_unknown(piece, &format!("unknown {what}"), &listed);
        }
        found.map(|choice| (choice.2, piece))
    }

    /// Whether a number, with or without a sign, comes next.
    pub(super) fn at_number(&self) -> bool {
        let kind = |at: usize| self.tokens.get(at).map(|token| token.kind);
        kind(self.next) == Some(Kind::Number)
            || (self.at_any(&["+", "-"]) && kind(self.next + 1) == Some(Kind::Number))
    }

    /// A finite number with its sign.
    pub(super) fn number(&mut self, report: &mut Report) -> Option<Number<'a>> {
        let start = self.place().start;
        let signed = self.at_any(&["+", "-"]);
        self.next += usize::from(signed);
        let token = self.peek().filter(|token| token.kind != Kind::Sign);
        let Some(token) = token else {
            report.add_expected(self.place(), self.found(), "a number");
            return None;
        };
        let found = number(token.piece, report)?;
        self.next += 1;
        let negative = self.text.get(start..).is_some_and(|text| text.starts_with('-'));
        let end = token.piece.span().end;
        let place = Piece::new(self.text.get(start..end).unwrap_or_default(), start);
        Some(Number { value: if negative { -found.value } else { found.value }, place })
    }

    /// The text from a place up to the last token that was taken.
    pub(super) fn since(&self, start: usize) -> Piece<'a> {
        let last = self.next.checked_sub(1).and_then(|last| self.tokens.get(last));
        let end = last.map_or(start, |token| token.piece.span().end).max(start);
        Piece::new(self.text.get(start..end).unwrap_or_default(), start)
    }

    /// The tokens that follow on the same line, up to one of `stops`, as one piece.
    pub(super) fn rest_of_line(&mut self, start: usize, stops: &[&str]) -> Option<Piece<'a>> {
        let line = self.text.get(start..)?;
        let end = start + line.find(['\n', '\r']).unwrap_or(line.len());
        let from = self.next;
        let begin = self.place().start;
        while self.peek().is_some_and(|token| token.piece.start < end) && !self.at_any(stops) {
            self.next += 1;
        }
        (self.next > from).then(|| self.since(begin))
    }

    /// Goes past the next `;`, or up to the next of `stops`; always past one token at least.
    pub(super) fn recover(&mut self, stops: &[&str], from: usize) {
        if self.next == from {
            self.next += 1;
        }
        while self.peek().is_some() && !self.at_any(stops) {
            if self.takes(";") {
                return;
            }
            self.next += 1;
        }
    }

    pub(super) const fn position(&self) -> usize {
        self.next
    }
}
