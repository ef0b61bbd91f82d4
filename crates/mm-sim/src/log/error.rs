//! Why a log could not be written.

use std::path::PathBuf;

/// Why a log could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// The file could not be created.
    #[error("cannot create the log {}", .path.display())]
    Create {
        /// The file as given.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file was open, but could not be written to: a full disk, for example.
    #[error("cannot write to the log {}", .path.display())]
    Write {
        /// The file as given.
        path: PathBuf,
        /// What the container format or the operating system says.
        source: mcap::McapError,
    },
}
