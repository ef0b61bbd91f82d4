//! The `mmsim` binary, run in a folder of its own.

use mcap::MessageStream;
use mcap::read::Summary;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a process left.
#[derive(Debug)]
pub(crate) struct Ended {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// An empty folder for one test, below the build folder.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub(crate) fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder below the build folder");
        Self(path)
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("a file in a folder of our own");
    }

    /// The command in this folder, its output captured.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mmsim"));
        command.current_dir(&self.0).args(args);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    /// Runs `mmsim` to its end.
    pub(crate) fn mmsim(&self, args: &[&str]) -> Ended {
        ended(self.command(args).output().expect("the binary starts"))
    }

    /// Runs `mmsim`, which has to end with a code.
    pub(crate) fn expect(&self, code: i32, args: &[&str]) -> Ended {
        let ended = self.mmsim(args);
        assert_eq!(ended.code, code, "exit code of {args:?}:\n{}{}", ended.stdout, ended.stderr);
        assert!(!ended.stderr.contains("panicked"), "{args:?}:\n{}", ended.stderr);
        ended
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            let _ = std::fs::remove_dir_all(&self.0);
        }
    }
}

pub(crate) fn ended(output: std::process::Output) -> Ended {
    let text = |bytes| String::from_utf8(bytes).expect("messages are text");
    Ended {
        code: output.status.code().expect("the process ends by itself"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// What a complete log holds.
pub(crate) struct Log {
    /// Messages by topic.
    pub(crate) topics: BTreeMap<String, u32>,
    /// Attachments by name.
    pub(crate) attachments: BTreeMap<String, String>,
    /// The record of how the run ended.
    pub(crate) result: BTreeMap<String, String>,
}

/// Reads a log that has to be complete: index, attachments, outcome, and every message.
pub(crate) fn complete_log(path: &Path) -> Log {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let summary = Summary::read(&bytes).expect("a log").expect("an index at its end");
    let mut topics = BTreeMap::new();
    for message in MessageStream::new(&bytes).expect("a log") {
        *topics.entry(message.expect("a message").channel.topic.clone()).or_insert(0) += 1;
    }
    let mut attachments = BTreeMap::new();
    for index in &summary.attachment_indexes {
        let attachment = mcap::read::attachment(&bytes, index).expect("an attachment");
        let text = String::from_utf8(attachment.data.into_owned()).expect("text");
        attachments.insert(attachment.name, text);
    }
    let result = summary
        .metadata_indexes
        .iter()
        .map(|index| mcap::read::metadata(&bytes, index).expect("a metadata record"))
        .find(|record| record.name == "mmsim.result")
        .expect("the record of how the run ended");
    Log { topics, attachments, result: result.metadata }
}
