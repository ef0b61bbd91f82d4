//! A panel of curves in space: an orthographic view of a box with axes, ticks and the curves' shadows on its floor.

use mm_model::Real;

use super::axes::{extent, padded, ticks};
use super::canvas::{Anchor, Canvas};
use super::page::{FigureError, Frame, Space};
use super::reduce::{self, Pixel};
use super::style::{GRID, INK, LABEL, SHADOW, START, Stroke, TICK};

/// Direction to the eye, rad: about the vertical from the x axis, and above the floor.
const AZIMUTH: f64 = -1.05;
const ELEVATION: f64 = 0.45;

/// Height of the box in its longer horizontal side.
const HEIGHT: f64 = 0.55;
/// Shorter horizontal side at least, in the longer one.
const SLIMMEST: f64 = 0.5;

/// Span of a range at least, in the widest one.
const FLATTEST: f64 = 0.02;

/// Room around the box for ticks and labels, px.
const AROUND: (f64, f64) = (62.0, 44.0);

/// From space to the canvas.
struct View {
    low: [f64; 3],
    high: [f64; 3],
    /// Edges of the box.
    sides: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    scale: f64,
    origin: Pixel,
}

impl View {
    /// The box that holds the ranges, fitted into a frame.
    fn fit(ranges: [(f64, f64); 3], frame: Frame) -> Self {
        let spans = ranges.map(|(low, high)| high - low);
        let longest = f64::max(spans[0], spans[1]);
        let horizontal = |span: f64| f64::max(span / longest, SLIMMEST);
        let (sin_a, cos_a) = Real::sin_cos(AZIMUTH);
        let (sin_e, cos_e) = Real::sin_cos(ELEVATION);
        let mut view = Self {
            low: ranges.map(|(low, _)| low),
            high: ranges.map(|(_, high)| high),
            sides: [horizontal(spans[0]), horizontal(spans[1]), HEIGHT],
            right: [-sin_a, cos_a, 0.0],
            up: [-sin_e * cos_a, -sin_e * sin_a, cos_e],
            scale: 1.0,
            origin: (0.0, 0.0),
        };
        let corners: Vec<Pixel> = (0..8_u8)
            .map(|i| [i & 1, (i >> 1) & 1, (i >> 2) & 1].map(|bit| bit == 1))
            .map(|is_high| view.corner(is_high))
            .collect();
        let (left, right) = extent(corners.iter().map(|c| c.0)).unwrap_or((0.0, 1.0));
        let (top, bottom) = extent(corners.iter().map(|c| c.1)).unwrap_or((0.0, 1.0));
        let room = (frame.width - 2.0 * AROUND.0, frame.height - 2.0 * AROUND.1);
        view.scale = f64::min(room.0 / (right - left), room.1 / (bottom - top));
        view.origin = (
            frame.left + 0.5 * frame.width - 0.5 * view.scale * (left + right),
            frame.top + 0.5 * frame.height - 0.5 * view.scale * (top + bottom),
        );
        view
    }

    fn pixel(&self, point: [f64; 3]) -> Pixel {
        let mut at = (0.0, 0.0);
        for (axis, value) in point.into_iter().enumerate() {
            let part = (value - self.low[axis]) / (self.high[axis] - self.low[axis]);
            let along = part * self.sides[axis];
            at.0 += along * self.right[axis];
            at.1 -= along * self.up[axis];
        }
        (self.origin.0 + self.scale * at.0, self.origin.1 + self.scale * at.1)
    }

    fn corner(&self, is_high: [bool; 3]) -> Pixel {
        self.pixel([0, 1, 2].map(|axis| if is_high[axis] { self.high[axis] } else { self.low[axis] }))
    }
}

/// An axis on an edge of the box: its number, whether the edge is at the upper end of each other axis, and where texts go.
struct Edge {
    axis: usize,
    label: &'static str,
    at_high: [bool; 3],
    /// The two walls that carry its grid: the axis along which a grid line runs.
    grids: [usize; 2],
    outward: Pixel,
}

/// Seen from the front right: walls at the lower x, the upper y and the lower z are behind the curves.
const EDGES: [Edge; 3] = [
    Edge { axis: 0, label: "x (m)", at_high: [false, false, false], grids: [1, 2], outward: (-0.35, 1.0) },
    Edge { axis: 1, label: "y (m)", at_high: [true, false, false], grids: [0, 2], outward: (0.9, 0.75) },
    Edge { axis: 2, label: "z (m)", at_high: [false, false, false], grids: [0, 1], outward: (-1.0, 0.0) },
];

