//! The robot as it really is, integrated by the classical Runge-Kutta method of order 4.

use mm_model::{ArmPosture, Configuration, Force, Mechanism, Robot, Sines, Torque, Velocity};

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

/// Sines and cosines of a state, shared by kinematics, controller and dynamics.
pub type PlantSines = Sines<f64, ArmPosture<f64>>;

/// A robot under torques and disturbances.
#[derive(Debug, Clone, PartialEq)]
pub struct Plant {
    robot: Robot<f64, 3>,
    disturbances: Disturbances,
    step: f64,
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
    pub fn sines(&self, q: &Configuration<f64, 3>) -> PlantSines {
        self.robot.sines(q)
    }

    /// Generalized force of the disturbances at time `t`.
    #[must_use]
    #[inline]
    pub fn external(&self, t: f64, sines: &PlantSines) -> Force<f64, 3> {
        self.disturbances.force((t, t), &self.robot, sines)
    }

    /// The state one step later, under a constant torque; `sines` are those of the state.
    ///
    /// Equation: the classical method of order 4 for (q, nu)' = (S(q) nu, M^-1 (B tau + f_ext - C nu - g - friction)). Since
    /// heading and joints have nu as their rate, its mean over the four stages is nu + h (a1 + a2 + a3)/6: the stages of nu need
    /// not be kept.
    #[must_use]
    #[inline]
    pub fn step(
        &self,
        t: f64,
        state: &PlantState,
        sines: &PlantSines,
        torque: &Torque<f64, 3>,
    ) -> PlantState {
        let (h, half) = (self.step, 0.5 * self.step);
        let force = self.robot.force_of(torque);
        let PlantState { q, nu, travel } = state;
        let after = |a: &Velocity<f64, 3>, dt: f64| nu.zip(*a, |nu, a| nu + dt * a);

        let a1 = self.acceleration((t, t), nu, sines, &force);
        let (nu2, at2) = (after(&a1, half), turned(sines, nu, half));
        let a2 = self.acceleration((t, t + half), &nu2, &at2, &force);
        let (nu3, at3) = (after(&a2, half), turned(sines, &nu2, half));
        let a3 = self.acceleration((t, t + half), &nu3, &at3, &force);
        let (nu4, at4) = (after(&a3, h), turned(sines, &nu3, h));
        let a4 = self.acceleration((t, t + h), &nu4, &at4, &force);

        let sixth = h / 6.0;
        let middle = a2.plus(a3);
        let moved = nu.zip(a1.plus(middle), |nu, a| h * (nu + sixth * a));
        let gained = a1.plus(a4).plus(middle.plus(middle)).scaled(sixth);
        let [v1, v2, v3, v4] = [nu.forward, nu2.forward, nu3.forward, nu4.forward];
        let [h1, h2, h3, h4] = [sines.heading, at2.heading, at3.heading, at4.heading];
        let along = |c: [f64; 4]| {
            let [c1, c2, c3, c4] = c;
            sixth * (v1 * c1 + 2.0 * (v2 * c2 + v3 * c3) + v4 * c4)
        };
        let mut joints = q.joints;
        for (joint, by) in joints.iter_mut().zip(moved.joints) {
            *joint += by;
        }
        PlantState {
            q: Configuration {
                x: q.x + along([h1.cos, h2.cos, h3.cos, h4.cos]),
                y: q.y + along([h1.sin, h2.sin, h3.sin, h4.sin]),
                heading: q.heading + moved.yaw_rate,
                joints,
            },
            nu: nu.plus(gained),
            travel: travel + moved.forward,
        }
    }

    /// Acceleration at a stage, for `(begin, t)` the beginning of the step and the time of the stage.
    #[inline(always)]
    fn acceleration(
        &self,
        times: (f64, f64),
        nu: &Velocity<f64, 3>,
        sines: &PlantSines,
        force: &Force<f64, 3>,
    ) -> Velocity<f64, 3> {
        let inertia = self.robot.inertia(&sines.posture);
        if self.disturbances.is_none() {
            self.robot.acceleration(&inertia, nu, force)
        } else {
            let external = self.disturbances.force(times, &self.robot, sines);
            self.robot.acceleration(&inertia, nu, &force.plus(external))
        }
    }
}

/// The sines after `dt` at velocity `nu`: the angles turn by little, so that theirs follow from those of the state.
#[inline(always)]
fn turned(sines: &PlantSines, nu: &Velocity<f64, 3>, dt: f64) -> PlantSines {
    Sines {
        heading: sines.heading.turned_by(dt * nu.yaw_rate),
        posture: sines.posture.turned_by(nu.joints.map(|rate| dt * rate)),
    }
}
