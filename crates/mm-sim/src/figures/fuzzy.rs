//! Pictures of fuzzy systems: membership functions, and what the outputs are over the inputs.

mod map;
mod response;
mod sets;

use plotters::style::RGBColor;

use super::canvas::{Anchor, svg, width_of};
use super::page::{FigureError, Frame};
use super::style::TITLE;

pub use map::Map;
pub use response::{Break, Overlay, Response};
pub use sets::{Sets, Term};

/// A picture of a fuzzy system: the variables in two columns, then what the outputs are.
#[derive(Debug, Clone, PartialEq)]
pub struct FuzzyPage {
    /// Title.
    pub title: String,
    /// The variables: inputs, then outputs.
    pub sets: Vec<Sets>,
    /// Outputs over one input.
    pub responses: Vec<Response>,
    /// Outputs over two inputs.
    pub maps: Vec<Map>,
}

const WIDTH: f64 = 920.0;
const MARGIN: f64 = 10.0;
const TITLE_HEIGHT: f64 = 34.0;
/// Sizes of names and of tick labels, px; more than in pictures of runs, which hold more.
const LABEL: f64 = 16.0;
const TICK: f64 = 14.5;
const RESPONSE_HEIGHT: f64 = 340.0;

impl FuzzyPage {
    /// Draws the picture.
    ///
    /// # Errors
    /// Those of the drawing library.
    pub fn to_svg(&self) -> Result<String, FigureError> {
        let column = 0.5 * (WIDTH - 2.0 * MARGIN);
        let mut top = TITLE_HEIGHT;
        let mut place = |width: f64, heights: &[f64]| {
            let height = heights.iter().copied().fold(0.0, f64::max);
            let lefts = [MARGIN, MARGIN + width];
            let frames = lefts.map(|left| Frame { left, top, width, height });
            top += height;
            frames
        };
        let mut sets = Vec::new();
        for pair in self.sets.chunks(2) {
            let heights: Vec<f64> = pair.iter().map(|sets| sets.height(column)).collect();
            sets.extend(pair.iter().zip(place(column, &heights)));
        }
        let responses: Vec<_> = self
            .responses
            .iter()
            .map(|response| (response, place(WIDTH - 2.0 * MARGIN, &[RESPONSE_HEIGHT])[0]))
            .collect();
        let mut maps = Vec::new();
        for pair in self.maps.chunks(2) {
            maps.extend(pair.iter().zip(place(column, &[map::HEIGHT])));
        }
        svg((WIDTH, top + MARGIN), |canvas| {
            let title = shortened(&self.title, WIDTH - 3.0 * MARGIN, TITLE);
            canvas.text((MARGIN + 4.0, 0.5 * TITLE_HEIGHT + 2.0), &title, TITLE, Anchor::Start)?;
            for (panel, frame) in sets {
                sets::draw(canvas, frame, panel)?;
            }
            for (panel, frame) in responses {
                response::draw(canvas, frame, panel)?;
            }
            for (panel, frame) in maps {
                map::draw(canvas, frame, panel)?;
            }
            Ok(())
        })
    }
}

/// Colours of the terms of a variable, in turn: those of Okabe and Ito that stand out from white.
const COLORS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// The beginning of a text that fits a width, with dots where it is cut.
fn shortened(text: &str, width: f64, size: f64) -> String {
    if width_of(text, size) <= width {
        return text.to_owned();
    }
    let mut kept = String::new();
    for letter in text.chars() {
        if width_of(&kept, size) + width_of("....", size) > width {
            break;
        }
        kept.push(letter);
    }
    kept + "..."
}
