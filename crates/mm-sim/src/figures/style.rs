//! Colours, strokes and sizes: the look of every picture, in one place.

use plotters::style::RGBColor;

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    pub(super) color: RGBColor,
    /// Width, px.
    pub(super) width: f64,
    /// Length of a dash and of a gap, px; none for a solid line.
    pub(super) dash: Option<(f64, f64)>,
}

const BLUE: RGBColor = RGBColor(0, 114, 178);
const VERMILION: RGBColor = RGBColor(213, 94, 0);
const GREEN: RGBColor = RGBColor(0, 158, 115);
const ORANGE: RGBColor = RGBColor(230, 159, 0);
const PURPLE: RGBColor = RGBColor(204, 121, 167);
const SKY: RGBColor = RGBColor(86, 180, 233);
const VIOLET: RGBColor = RGBColor(107, 91, 210);
const BROWN: RGBColor = RGBColor(140, 74, 47);
const BLACK: RGBColor = RGBColor(0, 0, 0);
const GREY: RGBColor = RGBColor(150, 150, 150);

pub(super) const INK: RGBColor = RGBColor(40, 40, 40);
pub(super) const GRID: RGBColor = RGBColor(225, 225, 225);
pub(super) const SHADOW: RGBColor = RGBColor(205, 205, 205);

/// Radius of the dot where a path starts, px.
pub(super) const START: f64 = 3.5;
/// Size of titles, px.
pub(super) const TITLE: f64 = 17.0;
/// Size of axis labels and legends, px.
pub(super) const LABEL: f64 = 14.0;
/// Size of tick labels, px.
pub(super) const TICK: f64 = 12.5;

impl Stroke {
    const fn solid(color: RGBColor, width: f64) -> Self {
        Self { color, width, dash: None }
    }

    /// What was desired: dashed, drawn on top of what was done.
    pub const DESIRED: Self = Self { color: BLACK, width: 1.1, dash: Some((5.0, 4.0)) };
    /// The base beside the tip.
    pub const BASE: Self = Self::solid(GREY, 2.2);

    /// The stroke of a law, the same in all pictures.
    #[must_use]
    pub fn of_law(name: &str) -> Self {
        match name {
            "bsmc" => Self::solid(ORANGE, 3.2),
            "bsmc-sat" => Self { color: PURPLE, width: 1.6, dash: Some((9.0, 3.0)) },
            "bfsmc-thesis" => Self { color: VERMILION, width: 1.8, dash: Some((7.0, 3.0)) },
            "bfsmc" | "none" => Self::solid(BLUE, 1.6),
            _ => Self { color: GREEN, width: 1.6, dash: Some((2.5, 2.5)) },
        }
    }

    /// The stroke of a run among others: its law's, or another one for its number.
    #[must_use]
    pub(super) fn of_run(name: &str, number: usize) -> Self {
        const OTHERS: [(RGBColor, Option<(f64, f64)>); 6] = [
            (GREEN, Some((2.5, 2.5))),
            (SKY, None),
            (VIOLET, Some((7.0, 3.0))),
            (BROWN, None),
            (GREEN, None),
            (SKY, Some((2.5, 2.5))),
        ];
        match name {
            "bsmc" | "bsmc-sat" | "bfsmc-thesis" | "bfsmc" | "none" => Self::of_law(name),
            _ => {
                let (color, dash) = OTHERS.get(number % OTHERS.len()).copied().unwrap_or((GREEN, None));
                Self { color, width: 1.6, dash }
            }
        }
    }

    /// The only run of a picture: the colour of its law.
    #[must_use]
    pub fn only(name: &str) -> Self {
        Self::solid(Self::of_law(name).color, 2.2)
    }

    /// The same colour, solid: for signals that chatter, in panels of their own.
    #[must_use]
    pub const fn alone(self) -> Self {
        Self::solid(self.color, 1.6)
    }

    /// The same colour, solid and thin: for torques, which chatter most.
    #[must_use]
    pub const fn thin(self) -> Self {
        Self::solid(self.color, 1.0)
    }
}
