//! What pushes the robot besides its actuators.

use mm_model::{Force, Mechanism, Real, Robot, Torque};
use nalgebra::Vector3;

use crate::plant::PlantSines;
use crate::random::noise_at;

/// Where a disturbance acts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// Torques on the actuators' axes, one factor each; the amplitude is in N m.
    Torque(Torque<f64, 3>),
    /// A force at the tip along a unit vector of the world frame; the amplitude is in N.
    Tip(Vector3<f64>),
    /// A slip of the base on the ground, one factor a direction; the amplitude is in m/s or rad/s.
    Slip(Slip),
}

/// What the contact with the ground adds to the rate of the pose: the wheels do not see it, a measured pose does.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Slip {
    /// Along the heading, m/s.
    pub forward: f64,
    /// To the left, m/s.
    pub sideways: f64,
    /// Counter-clockwise, rad/s.
    pub yaw_rate: f64,
}

/// How a disturbance runs in time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// The amplitude, from beginning to end.
    Constant,
    /// amplitude sin(frequency t + phase), t the scenario's time.
    Sine {
        /// Angular frequency, rad/s.
        frequency: f64,
        /// Phase, rad.
        phase: f64,
    },
    /// Uniform in [-amplitude, amplitude], a new value every `hold`; the same for the same seed.
    Noise {
        /// Time for which a value is held, s.
        hold: f64,
        /// Seed of this disturbance.
        seed: u64,
    },
}

/// One disturbance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disturbance {
    /// Where it acts.
    pub target: Target,
    /// How it runs.
    pub shape: Shape,
    /// Its size, N m, N, m/s or rad/s.
    pub amplitude: f64,
    /// From this time on, s.
    pub from: f64,
    /// Up to, and without, this time, s.
    pub to: f64,
}

impl Disturbance {
    /// Size at time `t` of an integration step that begins at `begin`.
    ///
    /// What jumps (on, off, the next random value) does so with the beginning of a step: no step of the integrator sees both
    /// sides of a jump.
    #[must_use]
    pub fn size(&self, begin: f64, t: f64) -> f64 {
        // Steps begin at multiples of the step, up to rounding.
        let begin = begin + 1e-9;
        if !(begin >= self.from && begin < self.to) {
            return 0.0;
        }
        self.amplitude
            * match self.shape {
                Shape::Constant => 1.0,
                Shape::Sine { frequency, phase } => Real::sin_cos(frequency * t + phase).0,
                Shape::Noise { hold, seed } => noise_at(seed, Real::floor((begin - self.from) / hold)),
            }
    }
}

/// All disturbances of a scenario.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Disturbances {
    all: Vec<Disturbance>,
    slips: bool,
}

impl Disturbances {
    /// A set of disturbances that act together.
    #[must_use]
    pub fn new(all: Vec<Disturbance>) -> Self {
        let slips = all.iter().any(|disturbance| matches!(disturbance.target, Target::Slip(_)));
        Self { all, slips }
    }

    /// Whether the base slips at any time.
    #[must_use]
    #[inline]
    pub const fn slips(&self) -> bool {
        self.slips
    }

    /// Sum of the slips at time `t` of a step that begins at `begin`.
    ///
    /// It is kinematic: it changes the rate of the pose and, through it, nothing of the dynamics, which see the wheels' speeds.
    #[must_use]
    pub fn slip(&self, (begin, t): (f64, f64)) -> Slip {
        let mut sum = Slip::default();
        for disturbance in &self.all {
            if let Target::Slip(factors) = disturbance.target {
                let size = disturbance.size(begin, t);
                sum.forward += size * factors.forward;
                sum.sideways += size * factors.sideways;
                sum.yaw_rate += size * factors.yaw_rate;
            }
        }
        sum
    }

    /// Whether nothing disturbs.
    #[must_use]
    #[inline]
    pub const fn is_none(&self) -> bool {
        self.all.is_empty()
    }

    /// Sum of the torques on the actuators' axes and of the forces at the tip at time `t` of a step that begins at `begin`.
    #[must_use]
    pub fn sizes(&self, begin: f64, t: f64) -> (Torque<f64, 3>, Vector3<f64>) {
        let mut sum = (Torque::zero(), Vector3::zeros());
        for disturbance in &self.all {
            let size = disturbance.size(begin, t);
            match disturbance.target {
                Target::Torque(factors) => sum.0 = sum.0.plus(factors.scaled(size)),
                Target::Tip(direction) => sum.1 += direction * size,
                Target::Slip(_) => {}
            }
        }
        sum
    }

    /// The generalized force at time `t` of a step that begins at `begin`: B times the torques, J' times the forces at the tip.
    #[must_use]
    pub fn force(&self, (begin, t): (f64, f64), robot: &Robot<f64, 3>, sines: &PlantSines) -> Force<f64, 3> {
        if self.is_none() {
            return Force::zero();
        }
        let (torque, at_tip) = self.sizes(begin, t);
        let mut force = robot.force_of(&torque);
        if self.all.iter().any(|d| matches!(d.target, Target::Tip(_))) {
            let jacobian = robot.tip_jacobian(sines.heading, &sines.posture);
            force = force.plus(jacobian.transpose_product(&at_tip));
        }
        force
    }
}
