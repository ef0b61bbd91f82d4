//! Integration tests of the simulator and its command: one program, so that the dependencies are linked and the generic code compiled once.

#[expect(clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]
mod common {
    pub(crate) mod command;
    pub(crate) mod scenario;
}

mod cli;
mod cli_comfort;
mod cli_endings;
mod cli_fis;
mod cli_input;
mod cli_report;
mod cli_reproduce;
mod cli_sweep;
mod cli_tune;
mod figures;
mod hardware;
mod log_killed;
mod log_layouts;
mod log_read;
mod log_recover;
mod log_roundtrip;
mod pil;
mod reproduce;
mod retuning;
mod robot_round_trip;
mod robot_urdf;
mod scenario_bundled;
mod scenario_errors;
mod scenario_faults;
mod scenario_fuzzy;
mod scenario_gains;
mod scenario_include;
mod scenario_malformed;
mod scenario_reference;
mod scenario_rules;
mod scenario_set;
