//! Encoders of wheels and joints, and what locates the base.

use mm_control::{Measurement, WheelAngles};
use mm_model::{Configuration, Real, Robot, WheelRates};

use super::DelayLine;
use crate::plant::PlantState;
use crate::random::Stream;

/// Where the measured pose of the base comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PoseSource {
    /// The true pose with white noise, rounded.
    True {
        /// Rounding of x and y, m; 0 for none.
        position_resolution: f64,
        /// Standard deviation of the noise of x and y, m.
        position_noise: f64,
        /// Rounding of the heading, rad; 0 for none.
        heading_resolution: f64,
        /// Standard deviation of the noise of the heading, rad.
        heading_noise: f64,
    },
    /// Integrated from the encoders of the wheels, from the true pose at the start on.
    Odometry,
}

/// The sensors, read once a control period.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensors {
    /// Whether the wheels have encoders that the controller reads.
    pub wheel_encoders: bool,
    /// Angle between two marks of a wheel's encoder, rad; 0 for none.
    pub wheel_step: f64,
    /// Angle between two marks of a joint's encoder, rad; 0 for none.
    pub joint_step: f64,
    /// Source of the pose.
    pub pose: PoseSource,
    /// Control periods from a reading to its use.
    pub delay: usize,
    /// Seed of the noise.
    pub seed: u64,
}

impl Sensors {
    /// Sensors that read the truth at once.
    #[must_use]
    pub const fn ideal() -> Self {
        let pose = PoseSource::True {
            position_resolution: 0.0,
            position_noise: 0.0,
            heading_resolution: 0.0,
            heading_noise: 0.0,
        };
        Self { wheel_encoders: true, wheel_step: 0.0, joint_step: 0.0, pose, delay: 0, seed: 0 }
    }
}

/// The multiple of `step` nearest to `value`; halves go up, and a step of 0 changes nothing.
///
/// The error is uniform in +-step/2 where the value passes many steps: variance step^2/12.
#[must_use]
#[inline]
pub fn quantized(value: f64, step: f64) -> f64 {
    if step > 0.0 { Real::floor(value / step + 0.5) * step } else { value }
}

/// Number of the stream of sensor noise; those of disturbances are their places in the file.
const STREAM: u64 = 0x7365_6E73_6F72_0001;

/// Sensors at work.
#[derive(Debug, Clone)]
pub(super) struct SensorState<'a> {
    sensors: &'a Sensors,
    robot: Robot<f64, 3>,
    start_heading: f64,
    noise: Stream,
    /// Wheels at the last reading and the pose by odometry there.
    rolled: (WheelAngles<f64>, Configuration<f64, 3>),
    delay: DelayLine<Measurement<f64, 3>>,
}

impl<'a> SensorState<'a> {
    pub(super) fn new(sensors: &'a Sensors, robot: &Robot<f64, 3>, start: &PlantState) -> Self {
        let mut state = Self {
            sensors,
            robot: *robot,
            start_heading: start.q.heading - start.yaw_slip,
            noise: Stream::new(sensors.seed, STREAM),
            rolled: (WheelAngles { right: 0.0, left: 0.0 }, start.q),
            delay: DelayLine::new(sensors.delay),
        };
        state.rolled.0 = state.wheels(start);
        state
    }

    /// A reading of now, and what has come through by now.
    pub(super) fn measure(&mut self, state: &PlantState) -> Measurement<f64, 3> {
        let wheels = self.wheels(state);
        let pose = self.pose(state, &wheels);
        let joints = state.q.joints.map(|angle| quantized(angle, self.sensors.joint_step));
        let q = Configuration { joints, ..pose };
        self.delay.push(Measurement { q, wheels: self.sensors.wheel_encoders.then_some(wheels) })
    }

    /// The wheels turn by the way rolled and by what they turned the base, not by a slip.
    fn wheels(&self, state: &PlantState) -> WheelAngles<f64> {
        let turned = state.q.heading - state.yaw_slip - self.start_heading;
        let angles = self.robot.wheel_rates(state.travel, turned);
        let read = |angle| quantized(angle, self.sensors.wheel_step);
        WheelAngles { right: read(angles.right), left: read(angles.left) }
    }

    fn pose(&mut self, state: &PlantState, wheels: &WheelAngles<f64>) -> Configuration<f64, 3> {
        match self.sensors.pose {
            PoseSource::True { position_resolution, position_noise, heading_resolution, heading_noise } => {
                let mut read = |value: f64, noise: f64, resolution: f64| {
                    let noise = if noise > 0.0 { noise * self.noise.next_normal() } else { 0.0 };
                    quantized(value + noise, resolution)
                };
                let x = read(state.q.x, position_noise, position_resolution);
                let y = read(state.q.y, position_noise, position_resolution);
                let heading = read(state.q.heading, heading_noise, heading_resolution);
                Configuration { x, y, heading, joints: state.q.joints }
            }
            PoseSource::Odometry => {
                let (last, pose) = &mut self.rolled;
                let (way, turn) = self.robot.base_speed(WheelRates {
                    right: wheels.right - last.right,
                    left: wheels.left - last.left,
                });
                let (sin, cos) = Real::sin_cos(pose.heading + 0.5 * turn);
                pose.x += way * cos;
                pose.y += way * sin;
                pose.heading += turn;
                *last = *wheels;
                *pose
            }
        }
    }
}
