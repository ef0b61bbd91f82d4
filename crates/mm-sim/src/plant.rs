//! The robot as it really is, integrated by the classical Runge-Kutta method of order 4.

use mm_model::{ArmPosture, Configuration, Force, Mechanism, Robot, Sines, Torque, Velocity};

use crate::disturbance::{Disturbances, Slip};

/// State of the plant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlantState {
    /// Configuration.
    pub q: Configuration<f64, 3>,
    /// Quasi-velocities.
    pub nu: Velocity<f64, 3>,
    /// Signed length of the path that the wheels rolled, m: with the heading it gives the wheel angles.
    pub travel: f64,
    /// Part of the heading that the wheels did not make but a slip, rad.
    pub yaw_slip: f64,
}

/// A load at the tip for a while.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Payload {
    /// The robot with the load as a part of its last link.
    pub robot: Robot<f64, 3>,
    /// From this time on, s.
    pub from: f64,
    /// Up to, and without, this time, s.
    pub to: f64,
}

/// Sines and cosines of a state, shared by kinematics, controller and dynamics.
pub type PlantSines = Sines<f64, ArmPosture<f64>>;

/// A robot under torques and disturbances.
#[derive(Debug, Clone, PartialEq)]
pub struct Plant {
    robot: Robot<f64, 3>,
    disturbances: Disturbances,
    step: f64,
    payload: Option<Payload>,
}

impl Plant {
    /// The plant of a robot and its disturbances, with integration step `step` in s.
    #[must_use]
    pub const fn new(robot: Robot<f64, 3>, disturbances: Disturbances, step: f64) -> Self {
        Self { robot, disturbances, step, payload: None }
    }

    /// The same plant with a payload.
    ///
    /// The robot changes between two steps, its velocity does not: a load is taken over at the speed of the tip. Dropping is exactly
    /// so; picking up a load at rest would also cost m v of the tip's momentum, 0.6 N s for 2 kg at 0.3 m/s.
    #[must_use]
    pub const fn with_payload(mut self, payload: Payload) -> Self {
        self.payload = Some(payload);
        self
    }

    /// The robot as it really is, without a payload.
    #[must_use]
    pub const fn robot(&self) -> &Robot<f64, 3> {
        &self.robot
    }

    /// The robot as it really is in a step that begins at time `t`, with the payload that it then has.
    #[must_use]
    #[inline]
    pub fn robot_at(&self, t: f64) -> &Robot<f64, 3> {
        // Steps begin at multiples of the step, up to rounding.
        match &self.payload {
            Some(load) if t + 1e-9 >= load.from && t + 1e-9 < load.to => &load.robot,
            _ => &self.robot,
        }
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
        if self.disturbances.slips() {
            return self.step_driven(t, state, sines, &[*torque; 3]);
        }
        let force = self.robot.force_of(torque);
        self.integrate::<false>(t, state, sines, [&force; 3])
    }

    /// The state one step later, under a torque that varies: its values at the begin, in the middle and at the end of the step.
    ///
    /// The stages of the Runge-Kutta method get the torque of their time, so that the order is kept for a torque that is smooth
    /// within the step. A slip adds to the rate of the pose and not to the wheels: x' = (v + a) cos(heading) - b sin(heading),
    /// y' = (v + a) sin(heading) + b cos(heading), heading' = omega + u for a slip of a forward, b sideways (to the left) and u in yaw.
    #[must_use]
    pub fn step_driven(
        &self,
        t: f64,
        state: &PlantState,
        sines: &PlantSines,
        torques: &[Torque<f64, 3>; 3],
    ) -> PlantState {
        let [begin, middle, end] = torques.each_ref().map(|torque| self.robot.force_of(torque));
        if self.disturbances.slips() {
            self.integrate::<true>(t, state, sines, [&begin, &middle, &end])
        } else {
            self.integrate::<false>(t, state, sines, [&begin, &middle, &end])
        }
    }

