//! A panel of an output over two inputs, as bands of colour.

use plotters::style::RGBColor;

use super::super::axes::{extent, ticks};
use super::super::canvas::{Anchor, Canvas};
use super::super::page::{FigureError, Frame};
use super::super::style::INK;
use super::{LABEL, TICK, shortened};

/// An output over two inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// Title of the panel.
    pub title: String,
    /// The input along the horizontal axis, and its range.
    pub x: (String, (f64, f64)),
    /// The input along the vertical axis, and its range.
    pub y: (String, (f64, f64)),
    /// The output.
    pub z: String,
    /// The output in the middle of each cell: row by row from the lowest `y`, each in ascending order of `x`.
    pub rows: Vec<Vec<f64>>,
}

impl Map {
    /// Cells along each axis that fill the panel with whole pixels.
    pub const CELLS: usize = 100;
}

pub(super) const HEIGHT: f64 = 410.0;
/// Pixels of a cell, when there are as many as fit.
const CELL: f64 = 3.0;
const LEFT: f64 = 70.0;
const ABOVE: f64 = 40.0;
/// Bands of colour.
const BANDS: f64 = 24.0;
/// The bar of colours: distance from the map, and width.
const BAR: (f64, f64) = (14.0, 16.0);

/// Draws a panel into its part of the canvas.
pub(super) fn draw(canvas: &Canvas<'_>, frame: Frame, map: &Map) -> Result<(), FigureError> {
    let side = CELL * 100.0;
    let (left, top) = ((frame.left + LEFT).round(), (frame.top + ABOVE).round());
    let (right, bottom) = (left + side, top + side);
    let (low, high) = extent(map.rows.iter().flatten().copied()).unwrap_or((0.0, 0.0));
    let band = |value: f64| {
        if high > low { ((value - low) / (high - low) * BANDS).floor().clamp(0.0, BANDS - 1.0) } else { 0.0 }
    };
    let height = side / count(map.rows.len());
    for (row, values) in map.rows.iter().rev().enumerate() {
        let from = top + count(row) * height;
        let width = side / count(values.len());
        let mut begin = 0;
        while let Some(first) = values.get(begin).map(|value| band(*value)) {
            let length =
                values.iter().skip(begin).take_while(|value| (band(**value) - first).abs() < 0.5).count();
            let end = begin + length.max(1);
            // A little over what comes next, so that no line shows between two of one colour at any magnification.
            let to =
                (f64::min(left + count(end) * width + 1.0, right), f64::min(from + height + 1.0, bottom));
            canvas.block((left + count(begin) * width, from), to, color((first + 0.5) / BANDS))?;
            begin = end;
        }
    }
    canvas.frame((left, top), (right, bottom))?;
    axes(canvas, (left, top, side), map)?;
    bar(canvas, (right + BAR.0, top, side), (low, high))?;
    let title = shortened(&map.title, frame.width - 20.0, LABEL);
    canvas.text((frame.left + 0.5 * frame.width, frame.top + 18.0), &title, LABEL, Anchor::Middle)?;
    canvas.upwards((frame.left + 14.0, top + 0.5 * side), &shortened(&map.y.0, side, LABEL), LABEL)?;
    canvas.upwards(
        (frame.left + frame.width - 8.0, top + 0.5 * side),
        &shortened(&map.z, side, LABEL),
        LABEL,
    )?;
    canvas.text((left + 0.5 * side, bottom + 32.0), &shortened(&map.x.0, side, LABEL), LABEL, Anchor::Middle)
}

fn axes(canvas: &Canvas<'_>, (left, top, side): (f64, f64, f64), map: &Map) -> Result<(), FigureError> {
    let part = |value: f64, (lo, hi): (f64, f64)| if hi > lo { (value - lo) / (hi - lo) } else { 0.5 };
    let bottom = top + side;
    for (value, text) in ticks(map.x.1, 5.0) {
        let at = left + part(value, map.x.1) * side;
        canvas.hair((at, bottom), (at, bottom + 4.0), INK)?;
        canvas.text((at, bottom + 13.0), &text, TICK, Anchor::Middle)?;
    }
    for (value, text) in ticks(map.y.1, 6.0) {
        let at = bottom - part(value, map.y.1) * side;
        canvas.hair((left - 4.0, at), (left, at), INK)?;
        canvas.text((left - 8.0, at), &text, TICK, Anchor::End)?;
    }
    Ok(())
}

/// What each colour stands for.
fn bar(
    canvas: &Canvas<'_>,
    (left, top, side): (f64, f64, f64),
    (low, high): (f64, f64),
) -> Result<(), FigureError> {
    let (right, bottom) = (left + BAR.1, top + side);
    if high <= low {
        canvas.block((left, top), (right, bottom), color(0.5 / BANDS))?;
        canvas.frame((left, top), (right, bottom))?;
        return canvas.text((right + 8.0, top + 0.5 * side), &format!("{low:.4}"), TICK, Anchor::Start);
    }
    let mut band = 0.0;
    while band < BANDS {
        // Each a little over the one below it.
        let (from, to) = (bottom - (band + 1.0) / BANDS * side, bottom - band / BANDS * side + 1.0);
        canvas.block((left, from), (right, to.min(bottom)), color((band + 0.5) / BANDS))?;
        band += 1.0;
    }
    canvas.frame((left, top), (right, bottom))?;
    for (value, text) in ticks((low, high), 7.0) {
        let at = bottom - (value - low) / (high - low) * side;
        canvas.hair((right, at), (right + 4.0, at), INK)?;
        canvas.text((right + 8.0, at), &text, TICK, Anchor::Start)?;
    }
    Ok(())
}

#[expect(clippy::cast_precision_loss, reason = "cells of a panel")]
const fn count(n: usize) -> f64 {
    n as f64
}

/// Colours that grow lighter evenly, for eyes of any kind and in grey as well: those called viridis.
const RAMP: [[f64; 3]; 10] = [
    [68.0, 1.0, 84.0],
    [72.0, 40.0, 120.0],
    [62.0, 74.0, 137.0],
    [49.0, 104.0, 142.0],
    [38.0, 130.0, 142.0],
    [31.0, 158.0, 137.0],
    [53.0, 183.0, 121.0],
    [109.0, 205.0, 89.0],
    [180.0, 222.0, 44.0],
    [253.0, 231.0, 37.0],
];

/// The colour of a part of the range.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "parts of 0 to 9 and of 0 to 255"
)]
fn color(part: f64) -> RGBColor {
    let along = part.clamp(0.0, 1.0) * 9.0;
    let at = (along.floor() as usize).min(8);
    let (Some(from), Some(to)) = (RAMP.get(at), RAMP.get(at + 1)) else { return INK };
    let between = along - count(at);
    let channel = |k: usize| (from[k] + between * (to[k] - from[k])).round() as u8;
    RGBColor(channel(0), channel(1), channel(2))
}
