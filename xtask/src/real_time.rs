//! How fast the closed loop runs: simulated seconds per second of CPU time, one core, no log.

use anyhow::{Context, Result, ensure};

use crate::shell::{self, cargo, command_with, output, target_directory};

/// Duration of the square, s.
const SIMULATED: f64 = 98.0;

/// Times `runs` runs of the whole square in the release build.
pub(crate) fn run(runs: u32) -> Result<()> {
    ensure!(runs > 0, "at least one run");
    shell::run(&mut cargo(&["build", "--release", "-p", "mm-benches", "--bin", "real_time"]))?;
    let program = target_directory()?.join("release").join("real_time");
    let program = program.to_str().context("the target directory is not UTF-8")?;
    let text = output(&mut command_with(program, &[&runs.to_string()]))?;
    let mut seconds = Vec::new();
    for line in text.lines() {
        seconds.push(line.parse::<f64>()? * 1e-9);
    }
    seconds.sort_by(f64::total_cmp);
    let best = *seconds.first().context("no run")?;
    let median = *seconds.get(seconds.len() / 2).context("no run")?;
    println!(
        "the square with bfsmc, {SIMULATED} s at 1 kHz, metrics and digest, no log; {runs} runs on one core"
    );
    for (name, value) in [("median", median), ("quickest", best)] {
        println!("{name:<9} {value:.4} s of CPU time: {:.0} simulated seconds a second", SIMULATED / value);
    }
    Ok(())
}
