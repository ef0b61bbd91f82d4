//! A progress bar over runs, on a terminal only.

use std::io::IsTerminal as _;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// A bar of so many runs, of which the first `done` were done before; hidden unless it is to be shown and there is a terminal.
pub(super) fn bar(show: bool, done: u64, total: u64) -> ProgressBar {
    if !(show && std::io::stderr().is_terminal()) {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(total).with_position(done);
    if let Ok(style) =
        ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len} {per_sec} {elapsed} left {eta}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.reset_eta();
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
