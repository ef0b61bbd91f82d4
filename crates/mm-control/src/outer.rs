//! Outer loop: kinematic backstepping (4.1 to 4.13), from the tip's error to the velocity that the robot should have.

mod params;
mod posture_task;

pub use params::OuterParams;

use mm_model::{Configuration, Force, Mechanism, Real, Robot, Sines, SinesOf, TipJacobian, Velocity};
use nalgebra::Vector3;

use crate::Reference;
use crate::symmetric3::Symmetric3;

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
}

/// Kinematic backstepping with a weighted, damped pseudo-inverse and a posture task in its null space.
///
/// Equation, with e = p - p_d (actual minus desired), u = p_d' - K e:
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OuterLoop<T, const N: usize> {
    params: OuterParams<T, N>,
    inverse_weights: Velocity<T, N>,
}

impl<T: Real, const N: usize> OuterLoop<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    pub(crate) fn new(params: OuterParams<T, N>) -> Self {
        Self { params, inverse_weights: params.weights.map(|weight| T::ONE / weight) }
    }

    /// The parameters.
    #[must_use]
    pub const fn params(&self) -> &OuterParams<T, N> {
        &self.params
    }

    /// Whether this det(J J') is below the threshold at which damping sets in.
    #[must_use]
    #[inline]
    pub fn is_near_singular(&self, manipulability_squared: T) -> bool {
        let threshold = self.params.manipulability_threshold;
        manipulability_squared < threshold * threshold
    }

    /// Evaluates the law at a configuration, given with its sines, with `nu` the measured velocity.
    #[inline]
    pub fn evaluate(
        &self,
        robot: &Robot<T, N>,
        (q, sines): (&Configuration<T, N>, &SinesOf<T, N>),
        nu: &Velocity<T, N>,
        reference: &Reference<T>,
    ) -> OuterOutput<T, N> {
        let Sines { heading, ref posture } = *sines;
        let tip = robot.tip_offset(heading, posture) + Vector3::new(q.x, q.y, T::ZERO);
        let jacobian = robot.tip_jacobian(heading, posture);
        let rate = robot.tip_jacobian_rate(heading, posture, nu);
        let gain = &self.params.position_gain;
        let error = tip - reference.position;
        let error_rate = jacobian.product(nu) - reference.velocity;
        let u = reference.velocity - gain.component_mul(&error);
        let du = reference.acceleration - gain.component_mul(&error_rate);

        let task = self.params.posture_task(robot, q, posture, nu);
        let (z, dz) = (&task.velocity, &task.rate);
        let normal = self.normal_matrix(&jacobian, task.damping_squared).factor();
        let y = normal.solve(&(u - jacobian.joint_product(z)));
        let x = self.weighted(jacobian.transpose_product(&y));
        let x_turn = self.weighted(rate.transpose_product(&y));
        let drift = rate.product(&x) + jacobian.product(&x_turn) + y * task.damping_squared_rate;
        let dy = normal.solve(&(du - rate.joint_product(z) - jacobian.joint_product(dz) - drift));
        let dx = x_turn.plus(self.weighted(jacobian.transpose_product(&dy)));
        OuterOutput {
            nu_c: with_joints_added(x, z),
            dnu_c: with_joints_added(dx, dz),
            tip,
            error,
            manipulability_squared: task.manipulability_squared,
            damping_squared: task.damping_squared,
        }
    }

    /// W^-1 times a covector.
    #[inline]
    fn weighted(&self, covector: Force<T, N>) -> Velocity<T, N> {
        let Force { forward, yaw, joints } = covector;
        Velocity { forward, yaw_rate: yaw, joints }.zip(self.inverse_weights, |a, w| a * w)
    }

    /// A = J W^-1 J' + lambda^2 I.
    #[inline]
    fn normal_matrix(&self, jacobian: &TipJacobian<T, N>, damping_squared: T) -> Symmetric3<T> {
        jacobian
            .columns()
            .zip(self.inverse_weights.channels())
            .fold(Symmetric3::scaled_identity(damping_squared), |sum, (column, weight)| {
                sum.plus_outer(column, weight)
            })
    }
}

#[inline]
fn with_joints_added<T: Real, const N: usize>(mut nu: Velocity<T, N>, joints: &[T; N]) -> Velocity<T, N> {
    for (rate, &more) in nu.joints.iter_mut().zip(joints) {
        *rate += more;
    }
    nu
}