/// Draws a panel into its part of the canvas.
pub(super) fn draw(canvas: &Canvas<'_>, frame: Frame, space: &Space) -> Result<(), FigureError> {
    let values = |axis: usize| space.curves.iter().flat_map(move |c| c.points.iter().map(move |p| p[axis]));
    let ranges = [0, 1, 2].map(|axis| padded(extent(values(axis)), 0.05));
    let view = View::fit(with_least_spans(ranges), frame);
    for edge in &EDGES {
        draw_edge(canvas, &view, edge)?;
    }
    for [from, to] in outline() {
        canvas.hair(view.corner(from), view.corner(to), INK)?;
    }
    for curve in &space.curves {
        let shadow: Vec<Pixel> =
            curve.points.iter().map(|[x, y, _]| view.pixel([*x, *y, view.low[2]])).collect();
        draw_path(canvas, &shadow, Stroke { color: SHADOW, width: 1.2, dash: None })?;
    }
    for curve in &space.curves {
        let points: Vec<Pixel> = curve.points.iter().map(|point| view.pixel(*point)).collect();
        draw_path(canvas, &points, curve.stroke)?;
        if let Some(start) = points.first()
            && curve.stroke.dash.is_none()
        {
            canvas.disc(*start, START, curve.stroke.color)?;
        }
    }
    let title = (frame.left + 0.5 * frame.width, frame.top + 10.0);
    canvas.text(title, &space.title, LABEL, Anchor::Middle)
}

/// Widens the ranges in which next to nothing happens: a path at one height should look so, not show its errors.
fn with_least_spans(ranges: [(f64, f64); 3]) -> [(f64, f64); 3] {
    let widest = ranges.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
    ranges.map(|(low, high)| {
        let lacking = f64::max(0.5 * (FLATTEST * widest - (high - low)), 0.0);
        (low - lacking, high + lacking)
    })
}

fn draw_path(canvas: &Canvas<'_>, points: &[Pixel], stroke: Stroke) -> Result<(), FigureError> {
    let finite: Vec<Pixel> = points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    let kept = reduce::path(&finite);
    let drawn: Vec<Pixel> = kept.iter().filter_map(|&i| finite.get(i).copied()).collect();
    canvas.line(&drawn, stroke)
}

/// The edges of the floor and of the two walls behind.
fn outline() -> [[[bool; 3]; 2]; 9] {
    let (o, i) = (false, true);
    [
        [[o, o, o], [i, o, o]],
        [[i, o, o], [i, i, o]],
        [[i, i, o], [o, i, o]],
        [[o, i, o], [o, o, o]],
        [[o, o, o], [o, o, i]],
        [[o, o, i], [o, i, i]],
        [[o, i, i], [i, i, i]],
        [[i, i, i], [i, i, o]],
        [[o, i, o], [o, i, i]],
    ]
}

/// Grid lines on the two walls of an axis, ticks and label on its edge.
fn draw_edge(canvas: &Canvas<'_>, view: &View, edge: &Edge) -> Result<(), FigureError> {
    let ends = |axis: usize| (view.low[axis], view.high[axis]);
    let length = {
        let mut high = edge.at_high;
        high[edge.axis] = true;
        let (a, b) = (view.corner(edge.at_high_but(false)), view.corner(high));
        Real::sqrt((b.0 - a.0) * (b.0 - a.0) + (b.1 - a.1) * (b.1 - a.1))
    };
    // Where the walls behind stand: lower x, upper y, lower z.
    let behind = [view.low[0], view.high[1], view.low[2]];
    let mut base = [0, 1, 2].map(|axis| if edge.at_high[axis] { view.high[axis] } else { view.low[axis] });
    for (value, text) in ticks(ends(edge.axis), length / 46.0) {
        for along in edge.grids {
            let mut from = behind;
            from[edge.axis] = value;
            let mut to = from;
            (from[along], to[along]) = ends(along);
            canvas.hair(view.pixel(from), view.pixel(to), GRID)?;
        }
        base[edge.axis] = value;
        let (x, y) = view.pixel(base);
        let (dx, dy) = edge.outward;
        canvas.hair((x, y), (x + 5.0 * dx, y + 5.0 * dy), INK)?;
        let anchor = if dx < -0.5 {
            Anchor::End
        } else if dx > 0.5 {
            Anchor::Start
        } else {
            Anchor::Middle
        };
        canvas.text((x + 9.0 * dx, y + 13.0 * dy), &text, TICK, anchor)?;
    }
    base[edge.axis] = 0.5 * (view.low[edge.axis] + view.high[edge.axis]);
    let (x, y) = view.pixel(base);
    let (dx, dy) = edge.outward;
    if edge.axis == 2 {
        canvas.upwards((x - 48.0, y), edge.label, LABEL)
    } else {
        canvas.text((x + 40.0 * dx, y + 36.0 * dy), edge.label, LABEL, Anchor::Middle)
    }
}

impl Edge {
    /// The corner where the edge begins or ends.
    fn at_high_but(&self, is_high: bool) -> [bool; 3] {
        let mut at = self.at_high;
        at[self.axis] = is_high;
        at
    }
}
