//! The law with the base held in part, or with channels at the bounds of their rates: the general, slower form of the ordinary one.

use mm_model::{Configuration, Mechanism, Real, Robot, Sines, SinesOf, TipJacobian, Velocity};

use nalgebra::Vector3;

use super::base_share::BaseShare;
use super::correction::TipTask;
use super::{OuterLoop, OuterOutput, channels_of};
use crate::Reference;
use crate::symmetric3::Symmetric3;

/// How far a rate has to be beyond its bound until the damping of what is left counts in full, m/s and rad/s.
///
/// Below that it sets in proportionally, so that nu_c does not jump when a channel comes to its bound.
const DAMPING_RAMP: f64 = 0.5;

/// What the law is evaluated at.
pub(super) struct Situation<'a, T, const N: usize>
where
    T: Real,
    Robot<T, N>: Mechanism<T, N>,
{
    pub(super) robot: &'a Robot<T, N>,
    pub(super) q: &'a Configuration<T, N>,
    pub(super) sines: &'a SinesOf<T, N>,
    pub(super) nu: &'a Velocity<T, N>,
    pub(super) reference: &'a Reference<T>,
}

/// J, its rate and what the tip should do.
struct Task<T, const N: usize> {
    jacobian: TipJacobian<T, N>,
    jacobian_rate: TipJacobian<T, N>,
    tip: TipTask<T>,
}

/// A value and its rate along the motion.
type Moving<T> = (T, T);

/// A channel asked for more than its bound: how much more, and the bound.
#[derive(Debug, Clone, Copy)]
struct Violation<T> {
    channel: usize,
    excess: Moving<T>,
    bound: Moving<T>,
}

/// The channels that are free to move, and what the others are held to.
struct Channels<T, const N: usize> {
    /// Share of each channel, 1 unless it is held, with its rate.
    share: Velocity<T, N>,
    share_rate: Velocity<T, N>,
    /// Null-space velocity z, the bound for a held channel, with its rate.
    z: Velocity<T, N>,
    dz: Velocity<T, N>,
}

