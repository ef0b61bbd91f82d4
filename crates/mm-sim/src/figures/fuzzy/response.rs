//! A panel of an output over one input, jumps drawn as jumps.

use super::super::axes::{extent, padded, ticks};
use super::super::canvas::{Anchor, Canvas, width_of};
use super::super::page::{FigureError, Frame};
use super::super::reduce::{self, Pixel};
use super::super::style::{GRID, Stroke};
use super::{COLORS, LABEL, TICK, shortened};

/// An output over one input.
#[derive(Debug, Clone, PartialEq)]
pub struct Response {
    /// Title of the panel.
    pub title: String,
    /// The input, and its range.
    pub x: (String, (f64, f64)),
    /// The output.
    pub y: String,
    /// The curve, in ascending order.
    pub points: Vec<[f64; 2]>,
    /// Its jumps, in ascending order.
    pub breaks: Vec<Break>,
    /// The same output as another engine has it.
    pub overlay: Option<Overlay>,
}

/// A jump: where, and the values before, at and after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Break {
    /// Where.
    pub at: f64,
    /// Value just below, there, and just above.
    pub values: [f64; 3],
}

/// A curve on top, in parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlay {
    /// Name in the legend.
    pub name: String,
    /// The parts, between jumps.
    pub parts: Vec<Vec<[f64; 2]>>,
}

const LEFT: f64 = 76.0;
const RIGHT: f64 = 16.0;
const ABOVE: f64 = 34.0;
const BELOW: f64 = 48.0;
/// Jumps that are marked; more of them are drawn as parts of the curve alone.
const MOST_MARKED: usize = 40;

/// Draws a panel into its part of the canvas.
pub(super) fn draw(canvas: &Canvas<'_>, frame: Frame, response: &Response) -> Result<(), FigureError> {
    let (left, right) = (frame.left + LEFT, frame.left + frame.width - RIGHT);
    let (top, bottom) = (frame.top + ABOVE, frame.top + frame.height - BELOW);
    let (lo, hi) = response.x.1;
    let values = response.points.iter().map(|[_, y]| *y);
    let (low, high) = padded(extent(values), 0.08);
    let pixel = |x: f64, y: f64| -> Pixel {
        let part = if hi > lo { (x - lo) / (hi - lo) } else { 0.5 };
        (left + part * (right - left), bottom - (y - low) / (high - low) * (bottom - top))
    };
    for (value, text) in ticks((lo, hi), (right - left) / 70.0) {
        let (at, _) = pixel(value, low);
        canvas.hair((at, top), (at, bottom), GRID)?;
        canvas.text((at, bottom + 11.0), &text, TICK, Anchor::Middle)?;
    }
    for (value, text) in ticks((low, high), (bottom - top) / 40.0) {
        let (_, at) = pixel(lo, value);
        canvas.hair((left, at), (right, at), GRID)?;
        canvas.text((left - 6.0, at), &text, TICK, Anchor::End)?;
    }
    canvas.frame((left, top), (right, bottom))?;
    let [color, second, ..] = COLORS;
    for part in parts(response) {
        let points: Vec<Pixel> = part.iter().map(|[x, y]| pixel(*x, *y)).collect();
        let kept = reduce::path(&points);
        let drawn: Vec<Pixel> = kept.iter().filter_map(|&at| points.get(at).copied()).collect();
        canvas.line(&drawn, Stroke { color, width: 2.4, dash: None })?;
    }
    if let Some(overlay) = &response.overlay {
        for part in &overlay.parts {
            let points: Vec<Pixel> = part.iter().map(|[x, y]| pixel(*x, *y)).collect();
            let kept = reduce::path(&points);
            let points: Vec<Pixel> = kept.iter().filter_map(|&at| points.get(at).copied()).collect();
            canvas.line(&points, Stroke { color: second, width: 1.4, dash: Some((5.0, 4.0)) })?;
        }
        legend(canvas, (right, frame.top + 0.5 * ABOVE), &overlay.name, second)?;
    }
    if response.breaks.len() <= MOST_MARKED {
        for Break { at, values: [before, value, after] } in &response.breaks {
            let (ends, dot) = ([pixel(*at, *before), pixel(*at, *after)], pixel(*at, *value));
            canvas.line(&ends, Stroke { color, width: 1.0, dash: Some((2.0, 3.0)) })?;
            for end in ends {
                canvas.ring(end, 3.6, color)?;
            }
            canvas.disc(dot, 3.6, color)?;
        }
    }
    let middle = 0.5 * (left + right);
    let name = shortened(&response.x.0, right - left, LABEL);
    canvas.text((middle, bottom + 30.0), &name, LABEL, Anchor::Middle)?;
    canvas.upwards(
        (frame.left + 14.0, 0.5 * (top + bottom)),
        &shortened(&response.y, bottom - top, LABEL),
        LABEL,
    )?;
    let title = shortened(&response.title, 0.6 * (right - left), LABEL);
    canvas.text((middle, frame.top + 0.5 * ABOVE), &title, LABEL, Anchor::Middle)
}

fn legend(
    canvas: &Canvas<'_>,
    (right, y): Pixel,
    name: &str,
    color: plotters::style::RGBColor,
) -> Result<(), FigureError> {
    let begin = right - width_of(name, LABEL) - 46.0;
    canvas.line(&[(begin, y), (begin + 34.0, y)], Stroke { color, width: 1.8, dash: Some((5.0, 4.0)) })?;
    canvas.text((begin + 41.0, y), name, LABEL, Anchor::Start)
}

/// The curve between its jumps, each part up to the limit there.
fn parts(response: &Response) -> Vec<Vec<[f64; 2]>> {
    let mut parts = vec![Vec::new()];
    let mut breaks = response.breaks.iter().peekable();
    for &[x, y] in &response.points {
        while let Some(Break { at, values: [before, _, after] }) = breaks.next_if(|jump| jump.at <= x) {
            if let Some(part) = parts.last_mut() {
                part.push([*at, *before]);
            }
            parts.push(vec![[*at, *after]]);
        }
        let is_at_break = response.breaks.iter().any(|jump| (jump.at - x).abs() <= 0.0);
        if let Some(part) = parts.last_mut().filter(|_| !is_at_break) {
            part.push([x, y]);
        }
    }
    parts
}
