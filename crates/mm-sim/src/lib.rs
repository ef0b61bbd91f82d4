//! Simulator.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Scenario files.
pub mod scenario;