    /// One step; `SLIPS` says whether the base slips, so that one that does not pays nothing for it.
    #[inline(always)]
    fn integrate<const SLIPS: bool>(
        &self,
        t: f64,
        state: &PlantState,
        sines: &PlantSines,
        [begin, middle, end]: [&Force<f64, 3>; 3],
    ) -> PlantState {
        let (h, half) = (self.step, 0.5 * self.step);
        let robot = self.robot_at(t);
        let PlantState { q, nu, .. } = state;
        let after = |a: &Velocity<f64, 3>, dt: f64| nu.zip(*a, |nu, a| nu + dt * a);
        let slip = |at: f64| if SLIPS { self.disturbances.slip((t, at)) } else { Slip::default() };
        let (slip1, slip23, slip4) = (slip(t), slip(t + half), slip(t + h));

        let a1 = self.acceleration(robot, (t, t), nu, sines, begin);
        let (nu2, at2) = (after(&a1, half), turned::<SLIPS>(sines, nu, half, &slip1));
        let a2 = self.acceleration(robot, (t, t + half), &nu2, &at2, middle);
        let (nu3, at3) = (after(&a2, half), turned::<SLIPS>(sines, &nu2, half, &slip23));
        let a3 = self.acceleration(robot, (t, t + half), &nu3, &at3, middle);
        let (nu4, at4) = (after(&a3, h), turned::<SLIPS>(sines, &nu3, h, &slip23));
        let a4 = self.acceleration(robot, (t, t + h), &nu4, &at4, end);

        let sixth = h / 6.0;
        let inner = a2.plus(a3);
        let moved = nu.zip(a1.plus(inner), |nu, a| h * (nu + sixth * a));
        let gained = a1.plus(a4).plus(inner.plus(inner)).scaled(sixth);
        let [v1, v2, v3, v4] = [nu.forward, nu2.forward, nu3.forward, nu4.forward];
        let [h1, h2, h3, h4] = [sines.heading, at2.heading, at3.heading, at4.heading];
        let along = |[v1, v2, v3, v4]: [f64; 4], [c1, c2, c3, c4]: [f64; 4]| {
            sixth * (v1 * c1 + 2.0 * (v2 * c2 + v3 * c3) + v4 * c4)
        };
        let (cos, sin) = ([h1.cos, h2.cos, h3.cos, h4.cos], [h1.sin, h2.sin, h3.sin, h4.sin]);
        let mut joints = q.joints;
        for (joint, by) in joints.iter_mut().zip(moved.joints) {
            *joint += by;
        }
        let rolled = [v1, v2, v3, v4];
        let mut next = PlantState {
            q: Configuration {
                x: q.x + along(rolled, cos),
                y: q.y + along(rolled, sin),
                heading: q.heading + moved.yaw_rate,
                joints,
            },
            nu: nu.plus(gained),
            travel: state.travel + moved.forward,
            yaw_slip: state.yaw_slip,
        };
        if SLIPS {
            let each = |part: fn(&Slip) -> f64| [part(&slip1), part(&slip23), part(&slip23), part(&slip4)];
            let (forward, sideways) = (each(|slip| slip.forward), each(|slip| slip.sideways));
            next.q.x += along(forward, cos) - along(sideways, sin);
            next.q.y += along(forward, sin) + along(sideways, cos);
            let turn = along(each(|slip| slip.yaw_rate), [1.0; 4]);
            next.q.heading += turn;
            next.yaw_slip += turn;
        }
        next
    }

    /// Acceleration of the robot at a stage, for `(begin, t)` the beginning of the step and the time of the stage.
    #[inline(always)]
    fn acceleration(
        &self,
        robot: &Robot<f64, 3>,
        times: (f64, f64),
        nu: &Velocity<f64, 3>,
        sines: &PlantSines,
        force: &Force<f64, 3>,
    ) -> Velocity<f64, 3> {
        let inertia = robot.inertia(&sines.posture);
        if self.disturbances.is_none() {
            robot.acceleration(&inertia, nu, force)
        } else {
            let external = self.disturbances.force(times, &self.robot, sines);
            robot.acceleration(&inertia, nu, &force.plus(external))
        }
    }
}

/// The sines after `dt` at velocity `nu`: the angles turn by little, so that theirs follow from those of the state.
#[inline(always)]
fn turned<const SLIPS: bool>(sines: &PlantSines, nu: &Velocity<f64, 3>, dt: f64, slip: &Slip) -> PlantSines {
    let rate = if SLIPS { nu.yaw_rate + slip.yaw_rate } else { nu.yaw_rate };
    Sines {
        heading: sines.heading.turned_by(dt * rate),
        posture: sines.posture.turned_by(nu.joints.map(|rate| dt * rate)),
    }
}
