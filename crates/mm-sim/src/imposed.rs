//! Imposed velocities, without a controller: the verification runs of section 3.7.
//!
//! The configuration is integrated by Runge-Kutta from the imposed quasi-velocities and compared with the motion that they make
//! exactly: straight lines and circles of the base (radius v/omega), joints that ramp.

use mm_control::Reference;
use mm_model::{Angle, Configuration, Mechanism, Real, Robot, Velocity};

use crate::digest::Digest;
use crate::metrics::{Accumulator, Tick};
use crate::monitors::Lyapunov;
use crate::plant::{Plant, PlantState};
use crate::scenario::{Loaded, ScenarioError, Segment};
use crate::simulation::{ASK_EVERY, Clock, Ending, Recorder, RunResult, Sample};

/// A motion of constant velocities, piece by piece.
#[derive(Debug, Clone)]
pub struct Imposed {
    /// The robot; nothing pushes it.
    pub plant: Plant,
    /// The clock.
    pub clock: Clock,
    start: PlantState,
    pieces: Vec<Piece>,
}

/// A stretch of constant velocity, with the configuration from which it starts.
#[derive(Debug, Clone, Copy)]
struct Piece {
    from: f64,
    to: f64,
    start: Configuration<f64, 3>,
    nu: Velocity<f64, 3>,
}

impl Piece {
    /// The configuration at time `t`, in closed form.
    fn at(&self, t: f64) -> Configuration<f64, 3> {
        let dt = t - self.from;
        let (v, omega) = (self.nu.forward, self.nu.yaw_rate);
        let half_turn = 0.5 * omega * dt;
        let heading = self.start.heading + omega * dt;
        // The chord of the arc: v dt sin(half turn)/(half turn) along the mean heading.
        let ratio = if half_turn.abs() < 1e-4 {
            1.0 - half_turn * half_turn / 6.0
        } else {
            Real::sin_cos(half_turn).0 / half_turn
        };
        let (sin, cos) = Real::sin_cos(self.start.heading + half_turn);
        let chord = v * dt * ratio;
        let mut joints = self.start.joints;
        for (joint, rate) in joints.iter_mut().zip(self.nu.joints) {
            *joint += rate * dt;
        }
        Configuration { x: self.start.x + chord * cos, y: self.start.y + chord * sin, heading, joints }
    }
}

impl Imposed {
    /// Lines up the segments of a scenario.
    ///
    /// # Errors
    /// A segment that does not end with a plant step.
    pub(crate) fn build(
        loaded: &Loaded,
        segments: &[Segment],
        (plant, clock): (Plant, Clock),
        start: PlantState,
    ) -> Result<Self, ScenarioError> {
        let step = clock.period / f64::from(clock.substeps);
        let mut pieces: Vec<Piece> = Vec::new();
        let (mut from, mut q) = (0.0, start.q);
        for (number, segment) in segments.iter().enumerate() {
            let steps = segment.until_s / step;
            if (steps - steps.round()).abs() > 1e-6 {
                return Err(loaded.problem(
                    &format!("trajectory.segment.{number}.until_s"),
                    format!("a segment ends at {} s, in the middle of a plant step", segment.until_s),
                    format!("a multiple of `plant_step_s`, {step} s"),
                ));
            }
            let nu = Velocity {
                forward: segment.forward_m_s,
                yaw_rate: segment.yaw_rate_rad_s,
                joints: segment.joint_rates_rad_s,
            };
            let piece = Piece { from, to: segment.until_s, start: q, nu };
            (from, q) = (piece.to, piece.at(piece.to));
            pieces.push(piece);
        }
        pieces.push(Piece { from, to: f64::INFINITY, start: q, nu: Velocity::zero() });
        Ok(Self { plant, clock, start, pieces })
    }

    /// The piece in force at time `t`, up to rounding of the clock.
    fn piece(&self, t: f64) -> &Piece {
        let found = self.pieces.iter().find(|piece| t + 1e-9 < piece.to);
        // The last piece has no end.
        found.unwrap_or(&self.pieces[self.pieces.len() - 1])
    }

    /// The exact motion of the tip at time `t`.
    #[must_use]
    pub fn reference(&self, t: f64) -> Reference<f64> {
        let piece = self.piece(t);
        let (q, robot) = (piece.at(t), self.plant.robot());
        Reference {
            position: robot.tip_position(&q),
            velocity: robot.jacobian(&q).product(&piece.nu),
            acceleration: robot.jacobian_bias(&q, &piece.nu),
        }
    }

