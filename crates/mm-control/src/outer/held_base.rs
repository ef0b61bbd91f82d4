//! The law with the base held in part: other weights, and the damping of what is left.

use mm_model::{Real, TipJacobian, Velocity};
use nalgebra::Vector3;

use super::base_share::BaseShare;
use super::correction::TipTask;
use super::posture_task::PostureTask;
use super::solution::Solution;
use super::{OuterLoop, OuterOutput, normal_matrix};
use crate::symmetric3::Symmetric3;

impl<T: Real, const N: usize> OuterLoop<T, N> {
    /// Solves anew with the share beta of the base.
    ///
    /// The damping is that of the ordinary law with det(J S J') for the manipulability, S being the shares: an arm alone is near a
    /// singularity earlier.
    #[inline(never)]
    pub(super) fn hold_base(
        &self,
        solution: &mut Solution<T, N>,
        (tip, null): (&TipTask<T>, &PostureTask<T, N>),
        base: BaseShare<T>,
        output: &mut OuterOutput<T, N>,
    ) {
        let share = Velocity { forward: base.value, yaw_rate: base.value, ..Velocity::splat(T::ONE) };
        let share_rate = Velocity { forward: base.rate, yaw_rate: base.rate, ..Velocity::zero() };
        let (jacobian, jacobian_rate) = (&solution.jacobian, &solution.jacobian_rate);
        let (squared, rate) = determinant((jacobian, jacobian_rate), (&share, &share_rate));
        let (damping, damping_rate) = self.damping(squared, rate);
        solution.weights = share.zip(self.inverse_weights, |a, b| a * b);
        solution.base_rates =
            (base.rate * self.inverse_weights.forward, base.rate * self.inverse_weights.yaw_rate);
        solution.damping_rate = damping_rate;
        solution.factor = normal_matrix(jacobian, &solution.weights, damping).factor();
        let wide = |joints: [T; N]| Velocity { joints, ..Velocity::zero() };
        (output.nu_c, output.dnu_c) = solution.velocity(tip, (&wide(null.velocity), &wide(null.rate)));
        output.damping_squared = damping;
        output.near_singular |= self.is_near_singular(squared);
    }

    /// Damping and its rate for the square of a manipulability and its rate.
    fn damping(&self, squared: T, rate: T) -> (T, T) {
        let threshold = self.params.manipulability_threshold;
        let per_threshold = T::ONE / (threshold * threshold);
        let lack = T::ONE - squared * per_threshold;
        if !(lack > T::ZERO) {
            return (T::ZERO, T::ZERO);
        }
        let most = self.params.damping_max * self.params.damping_max;
        (most * lack * lack, -(T::TWO * most * lack * rate * per_threshold))
    }
}

/// det(J S J') and its rate along the motion.
fn determinant<T: Real, const N: usize>(
    (j, turn): (&TipJacobian<T, N>, &TipJacobian<T, N>),
    (share, change): (&Velocity<T, N>, &Velocity<T, N>),
) -> (T, T) {
    let none = Symmetric3::scaled_identity(T::ZERO);
    let added = |(matrix, rate): (Symmetric3<T>, Symmetric3<T>),
                 (column, turn): (&Vector3<T>, &Vector3<T>),
                 (share, change): (T, T)| {
        let turned = rate.plus_both(column, turn, share);
        (matrix.plus_outer(column, share), turned.plus_outer(column, change))
    };
    let columns = j.columns().zip(turn.columns()).zip(share.channels().zip(change.channels()));
    let sums = columns.fold((none, none), |sums, (columns, shares)| added(sums, columns, shares));
    sums.0.determinant(&sums.1)
}
