//! Fuzzing: any text at all to the readers of `mm-fis` and of scenarios, with libFuzzer by cargo-fuzz, which needs nightly.

use anyhow::{Result, ensure};

use crate::shell::{answers, command_with, root, run};

/// The targets, in `fuzz/fuzz_targets`, their dictionaries, and the texts that the search starts from.
const TARGETS: [(&str, &str, &[&str]); 3] = [
    ("read_fis", "fuzz/fis.dict", SYSTEMS),
    ("read_fcl", "fuzz/fcl.dict", SYSTEMS),
    ("read_scenario", "fuzz/scenario.dict", &["scenarios"]),
];

/// Fuzzy systems.
const SYSTEMS: &[&str] =
    &["crates/mm-fis/tests/corpus/good", "crates/mm-fis/tests/corpus/bad", "scenarios/fis"];

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
    for (target, ..) in TARGETS {
        run(&mut nightly(&["build", target]))?;
    }
    for (target, dictionary, seeds) in TARGETS {
        let corpus = format!("fuzz/corpus/{target}");
        std::fs::create_dir_all(root().join(&corpus))?;
        let time = format!("-max_total_time={seconds}");
        let dictionary = format!("-dict={}", root().join(dictionary).display());
        let mut command = nightly(&["run", target, &corpus]);
        command.args(seeds).args(["--", &time, &dictionary]);
        command.args(["-fork=0", "-rss_limit_mb=2048", "-malloc_limit_mb=512", "-timeout=10"]);
        run(command.args(["-max_len=8192", "-print_final_stats=1"]))?;
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
