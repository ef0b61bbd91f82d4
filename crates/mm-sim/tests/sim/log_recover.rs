//! `mmsim log info` and `mmsim log recover`: whole, cut and damaged logs.
//!
//! Law: of a log that ends anywhere, everything up to its last complete record is got back, in the same order with the same bytes, and
//! the exit code says whether something that was complete is missing. Why: a log is all that is left of a run that was killed.
//! Reference: the chunks of the original, read by the `mcap` crate. No tolerance.

#![expect(clippy::expect_used, reason = "a helper that cannot go on is a failed test")]

use crate::common::command::{Folder, complete_log};
use mcap::read::{ChunkReader, LinearReader, Options};
use mcap::records::Record;
use serde_json::Value;
use std::path::Path;

/// A run of two seconds with a sample every tick, for a log of several chunks, and the log.
fn logged(test: &str) -> (Folder, Vec<u8>) {
    let folder = Folder::new(test);
    let (short, every) = ("simulation.duration_s=2", "simulation.log_rate_hz=1000");
    folder.expect(0, &["--scenario", "square", "--quiet", "--set", short, "--set", every, "--out", "."]);
    let bytes = std::fs::read(folder.path("square.mcap")).expect("the log");
    (folder, bytes)
}

/// Time, channel and bytes of every message in the complete chunks of a log.
pub(crate) fn messages(bytes: &[u8]) -> Vec<(u64, u16, Vec<u8>)> {
    let records = LinearReader::new_with_options(bytes, Options::IgnoreEndMagic.into()).expect("a log");
    let mut found = Vec::new();
    for record in records.map_while(Result::ok) {
        let Record::Chunk { header, data } = record else { continue };
        for inside in ChunkReader::new(header, &data).expect("a compression that is known") {
            if let Record::Message { header, data } = inside.expect("a record") {
                found.push((header.log_time, header.channel_id, data.into_owned()));
            }
        }
    }
    found
}

fn read(path: &Path) -> Vec<(u64, u16, Vec<u8>)> {
    messages(&std::fs::read(path).expect("the recovered log"))
}

/// Where chunks begin and how long they are, by the index of the whole file.
fn chunks(bytes: &[u8]) -> Vec<(usize, usize)> {
    let summary = mcap::read::Summary::read(bytes).expect("a log").expect("an index");
    let place = |number: u64| usize::try_from(number).expect("a small file");
    summary.chunk_indexes.iter().map(|c| (place(c.chunk_start_offset), place(c.chunk_length))).collect()
}

#[test]
fn info_tells_what_is_in_a_log() {
    let (folder, bytes) = logged("log_info");
    let text = folder.expect(0, &["log", "info", "square.mcap"]);
    assert!(text.stderr.is_empty(), "nothing to complain of: {}", text.stderr);
    for part in
        ["whole", "finished", "/disturbance", "mmsim_msgs/msg/Control", "scenario.toml", "0 to 1.999 s"]
    {
        assert!(text.stdout.contains(part), "{part} is in\n{}", text.stdout);
    }
    let info = folder.expect(0, &["log", "info", "square.mcap", "--json"]).stdout;
    let info: Value = serde_json::from_str(&info).expect("JSON");
    let log = complete_log(&folder.path("square.mcap"));
    assert_eq!(info["schema"], "mmsim.log-info/1", "name of the format");
    assert_eq!(info["state"], "whole", "{info}");
    assert_eq!(info["bytes"], bytes.len(), "size");
    assert_eq!((&info["scenario"], &info["controller"]), (&"square".into(), &"bfsmc".into()), "what ran");
    assert_eq!((&info["seed"], &info["samples"]), (&0.into(), &2000.into()), "numbers are numbers");
    assert_eq!(info["digest"], log.result["digest"], "digest");
    let edits = ["simulation.duration_s=2", "simulation.log_rate_hz=1000"];
    assert_eq!(info["edits"], serde_json::json!(edits), "what was laid over the scenario");
    for edit in edits {
        assert!(text.stdout.contains(edit), "{edit} is in\n{}", text.stdout);
    }
    assert_eq!(info["version"], mm_sim::VERSION, "version");
    assert_eq!((&info["start_ns"], &info["end_ns"]), (&0.into(), &1_999_000_000_u64.into()), "time");
    for topic in info["topics"].as_array().expect("a list") {
        let name = topic["topic"].as_str().expect("a name");
        assert_eq!(topic["messages"], log.topics.get(name).copied().unwrap_or(0), "messages on {name}");
    }
    assert_eq!(info["messages"], log.topics.values().sum::<u32>(), "messages");
}

