//! From what the simulation and a scenario say to what a log holds.

use mm_model::{Real, Robot};

use super::{LogHeader, LogSample, RobotShape};
use crate::VERSION;
use crate::channels::{forces, torques, velocities};
use crate::experiment::{Experiment, controller_name};
use crate::monitors::cut_torques;
use crate::scenario::Loaded;
use crate::simulation::Sample;

/// Points of the desired path in the log.
const PATH_POINTS: u32 = 2000;

/// Gives what is known of a scenario's run before it begins to `take`.
pub(crate) fn with_header<R>(
    loaded: &Loaded,
    experiment: &Experiment,
    take: impl FnOnce(&LogHeader<'_>) -> R,
) -> R {
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
        edits: loaded.edits(),
        files: &files,
        versions: &[("mmsim", VERSION)],
        seed: loaded.file.simulation.seed,
        controller: controller_name(loaded.file.controller.kind),
        robot: RobotShape::from(experiment.plant().robot().params()),
        reference: &reference,
    };
    take(&header)
}

/// Makes samples of a log of those of a simulation.
#[derive(Debug)]
pub(crate) struct Converter {
    half_track: f64,
    wheel_radius: f64,
    robot: Robot<f64, 3>,
    start_heading: Option<f64>,
}

impl Converter {
    pub(crate) fn new(experiment: &Experiment) -> Self {
        let robot = *experiment.plant().robot();
        let params = robot.params();
        Self {
            half_track: 0.5 * params.track_width,
            wheel_radius: params.wheel_radius,
            robot,
            start_heading: None,
        }
    }

    pub(crate) fn converted(&mut self, sample: &Sample<'_>) -> LogSample {
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
