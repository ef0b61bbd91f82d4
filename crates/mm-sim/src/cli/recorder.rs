//! Takes the samples of a run into the log and the progress bar.

use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use mm_model::{Force, Real, Robot, Torque, Velocity};

use super::interrupt;
use crate::VERSION;
use crate::experiment::{Experiment, controller_name};
use crate::log::{LogError, LogHeader, LogSample, LogWriter, Outcome, RobotShape};
use crate::monitors::cut_torques;
use crate::scenario::Loaded;
use crate::simulation::{Recorder, Sample};

/// Steps of the progress bar.
const PROGRESS_STEPS: u64 = 1000;
/// Points of the desired path in the log.
const PATH_POINTS: u32 = 2000;

/// Log and progress of one run.
pub(super) struct RunRecorder {
    log: Option<(LogWriter, PathBuf)>,
    progress: ProgressBar,
    duration: f64,
    half_track: f64,
    wheel_radius: f64,
    robot: Robot<f64, 3>,
    start_heading: Option<f64>,
}

impl RunRecorder {
    /// Opens the log at `path`, if there is one.
    pub(super) fn open(
        loaded: &Loaded,
        experiment: &Experiment,
        path: Option<PathBuf>,
        show_progress: bool,
    ) -> Result<Self, LogError> {
        interrupt::install();
        let params = experiment.plant().robot().params();
        let log = path.map(|path| open_log(loaded, experiment, &path).map(|log| (log, path))).transpose()?;
        Ok(Self {
            log,
            progress: progress_bar(show_progress),
            duration: experiment.clock().duration(),
            half_track: 0.5 * params.track_width,
            wheel_radius: params.wheel_radius,
            robot: *experiment.plant().robot(),
            start_heading: None,
        })
    }

    /// Ends the progress bar.
    pub(super) fn clear(&self) {
        self.progress.finish_and_clear();
    }

    /// Finishes the log, if there is one.
    pub(super) fn finish(self, outcome: Outcome, summary: &str, digest: &str) -> Result<(), LogError> {
        match self.log {
            Some((log, _)) => log.finish_as(outcome, summary, digest),
            None => Ok(()),
        }
    }

    fn log_sample(&mut self, sample: &Sample<'_>) -> LogSample {
        let Sample { state, reference, .. } = sample;
        let start = *self.start_heading.get_or_insert(state.q.heading);
        let turned = self.half_track * (state.q.heading - state.yaw_slip - start);
        let mut out = LogSample {
            t_s: sample.t,
            x: state.q.x,
            y: state.q.y,
            heading: state.q.heading,
            joints: state.q.joints,
            forward: state.nu.forward,
            yaw_rate: state.nu.yaw_rate,
            joint_rates: state.nu.joints,
            wheel_angles: [
                (state.travel + turned) / self.wheel_radius,
                (state.travel - turned) / self.wheel_radius,
            ],
            p_d: reference.position.into(),
            dp_d: reference.velocity.into(),
            tip: sample.tip.into(),
            error: (sample.tip - reference.position).into(),
            torque_commanded: torques(sample.torque),
            torque_applied: torques(sample.torque),
            disturbance: torques(&self.robot.torque_of(&sample.external)),
            manipulability: Real::sqrt(Real::max(sample.manipulability_squared, 0.0)),
            reaching_bound: forces(&sample.required_gain),
            lyapunov: sample.lyapunov.value,
            lyapunov_rate: sample.lyapunov.rate,
            ..LogSample::default()
        };
        if let Some(output) = sample.output {
            let signals = &output.signals;
            out.nu_c = velocities(&signals.nu_c);
            out.estimated = velocities(&signals.nu);
            out.sliding = velocities(&signals.sliding);
            out.torque_commanded = torques(&signals.commanded);
            out.fuzzy = forces(&signals.fuzzy);
            out.learned = forces(&signals.learned);
            out.damping = Real::sqrt(signals.damping_squared);
            out.saturated = sample.saturated;
            out.near_singular = output.status.near_singular;
            out.speed_limited = output.status.speed_limited;
            out.joint_limited = output.status.joint_limited;
            out.torque_limited = cut_torques(output);
        } else {
            out.nu_c = velocities(&state.nu);
            out.estimated = out.nu_c;
        }
        out
    }
}

impl Recorder for RunRecorder {
    type Error = LogError;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, LogError> {
        if self.log.is_some() {
            let out = self.log_sample(sample);
            if let Some((log, _)) = &mut self.log {
                log.write(&out)?;
            }
        }
        if !self.progress.is_hidden() {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                clippy::cast_precision_loss,
                reason = "a fraction of a thousand steps"
            )]
            self.progress.set_position((sample.t / self.duration * PROGRESS_STEPS as f64) as u64);
        }
        Ok(true)
    }

    fn goes_on(&mut self) -> bool {
        !interrupt::asked()
    }
}

fn progress_bar(show: bool) -> ProgressBar {
    if !(show && std::io::stderr().is_terminal()) {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(PROGRESS_STEPS);
    if let Ok(style) = ProgressStyle::with_template("{msg} [{bar:40}] {percent}% {elapsed} left {eta}") {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

fn open_log(loaded: &Loaded, experiment: &Experiment, path: &Path) -> Result<LogWriter, LogError> {
    let duration = experiment.clock().duration();
    let reference: Vec<[f64; 4]> = (0..PATH_POINTS)
        .map(|i| {
            let t = duration * f64::from(i) / f64::from(PATH_POINTS - 1);
            let p = experiment.desired(t);
            [t, p.x, p.y, p.z]
        })
        .collect();
    let files: Vec<(&str, &str)> = loaded.files().collect();
    LogWriter::create(
        path,
        &LogHeader {
            scenario_name: loaded.name(),
            scenario_text: loaded.text(),
            files: &files,
            versions: &[("mmsim", VERSION)],
            seed: loaded.file.simulation.seed,
            controller: controller_name(loaded.file.controller.kind),
            robot: RobotShape::from(experiment.plant().robot().params()),
            reference: &reference,
        },
    )
}

fn torques(t: &Torque<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = t.joints;
    [t.right, t.left, j1, j2, j3]
}

fn velocities(v: &Velocity<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = v.joints;
    [v.forward, v.yaw_rate, j1, j2, j3]
}

fn forces(f: &Force<f64, 3>) -> [f64; 5] {
    let [j1, j2, j3] = f.joints;
    [f.forward, f.yaw, j1, j2, j3]
}
