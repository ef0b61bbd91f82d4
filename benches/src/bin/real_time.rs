//! Runs the whole square a few times and prints the CPU time of each run, one a line, in nanoseconds: `real_time RUNS`.

use std::hint::black_box;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use mm_benches::{SQUARE_TICKS, cpu_time, square};
use mm_control::LawKind;
use mm_sim::simulation::{Ending, NoRecorder};

fn main() -> Result<()> {
    let runs: u32 = std::env::args().nth(1).context("usage: real_time RUNS")?.parse()?;
    let simulation = square(LawKind::Bfsmc, SQUARE_TICKS)?;
    let start = Instant::now();
    for _ in 0..runs {
        let before = cpu_time().unwrap_or_else(|| start.elapsed().as_nanos());
        let Ok(result) = black_box(&simulation).run(&mut NoRecorder);
        let after = cpu_time().unwrap_or_else(|| start.elapsed().as_nanos());
        ensure!(result.ending == Ending::Finished, "the run ended early: {:?}", result.ending);
        println!("{}", after - before);
    }
    Ok(())
}
