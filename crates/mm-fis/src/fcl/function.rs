//! `FUNCTION` terms: what a Sugeno rule concludes, where it is linear in the inputs.

use super::parser::Parser;
use super::token::{Kind, Token};
use crate::read::{Piece, Report};

/// How deep brackets may be nested.
pub(super) const MAX_DEPTH: usize = 64;

/// A factor for each input, then a constant.
type Sum = Vec<f64>;

/// Reads `2 * x + 3 * (y - 1)`.
pub(super) struct Function<'p, 'a> {
    pub(super) parser: &'p mut Parser<'a>,
    pub(super) inputs: &'p [Piece<'a>],
}

impl Function<'_, '_> {
    pub(super) fn sum(&mut self, depth: usize, report: &mut Report) -> Option<Sum> {
        let start = self.parser.place().start;
        if depth > MAX_DEPTH {
            report.add(self.parser.place(), format!("brackets nested more than {MAX_DEPTH} deep"));
            return None;
        }
        let mut sum = self.product(depth, report)?;
        loop {
            let sign = if self.parser.takes("+") {
                1.0
            } else if self.parser.takes("-") {
                -1.0
            } else {
                break;
            };
            let next = self.product(depth, report)?;
            for (total, part) in sum.iter_mut().zip(next) {
                *total += sign * part;
            }
        }
        self.finite(sum, start, report)
    }

    fn product(&mut self, depth: usize, report: &mut Report) -> Option<Sum> {
        let start = self.parser.place().start;
        let mut product = self.factor(depth, report)?;
        loop {
            let divides = self.parser.at("/");
            if !divides && !self.parser.at("*") {
                break;
            }
            let _ = self.parser.advance();
            let right = self.factor(depth, report)?;
            let constant = |sum: &Sum| match sum.split_last() {
                Some((constant, factors)) if factors.iter().all(|factor| factor.abs() <= 0.0) => {
                    Some(*constant)
                }
                _ => None,
            };
            let scaled = match (constant(&product), constant(&right), divides) {
                (_, Some(number), true) => product.iter().map(|part| part / number).collect(),
                (_, Some(number), false) => product.iter().map(|part| part * number).collect(),
                (Some(number), None, false) => right.iter().map(|part| part * number).collect(),
                _ => {
                    let place = self.parser.since(start);
                    report.add_expected(place, format!("{}, which is not linear", place.shown()), LINEAR);
                    return None;
                }
            };
            product = scaled;
        }
        self.finite(product, start, report)
    }

    fn factor(&mut self, depth: usize, report: &mut Report) -> Option<Sum> {
        let mut negative = false;
        while self.parser.at_any(&["+", "-"]) {
            negative ^= self.parser.at("-");
            let _ = self.parser.advance();
        }
        let mut value = match self.parser.peek() {
            Some(Token { kind: Kind::Word, piece }) => {
                let _ = self.parser.advance();
                let Some(at) = super::names::find(self.inputs, piece) else {
                    let known: Vec<&str> = self.inputs.iter().map(|name| name.text).collect();
                    report.add_unknown(piece, "unknown input", &known);
                    return None;
                };
                (0..=self.inputs.len()).map(|index| if index == at { 1.0 } else { 0.0 }).collect::<Sum>()
            }
            Some(Token { kind: Kind::Sign, .. }) if self.parser.takes("(") => {
                let inside = self.sum(depth + 1, report)?;
                self.parser.expect(")", report)?;
                inside
            }
            _ => {
                let number = self.parser.number(report)?;
                (0..=self.inputs.len())
                    .map(|index| if index == self.inputs.len() { number.value } else { 0.0 })
                    .collect()
            }
        };
        if self.parser.at_any(&["^", "%"]) {
            report.add_expected(self.parser.place(), self.parser.found(), LINEAR);
            return None;
        }
        if negative {
            value.iter_mut().for_each(|part| *part = -*part);
        }
        Some(value)
    }

    fn finite(&self, sum: Sum, start: usize, report: &mut Report) -> Option<Sum> {
        if sum.iter().all(|part| part.is_finite()) {
            return Some(sum);
        }
        report.add(self.parser.since(start), "a function whose numbers are not finite");
        None
    }
}

const LINEAR: &str = "sums and multiples of inputs and numbers";
