//! Ctrl-C: the first one asks the run to end and its log to be finished, the second ends the process.

use std::sync::Once;
use std::sync::atomic::{AtomicBool, Ordering};

static ASKED: AtomicBool = AtomicBool::new(false);
static INSTALL: Once = Once::new();

/// Exit code of a process that a second Ctrl-C ends.
const KILLED: i32 = 130;

/// Installs the handler, once a process.
pub(super) fn install() {
    INSTALL.call_once(|| {
        let handler = || {
            if ASKED.swap(true, Ordering::Relaxed) {
                std::process::exit(KILLED);
            }
        };
        if let Err(error) = ctrlc::set_handler(handler) {
            super::complain(&format_args!("warning: Ctrl-C will not finish the log: {error}"));
        }
    });
}

/// Whether the run was asked to end.
pub(super) fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
