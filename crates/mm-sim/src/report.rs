//! The report: one HTML file that shows runs side by side, opens from disk and needs no network.
//!
//! ```text
//! LogFile or Recording --payload: signals reduced, base64--+
//! summaries --metrics: tables--------------------------------> shell: one page with styles, scripts, libraries and its own policy
//! ```
//! What is shown is here; how it moves is in `assets/`, plain scripts over uPlot and three.js, which are in `vendor/`. Whatever comes
//! from a file is escaped: text by the template library, data by JSON without `<`. The page may run no script but its own.

mod colors;
mod metrics;
mod of_logs;
mod of_reproduction;
mod payload;
mod plots;
mod series;
mod shell;
mod thesis;

pub(crate) use of_logs::names;
pub use of_logs::of_logs;
pub(crate) use of_reproduction::of_reproduction;
pub(crate) use payload::{Group, Run, Signals};
