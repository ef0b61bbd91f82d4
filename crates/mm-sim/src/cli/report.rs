//! `mmsim report`: logs as one HTML file.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;

use super::run::with_causes;
use super::{Exit, complain, print};
use crate::log::LogFile;
use crate::{report, whole};

/// Name of the file in its folder.
const FILE: &str = "report.html";

#[derive(Debug, Clone, Args)]
pub(super) struct ReportArgs {
    /// Logs, each a run to show beside the others.
    #[arg(value_name = "RUN.mcap", required = true)]
    logs: Vec<PathBuf>,
    /// Folder for report.html; that of the first log by default.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Reads the logs and writes their report.
pub(super) fn report(args: &ReportArgs) -> Exit {
    let logs = match read(&args.logs) {
        Ok(logs) => logs,
        Err(exit) => return exit,
    };
    let beside =
        || args.logs.first().and_then(|log| log.parent()).unwrap_or_else(|| Path::new("")).to_owned();
    let path = args.out.clone().unwrap_or_else(beside).join(FILE);
    match write(&path, report::of_logs(&logs).as_bytes()) {
        Ok(()) => print(&path.display().to_string()),
        Err(exit) => exit,
    }
}

/// Reads all logs; complains of what is wrong with them.
pub(super) fn read(paths: &[PathBuf]) -> Result<Vec<LogFile>, Exit> {
    let mut logs = Vec::new();
    for path in paths {
        let log = LogFile::read(path).map_err(|error| {
            complain(&format_args!("error: {}", with_causes(&error)));
            Exit::Usage
        })?;
        for warning in &log.warnings {
            complain(&format_args!("warning: {}: {warning}", path.display()));
        }
        logs.push(log);
    }
    Ok(logs)
}

/// Writes a whole file, and the folder that it is in.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Exit> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let made = folder.map_or(Ok(()), std::fs::create_dir_all);
    made.and_then(|()| whole::write(path, |file| file.write_all(bytes))).map_err(|error| {
        complain(&format_args!("error: cannot write {}: {error}", path.display()));
        Exit::Failed
    })
}
