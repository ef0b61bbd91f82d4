//! Why a log could not be read.

use std::path::PathBuf;

/// Why a log could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The file is not there, or cannot be read.
    #[error("cannot read the log {}", .path.display())]
    Open {
        /// The file as given.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file does not begin as an MCAP file does.
    #[error("{}: this is no MCAP file; `mmsim run` writes one", .path.display())]
    NoLog {
        /// The file as given.
        path: PathBuf,
    },
    /// The file has no sample of a run.
    #[error("{}: there is no sample of a run on `/control`; expected a log of `mmsim`", .path.display())]
    NoSamples {
        /// The file as given.
        path: PathBuf,
    },
}
