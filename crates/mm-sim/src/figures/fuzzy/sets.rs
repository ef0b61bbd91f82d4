//! A panel of the terms of a variable.

use super::super::axes::ticks;
use super::super::canvas::{Anchor, Canvas, width_of};
use super::super::page::{FigureError, Frame};
use super::super::reduce::Pixel;
use super::super::style::{GRID, Stroke};
use super::{COLORS, LABEL, TICK, shortened};

/// A variable and its terms.
#[derive(Debug, Clone, PartialEq)]
pub struct Sets {
    /// Title of the panel.
    pub title: String,
    /// Its range.
    pub range: (f64, f64),
    /// Its terms.
    pub terms: Vec<Term>,
}

/// A term of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Term {
    /// A fuzzy set: its name, where it is largest, and its degrees over the range.
    Set(String, f64, Vec<[f64; 2]>),
    /// A number: its name and value.
    Number(String, f64),
    /// Anything else, in words.
    Words(String),
}

const LEFT: f64 = 52.0;
const RIGHT: f64 = 16.0;
const TITLE_HEIGHT: f64 = 26.0;
const PLOT: f64 = 130.0;
const BELOW: f64 = 28.0;
/// Height of a row of names, and of a line of words.
const ROW: f64 = 21.0;
const WORDS: f64 = 21.0;
/// Room between two names in a row.
const BETWEEN: f64 = 9.0;

impl Sets {
    /// Height that the panel takes, px.
    pub(super) fn height(&self, width: f64) -> f64 {
        let words = self.terms.iter().filter(|term| matches!(term, Term::Words(_))).count();
        let rows = self.names(0.0, width).1;
        let plot =
            if words == self.terms.len() && words > 0 { 0.0 } else { PLOT + BELOW + count(rows) * ROW };
        TITLE_HEIGHT + plot + count(words) * WORDS + 14.0
    }

    /// The range that is drawn: the variable's, and the numbers outside of it.
    fn drawn(&self) -> (f64, f64) {
        let numbers = self.terms.iter().filter_map(|term| match term {
            Term::Number(_, value) if value.is_finite() => Some(*value),
            _ => None,
        });
        numbers.fold(self.range, |(lo, hi), value| (lo.min(value), hi.max(value)))
    }

    /// For each term its name's horizontal middle and row, and the number of rows: names go to the lowest row with room for them.
    fn names(&self, left: f64, width: f64) -> (Vec<Option<(f64, usize)>>, usize) {
        let (from, to) = (left + LEFT, left + width - RIGHT);
        let (lo, hi) = self.drawn();
        let middles = self.terms.iter().map(|term| {
            let (name, at) = match term {
                Term::Set(name, at, _) | Term::Number(name, at) => (name, *at),
                Term::Words(_) => return None,
            };
            let half = 0.5 * width_of(&label(name), LABEL);
            let part = if hi > lo { ((at - lo) / (hi - lo)).clamp(0.0, 1.0) } else { 0.5 };
            let middle = (from + part * (to - from)).min(to - half).max(from + half);
            Some((middle, half))
        });
        let mut order: Vec<(usize, f64, f64)> = middles
            .clone()
            .enumerate()
            .filter_map(|(at, place)| place.map(|(x, half)| (at, x, half)))
            .collect();
        order.sort_by(|a, b| a.1.total_cmp(&b.1));
        let mut placed = vec![None; self.terms.len()];
        let mut ends: Vec<f64> = Vec::new();
        for (at, middle, half) in order {
            let row = ends.iter().position(|end| middle - half >= end + BETWEEN).unwrap_or(ends.len());
            let end = middle + half;
            match ends.get_mut(row) {
                Some(last) => *last = end,
                None => ends.push(end),
            }
            if let Some(slot) = placed.get_mut(at) {
                *slot = Some((middle, row));
            }
        }
        (placed, ends.len())
    }
}

/// A name that is not longer than a panel.
fn label(name: &str) -> String {
    shortened(name, 200.0, LABEL)
}

#[expect(clippy::cast_precision_loss, reason = "rows of a panel")]
const fn count(n: usize) -> f64 {
    n as f64
}

