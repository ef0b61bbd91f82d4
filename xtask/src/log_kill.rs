//! Kills runs at random moments, recovers their logs and has the readers of others read them.

use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use serde_json::Value;

use crate::mmsim::Mmsim;
use crate::python::environment;
use crate::shell::{command, output, root, run, target_directory};

/// Where the reader and the list of its packages are, from the root of the workspace.
const READERS: &str = "tests/log_readers";
/// Runs to kill.
const RUNS: u32 = 10;
/// The run: ten simulated hours.
const SCENARIO: [&str; 5] =
    ["--scenario", "square-compare", "--quiet", "--set", "simulation.duration_s=36000"];
/// Earliest and latest moment of a kill after the start of the log, ms.
const MOMENTS_MS: (u64, u64) = (50, 1500);
/// How often the length of a growing log is looked at.
const LOOK: Duration = Duration::from_millis(1);

/// What was seen of a run before it was killed.
struct Seen {
    /// Wall time from the start of the log to the kill.
    lived: Duration,
    /// Longest time in which the log did not grow, the one before the kill included.
    longest_wait: Duration,
}

/// Kills, recovers, reads; fails if anything that was in a file is not given back.
pub(crate) fn run_all(mmsim: &Mmsim, seed: u64) -> Result<()> {
    let folder = target_directory()?.join("log-kill");
    std::fs::create_dir_all(&folder)?;
    let python = environment(&folder.join("python"), &root().join(READERS).join("requirements.txt"))?;
    let (torn, back) = (folder.join("square-compare.mcap"), folder.join("recovered.mcap"));
    println!(
        "{:>4} {:>9} {:>15} {:>12} {:>11} {:>10}",
        "run", "lived, ms", "longest wait, ms", "bytes", "torn bytes", "messages"
    );
    let mut random = seed;
    for number in 1..=RUNS {
        let (from, to) = MOMENTS_MS;
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let moment = Duration::from_millis(from + (random >> 33) % (to - from));
        let seen = kill_one(mmsim, &folder, &torn, moment)?;
        let text = |path: &Path| path.display().to_string();
        let recovered = mmsim.output(&["log", "recover", &text(&torn), "-o", &text(&back)])?;
        let said = String::from_utf8_lossy(&recovered.stderr).into_owned();
        ensure!(recovered.status.code() == Some(0), "run {number}: {}: {said}", recovered.status);
        let info = mmsim.output(&["log", "info", &text(&torn), "--json"])?;
        let info: Value = serde_json::from_slice(&info.stdout).context("no JSON from `mmsim log info`")?;
        let messages =
            output(command(&python).arg(root().join(READERS).join("read_back.py")).args([&torn, &back]))?;
        let number_of = |key: &str| info.get(key).and_then(Value::as_u64).unwrap_or_default();
        ensure!(
            messages == number_of("messages").to_string(),
            "run {number}: {messages} messages by Python: {info}"
        );
        println!(
            "{number:>4} {:>9} {:>15} {:>12} {:>11} {messages:>10}",
            seen.lived.as_millis(),
            seen.longest_wait.as_millis(),
            number_of("bytes"),
            number_of("torn_bytes")
        );
    }
    let rerun = python.with_file_name("rerun");
    run(command(&rerun).args(["mcap", "check"]).arg(&back))?;
    run(command(&rerun).args(["mcap", "convert"]).arg(&back).arg("-o").arg(folder.join("recovered.rrd")))
}

/// Starts a run, kills it `moment` after its log has begun.
fn kill_one(mmsim: &Mmsim, folder: &Path, log: &PathBuf, moment: Duration) -> Result<Seen> {
    let _ = std::fs::remove_file(log);
    let mut start = mmsim.with(&SCENARIO);
    let mut run =
        start.arg("--out").arg(folder).stdout(Stdio::null()).spawn().context("cannot start mmsim")?;
    let seen = watch(&mut run, log, moment);
    run.kill()?;
    run.wait()?;
    seen
}

fn watch(run: &mut Child, log: &PathBuf, moment: Duration) -> Result<Seen> {
    let length = || std::fs::metadata(log).map_or(0, |file| file.len());
    while length() == 0 {
        ensure!(run.try_wait()?.is_none(), "the run ended by itself");
        std::thread::sleep(LOOK);
    }
    let begin = Instant::now();
    let (mut last, mut grown, mut longest_wait) = (length(), begin, Duration::ZERO);
    while begin.elapsed() < moment {
        std::thread::sleep(LOOK);
        let now = length();
        longest_wait = longest_wait.max(grown.elapsed());
        if now > last {
            (last, grown) = (now, Instant::now());
        }
    }
    ensure!(run.try_wait()?.is_none(), "the run ended by itself");
    Ok(Seen { lived: begin.elapsed(), longest_wait })
}
