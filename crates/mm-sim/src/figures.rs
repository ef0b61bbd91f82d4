//! Pictures of runs, as SVG and PNG.
//!
//! ```text
//! Simulation --Recording--> columns at the log rate --Kind::page--> panels of curves --Page::to_svg--> text
//! ```
//! A [`Recording`] takes the samples of a run; a [`Kind`] says what to show of one run or of several; a [`Page`] is what is
//! shown, as plain data, and draws itself. Text stays text, so that no font is needed to draw a picture; for PNG there is one here. The same recording
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
mod png;
mod recording;
pub(crate) mod reduce;
mod space;
mod style;

pub use kinds::{Kind, Run};
pub use page::{Axis, Curve, FigureError, Graph, Page, Panel, Space};
pub use png::{PngError, png};
pub use recording::{Group, Recording};
pub use style::Stroke;