/// Draws a panel into its part of the canvas.
pub(super) fn draw(canvas: &Canvas<'_>, frame: Frame, sets: &Sets) -> Result<(), FigureError> {
    let (names, rows) = sets.names(frame.left, frame.width);
    let top = frame.top + TITLE_HEIGHT + count(rows) * ROW;
    let (left, right) = (frame.left + LEFT, frame.left + frame.width - RIGHT);
    let title = shortened(&sets.title, right - left, LABEL);
    canvas.text((0.5 * (left + right), frame.top + 0.5 * TITLE_HEIGHT), &title, LABEL, Anchor::Middle)?;
    let has_plot = names.iter().any(Option::is_some);
    let bottom = if has_plot { top + PLOT } else { frame.top + TITLE_HEIGHT };
    let (lo, hi) = sets.drawn();
    let pixel = |x: f64, degree: f64| -> Pixel {
        let part = if hi > lo { (x - lo) / (hi - lo) } else { 0.5 };
        (left + part * (right - left), bottom - degree * PLOT)
    };
    if has_plot {
        axes(canvas, ((left, right), (top, bottom)), sets, pixel)?;
    }
    let mut line = bottom + if has_plot { BELOW } else { 0.5 * WORDS };
    for ((term, place), number) in sets.terms.iter().zip(&names).zip(0..) {
        let color = COLORS.get(number % COLORS.len()).copied().unwrap_or_default();
        // Colours that come again are dashed.
        let dash = if (number / COLORS.len()) % 2 == 1 { Some((6.0, 3.0)) } else { None };
        let stroke = Stroke { color, width: 2.0, dash };
        match term {
            Term::Set(_, _, points) => {
                for part in above_zero(points) {
                    let points: Vec<Pixel> = part.iter().map(|[x, degree]| pixel(*x, *degree)).collect();
                    canvas.line(&points, stroke)?;
                }
            }
            Term::Number(_, value) => {
                canvas.line(&[pixel(*value, 0.0), pixel(*value, 1.0)], stroke)?;
                canvas.disc(pixel(*value, 1.0), 3.5, color)?;
            }
            Term::Words(words) => {
                let words = shortened(words, right - frame.left - 12.0, LABEL);
                canvas.text((frame.left + 12.0, line), &words, LABEL, Anchor::Start)?;
                line += WORDS;
            }
        }
        if let (Term::Set(name, ..) | Term::Number(name, _), Some((middle, row))) = (term, place) {
            let y = top - 13.0 - count(*row) * ROW;
            let name = label(name);
            let half = 0.5 * width_of(&name, LABEL);
            canvas.text((*middle, y), &name, LABEL, Anchor::Middle)?;
            canvas.line(
                &[(middle - half, y + 9.5), (middle + half, y + 9.5)],
                Stroke { dash: None, ..stroke },
            )?;
        }
    }
    Ok(())
}

type Span = (f64, f64);

fn axes(
    canvas: &Canvas<'_>,
    ((left, right), (top, bottom)): (Span, Span),
    sets: &Sets,
    pixel: impl Fn(f64, f64) -> Pixel,
) -> Result<(), FigureError> {
    for (value, text) in ticks(sets.drawn(), (right - left) / 62.0) {
        let (at, _) = pixel(value, 0.0);
        canvas.hair((at, top), (at, bottom), GRID)?;
        canvas.text((at, bottom + 11.0), &text, TICK, Anchor::Middle)?;
    }
    for (degree, text) in [(0.0, "0"), (0.5, "0.5"), (1.0, "1")] {
        let (_, at) = pixel(sets.drawn().0, degree);
        canvas.hair((left, at), (right, at), GRID)?;
        canvas.text((left - 6.0, at), text, TICK, Anchor::End)?;
    }
    canvas.frame((left, top), (right, bottom))
}

/// The parts of a curve that are not at zero, so that a term does not hide the others where it does not hold.
fn above_zero(points: &[[f64; 2]]) -> Vec<&[[f64; 2]]> {
    let is_zero = |at: usize| points.get(at).is_some_and(|[_, degree]| *degree <= 5e-4);
    let mut parts = Vec::new();
    let mut begin = 0;
    for at in 1..=points.len() {
        if at == points.len() || (is_zero(at - 1) && is_zero(at)) {
            parts.extend(points.get(begin..at).filter(|part| part.len() > 1));
            begin = at;
        }
    }
    parts
}
