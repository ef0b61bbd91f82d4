//! The log of one run: what a recorder writes, sample by sample.

use std::path::Path;

use mm_model::{Force, Real, Robot, Torque, Velocity};

use super::timely::TimelyWriter;
use super::{LogError, LogHeader, LogSample, LogWriter, Outcome, RobotShape};
use crate::VERSION;
use crate::experiment::{Experiment, controller_name};
use crate::monitors::cut_torques;
use crate::scenario::Loaded;
use crate::simulation::{Recorder, Sample};

/// Points of the desired path in the log.
const PATH_POINTS: u32 = 2000;

/// A log that takes the samples of a run.
#[derive(Debug)]
pub struct RunLog {
    writer: TimelyWriter,
    half_track: f64,
    wheel_radius: f64,
    robot: Robot<f64, 3>,
    start_heading: Option<f64>,
}

impl RunLog {
    /// The path that stands for standard output.
    pub const STDOUT: &str = "-";

    /// Makes the file of a scenario's run, with what is known before it begins.
    ///
    /// # Errors
    /// The file cannot be made or written.
    pub fn create(loaded: &Loaded, experiment: &Experiment, path: &Path) -> Result<Self, LogError> {
        let params = experiment.plant().robot().params();
        let duration = experiment.clock().duration();
        let reference: Vec<[f64; 4]> = (0..PATH_POINTS)
            .map(|i| {
                let t = duration * f64::from(i) / f64::from(PATH_POINTS - 1);
                let p = experiment.desired(t);
                [t, p.x, p.y, p.z]
            })
            .collect();
        let files: Vec<(&str, &str)> = loaded.files().collect();
        let header = LogHeader {
            scenario_name: loaded.name(),
            scenario_text: loaded.text(),
            files: &files,
            versions: &[("mmsim", VERSION)],
            seed: loaded.file.simulation.seed,
            controller: controller_name(loaded.file.controller.kind),
            robot: RobotShape::from(experiment.plant().robot().params()),
            reference: &reference,
        };
        let writer = if path == Self::STDOUT {
            LogWriter::to_stdout(&header)
        } else {
            LogWriter::create(path, &header)
        }?;
        Ok(Self {
            writer: TimelyWriter::new(writer),
            half_track: 0.5 * params.track_width,
            wheel_radius: params.wheel_radius,
            robot: *experiment.plant().robot(),
            start_heading: None,
        })
    }

    /// Ends the file of a run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(self, outcome: Outcome, summary: &str, digest: &str) -> Result<(), LogError> {
        self.writer.finish_as(outcome, summary, digest)
    }

    fn converted(&mut self, sample: &Sample<'_>) -> LogSample {
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

impl Recorder for RunLog {
    type Error = LogError;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, LogError> {
        let converted = self.converted(sample);
        self.writer.write(&converted)?;
        Ok(true)
    }
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
