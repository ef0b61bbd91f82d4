//! Braking: the torque of a stop, and where the robot is while nobody sees it.

use mm_model::{Angle, Configuration, Force, Mechanism, Real, Robot, Torque, Velocity};

/// The law of a stop.
///
/// ```text
/// f = g(q) - d_hat - D nu - K (q - q_s),   D = rate M_e,   K = rate^2/2 M_e (joints alone),   tau = B^-1 f within the limits
/// ```
/// M_e is the effective inertia 1/(M^-1)_ii at the rest posture, q_s the posture at the beginning of the stop, d_hat what the law had learned
/// of the joints' loads while it saw them, so that an arm heavier than its model does not sink. With V = nu'M nu/2 + (q - q_s)'K(q - q_s)/2 and
/// dM/dt - 2C skew, V' = -nu'D nu - nu'friction <= 0 for the nominal robot: the spring is relaxed at the beginning, so V is
/// the kinetic energy there and the arm never leaves q_s by more than that allows. The eigenvalues of M^-1 D sum to (2 + N) rate at the rest
/// posture; with rate at most 0.1 per period none reaches the 2 per period at which a held torque destabilizes.
///
/// Limits keep the sign of the power: the torques of the wheels are cut by a common factor, so that they stay a positive multiple
/// of -B^-1 D nu; a joint's torque is cut to its limits after the load, and clamp(a + b) - clamp(a) has the sign of b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Braking<T, const N: usize> {
    /// D, kg/s and kg m^2/s.
    damping: Force<T, N>,
    /// K, N m/rad.
    stiffness: [T; N],
    /// Longest step of a prediction, s, and how many of them there are at most.
    step: T,
    steps: u32,
}

impl<T: Real, const N: usize> Braking<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    pub(super) fn new(inertia: &Force<T, N>, rate: T, (period, hold_periods): (T, u32)) -> Self {
        let rate = rate.min(T::ONE / (T::from_u32(10) * period));
        Self {
            damping: inertia.scaled(rate),
            stiffness: inertia.joints.map(|inertia| T::HALF * rate * rate * inertia),
            step: period,
            steps: hold_periods.saturating_add(2),
        }
    }

    /// The torque of a stop at a configuration and velocity.
    pub(super) fn torque(
        &self,
        robot: &Robot<T, N>,
        (q, nu): (&Configuration<T, N>, &Velocity<T, N>),
        posture: &[T; N],
        learned: &[T; N],
    ) -> Torque<T, N> {
        let load = robot.gravity(&robot.inertia(&robot.posture(&q.joints)));
        let mut force =
            Velocity::zip(*nu, Velocity::from_channels(self.damping.channels()), |nu, d| -(nu * d));
        let joints = load.joints.iter().zip(*learned).zip(q.joints.iter().zip(posture)).zip(self.stiffness);
        for (force, (((load, learned), (q, posture)), stiffness)) in force.joints.iter_mut().zip(joints) {
            *force += *load - learned - stiffness * (*q - *posture);
        }
        let wanted = robot.torque_of(&Force::from_channels(force.channels()));
        limited(robot, wanted)
    }

    /// Where the robot is after a time under a generalized force, by its nominal model.
    ///
    /// The force is that of the torque and what the law had learned of the joints' loads: a load that [`torque`](Self::torque) carries,
    /// but that the prediction did not know, would seem to push the arm away, and the spring would take its share back.
    /// Semi-implicit Euler, a period at a time; beyond the few periods that a prediction is worth anything the robot is taken to stay.
    pub(super) fn predict(
        &self,
        robot: &Robot<T, N>,
        (last_q, last_nu): &mut (Configuration<T, N>, Velocity<T, N>),
        force: &Force<T, N>,
        elapsed: T,
    ) {
        let mut left = elapsed;
        for _ in 0..self.steps {
            let step = left.min(self.step);
            if !(step > T::ZERO) {
                break;
            }
            left -= step;
            let inertia = robot.inertia(&robot.posture(&last_q.joints));
            let nu = last_nu.plus(robot.acceleration(&inertia, last_nu, force).scaled(step));
            let rate = Robot::<T, N>::configuration_rate(Angle::of(last_q.heading), &nu);
            let mut q = Configuration {
                x: last_q.x + step * rate.x,
                y: last_q.y + step * rate.y,
                heading: last_q.heading + step * rate.heading,
                joints: last_q.joints,
            };
            for (joint, rate) in q.joints.iter_mut().zip(rate.joints) {
                *joint += step * rate;
            }
            if !(nu.is_finite() && q.is_finite()) {
                break;
            }
            (*last_q, *last_nu) = (q, nu);
        }
    }
}

/// A torque within the limits, whatever it was: the wheels cut by a common factor, zero for what is not a number.
pub(super) fn limited<T: Real, const N: usize>(robot: &Robot<T, N>, torque: Torque<T, N>) -> Torque<T, N> {
    let most = robot.params().limits.wheel_torque;
    let largest = torque.right.abs().max(torque.left.abs());
    let cut = if largest > most { most / largest } else { T::ONE };
    let scaled = Torque { right: torque.right * cut, left: torque.left * cut, ..torque };
    let finite = |torque: T| if torque >= T::ZERO || torque < T::ZERO { torque } else { T::ZERO };
    robot.limit_torque(&scaled.map(finite)).0
}
