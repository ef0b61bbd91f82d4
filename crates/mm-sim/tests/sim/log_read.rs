//! A log is read back as it was written, whole or torn.
//!
//! Laws: every field of `/control` is a column; the tip minus its reference is the error; what identifies the run is what the summary
//! says; a file cut anywhere is read up to there with a warning, or refused in one line, and never more.
//! Why: reports and figures are made of it, and a run may be killed. Reference: the summary of the same run, and the whole file for a
//! torn one. Tolerance: a rounding of the error.

#![expect(clippy::expect_used, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::Folder;
use mm_sim::log::{LogFile, control_field_names};
use serde_json::Value;

/// A run of half a second in a folder; its log and its summary.
fn run(folder: &Folder) -> (std::path::PathBuf, Value) {
    let args =
        ["--scenario", "spiral-compare", "--set", "simulation.duration_s=0.5", "--seed", "7", "--json"];
    let summary = serde_json::from_str(&folder.expect(0, &args).stdout).expect("a summary");
    (folder.path("out/spiral-compare.mcap"), summary)
}

#[test]
fn a_whole_log_is_read_as_written() {
    let folder = Folder::new("log-read");
    let (path, summary) = run(&folder);
    let log = LogFile::read(&path).expect("a log");
    assert_eq!(log.warnings, Vec::<String>::new(), "nothing to say");
    let names: Vec<&str> = log.columns.names().iter().map(String::as_str).collect();
    assert_eq!(names, control_field_names().collect::<Vec<_>>(), "a column for each field");
    let said = ["scenario", "controller", "seed", "version"].map(|key| log.says(key));
    assert_eq!(said, ["spiral-compare", "bfsmc", "7", mm_sim::VERSION], "the run");
    assert_eq!(log.outcome(), "finished", "how it ended");
    let digest = log.result.as_ref().and_then(|result| result.get("digest"));
    assert_eq!(digest.map(String::as_str), summary["digest"].as_str(), "the same run");
    assert_eq!(log.summary.as_ref(), Some(&summary), "the summary");
    assert!(log.scenario_text.contains("name = \"spiral-compare\""), "the scenario as run");
    assert_eq!(log.urdf.matches("<link name=").count(), 7, "the robot");
    assert_eq!(log.reference.len(), 2000, "the desired path");
    let time = log.columns.time();
    assert!(time.len() >= 50 && time.windows(2).all(|pair| pair[0] < pair[1]), "{} samples", time.len());
    for axis in ["x", "y", "z"] {
        let [tip, reference, error] = ["tip_AXIS_m", "reference_AXIS_m", "error_AXIS_m"]
            .map(|name| log.columns.get(&name.replace("AXIS", axis)));
        for ((tip, reference), error) in tip.iter().zip(reference).zip(error) {
            assert!((tip - reference - error).abs() < 1e-15, "{axis}: {tip} - {reference} is not {error}");
        }
    }
    assert!(log.columns.get("no_such_field").is_empty(), "none of another name");
}

#[test]
fn a_torn_log_is_read_up_to_there() {
    let folder = Folder::new("log-torn");
    let (path, _) = run(&folder);
    let bytes = std::fs::read(&path).expect("a file");
    let whole = LogFile::of(&path, bytes.as_slice()).expect("a log");
    let mut read = 0;
    for part in 0..200 {
        let length = bytes.len() * part / 200;
        let Ok(log) = LogFile::of("torn.mcap", &bytes[..length]) else { continue };
        read += 1;
        // What follows the outcome repeats what was read.
        let is_told = log.result.is_some() || log.warnings.iter().any(|warning| warning.contains("torn"));
        assert!(is_told, "cut at {length}: {:?}", log.warnings);
        for name in log.columns.names() {
            let (some, all) = (log.columns.get(name), whole.columns.get(name));
            assert_eq!(some, &all[..some.len()], "{name}, cut at {length}, is the beginning of the whole");
        }
    }
    assert!(read > 10, "some of the cuts leave samples: {read}");
    // Without its end magic, summary section and outcome, as a killed run leaves it.
    let at = bytes.windows(12).position(|window| window == b"mmsim.result").expect("the outcome");
    let log = LogFile::of("killed.mcap", &bytes[..at - 13]).expect("a log");
    assert_eq!(log.columns.len(), whole.columns.len(), "all samples");
    assert_eq!(log.outcome(), "unfinished", "no outcome");
    assert!(log.warnings.iter().any(|w| w.contains("did not reach its end")), "{:?}", log.warnings);
}

