//! Why a log could not be written or read.

use std::path::PathBuf;

/// Why a log could not be written or read.
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
    /// The file could not be read, or is no MCAP file.
    #[error("cannot read the log {}", .path.display())]
    Read {
        /// The file as given.
        path: PathBuf,
        /// What the container format or the operating system says.
        source: mcap::McapError,
    },
    /// The file is a log without a single readable message.
    #[error("the log {} holds no message that could be read", .path.display())]
    Empty {
        /// The file as given.
        path: PathBuf,
    },
}
