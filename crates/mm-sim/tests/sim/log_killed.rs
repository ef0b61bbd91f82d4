//! Runs that are killed: what their logs give back.
//!
//! Law: of a run that is killed at any moment, `mmsim log recover` gives back every message of every chunk that was in the file, and
//! says 0. Why: the promise of the log. Reference: the complete chunks of what the killed run left, read by the `mcap` crate; what the file
//! held at an earlier look is in it. No tolerance. How much wall time a kill costs is measured by `cargo xtask log-kill`.

use crate::common::command::Folder;
use crate::log_recover::messages;
use std::time::Duration;

/// Moments of the kills after the start of the log, ms; spread over several flushes.
const MOMENTS_MS: [u64; 10] = [3, 61, 107, 158, 211, 284, 333, 397, 452, 520];

#[test]
fn killed_runs_give_back_what_was_in_the_file() {
    let folder = Folder::new("log_killed");
    let log = folder.path("square.mcap");
    for moment in MOMENTS_MS {
        let _ = std::fs::remove_file(&log);
        let args = ["--scenario", "square", "--quiet", "--set", "simulation.duration_s=36000", "--out", "."];
        let mut run = folder.command(&args).spawn().expect("the binary starts");
        while !std::fs::metadata(&log).is_ok_and(|file| file.len() > 0) {
            assert!(run.try_wait().expect("a child").is_none(), "the run goes on");
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(moment));
        let before = std::fs::read(&log).expect("the log so far");
        std::thread::sleep(Duration::from_millis(10));
        run.kill().expect("SIGKILL");
        run.wait().expect("a child");
        let left = std::fs::read(&log).expect("what is left");
        assert!(left.starts_with(&before), "a log grows at its end only");

        let expected = messages(&left);
        let ended = folder.expect(0, &["log", "recover", "square.mcap", "-o", "back.mcap"]);
        let back = std::fs::read(folder.path("back.mcap")).expect("the recovered log");
        assert!(messages(&back) == expected, "killed after {moment} ms:\n{}", ended.stderr);
        assert!(expected.starts_with(&messages(&before)), "what was flushed before is there");
        assert!(mcap::read::Summary::read(&back).is_ok_and(|index| index.is_some()), "with an index");
    }
}
