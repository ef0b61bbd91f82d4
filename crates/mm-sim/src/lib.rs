//! Simulator.
pub mod log;
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
