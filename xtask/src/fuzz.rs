//! Fuzzing: any text at all to the readers of `mm-fis` and of scenarios, any bytes to the reader of logs, with libFuzzer by cargo-fuzz, which
//! needs nightly.

use anyhow::{Result, ensure};

use crate::shell::{answers, command_with, root, run};

/// A target in `fuzz/fuzz_targets`.
struct Target {
    name: &'static str,
    dictionary: &'static str,
    /// What the search starts from.
    seeds: &'static [&'static str],
    /// Longest input, bytes.
    longest: u32,
}

const TEXTS: &[&str] =
    &["crates/mm-fis/tests/corpus/good", "crates/mm-fis/tests/corpus/bad", "scenarios/fis"];

const TARGETS: [Target; 4] = [
    Target { name: "read_fis", dictionary: "fuzz/fis.dict", seeds: TEXTS, longest: 8192 },
    Target { name: "read_fcl", dictionary: "fuzz/fcl.dict", seeds: TEXTS, longest: 8192 },
    Target { name: "read_scenario", dictionary: "fuzz/scenario.dict", seeds: &["scenarios"], longest: 8192 },
    Target { name: "read_log", dictionary: "fuzz/log.dict", seeds: &["fuzz/seeds/log"], longest: 65536 },
];

/// Builds the targets and runs each for a time; fails on the first finding.
///
/// What the search learns is kept in `fuzz/corpus`, a finding in `fuzz/artifacts`; neither is committed.
pub(crate) fn fuzz(seconds: u64) -> Result<()> {
    ensure!(
        answers("cargo", &["+nightly", "--version"]),
        "no nightly toolchain: `rustup toolchain install nightly --profile minimal`"
    );
    ensure!(
        answers("cargo", &["+nightly", "fuzz", "--version"]),
        "no cargo-fuzz: `cargo install cargo-fuzz --locked`"
    );
    for target in &TARGETS {
        run(&mut nightly(&["build", target.name]))?;
    }
    for Target { name, dictionary, seeds, longest } in TARGETS {
        let corpus = format!("fuzz/corpus/{name}");
        std::fs::create_dir_all(root().join(&corpus))?;
        let time = format!("-max_total_time={seconds}");
        let dictionary = format!("-dict={}", root().join(dictionary).display());
        let longest = format!("-max_len={longest}");
        let mut command = nightly(&["run", name, &corpus]);
        command.args(seeds).args(["--", &time, &dictionary, &longest]);
        command.args(["-fork=0", "-rss_limit_mb=2048", "-malloc_limit_mb=512", "-timeout=10"]);
        run(command.arg("-print_final_stats=1"))?;
    }
    Ok(())
}

fn nightly(arguments: &[&str]) -> std::process::Command {
    let mut cargo = command_with("cargo", &["+nightly", "fuzz"]);
    // The job itself runs under another cargo, whose choice of toolchain is not meant here.
    for variable in ["CARGO", "RUSTC", "RUSTUP_TOOLCHAIN", "RUSTC_WRAPPER"] {
        cargo.env_remove(variable);
    }
    cargo.args(arguments);
    cargo
}