impl<T: Real, const N: usize> OuterLoop<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Solves with the base's share, then holds the channel farthest beyond its bound to it and solves again, at most 1 + N times.
    ///
    /// Equation, S = diag(share), A = J S W^-1 J' + lambda^2 I, a held channel having share 0 and z = bound:
    ///
    /// ```text
    /// nu_c = z + S W^-1 J' y,   A y = u - J z
    /// nu_c' = z_dot + S_dot W^-1 J' y + S W^-1 (J_dot' y + J' y'),   A y' = u' - J_dot z - J z_dot - A_dot y
    /// ```
    /// The damping is that of the ordinary law with det(J S J') for the manipulability: a robot with channels held is near a
    /// singularity earlier. It blends in as a channel goes beyond its bound. A channel once held is not let go within the same
    /// update, so that the result need not be the best one where several are at their bounds.
    ///
    /// # Source
    /// F. Flacco, A. De Luca, O. Khatib, Motion control of redundant robots under joint constraints: saturation in the null
    /// space, ICRA 2012. There the task is scaled down where the joints do not suffice, here it is damped.
    #[inline(never)]
    pub(super) fn restrain(
        &self,
        situation: &Situation<'_, T, N>,
        base: BaseShare<T>,
        output: &mut OuterOutput<T, N>,
    ) {
        let Situation { robot, q, sines, nu, reference } = *situation;
        let Sines { heading, ref posture } = *sines;
        let jacobian = robot.tip_jacobian(heading, posture);
        let error_rate = jacobian.product(nu) - reference.velocity;
        let jacobian_rate = robot.tip_jacobian_rate(heading, posture, nu);
        let tip = self.params.tip_task(reference, &output.error, &error_rate);
        let task = Task { jacobian, jacobian_rate, tip };
        let null = self.params.posture_task(robot, q, posture, nu);
        let mut channels = Channels {
            share: Velocity { forward: base.value, yaw_rate: base.value, ..Velocity::splat(T::ONE) },
            share_rate: Velocity { forward: base.rate, yaw_rate: base.rate, ..Velocity::zero() },
            z: Velocity { joints: null.velocity, ..Velocity::zero() },
            dz: Velocity { joints: null.rate, ..Velocity::zero() },
        };
        let mut damping = (null.damping_squared, null.damping_squared_rate);
        let mut least = null.manipulability_squared;
        if base != BaseShare::full() {
            let det = channels.determinant(&task);
            (damping, least) = (self.damping(det), least.min(det.0));
        }
        let mut solution = self.solved(&task, &channels, damping);
        for _ in 0..=N {
            let Some(violation) = self.worst(situation, &solution, &channels) else { break };
            channels.hold(&violation);
            output.speed_limited |= violation.channel == 0;
            output.joint_limited |= violation.channel != 0;
            let det = channels.determinant(&task);
            (damping, least) = (blended(damping, self.damping(det), violation.excess), least.min(det.0));
            solution = self.solved(&task, &channels, damping);
        }
        (output.nu_c, output.dnu_c) = solution;
        output.damping_squared = damping.0;
        output.near_singular = self.is_near_singular(least);
    }

    /// nu_c and its rate for given channels and damping.
    fn solved(
        &self,
        Task { jacobian, jacobian_rate, tip }: &Task<T, N>,
        Channels { share, share_rate, z, dz }: &Channels<T, N>,
        (damping, damping_rate): Moving<T>,
    ) -> (Velocity<T, N>, Velocity<T, N>) {
        let times = |a: &Velocity<T, N>, b: Velocity<T, N>| a.zip(b, |a, b| a * b);
        let weights = times(share, self.inverse_weights);
        let weight_rates = times(share_rate, self.inverse_weights);
        let normal = jacobian
            .fold_weighted(&weights, Symmetric3::scaled_identity(damping), |sum, column, weight| {
                sum.plus_outer(column, weight)
            })
            .factor();
        let y = normal.solve(&(tip.velocity - jacobian.product(z)));
        let pull = channels_of(jacobian.transpose_product(&y));
        let x = times(&weights, pull);
        let turn = channels_of(jacobian_rate.transpose_product(&y));
        let x_turn = times(&weights, turn).plus(times(&weight_rates, pull));
        let drift = jacobian_rate.product(&x) + jacobian.product(&x_turn) + y * damping_rate;
        let dy = normal.solve(&(tip.rate - jacobian_rate.product(z) - jacobian.product(dz) - drift));
        let dx = x_turn.plus(times(&weights, channels_of(jacobian.transpose_product(&dy))));
        (x.plus(*z), dx.plus(*dz))
    }

    /// Damping and its rate for the square of a manipulability and its rate.
    fn damping(&self, (squared, rate): Moving<T>) -> Moving<T> {
        let threshold = self.params.manipulability_threshold;
        let per_threshold = T::ONE / (threshold * threshold);
        let lack = T::ONE - squared * per_threshold;
        if !(lack > T::ZERO) {
            return (T::ZERO, T::ZERO);
        }
        let most = self.params.damping_max * self.params.damping_max;
        (most * lack * lack, -(T::TWO * most * lack * rate * per_threshold))
    }

    /// The free channel that is farthest beyond its bound, if there is one.
    fn worst(
        &self,
        situation: &Situation<'_, T, N>,
        (nu_c, dnu_c): &(Velocity<T, N>, Velocity<T, N>),
        channels: &Channels<T, N>,
    ) -> Option<Violation<T>> {
        let gamma = self.params.joint_limit_rate;
        let mut worst: Option<Violation<T>> = None;
        let mut consider = |channel, (rate, change): Moving<T>, (lower, upper): (T, T), bound_rate: T| {
            let (excess, bound) = if rate > upper {
                ((rate - upper, change - bound_rate), upper)
            } else {
                ((lower - rate, bound_rate - change), lower)
            };
            if excess.0 > worst.map_or(T::ZERO, |worst| worst.excess.0) {
                worst = Some(Violation { channel, excess, bound: (bound, bound_rate) });
            }
        };
        let share = &channels.share;
        if share.forward > T::ZERO {
            let fastest = self.bounds.forward;
            consider(0, (nu_c.forward, dnu_c.forward), (-fastest, fastest), T::ZERO);
        }
        if gamma > T::ZERO {
            let limits = &situation.robot.params().limits.joints;
            let measured = situation.q.joints.iter().zip(&situation.nu.joints).zip(limits);
            let asked = nu_c.joints.iter().zip(&dnu_c.joints).zip(&share.joints);
            for (joint, (((&angle, &speed), &(lo, hi)), ((&rate, &change), &share))) in
                measured.zip(asked).enumerate()
            {
                if share > T::ZERO {
                    let bounds = (gamma * (lo - angle), gamma * (hi - angle));
                    consider(2 + joint, (rate, change), bounds, -(gamma * speed));
                }
            }
        }
        worst
    }
}

