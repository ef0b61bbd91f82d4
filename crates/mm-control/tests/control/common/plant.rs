//! A plant for closed loops in the tests: the robot's equations of motion, integrated by RK4 under a held torque.

use mm_model::{Angle, Configuration, Force, Robot, Torque, Velocity};

/// A robot in motion.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plant {
    pub(crate) robot: Robot<f64, 3>,
    pub(crate) q: Configuration<f64, 3>,
    pub(crate) nu: Velocity<f64, 3>,
    pub(crate) time: f64,
}

impl Plant {
    /// One step under a held torque and an external generalized force of time.
    pub(crate) fn step(&mut self, torque: &Torque<f64, 3>, external: impl Fn(f64) -> Force<f64, 3>, dt: f64) {
        let slope = |q: &Configuration<f64, 3>, nu: &Velocity<f64, 3>, t: f64| {
            let rate = Robot::<f64, 3>::configuration_rate(Angle::of(q.heading), nu);
            (rate, self.robot.forward_dynamics(q, nu, torque, &external(t)))
        };
        let (q, nu, t) = (self.q, self.nu, self.time);
        let k1 = slope(&q, &nu, t);
        let k2 = slope(&moved(q, &k1.0, 0.5 * dt), &nu.plus(k1.1.scaled(0.5 * dt)), t + 0.5 * dt);
        let k3 = slope(&moved(q, &k2.0, 0.5 * dt), &nu.plus(k2.1.scaled(0.5 * dt)), t + 0.5 * dt);
        let k4 = slope(&moved(q, &k3.0, dt), &nu.plus(k3.1.scaled(dt)), t + dt);
        for (k, weight) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            self.q = moved(self.q, &k.0, weight * dt / 6.0);
            self.nu = self.nu.plus(k.1.scaled(weight * dt / 6.0));
        }
        self.time += dt;
    }
}

fn moved(q: Configuration<f64, 3>, rate: &Configuration<f64, 3>, dt: f64) -> Configuration<f64, 3> {
    let mut joints = q.joints;
    for (joint, rate) in joints.iter_mut().zip(rate.joints) {
        *joint += rate * dt;
    }
    Configuration {
        x: q.x + rate.x * dt,
        y: q.y + rate.y * dt,
        heading: q.heading + rate.heading * dt,
        joints,
    }
}
