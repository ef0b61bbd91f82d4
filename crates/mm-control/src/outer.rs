//! Outer loop: kinematic backstepping (4.1 to 4.13), from the tip's error to the velocity that the robot should have.

mod base_share;
mod correction;
mod held_base;
mod params;
mod posture_task;
mod rate_bounds;
mod restrained;
mod solution;

pub use params::OuterParams;

use mm_model::{Configuration, Force, Limits, Mechanism, Real, Robot, Sines, SinesOf, TipJacobian, Velocity};
use nalgebra::Vector3;

use crate::Reference;
use crate::symmetric3::Symmetric3;
use base_share::BaseHold;
use rate_bounds::RateBounds;
use solution::Solution;

/// What the outer loop asks of the inner one, and what it saw on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OuterOutput<T, const N: usize> {
    /// Virtual control nu_c: the velocity that lets the tip's error decay.
    pub nu_c: Velocity<T, N>,
    /// Its time derivative along the robot's measured motion.
    pub dnu_c: Velocity<T, N>,
    /// Tip by the controller's own kinematics, m, world.
    pub tip: Vector3<T>,
    /// Tip error, actual minus desired, m, world.
    pub error: Vector3<T>,
    /// det(J J'), the square of the manipulability.
    pub manipulability_squared: T,
    /// Square of the damping lambda; above zero only near a singularity.
    pub damping_squared: T,
    /// Whether the manipulability is below the threshold at which damping sets in, or too little of det(A) is left to the channels free
    /// to move.
    pub near_singular: bool,
    /// Whether the correction K e was cut to its largest speed, or the base held to the speed up to which the model holds.
    pub speed_limited: bool,
    /// Whether a joint's rate was held to the bound that keeps it within its limits.
    pub joint_limited: bool,
}

/// Kinematic backstepping with a weighted, damped pseudo-inverse and a posture task in its null space.
///
/// Equation, with e = p - p_d (actual minus desired), u = p_d' - K e, K e cut to a largest length:
///
/// ```text
/// nu_c = J# u + (I - J# J) z,    J# = W^-1 J' (J W^-1 J' + lambda^2 I)^-1
/// ```
/// It is evaluated as nu_c = z + W^-1 J' y with A y = u - J z, A = J W^-1 J' + lambda^2 I, so that no pseudo-inverse is formed.
/// Differentiating the same two lines along the robot's measured motion gives the derivative exactly:
///
/// ```text
/// A y' = u' - J_dot z - J z_dot - (J_dot W^-1 J' + J W^-1 J_dot' + (lambda^2)_dot I) y,   u' = p_d'' - K (J nu - p_d')
/// nu_c' = z_dot + W^-1 (J_dot' y + J' y')
/// ```
/// A one-step difference of nu_c would divide sensor noise by the period instead. `z` is the posture task: pull to the rest
/// posture, push off joint limits, climb the manipulability; see [`OuterParams`] for its terms and for lambda.
///
/// Convention: the thesis takes e = p_d - p in (4.9) and writes +K e; the law is the same. The Moore-Penrose inverse of (3.62) is
/// the special case W = I, lambda = 0, z = 0 ([`OuterParams::minimum_norm`]).
///
/// Stability (4.6 to 4.13): with J J# = I and nu = nu_c the error decays as e' = -K e; with an inner error it stays within
/// |J (nu - nu_c)| / min K.
///
/// Restraints, each of which leaves the law as it is, bit for bit, where it does not act, and keeps nu_c' exact where it does:
///
/// - **Speed of the correction.** |K e| above its largest length L is cut to it, and e' = -r K e with r = L/|K e| then. V = e'K e/2 falls
///   all the same, V' = -r |K e|^2, so that e = 0 is reached from everywhere, but only at the speed L far away instead of
///   exponentially. What is lost is the margin: an inner error d = J (nu - nu_c) gives V' = -|K e| (L - |d|) at worst, which
///   is negative only for |d| < L. A reference faster than the robot is not caught up with either.
/// - **Bounds on rates.** -gamma (q - lo) <= dq_c <= gamma (hi - q), which makes the box of joint limits invariant for nu = nu_c, and
///   |v_c| at most the speed up to which the model holds. A channel beyond its bound is held to it and the others take over, so
///   that e' = -K e still holds as long as they leave at least 0.3 of det(A) and lambda = 0. Otherwise the tip falls behind in the direction
///   that is lost, J nu_c = u - sum (1 - h_i) e_i j_i with the excess e_i and 0 <= h_i <= 1, and nothing is claimed of e but the
///   bounds themselves. nu_c does not jump when the first channel comes to its bound; where several are at theirs it may.
/// - **Base held.** The inverse weights of the base are multiplied by beta(t): 0 during the hold, when the arm alone follows, then
///   u^2 (3 - 2 u) over the release.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OuterLoop<T, const N: usize> {
    params: OuterParams<T, N>,
    inverse_weights: Velocity<T, N>,
    base_hold: BaseHold<T>,
    bounds: RateBounds<T, N>,
}

