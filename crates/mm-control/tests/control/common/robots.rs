//! Random robots and states.

use mm_control::Reference;
use mm_model::{Configuration, Friction, Limits, Link, Robot, RobotParams, Velocity};
use nalgebra::Vector3;

use super::random::Random;

impl Random {
    fn three(&mut self, lo: f64, hi: f64) -> [f64; 3] {
        [(); 3].map(|()| self.between(lo, hi))
    }

    fn link(&mut self) -> Link<f64> {
        let (length, mass) = (self.between(0.3, 1.0), self.between(0.5, 20.0));
        let scale = mass * length * length;
        Link {
            length,
            mass,
            com: length * self.between(0.2, 1.0),
            axial_inertia: scale * self.between(0.01, 0.1),
            pitch_inertia: scale * self.between(0.02, 0.2),
            normal_inertia: scale * self.between(0.02, 0.2),
        }
    }

    /// A robot with friction everywhere, its arm before, on or behind the axle.
    #[expect(clippy::expect_used, reason = "a test that cannot build its robot has failed")]
    pub(crate) fn robot(&mut self) -> Robot<f64, 3> {
        let [lo, hi] = [self.three(-4.0, -0.5), self.three(0.5, 4.0)];
        Robot::try_new(RobotParams {
            base_mass: self.between(5.0, 80.0),
            base_yaw_inertia: self.between(0.2, 5.0),
            base_com_offset: self.between(-0.3, 0.3),
            arm_offset: self.between(-0.4, 0.4),
            mount_height: self.between(-0.2, 0.8),
            wheel_radius: self.between(0.03, 0.3),
            track_width: self.between(0.15, 0.8),
            gravity: self.between(1.0, 12.0),
            links: [self.link(), self.link(), self.link()],
            rest_posture: self.three(-2.0, 2.0),
            friction: Friction {
                wheel_viscous: self.between(0.01, 0.5),
                wheel_coulomb: self.between(0.01, 0.5),
                joint_viscous: self.three(0.1, 2.0),
                joint_coulomb: self.three(0.1, 2.0),
                smoothing: 0.1,
            },
            limits: Limits {
                joints: [(lo[0], hi[0]), (lo[1], hi[1]), (lo[2], hi[2])],
                wheel_torque: self.between(20.0, 100.0),
                joint_torque: self.three(50.0, 250.0),
                speed: 2.0,
            },
        })
        .expect("the ranges of the random parameters are physical")
    }

    pub(crate) fn configuration(&mut self) -> Configuration<f64, 3> {
        let [x, y, heading] = self.three(-5.0, 5.0);
        Configuration { x, y, heading, joints: self.three(-3.5, 3.5) }
    }

    pub(crate) fn velocity(&mut self) -> Velocity<f64, 3> {
        let [forward, yaw_rate, _] = self.three(-2.0, 2.0);
        Velocity { forward, yaw_rate, joints: self.three(-2.0, 2.0) }
    }

    /// A reference within half a metre of a tip, moving.
    pub(crate) fn reference_near(&mut self, tip: Vector3<f64>) -> Reference<f64> {
        Reference {
            position: tip + Vector3::from(self.three(-0.5, 0.5)),
            velocity: Vector3::from(self.three(-1.0, 1.0)),
            acceleration: Vector3::from(self.three(-2.0, 2.0)),
        }
    }
}
