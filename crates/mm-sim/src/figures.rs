//! Pictures of runs, as SVG.
//!
//! ```text
//! Simulation --Recording--> columns at the log rate --Kind::page--> panels of curves --Page::to_svg--> text
//! ```
//! A [`Recording`] takes the samples of a run; a [`Kind`] says what to show of one run or of several; a [`Page`] is what is
//! shown, as plain data, and draws itself. Text stays text, so that no font is needed to draw a picture. The same recording
//! gives the same picture, byte for byte.
//!
//! Colours are those of Okabe and Ito, which people with any form of colour blindness tell apart; strokes differ in width and
//! dashes too, and what was desired is dashed on top of what was done.

mod axes;
mod canvas;
pub mod fuzzy;
mod graph;
mod kinds;
mod page;
mod recording;
mod reduce;
mod space;
mod style;

pub use kinds::{Kind, Run};
pub use page::{Axis, Curve, FigureError, Graph, Page, Panel, Space};
pub use recording::{Group, Recording};
pub use style::Stroke;