    /// Runs the motion. The torque reported is the one that would hold the imposed velocity.
    ///
    /// # Errors
    /// Those of the recorder.
    pub fn run<R: Recorder>(&self, recorder: &mut R) -> Result<RunResult, R::Error> {
        let robot = self.plant.robot();
        let mut metrics = Accumulator::new(self.clock.duration(), self.clock.period);
        let mut digest = Digest::new();
        let mut state = self.start;
        let mut ending = Ending::Finished;
        let mut crossed_at = None;
        for tick in 0..self.clock.ticks {
            let t = self.clock.time(tick);
            if tick.is_multiple_of(ASK_EVERY) && !recorder.goes_on() {
                ending = Ending::Stopped { t };
                break;
            }
            state.nu = self.piece(t).nu;
            let reference = self.reference(t);
            let tip = robot.tip_position(&state.q);
            let sines = self.plant.sines(&state.q);
            let loaded = self.plant.robot_at(t);
            let torque = robot.torque_of(&loaded.inverse_dynamics(&state.q, &state.nu, &Velocity::zero()));
            let wheels = robot.wheel_rates(state.nu.forward, state.nu.yaw_rate);
            let manipulability_squared = robot.manipulability_squared(&sines.posture);
            let within_limits = robot.each_within_limits(&state.q.joints);
            if crossed_at.is_none() && within_limits != [true; 3] {
                crossed_at = Some(t);
            }
            metrics.add(&Tick {
                t,
                error: tip - reference.position,
                nu: &state.nu,
                wheels: (wheels.right, wheels.left),
                torque: &torque,
                sliding: &Velocity::zero(),
                manipulability_squared,
                saturated: false,
                within_limits,
            });
            digest.add(t, &state.q, &state.nu, &torque);
            if tick.is_multiple_of(self.clock.log_every) {
                let sample = Sample {
                    t,
                    state: &state,
                    tip,
                    reference: &reference,
                    torque: &torque,
                    external: mm_model::Force::zero(),
                    required_gain: mm_model::Force::zero(),
                    lyapunov: Lyapunov::default(),
                    manipulability_squared,
                    saturated: false,
                    output: None,
                };
                if !recorder.record(&sample)? {
                    ending = Ending::Stopped { t };
                    break;
                }
            }
            self.advance(t, &mut state);
        }
        Ok(RunResult {
            metrics: metrics.finish(None),
            monitors: None,
            supervisor: None,
            digest: digest.finish(),
            ending,
            joint_limit_crossed_at: crossed_at,
            last: state,
        })
    }

    /// The configuration over one control period: dq/dt = S(q) nu by Runge-Kutta.
    fn advance(&self, t: f64, state: &mut PlantState) {
        let step = self.clock.period / f64::from(self.clock.substeps);
        for i in 0..self.clock.substeps {
            let nu = self.piece(t + f64::from(i) * step).nu;
            let rate = |turned: f64| {
                let heading = Angle::of(state.q.heading + turned * nu.yaw_rate);
                Robot::configuration_rate(heading, &nu)
            };
            let (k1, k23, k4) = (rate(0.0), rate(0.5 * step), rate(step));
            state.q.x += step / 6.0 * (k1.x + 4.0 * k23.x + k4.x);
            state.q.y += step / 6.0 * (k1.y + 4.0 * k23.y + k4.y);
            state.q.heading += step * nu.yaw_rate;
            for (joint, rate) in state.q.joints.iter_mut().zip(nu.joints) {
                *joint += step * rate;
            }
            state.travel += step * nu.forward;
            state.nu = nu;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Piece;
    use mm_model::{Configuration, Velocity};
    use nalgebra::Vector3;

    #[test]
    fn a_circle_has_radius_v_over_omega() {
        let nu = Velocity { forward: -0.5, yaw_rate: 1.0, joints: [0.0; 3] };
        let piece = Piece { from: 0.0, to: 10.0, start: Configuration::zero(), nu };
        for i in 0..100 {
            let q = piece.at(f64::from(i) * 0.1);
            // v < 0 and omega > 0 turn about the point v/omega to the left: (0, -0.5).
            let radius = (Vector3::new(q.x, q.y, 0.0) - Vector3::new(0.0, -0.5, 0.0)).norm();
            assert!((radius - 0.5).abs() < 1e-14, "radius {radius} at step {i}");
        }
    }
}