impl<T: Real, const N: usize> OuterLoop<T, N> {
    /// Whether this det(J J') is below the threshold at which damping sets in.
    #[must_use]
    #[inline]
    pub fn is_near_singular(&self, manipulability_squared: T) -> bool {
        let threshold = self.params.manipulability_threshold;
        manipulability_squared < threshold * threshold
    }
}

impl<T: Real, const N: usize> OuterLoop<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    pub(crate) fn new(params: OuterParams<T, N>, limits: &Limits<T, N>, period: T) -> Self {
        Self {
            params,
            inverse_weights: params.weights.map(|weight| T::ONE / weight),
            base_hold: BaseHold::new(&params, period),
            bounds: RateBounds::new(params.joint_limit_rate, limits.speed, &limits.joints),
        }
    }

    /// The parameters.
    #[must_use]
    pub const fn params(&self) -> &OuterParams<T, N> {
        &self.params
    }

    /// Updates over which the base is held and released; from then on the number of an update does not matter.
    #[must_use]
    #[inline]
    pub const fn held_updates(&self) -> u32 {
        self.base_hold.updates()
    }

    /// Evaluates the law at a configuration, given with its sines, with `nu` the measured velocity.
    ///
    /// `update` counts the updates since the start, from 0; it matters below [`held_updates`](Self::held_updates) only.
    #[inline(always)]
    pub fn evaluate(
        &self,
        robot: &Robot<T, N>,
        (q, sines): (&Configuration<T, N>, &SinesOf<T, N>),
        nu: &Velocity<T, N>,
        reference: &Reference<T>,
        update: u32,
    ) -> OuterOutput<T, N> {
        let Sines { heading, ref posture } = *sines;
        let position = robot.tip_offset(heading, posture) + Vector3::new(q.x, q.y, T::ZERO);
        let jacobian = robot.tip_jacobian(heading, posture);
        let rate = robot.tip_jacobian_rate(heading, posture, nu);
        let error = position - reference.position;
        let error_rate = jacobian.product(nu) - reference.velocity;
        let tip = self.params.tip_task(reference, &error, &error_rate);

        let task = self.params.posture_task(robot, q, posture, nu);
        let (z, dz) = (&task.velocity, &task.rate);
        let normal = normal_matrix(&jacobian, &self.inverse_weights, task.damping_squared);
        let factor = normal.factor();
        let y = factor.solve(&(tip.velocity - jacobian.joint_product(z)));
        let x = self.weighted(jacobian.transpose_product(&y));
        let x_turn = self.weighted(rate.transpose_product(&y));
        let drift = rate.product(&x) + jacobian.product(&x_turn) + y * task.damping_squared_rate;
        let dy = factor.solve(&(tip.rate - rate.joint_product(z) - jacobian.joint_product(dz) - drift));
        let dx = x_turn.plus(self.weighted(jacobian.transpose_product(&dy)));
        let mut output = OuterOutput {
            nu_c: with_joints_added(x, z),
            dnu_c: with_joints_added(dx, dz),
            tip: position,
            error,
            manipulability_squared: task.manipulability_squared,
            damping_squared: task.damping_squared,
            near_singular: self.is_near_singular(task.manipulability_squared),
            speed_limited: tip.limited,
            joint_limited: false,
        };
        let base_held = update < self.base_hold.updates();
        if base_held || self.bounds.exceeded(&q.joints, &output.nu_c) {
            let mut solution = Solution {
                jacobian,
                jacobian_rate: rate,
                weights: self.inverse_weights,
                base_rates: (T::ZERO, T::ZERO),
                damping_rate: task.damping_squared_rate,
                factor,
            };
            if base_held {
                self.hold_base(&mut solution, (&tip, &task), self.base_hold.share(update), &mut output);
            }
            self.restrain(&mut solution, (q, nu), &mut output);
        }
        output
    }

    /// W^-1 times a covector.
    #[inline]
    fn weighted(&self, covector: Force<T, N>) -> Velocity<T, N> {
        channels_of(covector).zip(self.inverse_weights, |a, w| a * w)
    }
}

/// A = J S W^-1 J' + lambda^2 I for inverse weights S W^-1.
#[inline]
fn normal_matrix<T: Real, const N: usize>(
    jacobian: &TipJacobian<T, N>,
    inverse_weights: &Velocity<T, N>,
    damping_squared: T,
) -> Symmetric3<T> {
    jacobian.fold_weighted(
        inverse_weights,
        Symmetric3::scaled_identity(damping_squared),
        |sum, column, weight| sum.plus_outer(column, weight),
    )
}

/// A covector read as a velocity, channel by channel.
#[inline]
fn channels_of<T: Real, const N: usize>(covector: Force<T, N>) -> Velocity<T, N> {
    let Force { forward, yaw, joints } = covector;
    Velocity { forward, yaw_rate: yaw, joints }
}

#[inline]
fn with_joints_added<T: Real, const N: usize>(mut nu: Velocity<T, N>, joints: &[T; N]) -> Velocity<T, N> {
    for (rate, &more) in nu.joints.iter_mut().zip(joints) {
        *rate += more;
    }
    nu
}
