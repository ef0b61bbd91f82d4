//! The weighted, damped least squares of the outer loop for any weights, solved together with its derivative.

use mm_model::{Real, TipJacobian, Velocity};

use super::channels_of;
use super::correction::TipTask;
use crate::symmetric3::Factor3;

/// nu_c = z + S W^-1 J' y with A y = u - J z, A = J S W^-1 J' + lambda^2 I: what it was solved with. S is the share of each channel.
pub(super) struct Solution<T, const N: usize> {
    pub(super) jacobian: TipJacobian<T, N>,
    pub(super) jacobian_rate: TipJacobian<T, N>,
    /// S W^-1, 0 for a held channel.
    pub(super) weights: Velocity<T, N>,
    /// Rates of the base's two; those of the joints are constant.
    pub(super) base_rates: (T, T),
    /// (lambda^2)'
    pub(super) damping_rate: T,
    /// A, factorized.
    pub(super) factor: Factor3<T>,
}

impl<T: Real, const N: usize> Solution<T, N> {
    /// Solves for what the tip should do and the task in the null space, (z, z'); gives nu_c and nu_c'.
    ///
    /// ```text
    /// A y' = u' - J_dot z - J z_dot - A_dot y
    /// nu_c' = z_dot + S_dot W^-1 J' y + S W^-1 (J_dot' y + J' y')
    /// ```
    pub(super) fn velocity(
        &self,
        tip: &TipTask<T>,
        (z, dz): (&Velocity<T, N>, &Velocity<T, N>),
    ) -> (Velocity<T, N>, Velocity<T, N>) {
        let Self { jacobian, jacobian_rate, weights, damping_rate, factor, .. } = self;
        let y = factor.solve(&(tip.velocity - jacobian.product(z)));
        let times = |a: Velocity<T, N>, b: &Velocity<T, N>| a.zip(*b, |a, b| a * b);
        let pull = channels_of(jacobian.transpose_product(&y));
        let x = times(pull, weights);
        let turn = channels_of(jacobian_rate.transpose_product(&y));
        let x_turn = self.with_base_rates(times(turn, weights), &pull);
        let drift =
            jacobian_rate.product(&x.plus(*z)) + jacobian.product(&x_turn.plus(*dz)) + y * *damping_rate;
        let dy = factor.solve(&(tip.rate - drift));
        let dx = x_turn.plus(times(channels_of(jacobian.transpose_product(&dy)), weights));
        (x.plus(*z), dx.plus(*dz))
    }

    /// A rate of S W^-1 times a vector, to which that of the base's weights is added.
    #[inline]
    pub(super) fn with_base_rates(
        &self,
        mut rate: Velocity<T, N>,
        vector: &Velocity<T, N>,
    ) -> Velocity<T, N> {
        rate.forward += vector.forward * self.base_rates.0;
        rate.yaw_rate += vector.yaw_rate * self.base_rates.1;
        rate
    }
}
