//! `mmsim log`: what is in a log, and what can be got back of a torn one.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};
use serde_json::{Value, json};

use super::run::with_causes;
use super::{Exit, complain, examples, print};
use crate::log::{self, End, LogError, LogInfo, RECOVERED, Recovered, Scan};

/// Name and version of the format of `mmsim log info --json`.
const SCHEMA: &str = "mmsim.log-info/1";
/// Damaged records that are named one by one.
const MAX_NAMED: usize = 10;

/// What `log` does.
#[derive(Debug, Subcommand)]
pub(super) enum LogCommand {
    /// Say what is in a log, and whether it is whole.
    #[command(after_help = examples::LOG_INFO)]
    Info(InfoArgs),
    /// Write what a torn or damaged log still holds to a new, whole one.
    #[command(after_help = examples::LOG_RECOVER)]
    Recover(RecoverArgs),
}

#[derive(Debug, Args)]
pub(super) struct InfoArgs {
    /// The log.
    #[arg(value_name = "FILE.mcap")]
    file: PathBuf,
    /// Print as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Args)]
pub(super) struct RecoverArgs {
    /// The log; it is not changed.
    #[arg(value_name = "FILE.mcap")]
    file: PathBuf,
    /// The new log; beside the old one, as FILE.recovered.mcap, by default.
    #[arg(long, short, value_name = "OUT.mcap")]
    output: Option<PathBuf>,
}

/// Runs one of the sub-commands.
pub(super) fn log(command: &LogCommand) -> Exit {
    match command {
        LogCommand::Info(args) => info(args),
        LogCommand::Recover(args) => recover(args),
    }
}

fn info(args: &InfoArgs) -> Exit {
    let info = match read(&args.file) {
        Ok(info) => info,
        Err(exit) => return exit,
    };
    let text = if args.json {
        serde_json::to_string_pretty(&as_json(&args.file, &info)).unwrap_or_default()
    } else {
        as_text(&args.file, &info)
    };
    warn(&args.file, &info.scan);
    let exit = if info.scan.is_whole() { Exit::Done } else { Exit::Missed };
    exit.max(print(&text))
}

fn recover(args: &RecoverArgs) -> Exit {
    let from = &args.file;
    let to = args.output.clone().unwrap_or_else(|| from.with_extension("recovered.mcap"));
    if is_same(from, &to) {
        complain(&format_args!("error: {} is the log itself: name another file with -o", to.display()));
        return Exit::Usage;
    }
    let found = match read(from) {
        Ok(found) => found,
        Err(exit) => return exit,
    };
    if found.scan.is_whole() {
        let outcome = found.entry("mmsim.result", "outcome").unwrap_or("not said");
        return print(&format!("{} is whole, nothing to recover; outcome: {outcome}", from.display()));
    }
    match log::recover(from, &to) {
        Ok(recovered) => said(args, &to, &recovered),
        Err(error) => failed(&error),
    }
}

fn said(args: &RecoverArgs, to: &Path, recovered: &Recovered) -> Exit {
    warn(&args.file, &recovered.scan);
    if recovered.left_out > 0 {
        complain(&format_args!("warning: {} records belong to no channel and are lost", recovered.left_out));
    }
    let exit = if recovered.is_complete() { Exit::Done } else { Exit::Missed };
    exit.max(print(&format!(
        "{}: {} messages of {} chunks up to {} s",
        to.display(),
        recovered.messages,
        recovered.scan.chunks,
        seconds(recovered.last_ns)
    )))
}

fn read(path: &Path) -> Result<LogInfo, Exit> {
    if !path.exists() {
        complain(&format_args!("error: there is no file {}", path.display()));
        return Err(Exit::Usage);
    }
    LogInfo::read(path).map_err(|error| failed(&error))
}

fn failed(error: &LogError) -> Exit {
    complain(&format_args!("error: {}", with_causes(error)));
    Exit::Failed
}

/// Whether two paths lead to one file.
fn is_same(one: &Path, other: &Path) -> bool {
    match (one.canonicalize(), other.canonicalize()) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

/// Says on standard error what is lost.
fn warn(path: &Path, scan: &Scan) {
    let path = path.display();
    match &scan.end {
        End::Torn if scan.torn_bytes() == 0 => {
            complain(&format_args!("warning: {path} is torn: it ends without its index"));
        }
        End::Torn => complain(&format_args!(
            "warning: {path} is torn: its last {} bytes are an unfinished record and are lost",
            scan.torn_bytes()
        )),
        End::Damaged(reason) => complain(&format_args!(
            "warning: {path} is damaged: {reason}; {} bytes from byte {} on are not read",
            scan.torn_bytes(),
            scan.complete_bytes
        )),
        _ => {}
    }
    for damage in scan.damage.iter().take(MAX_NAMED) {
        complain(&format_args!(
            "warning: {path}: {} bytes from byte {} on are damaged and are lost: {}",
            damage.bytes, damage.offset, damage.reason
        ));
    }
    if scan.damage.len() > MAX_NAMED {
        complain(&format_args!("warning: {path}: {} damaged records more", scan.damage.len() - MAX_NAMED));
    }
}

/// The state of a file in one word.
fn state(scan: &Scan) -> &'static str {
    match scan.end {
        End::Whole if scan.damage.is_empty() => "whole",
        End::Torn if scan.damage.is_empty() => "torn",
        _ => "damaged",
    }
}

/// Nanoseconds as seconds, exactly.
fn seconds(ns: u64) -> String {
    let text = format!("{}.{:09}", ns / 1_000_000_000, ns % 1_000_000_000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What identifies a run: key, metadata record, its key.
const IDENTITY: [(&str, &str, &str); 8] = [
    ("scenario", "mmsim", "scenario"),
    ("controller", "mmsim", "controller"),
    ("seed", "mmsim", "seed"),
    ("edits", "mmsim", "edits"),
    ("version", "mmsim", "version"),
    ("outcome", "mmsim.result", "outcome"),
    ("digest", "mmsim.result", "digest"),
    ("samples", "mmsim.result", "samples"),
];

fn as_text(path: &Path, info: &LogInfo) -> String {
    let scan = &info.scan;
    let mut out =
        format!("{}: {}, {} bytes, {} chunks\n", path.display(), state(scan), scan.bytes, scan.chunks);
    for (name, record, key) in IDENTITY {
        let value = match info.entry(record, key) {
            None => "not said".to_owned(),
            Some("") => "none".to_owned(),
            Some(text) if name == "edits" => match log::edits(text).as_slice() {
                [] => "none".to_owned(),
                edits => edits.join("\n").replace('\n', "\n             "),
            },
            Some(text) => text.to_owned(),
        };
        let _ = writeln!(out, "{name:12} {value}");
    }
    for change in info.changes() {
        let _ = writeln!(out, "{:12} {change}", "changed");
    }
    if info.metadata.contains_key(RECOVERED) {
        let _ = writeln!(out, "{:12} from a log that was torn or damaged", "recovered");
    }
    if let Some((first, last)) = info.span_ns {
        let _ = writeln!(out, "{:12} {} to {} s", "time", seconds(first), seconds(last));
    }
    out.push('\n');
    let width = info.topics.keys().map(String::len).max().unwrap_or(0);
    for (name, topic) in &info.topics {
        let _ = writeln!(out, "{name:width$} {:>12}  {}", topic.messages, topic.message_type);
    }
    out.push('\n');
    for attachment in &info.attachments {
        let _ = writeln!(out, "{} ({}, {} bytes)", attachment.name, attachment.media_type, attachment.bytes);
    }
    out.truncate(out.trim_end().len());
    out
}

fn as_json(path: &Path, info: &LogInfo) -> Value {
    let scan = &info.scan;
    let mut out = json!({
        "schema": SCHEMA,
        "file": path.display().to_string(),
        "state": state(scan),
        "recovered": info.metadata.contains_key(RECOVERED),
        "bytes": scan.bytes,
        "torn_bytes": scan.torn_bytes(),
        "chunks": scan.chunks,
        "messages": info.messages(),
        "start_ns": info.span_ns.map(|span| span.0),
        "end_ns": info.span_ns.map(|span| span.1),
    });
    for (name, record, key) in IDENTITY {
        let value = info.entry(record, key);
        // A seed may be larger than what some readers of JSON take for a whole number; it is one in the summary, too.
        let number =
            value.filter(|_| matches!(name, "seed" | "samples")).and_then(|text| text.parse::<u64>().ok());
        out[name] = match (name, value) {
            ("edits", Some(text)) => json!(log::edits(text)),
            _ => number.map_or_else(|| json!(value), |number| json!(number)),
        };
    }
    out["changes"] = info.changes().collect();
    let topics = info.topics.iter();
    let topics = topics
        .map(|(name, topic)| json!({"topic": name, "type": topic.message_type, "messages": topic.messages}));
    out["topics"] = topics.collect();
    let attachments = info.attachments.iter();
    let attachments = attachments
        .map(|file| json!({"name": file.name, "media_type": file.media_type, "bytes": file.bytes}));
    out["attachments"] = attachments.collect();
    let damage = scan.damage.iter();
    let damage =
        damage.map(|record| json!({"offset": record.offset, "bytes": record.bytes, "reason": record.reason}));
    out["damage"] = damage.collect();
    out["metadata"] = json!(info.metadata);
    out
}