#[test]
fn a_file_named_as_the_scenario_does_not_stand_for_it() {
    let folder = Folder::new("log-included");
    folder.write("scenario.toml", "include = \"square\"\nname = \"base\"\n");
    folder.write("mine.toml", "include = \"scenario.toml\"\nname = \"mine\"\nsimulation.duration_s = 0.01\n");
    folder.expect(0, &["--scenario", "mine.toml", "--quiet", "--out", "."]);
    let log = LogFile::read(folder.path("mine.mcap")).expect("a log");
    assert!(log.scenario_text.contains("name = \"mine\""), "what was run: {}", log.scenario_text);
    let other = log.files.iter().find(|(name, _)| name == "scenario.toml");
    assert!(other.is_some_and(|(_, text)| text.contains("\"base\"")), "{:?}", log.files);
}

#[test]
fn a_damaged_part_is_left_out_and_said() {
    let folder = Folder::new("log-damaged-read");
    // A sample every tick, for a log of several chunks.
    let (short, every) = ("simulation.duration_s=2", "simulation.log_rate_hz=1000");
    folder.expect(0, &["--scenario", "square", "--quiet", "--set", short, "--set", every, "--out", "."]);
    let path = folder.path("square.mcap");
    let mut bytes = std::fs::read(&path).expect("a file");
    let whole = LogFile::of(&path, bytes.as_slice()).expect("a log");
    let chunks = mcap::read::Summary::read(&bytes).expect("a log").expect("an index").chunk_indexes;
    assert!(chunks.len() > 3, "chunks before and after the one that is broken: {}", chunks.len());
    let broken = &chunks[2];
    let middle = broken.chunk_start_offset + broken.chunk_length / 2;
    bytes[usize::try_from(middle).expect("a small file")] ^= 0x55;
    let log = LogFile::of("damaged.mcap", bytes.as_slice()).expect("a log");
    let (some, all) = (log.columns.get("error_x_m"), whole.columns.get("error_x_m"));
    assert!(!some.is_empty() && some.len() < all.len(), "samples of the damaged chunk are left out");
    let (first, last) = (some.first(), some.last());
    assert_eq!((first, last), (all.first(), all.last()), "what precedes and what follows the damage is read");
    let said = format!("left out: 1, the first at byte {}", broken.chunk_start_offset);
    assert!(log.warnings.iter().any(|warning| warning.contains(&said)), "{:?}", log.warnings);
    assert_eq!(log.outcome(), "finished", "the outcome, too");
}

#[test]
fn what_is_no_log_is_refused_in_a_line() {
    let folder = Folder::new("log-none");
    folder.write("text.mcap", "not a log");
    let refused = |bytes: &[u8]| LogFile::of("file", bytes).expect_err("no log").to_string();
    assert_eq!(refused(b"not a log"), "file: this is no MCAP file; `mmsim run` writes one", "a text");
    let nothing = "file: there is no sample of a run on `/control`; expected a log of `mmsim`";
    assert_eq!(refused(mcap::MAGIC), nothing, "a beginning alone");
    let mut other = Vec::new();
    let mut writer = mcap::Writer::new(std::io::Cursor::new(&mut other)).expect("a file in memory");
    writer.add_channel(0, "/control", "json", &Default::default()).expect("a channel");
    writer.finish().expect("a whole file");
    drop(writer);
    assert_eq!(refused(&other), nothing, "a log of something else");
    let missing = LogFile::read(folder.path("none.mcap")).expect_err("no file").to_string();
    assert!(missing.starts_with("cannot read the log ") && missing.ends_with("none.mcap"), "{missing}");
}
