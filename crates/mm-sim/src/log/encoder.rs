//! The messages of a run, encoded, in the order in which they are sent; where they go is the caller's.

use super::arrows::Arrows;
use super::cdr::Cdr;
use super::frames::{JOINTS, Joint, joints, transforms};
use super::header::LogHeader;
use super::messages;
use super::sample::{LogSample, stamp_ns};
use super::topics::Topic;
use super::trail::Trail;
use super::urdf::urdf;

/// Simulated time between two messages on `/path`.
const PATH_PERIOD_NS: u64 = 500_000_000;
/// Most points of `/reference`.
const MAX_REFERENCE_POINTS: usize = 2_000;

/// One message.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Message<'a> {
    pub(crate) topic: Topic,
    pub(crate) sequence: u32,
    /// Time of the scenario.
    pub(crate) stamp_ns: u64,
    /// CDR.
    pub(crate) bytes: &'a [u8],
}

/// Makes the messages of one run. No allocation per sample once the buffers have grown.
#[derive(Debug)]
pub(crate) struct Encoder {
    joints: [Joint; JOINTS],
    wheel_radius_m: f64,
    half_track_m: f64,
    cdr: Cdr,
    trail: Trail,
    arrows: Arrows,
    next_path_ns: u64,
    samples: u32,
}

impl Encoder {
    pub(crate) fn new(header: &LogHeader<'_>) -> Self {
        Self {
            joints: joints(&header.robot),
            wheel_radius_m: header.robot.wheel_radius_m,
            half_track_m: header.robot.track_width_m / 2.0,
            cdr: Cdr::default(),
            trail: Trail::new(),
            arrows: Arrows::default(),
            next_path_ns: 0,
            samples: 0,
        }
    }

    /// Samples so far.
    pub(crate) const fn samples(&self) -> u32 {
        self.samples
    }

    /// What is known before the run: the robot and the whole desired path.
    pub(crate) fn preamble<E>(
        &mut self,
        header: &LogHeader<'_>,
        mut send: impl FnMut(Message<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let cdr = &mut self.cdr;
        messages::string(cdr, &urdf(&header.robot));
        send(message(Topic::RobotDescription, 0, 0, cdr))?;
        let stride = header.reference.len().div_ceil(MAX_REFERENCE_POINTS).max(1);
        let points = header.reference.iter().step_by(stride);
        messages::path(cdr, 0, points.map(|&[t, x, y, z]| (stamp_ns(t), [x, y, z])));
        send(message(Topic::Reference, 0, 0, cdr))
    }

    /// One instant of the run. Samples come in the order of time.
    pub(crate) fn sample<E>(
        &mut self,
        sample: &LogSample,
        mut send: impl FnMut(Message<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let (stamp, sequence) = (sample.stamp_ns(), self.samples);
        let cdr = &mut self.cdr;
        messages::tf(cdr, stamp, &transforms(&self.joints, sample));
        send(message(Topic::Tf, sequence, stamp, cdr))?;
        let turn = self.half_track_m * sample.yaw_rate;
        let wheel_rates = [sample.forward + turn, sample.forward - turn].map(|v| v / self.wheel_radius_m);
        messages::joint_states(cdr, stamp, sample, wheel_rates);
        send(message(Topic::JointStates, sequence, stamp, cdr))?;
        messages::odometry(cdr, stamp, sample);
        send(message(Topic::Odom, sequence, stamp, cdr))?;
        messages::control(cdr, stamp, sample);
        send(message(Topic::Control, sequence, stamp, cdr))?;
        if stamp >= self.next_path_ns {
            // The trail and, as its newest point, the tip as it is now.
            let kept = self.trail.points();
            let points =
                (0..kept.len() + 1).map(|index| kept.get(index).copied().unwrap_or((stamp, sample.tip)));
            messages::path(cdr, stamp, points);
            let number = stamp / PATH_PERIOD_NS;
            self.next_path_ns = number.saturating_add(1).saturating_mul(PATH_PERIOD_NS);
            send(message(Topic::Path, u32::try_from(number).unwrap_or(u32::MAX), stamp, cdr))?;
        }
        self.trail.offer(stamp, sample.tip);
        self.samples = self.samples.wrapping_add(1);
        if self.arrows.write(cdr, stamp, &self.joints, &sample.disturbance) {
            send(message(Topic::Disturbance, sequence, stamp, cdr))?;
        }
        Ok(())
    }
}

fn message(topic: Topic, sequence: u32, stamp_ns: u64, cdr: &Cdr) -> Message<'_> {
    Message { topic, sequence, stamp_ns, bytes: cdr.bytes() }
}
