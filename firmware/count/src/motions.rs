//! Motions that a controller is counted on: ordinary ones, and those that take its longest ways.

use mm_control::{Input, Reference, Timing};
use mm_model::{Configuration, Real, Velocity};
use nalgebra::Vector3;

/// Updates of a motion.
pub(crate) const UPDATES: u16 = 100;

/// Time between two updates, s.
pub(crate) const PERIOD: f32 = 1e-3;

/// The timing and the input of an update.
pub(crate) type Arrived<T> = (Timing<T>, Input<T, 3>);

/// A motion: x, y, heading and the joints each at a place, with a speed and an oscillation of 8 rad/s about it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) name: &'static str,
    /// Joint angles in the middle, rad.
    joints: [f32; 3],
    /// Amplitude of the joints, rad.
    swing: f32,
    /// Speed of the base, m/s.
    speed: f32,
    /// Where the reference is besides the tip, m, and its speed, m/s.
    ahead: f32,
    reference_speed: f32,
    /// Every so many inputs one that is not plausible; 0 for never.
    faulty_every: u16,
}

/// The motions.
///
/// | motion | what it leads through |
/// | --- | --- |
/// | cruise | the ordinary update: base and arm move, errors of some millimetres |
/// | stretched | the arm upright, near a singularity: damping, climb of the manipulability |
/// | bound | one joint near its limit, asked to go on: its rate bounded, the others take over |
/// | corner | two joints near their limits, the others take over what they can: the longest way there is |
/// | stalled | the same, and nothing moves: the supervisor looks closely, and at the weight of the arm, until it stops |
/// | limits | all joints near their limits and the base at its largest speed: everything held, one after the other |
/// | far | a reference far away: correction at its largest speed, torques at their limits |
/// | rest | nothing moves: the supervisor looks closely |
/// | faulty | every third input is not a number, too old, too early, or too late: held, and stopped |
pub(crate) const MOTIONS: [Motion; 9] = [
    Motion {
        name: "cruise",
        joints: [0.3, 1.0, -2.0],
        swing: 0.1,
        speed: 0.4,
        ahead: 0.002,
        reference_speed: 0.4,
        faulty_every: 0,
    },
    Motion {
        name: "stretched",
        joints: [0.2, 1.45, -0.06],
        swing: 0.05,
        speed: 0.1,
        ahead: 0.01,
        reference_speed: 0.1,
        faulty_every: 0,
    },
    Motion {
        name: "bound",
        joints: [0.2, -0.34, -1.0],
        swing: 0.005,
        speed: 0.2,
        ahead: 0.05,
        reference_speed: 0.2,
        faulty_every: 0,
    },
    Motion {
        name: "corner",
        joints: [-3.13, -0.34, 2.41],
        swing: 0.005,
        speed: 0.2,
        ahead: 0.4,
        reference_speed: 0.2,
        faulty_every: 0,
    },
    Motion {
        name: "stalled",
        joints: [-3.13, -0.34, 2.41],
        swing: 0.0,
        speed: 0.0,
        ahead: 0.4,
        reference_speed: 0.2,
        faulty_every: 0,
    },
    Motion {
        name: "limits",
        joints: [3.1, 1.9, -2.77],
        swing: 0.01,
        speed: 1.9,
        ahead: 0.4,
        reference_speed: 2.5,
        faulty_every: 0,
    },
    Motion {
        name: "far",
        joints: [0.1, 0.9, -1.9],
        swing: 0.2,
        speed: 0.2,
        ahead: 3.0,
        reference_speed: 1.0,
        faulty_every: 0,
    },
    Motion {
        name: "rest",
        joints: [0.0, 1.0, -2.0],
        swing: 0.0,
        speed: 0.0,
        ahead: 0.001,
        reference_speed: 0.0,
        faulty_every: 0,
    },
    Motion {
        name: "faulty",
        joints: [0.3, 1.0, -2.0],
        swing: 0.1,
        speed: 0.4,
        ahead: 0.002,
        reference_speed: 0.4,
        faulty_every: 3,
    },
];

impl Motion {
    /// What arrives at an update: the timing and the input. `tip` is the tip in the middle of the motion.
    pub(crate) fn at(&self, update: u16, tip: &Vector3<f32>) -> Arrived<f32> {
        let t = f32::from(update) * PERIOD;
        let (sine, cosine) = (8.0 * t).sin_cos_of();
        let angle = |middle: f32, part: f32| middle + part * self.swing * sine;
        let rate = |part: f32| part * self.swing * 8.0 * cosine;
        let [q1, q2, q3] = self.joints;
        let q = Configuration {
            x: self.speed * t,
            y: 0.1 * self.speed * self.speed * t,
            heading: 0.2 * self.speed * t,
            joints: [angle(q1, 1.0), angle(q2, 0.5), angle(q3, -0.7)],
        };
        let nu = Velocity {
            forward: self.speed,
            yaw_rate: 0.2 * self.speed,
            joints: [rate(1.0), rate(0.5), rate(-0.7)],
        };
        let position =
            tip + Vector3::new(self.reference_speed * t + self.ahead, self.ahead, -0.5 * self.ahead);
        let velocity = Vector3::new(self.reference_speed, 0.0, 0.0);
        let reference = Reference { position, velocity, acceleration: Vector3::new(0.0, 0.1, -0.2) };
        let mut arrived = (Timing::exact(PERIOD), Input { q, nu, reference });
        if self.faulty_every > 0 && update % self.faulty_every == 1 {
            spoil(&mut arrived, update / self.faulty_every);
        }
        arrived
    }

    /// The configuration in the middle of the motion.
    pub(crate) fn middle(&self) -> Configuration<f32, 3> {
        Configuration { joints: self.joints, ..Configuration::zero() }
    }
}

/// Makes what arrives implausible, each time in another way; now and then three times in a row, so that the robot is stopped.
fn spoil((timing, input): &mut Arrived<f32>, turn: u16) {
    match turn % 5 {
        0 => input.q.x = f32::NAN,
        1 => input.nu.joints = [40.0; 3],
        2 => timing.age = 1.0,
        3 => input.reference.position.z = f32::INFINITY,
        _ => timing.elapsed = 5.0 * PERIOD,
    }
}

/// Sine and cosine by the crate's own functions, whatever else the prelude offers.
trait SinCos {
    fn sin_cos_of(self) -> (f32, f32);
}

impl SinCos for f32 {
    fn sin_cos_of(self) -> (f32, f32) {
        Real::sin_cos(self)
    }
}