#[test]
fn a_log_that_is_cut_anywhere_comes_back_up_to_the_cut() {
    let (folder, bytes) = logged("log_cut");
    let end_of_data = chunks(&bytes).last().map_or(0, |(at, length)| at + length);
    for cut in (0..11).map(|k| 4_000 + k * (end_of_data - 4_000) / 10).chain([bytes.len() - 1]) {
        std::fs::write(folder.path("cut.mcap"), &bytes[..cut]).expect("a file of our own");
        let info = folder.expect(3, &["log", "info", "cut.mcap", "--json"]);
        assert!(info.stdout.contains("\"state\": \"torn\""), "cut at {cut}:\n{}", info.stdout);
        assert!(info.stderr.contains("cut.mcap is torn"), "cut at {cut}:\n{}", info.stderr);
        let expected = messages(&bytes[..cut]);
        if expected.is_empty() {
            let refused = folder.expect(1, &["log", "recover", "cut.mcap", "-o", "none.mcap"]);
            assert!(refused.stderr.contains("holds no message"), "{}", refused.stderr);
            assert!(!folder.path("none.mcap").exists(), "nothing is written");
            continue;
        }
        folder.expect(0, &["log", "recover", "cut.mcap"]);
        assert!(read(&folder.path("cut.recovered.mcap")) == expected, "messages of a log cut at {cut}");
        assert_eq!(std::fs::read(folder.path("cut.mcap")).expect("the log"), bytes[..cut], "as it was");
        let info = folder.expect(0, &["log", "info", "cut.recovered.mcap", "--json"]).stdout;
        let info: Value = serde_json::from_str(&info).expect("JSON");
        assert_eq!((&info["state"], &info["recovered"]), (&"whole".into(), &true.into()), "cut at {cut}");
        assert_eq!(info["scenario"], "square", "what identifies the run is kept");
        assert_eq!(info["attachments"][0]["name"], "scenario.toml", "and the scenario");
    }
}

#[test]
fn a_damaged_chunk_is_left_out_and_said() {
    let (folder, mut bytes) = logged("log_damaged");
    let whole = messages(&bytes);
    let places = chunks(&bytes);
    assert!(places.len() > 2, "chunks before and after the one that is broken");
    let (at, length) = places[1];
    bytes[at + length / 2] ^= 0x55;
    std::fs::write(folder.path("bad.mcap"), &bytes).expect("a file of our own");
    let ended = folder.expect(3, &["log", "recover", "bad.mcap", "-o", "good.mcap"]);
    assert!(ended.stderr.contains(&format!("{at} on are damaged and are lost")), "{}", ended.stderr);
    let got = read(&folder.path("good.mcap"));
    assert!(got.len() < whole.len() && !got.is_empty(), "{} of {} messages", got.len(), whole.len());
    let mut rest = whole.iter();
    assert!(got.iter().all(|message| rest.any(|w| w == message)), "nothing but what was there, in its order");
    assert!(got.last() == whole.last(), "what follows the damage is there");
}

#[test]
fn bytes_after_the_end_are_damage() {
    let (folder, mut bytes) = logged("log_longer");
    let whole = messages(&bytes);
    bytes.extend_from_slice(&[0; 1000]);
    std::fs::write(folder.path("long.mcap"), &bytes).expect("a file of our own");
    let info = folder.expect(3, &["log", "info", "long.mcap", "--json"]);
    assert!(info.stdout.contains("\"state\": \"damaged\""), "{}", info.stdout);
    assert!(info.stderr.contains("it goes on after its end; 1000 bytes"), "{}", info.stderr);
    folder.expect(3, &["log", "recover", "long.mcap"]);
    assert!(read(&folder.path("long.recovered.mcap")) == whole, "everything is there");
    folder.expect(0, &["log", "info", "long.recovered.mcap"]);
}

#[test]
fn an_edit_with_a_line_break_stays_one() {
    let folder = Folder::new("log_edit");
    let edit = "description=\"\"\"one\ntwo\"\"\"";
    let short = "simulation.duration_s=0.01";
    folder.expect(0, &["--scenario", "square", "--quiet", "--set", short, "--set", edit, "--out", "."]);
    let info = folder.expect(0, &["log", "info", "square.mcap", "--json"]).stdout;
    let info: Value = serde_json::from_str(&info).expect("JSON");
    assert_eq!(info["edits"], serde_json::json!([short, edit]));
}

#[test]
fn a_whole_log_needs_no_recovery() {
    let (folder, _) = logged("log_whole");
    let ended = folder.expect(0, &["log", "recover", "square.mcap"]);
    assert!(ended.stdout.contains("is whole"), "{}", ended.stdout);
    assert!(!folder.path("square.recovered.mcap").exists(), "nothing is written");
}

#[test]
fn what_is_no_log_is_refused() {
    let folder = Folder::new("log_refused");
    folder.write("text.mcap", "this is no log at all");
    folder.write("empty.mcap", "");
    for file in ["text.mcap", "empty.mcap"] {
        for command in ["info", "recover"] {
            let ended = folder.expect(1, &["log", command, file]);
            assert!(
                ended.stderr.starts_with(&format!("error: cannot read the log {file}: ")),
                "{}",
                ended.stderr
            );
            assert!(ended.stdout.is_empty(), "{}", ended.stdout);
        }
    }
    let ended = folder.expect(2, &["log", "info", "none.mcap"]);
    assert_eq!(ended.stderr, "error: there is no file none.mcap\n", "a name that is wrong");
    let ended = folder.expect(2, &["log", "recover", "text.mcap", "-o", "./text.mcap"]);
    assert!(ended.stderr.contains("is the log itself"), "{}", ended.stderr);
    let left = std::fs::read_dir(folder.path("")).expect("the folder").count();
    assert_eq!(left, 2, "nothing is left behind");
}
