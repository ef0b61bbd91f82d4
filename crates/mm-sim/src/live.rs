//! A run that is watched while it goes on: served to viewers, at the speed of time.
//!
//! The protocol is that of the [Foxglove SDK](https://docs.foxglove.dev/docs/sdk), which Foxglove and Lichtblick speak; topics and types
//! are those of the [log](crate::log). The gains of the controller are parameters that a viewer can change.
//!
//! Serving takes a hundred other crates, so it stands behind the feature `live`; without it [`Live::start`] says so.

#[cfg(not(feature = "live"))]
mod absent;
#[cfg(feature = "live")]
mod board;
#[cfg(feature = "live")]
mod server;
#[cfg(feature = "live")]
mod tunables;

use std::net::SocketAddr;

#[cfg(not(feature = "live"))]
pub use absent::Live;
#[cfg(feature = "live")]
pub use server::Live;

/// How a run is served.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Options {
    /// Where viewers connect; port 0 takes a free one.
    pub address: SocketAddr,
    /// Simulated seconds per second; infinite for as fast as it goes.
    pub speed: f64,
}

/// Why a run cannot be served.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// This build cannot.
    #[error(
        "this mmsim was built without the feature `live`; cargo install --path crates/mm-sim --features live"
    )]
    Absent,
    /// An imposed motion has no controller, and is over before anybody looks.
    #[error("imposed velocities are not served; a scenario with a controller is")]
    Imposed,
    /// The server did not start.
    #[error("cannot serve at {address}")]
    Server {
        /// Where.
        address: SocketAddr,
        /// Why.
        source: Box<dyn std::error::Error + Send + Sync>,
    },
}
