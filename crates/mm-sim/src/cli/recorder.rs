//! Takes the samples of a run into the log and the progress bar.

use std::io::IsTerminal as _;
use std::path::Path;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::interrupt;
use super::sparkline::Trace;
use super::table::short;
use crate::experiment::Experiment;
use crate::live::Live;
use crate::log::{LogError, Outcome, RunLog};
use crate::scenario::Loaded;
use crate::simulation::{Recorder, Retuned, Sample};

/// Steps of the progress bar.
const PROGRESS_STEPS: u64 = 1000;

/// Log and progress of one run.
pub(super) struct RunRecorder {
    log: Option<RunLog>,
    progress: ProgressBar,
    duration: f64,
    /// When the run began; the wait for a viewer is no part of it.
    begin: Instant,
    error: Trace,
    live: Option<Live>,
    /// Number of its changes that the log has.
    noted: usize,
}

impl RunRecorder {
    /// Opens the log at `path`, if there is one.
    pub(super) fn open(
        loaded: &Loaded,
        experiment: &Experiment,
        path: Option<&Path>,
        show_progress: bool,
    ) -> Result<Self, LogError> {
        interrupt::install();
        Ok(Self {
            log: path.map(|path| RunLog::create(loaded, experiment, path)).transpose()?,
            progress: progress_bar(show_progress),
            duration: experiment.clock().duration(),
            begin: Instant::now(),
            error: Trace::new(experiment.clock().duration()),
            live: None,
            noted: 0,
        })
    }

    /// Shows the run to viewers too.
    pub(super) fn serve(&mut self, live: Live) {
        self.live = Some(live);
        self.begin = Instant::now();
    }

    /// Wall time since the run began, s.
    pub(super) fn elapsed_s(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    /// What viewers changed, and when.
    pub(super) fn changes(&self) -> &[String] {
        self.live.as_ref().map_or(&[], Live::changes)
    }

    /// Ends the progress bar.
    pub(super) fn clear(&self) {
        self.progress.finish_and_clear();
    }

    /// The size of the error over time.
    pub(super) fn error(&self) -> Option<String> {
        self.error.line()
    }

    /// Finishes the log, if there is one.
    pub(super) fn finish(self, outcome: Outcome, summary: &str, digest: &str) -> Result<(), LogError> {
        match self.log {
            Some(log) => log.finish(outcome, summary, digest),
            None => Ok(()),
        }
    }
}

impl Recorder for RunRecorder {
    type Error = LogError;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, LogError> {
        if let Some(log) = &mut self.log {
            log.record(sample)?;
        }
        if let Some(live) = &mut self.live {
            live.show(sample, interrupt::asked);
            for change in live.changes().iter().skip(self.noted) {
                if let Some(log) = &mut self.log {
                    log.note_change(change)?;
                }
            }
            self.noted = live.changes().len();
            if interrupt::asked() {
                return Ok(false);
            }
        }
        self.error.take(sample.t, (sample.tip - sample.reference.position).norm());
        if !self.progress.is_hidden() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "a fraction of a thousand steps"
            )]
            self.progress.set_position((sample.t / self.duration * PROGRESS_STEPS as f64) as u64);
            let rate = sample.t / self.begin.elapsed().as_secs_f64();
            self.progress.set_prefix(format!("{} x real time", short(rate)));
        }
        Ok(true)
    }

    fn goes_on(&mut self) -> bool {
        !interrupt::asked()
    }

    fn retuned(&mut self) -> Option<Box<Retuned>> {
        self.live.as_mut().and_then(Live::retuned)
    }
}

fn progress_bar(show: bool) -> ProgressBar {
    if !(show && std::io::stderr().is_terminal()) {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(PROGRESS_STEPS);
    if let Ok(style) =
        ProgressStyle::with_template("{msg}[{bar:40}] {percent}% {prefix} {elapsed} left {eta}")
    {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
