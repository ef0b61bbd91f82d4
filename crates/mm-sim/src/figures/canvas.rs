//! Lines and text in SVG.

use plotters::coord::Shift;
use plotters::element::{Circle, DashedPathElement, PathElement, Rectangle, Text};
use plotters::prelude::{DrawingArea, IntoDrawingArea as _, SVGBackend};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color as _, FontTransform, IntoFont as _, RGBColor, ShapeStyle, TextStyle, WHITE};

use super::page::FigureError;
use super::reduce::Pixel;
use super::style::{INK, Stroke};

/// Units of the file in a pixel: the backend counts whole units, and curves need finer ones than pixels.
const FINE: f64 = 5.0;

/// Average width of a letter, in its size.
const LETTER: f64 = 0.55;

/// Where a text is relative to its point: beginning, middle or end.
#[derive(Debug, Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A drawing under way.
pub(super) struct Canvas<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Draws with `draw` on an empty canvas of a size in pixels, and gives the SVG.
pub(super) fn svg(
    (width, height): Pixel,
    draw: impl FnOnce(&Canvas<'_>) -> Result<(), FigureError>,
) -> Result<String, FigureError> {
    let mut text = String::new();
    {
        let size = (fine(width).unsigned_abs(), fine(height).unsigned_abs());
        let area = SVGBackend::with_string(&mut text, size).into_drawing_area();
        area.fill(&WHITE)?;
        let canvas = Canvas { area };
        draw(&canvas)?;
        canvas.area.present()?;
    }
    // The file is as large as it says in pixels; the finer units stay inside.
    let fine_size = format!(r#"width="{}" height="{}""#, fine(width), fine(height));
    Ok(text.replacen(&fine_size, &format!(r#"width="{width:.0}" height="{height:.0}""#), 1))
}

/// Pixels in units of the file.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a canvas is far smaller than 2^31 units; a cast saturates"
)]
fn fine(pixels: f64) -> i32 {
    (pixels * FINE).round() as i32
}

fn at((x, y): Pixel) -> (i32, i32) {
    (fine(x), fine(y))
}

/// Width that a text takes, about, px.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    text.chars().fold(0.0, |width, _| width + LETTER * size)
}

impl Canvas<'_> {
    /// A line through points.
    pub(super) fn line(&self, points: &[Pixel], stroke: Stroke) -> Result<(), FigureError> {
        let points: Vec<(i32, i32)> = points.iter().map(|point| at(*point)).collect();
        if points.len() < 2 {
            return Ok(());
        }
        let style = ShapeStyle {
            color: stroke.color.to_rgba(),
            filled: false,
            stroke_width: fine(stroke.width).unsigned_abs(),
        };
        match stroke.dash {
            None => self.area.draw(&PathElement::new(points, style))?,
            Some((dash, gap)) => {
                self.area.draw(&DashedPathElement::new(points, fine(dash), fine(gap), style))?;
            }
        }
        Ok(())
    }

    /// A thin straight line.
    pub(super) fn hair(&self, from: Pixel, to: Pixel, color: RGBColor) -> Result<(), FigureError> {
        self.line(&[from, to], Stroke { color, width: 0.8, dash: None })
    }

    /// A filled disc.
    pub(super) fn disc(&self, center: Pixel, radius: f64, color: RGBColor) -> Result<(), FigureError> {
        self.area.draw(&Circle::new(at(center), fine(radius), color.filled()))?;
        Ok(())
    }

    /// The outline of a disc, white within.
    pub(super) fn ring(&self, center: Pixel, radius: f64, color: RGBColor) -> Result<(), FigureError> {
        self.disc(center, radius, WHITE)?;
        let style =
            ShapeStyle { color: color.to_rgba(), filled: false, stroke_width: fine(1.4).unsigned_abs() };
        self.area.draw(&Circle::new(at(center), fine(radius), style))?;
        Ok(())
    }

    /// A filled rectangle.
    pub(super) fn block(&self, from: Pixel, to: Pixel, color: RGBColor) -> Result<(), FigureError> {
        self.area.draw(&Rectangle::new([at(from), at(to)], color.filled()))?;
        Ok(())
    }

    /// The outline of a rectangle.
    pub(super) fn frame(&self, from: Pixel, to: Pixel) -> Result<(), FigureError> {
        let style =
            ShapeStyle { color: INK.to_rgba(), filled: false, stroke_width: fine(0.8).unsigned_abs() };
        self.area.draw(&Rectangle::new([at(from), at(to)], style))?;
        Ok(())
    }

    /// A text, its middle at the height of a point.
    pub(super) fn text(
        &self,
        point: Pixel,
        text: &str,
        size: f64,
        anchor: Anchor,
    ) -> Result<(), FigureError> {
        self.write(point, text, style(size, anchor))
    }

    /// A text that reads upwards, about a point.
    pub(super) fn upwards(&self, point: Pixel, text: &str, size: f64) -> Result<(), FigureError> {
        let font = ("sans-serif", size * FINE).into_font().transform(FontTransform::Rotate270).color(&INK);
        self.write(point, text, font.pos(Pos::new(HPos::Center, VPos::Center)))
    }

    fn write(&self, point: Pixel, text: &str, style: TextStyle<'_>) -> Result<(), FigureError> {
        self.area.draw(&Text::new(text.to_owned(), at(point), style))?;
        Ok(())
    }
}

fn style(size: f64, anchor: Anchor) -> TextStyle<'static> {
    let horizontal = match anchor {
        Anchor::Start => HPos::Left,
        Anchor::Middle => HPos::Center,
        Anchor::End => HPos::Right,
    };
    ("sans-serif", size * FINE).into_font().color(&INK).pos(Pos::new(horizontal, VPos::Center))
}
