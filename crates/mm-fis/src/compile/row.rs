//! The slots of an output: its terms in a row, or one for each rule.

use mm_control::fuzzy::{Aggregation, Implication};

use super::q15::{OutputRow, corners_of};
use super::{CompileError, unsupported};
use crate::{System, Variable};

/// A slot, as [`Slot`](mm_control::fuzzy::fixed::Slot) makes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// [`Slot::cut`](mm_control::fuzzy::fixed::Slot::cut).
    Cut {
        /// Corners in steps.
        corners: [i32; 4],
        /// Corners of the slot before, for the maximum.
        below: Option<[i32; 4]>,
    },
    /// [`Slot::scaled`](mm_control::fuzzy::fixed::Slot::scaled).
    Scaled {
        /// Corners in steps.
        corners: [i32; 4],
    },
}

impl Shape {
    const fn corners(self) -> [i32; 4] {
        match self {
            Self::Cut { corners, .. } | Self::Scaled { corners } => corners,
        }
    }
}

/// The terms of an output within its range.
///
/// # Errors
/// A sloping side across an end.
pub(super) fn clipped_terms(variable: &Variable) -> Result<Vec<[i32; 4]>, CompileError> {
    let clip = |(term, [a, b, c, d]): (&crate::Term, [i32; 4])| {
        let crosses = |low: i32, high: i32, end: i32| low < end && end < high;
        if crosses(a, b, -32768) || crosses(a, b, 32768) || crosses(c, d, -32768) || crosses(c, d, 32768) {
            let part = format!("the term `{}` of output `{}`", term.name, variable.name);
            return Err(unsupported(part, "it has a sloping side across an end of the range"));
        }
        Ok([a, b, c, d].map(|corner| corner.clamp(-32768, 32768)))
    };
    variable.terms.iter().zip(corners_of(variable, "output")?).map(clip).collect()
}

/// The slots of an output, and which of them each rule fires; `concluded` has the term of each rule, counted from 1, or 0.
///
/// # Errors
/// Terms that form no row.
pub(super) fn row(
    system: &System,
    variable: &Variable,
    corners: &[[i32; 4]],
    concluded: &[usize],
) -> Result<(OutputRow, Vec<Option<usize>>), CompileError> {
    let scaled = system.implication == Implication::Prod;
    let of_rule = |&term: &usize| term.checked_sub(1).map(|position| corners[position]);
    let (shapes, fired) = if system.aggregation == Aggregation::Sum {
        let mut shapes = Vec::new();
        let fired = concluded.iter().map(of_rule).map(|corners| {
            corners.map(|corners| {
                shapes.push(if scaled {
                    Shape::Scaled { corners }
                } else {
                    Shape::Cut { corners, below: None }
                });
                shapes.len() - 1
            })
        });
        let fired = fired.collect();
        (shapes, fired)
    } else {
        let mut terms: Vec<[i32; 4]> = concluded.iter().filter_map(of_rule).collect();
        terms.sort_unstable();
        terms.dedup();
        check_row(variable, corners, &terms, scaled)?;
        let fired =
            concluded.iter().map(of_rule).map(|corners| terms.binary_search(&corners?).ok()).collect();
        let shape = |(position, &corners): (usize, &[i32; 4])| match position.checked_sub(1) {
            _ if scaled => Shape::Scaled { corners },
            None => Shape::Cut { corners, below: None },
            Some(before) => {
                Shape::Cut { corners, below: Some(terms[before]).filter(|below| below[3] > corners[0]) }
            }
        };
        (terms.iter().enumerate().map(shape).collect(), fired)
    };
    if shapes.is_empty() {
        return Err(unsupported(format!("output `{}`", variable.name), "no rule concludes anything for it"));
    }
    Ok((OutputRow { scale: scale(variable, &shapes)?, slots: shapes }, fired))
}

/// The largest scale: 2^29 for the area of one slot, 2^33 for all together.
fn scale(variable: &Variable, shapes: &[Shape]) -> Result<u32, CompileError> {
    let width = |shape: &Shape| {
        let [a, .., d] = shape.corners();
        u64::from(d.abs_diff(a))
    };
    let largest = shapes.iter().map(width).max().unwrap_or(0);
    let smallest = shapes.iter().map(width).filter(|&width| width > 0).min().unwrap_or(0);
    let part = || format!("the terms of output `{}`", variable.name);
    if largest == 0 {
        return Err(unsupported(part(), "they have no area"));
    }
    if largest > smallest << 13 {
        return Err(unsupported(part(), "the narrowest is too narrow beside the widest"));
    }
    let sum: u64 = shapes.iter().map(width).sum();
    let fits = |scale: &u32| largest << scale <= 1 << 29 && sum << scale <= 1 << 33;
    (1..=29).rev().find(fits).ok_or_else(|| unsupported(part(), "there are too many"))
}

/// Checks that sorted terms ascend in all corners and overlap at most the next one.
fn check_row(
    variable: &Variable,
    corners: &[[i32; 4]],
    terms: &[[i32; 4]],
    scaled: bool,
) -> Result<(), CompileError> {
    let refuse = |term: &[i32; 4], reason| {
        let name =
            corners.iter().position(|corners| corners == term).map_or("", |at| &variable.terms[at].name);
        Err(unsupported(format!("the term `{name}` of output `{}`", variable.name), reason))
    };
    for pair in terms.windows(2) {
        if pair[0].iter().zip(&pair[1]).any(|(lower, upper)| lower > upper) {
            return refuse(&pair[1], "its corners do not all lie right of those of the term before it");
        }
        if scaled && pair[0][3] > pair[1][0] {
            return refuse(
                &pair[1],
                "implication by the product with overlapping terms needs the sum as aggregation",
            );
        }
    }
    for triple in terms.windows(3) {
        if triple[0][3] > triple[2][0] {
            return refuse(&triple[2], "it overlaps the term before the one before it");
        }
    }
    Ok(())
}
