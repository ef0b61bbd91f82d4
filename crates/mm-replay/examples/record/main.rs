//! Records the closed-loop scenarios that come with the simulator: `record --out DIRECTORY [--ticks N] [SCENARIO ...]`.
//!
//! Each is recorded in f64 and in f32, as the files NAME.f64 and NAME.f32; the inputs are those of the run in f64. Both are then
//! replayed here, and a line of each is printed: name, precision, ticks, digest. With `--ticks N` not all ticks are
//! recorded but about N: the first N/2, and ten windows of N/20 each that are spread over the rest of the run. `record --list` names
//! the scenarios.

mod run;
mod setup;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use anyhow::{Context, Result, ensure};
use mm_replay::{Source, replay};
use mm_sim::experiment::Experiment;
use mm_sim::scenario;

fn main() -> Result<()> {
    let (mut is_list, mut out, mut ticks, mut names) = (false, None, None, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--list" => is_list = true,
            "--out" => out = arguments.next().map(PathBuf::from),
            "--ticks" => ticks = Some(arguments.next().context("--ticks needs a number")?.parse::<u32>()?),
            _ => names.push(argument),
        }
    }
    if is_list {
        closed_loops()?.iter().for_each(|name| println!("{name}"));
        return Ok(());
    }
    let out = out.context("--out DIRECTORY is missing")?;
    if names.is_empty() {
        names = closed_loops()?;
    }
    std::fs::create_dir_all(&out).with_context(|| format!("cannot make {}", out.display()))?;
    let results = in_parallel(&names, |name| record(name, ticks, &out));
    for result in results {
        print!("{}", result?);
    }
    Ok(())
}

/// Names of the bundled scenarios with a controller.
fn closed_loops() -> Result<Vec<String>> {
    let mut names = Vec::new();
    for (name, _) in scenario::bundled() {
        if matches!(Experiment::build(&scenario::load(name, &[])?)?, Experiment::Closed(_)) {
            names.push((*name).to_owned());
        }
    }
    Ok(names)
}

/// Records a scenario and replays both recordings; their lines.
fn record(name: &str, ticks: Option<u32>, out: &Path) -> Result<String> {
    let paths = ["f32", "f64"].map(|precision| out.join(format!("{name}.{precision}")));
    run::record(name, ticks, &paths).with_context(|| format!("recording `{name}`"))?;
    let mut lines = String::new();
    for path in &paths {
        let mut source = Opened(BufReader::new(File::open(path)?));
        let replayed = replay(&mut source).map_err(anyhow::Error::new)?;
        lines.push_str(&format!("{}\n", replayed.context("an empty file")?));
        ensure!(replay(&mut source)?.is_none(), "{}: more than one recording", path.display());
    }
    Ok(lines)
}

struct Opened(BufReader<File>);

impl Source for Opened {
    fn read(&mut self, buffer: &mut [u8]) -> usize {
        self.0.read(buffer).unwrap_or(0)
    }
}

/// Results in the order of the inputs.
fn in_parallel<I: Sync, O: Send>(items: &[I], work: impl Fn(&I) -> Result<O> + Sync) -> Vec<Result<O>> {
    let next = Mutex::new(items.iter().enumerate());
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let item = next.lock().ok().and_then(|mut next| next.next());
                    let Some((index, item)) = item else { break };
                    let result = work(item);
                    if let Ok(mut done) = done.lock() {
                        done.push((index, result));
                    }
                }
            });
        }
    });
    let Ok(mut done) = done.into_inner() else { return vec![Err(anyhow::anyhow!("a thread failed"))] };
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}
