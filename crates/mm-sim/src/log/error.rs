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
    /// Another run writes the file.
    #[error("another run writes the log {}; wait for it, or give another folder with --out", .path.display())]
    Busy {
        /// The file as given.
        path: PathBuf,
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

impl LogError {
    /// Whether the log went to a reader that has gone away.
    #[must_use]
    pub fn is_broken_pipe(&self) -> bool {
        match self {
            Self::Create { source, .. } | Self::Write { source: mcap::McapError::Io(source), .. } => {
                source.kind() == std::io::ErrorKind::BrokenPipe
            }
            Self::Busy { .. } | Self::Write { .. } | Self::Read { .. } | Self::Empty { .. } => false,
        }
    }
}