impl<T: Real, const N: usize> Channels<T, N> {
    /// Takes a channel out of what is free and holds it to its bound.
    fn hold(&mut self, violation: &Violation<T>) {
        let set = |values: &mut Velocity<T, N>, value: T| {
            if let Some(channel) = values.channel_mut(violation.channel) {
                *channel = value;
            }
        };
        set(&mut self.share, T::ZERO);
        set(&mut self.share_rate, T::ZERO);
        set(&mut self.z, violation.bound.0);
        set(&mut self.dz, violation.bound.1);
    }

    /// det(J S J') and its rate along the motion.
    fn determinant(&self, Task { jacobian, jacobian_rate, .. }: &Task<T, N>) -> Moving<T> {
        let none = Symmetric3::scaled_identity(T::ZERO);
        let added = |(matrix, rate): (Symmetric3<T>, Symmetric3<T>),
                     (column, turn): (&Vector3<T>, &Vector3<T>),
                     (share, change): Moving<T>| {
            let turned = rate.plus_both(column, turn, share);
            (matrix.plus_outer(column, share), turned.plus_outer(column, change))
        };
        let (j, turn, share, change) = (jacobian, jacobian_rate, &self.share, &self.share_rate);
        let base = added((none, none), (&j.forward, &turn.forward), (share.forward, change.forward));
        let base = added(base, (&j.yaw_rate, &turn.yaw_rate), (share.yaw_rate, change.yaw_rate));
        let joints = j.joints.iter().zip(&turn.joints).zip(share.joints.iter().zip(&change.joints));
        let sums =
            joints.fold(base, |sums, (columns, (&share, &change))| added(sums, columns, (share, change)));
        sums.0.determinant(&sums.1)
    }
}

/// From one damping to another as the excess grows.
fn blended<T: Real>(from: Moving<T>, to: Moving<T>, (excess, excess_rate): Moving<T>) -> Moving<T> {
    let ramp = T::from_f64(DAMPING_RAMP);
    if excess >= ramp {
        return to;
    }
    let (part, part_rate) = (excess / ramp, excess_rate / ramp);
    let gap = to.0 - from.0;
    (from.0 + part * gap, from.1 + part_rate * gap + part * (to.1 - from.1))
}

/// Bounds on the rates asked for, prepared so that to check them costs little.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RateBounds<T, const N: usize> {
    /// Largest forward speed, m/s.
    pub(super) forward: T,
    gamma: T,
    /// gamma times the middle of each joint's range, and gamma times half of it.
    joints: [(T, T); N],
}

impl<T: Real, const N: usize> RateBounds<T, N> {
    /// Bounds that gamma and the robot's limits make; none for a gamma of 0.
    pub(super) fn new(gamma: T, speed: T, limits: &[(T, T); N]) -> Self {
        let none = T::ONE / T::ZERO;
        let prepared = |(lo, hi): (T, T)| {
            let half = gamma * T::HALF;
            (half * (hi + lo), if gamma > T::ZERO { half * (hi - lo) } else { none })
        };
        let forward = if gamma > T::ZERO { speed } else { none };
        Self { forward, gamma, joints: limits.map(prepared) }
    }

    /// Whether a rate is beyond its bound: |gamma (middle - q) - q'| > gamma range/2.
    #[inline]
    pub(super) fn exceeded(&self, angles: &[T; N], rates: &Velocity<T, N>) -> bool {
        let mut joints = rates.joints.iter().zip(angles).zip(&self.joints);
        rates.forward.abs() > self.forward
            || joints
                .any(|((&rate, &angle), &(middle, half))| (middle - self.gamma * angle - rate).abs() > half)
    }
}
