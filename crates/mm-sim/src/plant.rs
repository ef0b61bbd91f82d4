//! The robot as it really is, integrated by the classical Runge-Kutta method of order 4.

use mm_model::{Angle, ArmPosture, Configuration, Force, Mechanism, Robot, Torque, Velocity};

use crate::disturbance::Disturbances;

/// State of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantState {
    /// Configuration.
    pub q: Configuration<f64, 3>,
    /// Quasi-velocities.
    pub nu: Velocity<f64, 3>,
    /// Signed length of the path of the axle's midpoint, m: with the heading it gives the wheel angles.
    pub travel: f64,
}

/// Sines and cosines of a state: everything transcendental in it, shared by kinematics and dynamics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sines {
    /// Of the heading.
    pub heading: Angle<f64>,
    /// Of the joints.
    pub posture: ArmPosture<f64>,
}

/// A robot under torques and disturbances.
#[derive(Debug, Clone, PartialEq)]
pub struct Plant {
    robot: Robot<f64, 3>,
    disturbances: Disturbances,
    step: f64,
}

/// Derivative of the state.
#[derive(Debug, Clone, Copy)]
struct Slope {
    x: f64,
    y: f64,
    nu: Velocity<f64, 3>,
    a: Velocity<f64, 3>,
}

impl Plant {
    /// The plant of a robot and its disturbances, with integration step `step` in s.
    #[must_use]
    pub const fn new(robot: Robot<f64, 3>, disturbances: Disturbances, step: f64) -> Self {
        Self { robot, disturbances, step }
    }

    /// The robot as it really is.
    #[must_use]
    pub const fn robot(&self) -> &Robot<f64, 3> {
        &self.robot
    }

    /// What disturbs it.
    #[must_use]
    pub const fn disturbances(&self) -> &Disturbances {
        &self.disturbances
    }

    /// Sines and cosines of a configuration.
    #[must_use]
    #[inline]
    pub fn sines(&self, q: &Configuration<f64, 3>) -> Sines {
        Sines { heading: Angle::of(q.heading), posture: self.robot.posture(&q.joints) }
    }

    /// Generalized force of the disturbances at time `t`.
    #[must_use]
    #[inline]
    pub fn external(&self, t: f64, sines: &Sines) -> Force<f64, 3> {
        self.disturbances.force((t, t), &self.robot, sines)
    }

    /// The state one step later, under a constant torque; `sines` are those of the state.
    ///
    /// Equation: the classical method of order 4 for (q, nu)' = (S(q) nu, M^-1 (B tau + f_ext - C nu - g - friction)).
    #[must_use]
    #[inline]
    pub fn step(&self, t: f64, state: &PlantState, sines: &Sines, torque: &Torque<f64, 3>) -> PlantState {
        let (h, half) = (self.step, 0.5 * self.step);
        let force = self.robot.force_of(torque);
        let k1 = self.slope((t, t), &state.nu, sines, &force);
        let k2 = self.slope_after(t, half, (state, sines), &k1, &force);
        let k3 = self.slope_after(t, half, (state, sines), &k2, &force);
        let k4 = self.slope_after(t, h, (state, sines), &k3, &force);
        let sixth = h / 6.0;
        let mean = |a: f64, b: f64, c: f64, d: f64| sixth * (a + 2.0 * (b + c) + d);
        let mean_of = |f: fn(&Slope) -> Velocity<f64, 3>| {
            let middle = f(&k2).plus(f(&k3));
            f(&k1).plus(f(&k4)).plus(middle.plus(middle)).scaled(sixth)
        };
        let moved = mean_of(|k| k.nu);
        let q = &state.q;
        let mut joints = q.joints;
        for (joint, by) in joints.iter_mut().zip(moved.joints) {
            *joint += by;
        }
        PlantState {
            q: Configuration {
                x: q.x + mean(k1.x, k2.x, k3.x, k4.x),
                y: q.y + mean(k1.y, k2.y, k3.y, k4.y),
                heading: q.heading + moved.yaw_rate,
                joints,
            },
            nu: state.nu.plus(mean_of(|k| k.a)),
            travel: state.travel + moved.forward,
        }
    }

    #[inline(always)]
    fn slope(&self, times: (f64, f64), nu: &Velocity<f64, 3>, sines: &Sines, force: &Force<f64, 3>) -> Slope {
        let inertia = self.robot.inertia(&sines.posture);
        let a = if self.disturbances.is_none() {
            self.robot.acceleration(&inertia, nu, force)
        } else {
            self.robot.acceleration(
                &inertia,
                nu,
                &force.plus(self.disturbances.force(times, &self.robot, sines)),
            )
        };
        Slope { x: nu.forward * sines.heading.cos, y: nu.forward * sines.heading.sin, nu: *nu, a }
    }

    /// The slope where the slope `k` leads in `dt`. Nothing depends on x and y, so that they stay where they are; the angles
    /// turn by little, so that their sines follow from those of the state.
    #[inline(always)]
    fn slope_after(
        &self,
        t: f64,
        dt: f64,
        (state, sines): (&PlantState, &Sines),
        k: &Slope,
        force: &Force<f64, 3>,
    ) -> Slope {
        let sines = Sines {
            heading: sines.heading.turned_by(dt * k.nu.yaw_rate),
            posture: sines.posture.turned_by(k.nu.joints.map(|rate| dt * rate)),
        };
        self.slope((t, t + dt), &state.nu.zip(k.a, |nu, a| nu + dt * a), &sines, force)
    }
}
