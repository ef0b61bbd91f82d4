//! A log that reaches the operating system in time, whether samples come or not.

use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::{LogError, LogSample, LogWriter, Outcome};

/// How often a thread looks whether something waits to be flushed.
const LOOK_PERIOD: Duration = Duration::from_millis(10);

/// A writer and a thread that flushes it: a run that stands still, waiting for a target or a plant of somebody else, has its last
/// samples in the file too.
#[derive(Debug)]
pub(super) struct TimelyWriter {
    shared: Arc<Mutex<Shared>>,
    /// Dropped to end the thread.
    stop: Option<Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    writer: Option<LogWriter>,
    /// Of a flush that failed, for the next call.
    error: Option<LogError>,
}

impl TimelyWriter {
    /// Takes a writer. Without a thread to be had it is flushed with its samples alone.
    pub(super) fn new(writer: LogWriter) -> Self {
        let shared = Arc::new(Mutex::new(Shared { writer: Some(writer), error: None }));
        let (stop, stopped) = mpsc::channel();
        let looked_at = Arc::clone(&shared);
        let look = move || {
            while stopped.recv_timeout(LOOK_PERIOD) == Err(RecvTimeoutError::Timeout) {
                flush(&mut lock(&looked_at));
            }
        };
        let thread = thread::Builder::new().name("log".to_owned()).spawn(look).ok();
        Self { shared, stop: Some(stop), thread }
    }

    /// Writes one instant of the run.
    pub(super) fn write(&self, sample: &LogSample) -> Result<(), LogError> {
        self.with(|writer| writer.write(sample))
    }

    /// Writes down what somebody changed.
    pub(super) fn note_change(&self, change: &str) -> Result<(), LogError> {
        self.with(|writer| writer.note_change(change))
    }

    /// Ends the log.
    pub(super) fn finish_as(self, outcome: Outcome, summary: &str, digest: &str) -> Result<(), LogError> {
        let mut shared = lock(&self.shared);
        if let Some(error) = shared.error.take() {
            return Err(error);
        }
        shared.writer.take().map_or(Ok(()), |writer| writer.finish_as(outcome, summary, digest))
    }

    /// What a flush failed with before, or what the writer says now.
    fn with(&self, write: impl FnOnce(&mut LogWriter) -> Result<(), LogError>) -> Result<(), LogError> {
        let mut shared = lock(&self.shared);
        if let Some(error) = shared.error.take() {
            return Err(error);
        }
        shared.writer.as_mut().map_or(Ok(()), write)
    }
}

impl Drop for TimelyWriter {
    fn drop(&mut self) {
        drop(self.stop.take());
        if let Some(thread) = self.thread.take() {
            // What it had to say is in the error.
            let _ = thread.join();
        }
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

fn flush(shared: &mut Shared) {
    if let Some(Err(error)) = shared.writer.as_mut().map(LogWriter::flush_if_due) {
        shared.error.get_or_insert(error);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{LogHeader, LogInfo, LogSample, LogWriter, recover_stream};
    use super::TimelyWriter;
    use crate::log::urdf::tests::thesis_like;
    use std::time::{Duration, Instant};

    fn header() -> LogHeader<'static> {
        LogHeader {
            scenario_name: "still",
            scenario_text: "",
            edits: &[],
            files: &[],
            versions: &[],
            seed: 0,
            controller: "none",
            robot: thesis_like(),
            reference: &[],
        }
    }

    /// Law: what was changed on the way is in a log that nobody finished, and in what is recovered of it, in the order of time. Why: a
    /// killed run must not pass for that of its scenario. Reference: the words that were given.
    #[test]
    fn changes_are_in_a_log_without_an_end() {
        let path = std::env::temp_dir().join(format!("mmsim-changed-{}.mcap", std::process::id()));
        let log = TimelyWriter::new(LogWriter::create(&path, &header()).expect("a file"));
        log.write(&LogSample::default()).expect("space");
        let words: Vec<String> = (0..12).map(|k| format!("gain = {k} from t = 0.{k:03} s on")).collect();
        for change in &words {
            log.note_change(change).expect("space");
        }
        drop(log);
        let torn = std::fs::read(&path).expect("our own file");
        std::fs::remove_file(&path).expect("our own file");
        let mut recovered = Vec::new();
        recover_stream(torn.as_slice(), &mut recovered).expect("a log");
        for bytes in [torn, recovered] {
            let info = LogInfo::of(bytes.as_slice()).expect("a log");
            assert_eq!(info.changes().collect::<Vec<_>>(), words, "{:?}", info.scan);
        }
    }

    /// Law: a sample is in the file without another one coming. Why: a run may stand still. Reference: the file, read while the
    /// writer is open; the wait is long enough for any machine.
    #[test]
    fn the_last_sample_reaches_the_file_while_nothing_happens() {
        let path = std::env::temp_dir().join(format!("mmsim-timely-{}.mcap", std::process::id()));
        let log = TimelyWriter::new(LogWriter::create(&path, &header()).expect("a file"));
        log.write(&LogSample::default()).expect("space");
        let begin = Instant::now();
        let is_there = || {
            LogInfo::read(&path)
                .is_ok_and(|info| info.topics.get("/control").is_some_and(|c| c.messages == 1))
        };
        while !is_there() {
            assert!(begin.elapsed() < Duration::from_secs(30), "the sample never came");
            std::thread::sleep(Duration::from_millis(10));
        }
        drop(log);
        std::fs::remove_file(&path).expect("our own file");
    }
}
