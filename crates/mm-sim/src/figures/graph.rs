//! A panel of curves in the plane.

use super::axes::{decades, extent, padded, ticks};
use super::canvas::{Anchor, Canvas};
use super::page::{Axis, FigureError, Frame, Graph};
use super::reduce::{self, Pixel};
use super::style::{GRID, LABEL, START, TICK};

/// Room around the plot, px: left for the tick labels and the label, below for the same, above for a title.
const LEFT: f64 = 72.0;
const BELOW: f64 = 40.0;
const ABOVE: f64 = 20.0;
const RIGHT: f64 = 14.0;

/// A range of values on a range of pixels.
struct Scale {
    range: (f64, f64),
    pixels: (f64, f64),
    floor: Option<f64>,
}

impl Scale {
    /// The value as it is drawn: itself, or its decimal logarithm.
    fn drawn(&self, value: f64) -> f64 {
        self.floor.map_or(value, |floor| logarithm(value, floor))
    }

    fn pixel(&self, drawn: f64) -> f64 {
        let part = (drawn - self.range.0) / (self.range.1 - self.range.0);
        self.pixels.0 + part * (self.pixels.1 - self.pixels.0)
    }

    fn ticks(&self, spacing: f64) -> Vec<(f64, String)> {
        let count = (self.pixels.1 - self.pixels.0).abs() / spacing;
        if self.floor.is_some() { decades(self.range, count) } else { ticks(self.range, count) }
    }
}

fn logarithm(value: f64, floor: f64) -> f64 {
    libm::log10(f64::max(value, floor))
}

/// Draws a panel into its part of the canvas.
pub(super) fn draw(canvas: &Canvas<'_>, frame: Frame, graph: &Graph) -> Result<(), FigureError> {
    let (x, y) = scales(frame, graph);
    let (left, right) = x.pixels;
    let (bottom, top) = y.pixels;
    for (value, text) in x.ticks(if graph.is_map { 58.0 } else { 48.0 }) {
        let at = x.pixel(value);
        canvas.hair((at, top), (at, bottom), GRID)?;
        canvas.text((at, bottom + 11.0), &text, TICK, Anchor::Middle)?;
    }
    for (value, text) in y.ticks(if graph.is_map { 58.0 } else { 30.0 }) {
        let at = y.pixel(value);
        canvas.hair((left, at), (right, at), GRID)?;
        canvas.text((left - 6.0, at), &text, TICK, Anchor::End)?;
    }
    for curve in &graph.curves {
        let finite = curve.points.iter().filter(|p| p.iter().all(|value| value.is_finite()));
        let points: Vec<Pixel> =
            finite.map(|[px, py]| (x.pixel(x.drawn(*px)), y.pixel(y.drawn(*py)))).collect();
        let kept = if graph.is_map { reduce::path(&points) } else { reduce::function(&points) };
        let drawn: Vec<Pixel> = kept.iter().filter_map(|&i| points.get(i).copied()).collect();
        canvas.line(&drawn, curve.stroke)?;
        if graph.is_map
            && let Some(start) = drawn.first()
        {
            canvas.disc(*start, START, curve.stroke.color)?;
        }
    }
    canvas.frame((left, top), (right, bottom))?;
    let middle = 0.5 * (left + right);
    canvas.text((middle, bottom + 27.0), &graph.x.label, LABEL, Anchor::Middle)?;
    canvas.upwards((frame.left + 12.0, 0.5 * (top + bottom)), &graph.y.label, LABEL)?;
    if !graph.title.is_empty() {
        canvas.text((middle, top - 10.0), &graph.title, LABEL, Anchor::Middle)?;
    }
    Ok(())
}

/// The scales of both axes; equal ones for a map.
fn scales(frame: Frame, graph: &Graph) -> (Scale, Scale) {
    // A little beyond the last sample, so that the end of the run is in sight, and has its tick.
    let margin = if graph.is_map { 0.06 } else { 0.005 };
    let values =
        |number: usize| graph.curves.iter().flat_map(move |c| c.points.iter().map(move |p| p[number]));
    let mut x = Scale {
        range: range(&graph.x, values(0), margin),
        pixels: (frame.left + LEFT, frame.left + frame.width - RIGHT),
        floor: graph.x.floor,
    };
    let mut y = Scale {
        range: range(&graph.y, values(1), 0.06),
        pixels: (frame.top + frame.height - BELOW, frame.top + ABOVE),
        floor: graph.y.floor,
    };
    if graph.is_map {
        let per_pixel =
            |scale: &Scale| (scale.range.1 - scale.range.0) / (scale.pixels.1 - scale.pixels.0).abs();
        let coarser = f64::max(per_pixel(&x), per_pixel(&y));
        for scale in [&mut x, &mut y] {
            let middle = 0.5 * (scale.range.0 + scale.range.1);
            let half = 0.5 * coarser * (scale.pixels.1 - scale.pixels.0).abs();
            scale.range = (middle - half, middle + half);
        }
    }
    (x, y)
}

/// The range of an axis in drawn values.
fn range(axis: &Axis, values: impl Iterator<Item = f64>, margin: f64) -> (f64, f64) {
    let covers = axis.covers.map_or([f64::NAN; 2], |(low, high)| [low, high]);
    let all = values.chain(covers);
    match axis.floor {
        None => padded(extent(all), margin),
        Some(floor) => {
            let finite = all.filter(|value| value.is_finite());
            let (low, high) = extent(finite.map(|value| logarithm(value, floor))).unwrap_or((0.0, 1.0));
            (low.floor(), f64::max(high.ceil(), low.floor() + 1.0))
        }
    }
}
