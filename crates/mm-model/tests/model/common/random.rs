//! Random robots and states from a generator of our own, so that every run draws the same ones.

use mm_model::{Configuration, Friction, Limits, Link, Real, Robot, RobotParams};

/// The robot of parameters that must be acceptable.
#[expect(clippy::expect_used, reason = "a test that cannot build its robot has failed")]
pub(crate) fn robot<T: Real>(params: RobotParams<T, 3>) -> Robot<T, 3> {
    Robot::try_new(params).expect("the ranges of the random parameters are physical")
}

/// SplitMix64 (Steele, Lea and Flood, 2014): 64 bits of state, passes BigCrush, four lines.
#[derive(Debug)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) const fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [`lo`, `hi`).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.bits() >> 11) as f64 / (1_u64 << 53) as f64)
    }

    /// A link of 0.1 to 1 m, its centre of mass anywhere along it and a little beyond, its inertias all different.
    fn link(&mut self) -> Link<f64> {
        let (length, mass) = (self.between(0.1, 1.0), self.between(0.5, 20.0));
        let scale = mass * length * length;
        Link {
            length,
            mass,
            com: length * self.between(0.0, 1.2),
            axial_inertia: scale * self.between(0.001, 0.1),
            pitch_inertia: scale * self.between(0.01, 0.2),
            normal_inertia: scale * self.between(0.01, 0.2),
        }
    }

    /// Parameters of a robot with friction everywhere; every third has its arm on the axle, every third behind it.
    pub(crate) fn params(&mut self, case: u32) -> RobotParams<f64, 3> {
        let arm_offset = match case % 3 {
            0 => 0.0,
            1 => -self.between(0.01, 0.5),
            _ => self.between(0.01, 0.5),
        };
        RobotParams {
            base_mass: self.between(5.0, 80.0),
            base_yaw_inertia: self.between(0.2, 5.0),
            base_com_offset: self.between(-0.3, 0.3),
            arm_offset,
            mount_height: self.between(-0.2, 0.8),
            wheel_radius: self.between(0.03, 0.3),
            track_width: self.between(0.15, 0.8),
            gravity: self.between(1.0, 12.0),
            links: [self.link(), self.link(), self.link()],
            rest_posture: [0.0, 1.0, -2.0],
            friction: Friction {
                wheel_viscous: self.between(0.01, 0.5),
                wheel_coulomb: self.between(0.01, 0.5),
                joint_viscous: [(); 3].map(|()| self.between(0.1, 2.0)),
                joint_coulomb: [(); 3].map(|()| self.between(0.1, 2.0)),
                smoothing: 0.1,
            },
            limits: Limits {
                joints: [(); 3].map(|()| (self.between(-4.0, -0.1), self.between(0.1, 4.0))),
                wheel_torque: 60.0,
                joint_torque: [150.0, 200.0, 150.0],
                speed: 2.0,
            },
        }
    }

    pub(crate) fn configuration(&mut self) -> Configuration<f64, 3> {
        Configuration {
            x: self.between(-5.0, 5.0),
            y: self.between(-5.0, 5.0),
            heading: self.between(-7.0, 7.0),
            joints: [(); 3].map(|()| self.between(-3.5, 3.5)),
        }
    }
}
