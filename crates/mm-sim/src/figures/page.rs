//! What a picture shows, as plain data, and its drawing.

use plotters::drawing::DrawingAreaErrorKind;

use super::canvas::{Anchor, Canvas, svg, width_of};
use super::graph;
use super::reduce::Pixel;
use super::space;
use super::style::{INK, LABEL, START, Stroke, TITLE};

/// Why a picture cannot be drawn.
#[derive(Debug, thiserror::Error)]
#[error("cannot draw the figure: {0}")]
pub struct FigureError(String);

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for FigureError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        Self(error.to_string())
    }
}

/// A picture: a title, a legend, and panels row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Title.
    pub title: String,
    /// Panels in a row.
    pub columns: usize,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Panel {
    /// Curves in the plane.
    Graph(Graph),
    /// Curves in space.
    Space(Space),
}

/// Curves over a common horizontal axis, or seen from above.
#[derive(Debug, Clone, PartialEq)]
pub struct Graph {
    /// Title of the panel; may be empty.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether both axes have the same scale: for a path seen from above.
    pub is_map: bool,
    /// The curves, the last one on top.
    pub curves: Vec<Curve<2>>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    /// Whether values are drawn by their logarithm, those below `floor` at the floor.
    pub floor: Option<f64>,
    /// Range that the axis has to cover besides its own curves, so that panels in a row have one scale.
    pub covers: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis.
    #[must_use]
    pub fn new(label: impl Into<String>) -> Self {
        Self { label: label.into(), ..Self::default() }
    }
}

/// Curves in space.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    /// Title of the panel; may be empty.
    pub title: String,
    /// The curves, the last one on top.
    pub curves: Vec<Curve<3>>,
}

/// A curve in D dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve<const D: usize> {
    /// Name in the legend.
    pub name: String,
    /// How it is drawn.
    pub stroke: Stroke,
    /// Its points.
    pub points: Vec<[f64; D]>,
}

/// Part of the canvas, px.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

const TITLE_HEIGHT: f64 = 30.0;
const LEGEND_HEIGHT: f64 = 24.0;
const MARGIN: f64 = 10.0;

impl Page {
    /// Draws the picture.
    ///
    /// # Errors
    /// Those of the drawing library.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        let columns = self.columns.max(1);
        let rows = self.panels.len().div_ceil(columns).max(1);
        let top = TITLE_HEIGHT + LEGEND_HEIGHT;
        let (width, height) = self.panel_size();
        let (columns_f, rows_f) = (count(columns), count(rows));
        let size = (columns_f * width + 2.0 * MARGIN, top + rows_f * height + MARGIN);
        svg(size, |canvas| {
            canvas.text((MARGIN + 4.0, 0.5 * TITLE_HEIGHT + 2.0), &self.title, TITLE, Anchor::Start)?;
            let begin = (MARGIN + 6.0, TITLE_HEIGHT + 0.5 * LEGEND_HEIGHT - 2.0);
            let end = legend(canvas, begin, &self.entries())?;
            if self.panels.iter().any(|panel| !is_timed(panel)) {
                canvas.disc((end + 6.0, begin.1), START, INK)?;
                canvas.text((end + 16.0, begin.1), "start", LABEL, Anchor::Start)?;
            }
            for (number, panel) in self.panels.iter().enumerate() {
                let frame = Frame {
                    left: MARGIN + count(number % columns) * width,
                    top: top + count(number / columns) * height,
                    width,
                    height,
                };
                match panel {
                    Panel::Graph(graph) => graph::draw(canvas, frame, graph)?,
                    Panel::Space(space) => space::draw(canvas, frame, space)?,
                }
            }
            Ok(())
        })
    }

    /// Width and height of each panel, px.
    fn panel_size(&self) -> Pixel {
        let width = match self.columns {
            0 | 1 => 740.0,
            2 => 450.0,
            _ => 340.0,
        };
        (width, if self.panels.iter().all(is_timed) { 190.0 } else { 520.0 })
    }

    /// Each name once, with its stroke, in the order of appearance, what was desired last.
    fn entries(&self) -> Vec<(&str, Stroke)> {
        let mut all: Vec<(&str, Stroke)> = Vec::new();
        let mut add = |name, stroke| {
            if !all.contains(&(name, stroke)) {
                all.push((name, stroke));
            }
        };
        for panel in &self.panels {
            match panel {
                Panel::Graph(graph) => graph.curves.iter().for_each(|curve| add(&curve.name, curve.stroke)),
                Panel::Space(space) => space.curves.iter().for_each(|curve| add(&curve.name, curve.stroke)),
            }
        }
        all.sort_by_key(|(_, stroke)| *stroke == Stroke::DESIRED);
        all
    }
}

/// Whether a panel shows curves over time, or another axis, and no path.
const fn is_timed(panel: &Panel) -> bool {
    matches!(panel, Panel::Graph(graph) if !graph.is_map)
}

/// A row of samples of strokes with their names; gives where it ends.
fn legend(canvas: &Canvas<'_>, (mut x, y): Pixel, entries: &[(&str, Stroke)]) -> Result<f64, FigureError> {
    for (name, stroke) in entries {
        canvas.line(&[(x, y), (x + 34.0, y)], Stroke { width: stroke.width.max(1.4), ..*stroke })?;
        canvas.text((x + 41.0, y), name, LABEL, Anchor::Start)?;
        x += 41.0 + width_of(name, LABEL) + 22.0;
    }
    Ok(x)
}

#[expect(clippy::cast_precision_loss, reason = "a page has a few panels")]
const fn count(n: usize) -> f64 {
    n as f64
}
