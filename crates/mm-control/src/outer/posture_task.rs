//! The task in the null space, z, and the damping near a singularity, both with their rates.

use mm_model::{Configuration, Mechanism, Real, Robot, Velocity};

use super::OuterParams;

/// Joint velocity wanted where the tip leaves the arm free, the damping, and their rates along the motion.
pub(super) struct PostureTask<T, const N: usize> {
    pub(super) velocity: [T; N],
    pub(super) rate: [T; N],
    pub(super) manipulability_squared: T,
    pub(super) damping_squared: T,
    pub(super) damping_squared_rate: T,
}

impl<T: Real, const N: usize> OuterParams<T, N> {
    #[inline]
    pub(super) fn posture_task(
        &self,
        robot: &Robot<T, N>,
        q: &Configuration<T, N>,
        posture: &<Robot<T, N> as Mechanism<T, N>>::Posture,
        nu: &Velocity<T, N>,
    ) -> PostureTask<T, N>
    where
        Robot<T, N>: Mechanism<T, N>,
    {
        let mut velocity = [T::ZERO; N];
        let mut rate = [T::ZERO; N];
        let joints = q.joints.iter().zip(&nu.joints);
        let targets = robot.params().rest_posture.iter().zip(&robot.params().limits.joints);
        for (((z, dz), (&angle, &dq)), (&rest, &limits)) in
            velocity.iter_mut().zip(&mut rate).zip(joints).zip(targets)
        {
            let (push, push_rate) = self.push_off_limits(angle, dq, limits);
            *z = self.posture_gain * (rest - angle) + push;
            *dz = push_rate - self.posture_gain * dq;
        }
        let mut task = PostureTask {
            velocity,
            rate,
            manipulability_squared: robot.manipulability_squared(posture),
            damping_squared: T::ZERO,
            damping_squared_rate: T::ZERO,
        };
        let threshold_squared = self.manipulability_threshold * self.manipulability_threshold;
        if task.manipulability_squared < threshold_squared {
            self.near_singularity(robot, posture, nu, &mut task);
        }
        task
    }

    /// Push off the joint limits: -+gain d^2 within the margin, zero elsewhere, with its rate.
    #[inline]
    fn push_off_limits(&self, angle: T, dq: T, (lo, hi): (T, T)) -> (T, T) {
        let margin = self.joint_limit_margin;
        let depth = (angle - (hi - margin)).max((lo + margin) - angle);
        if !(depth > T::ZERO) {
            return (T::ZERO, T::ZERO);
        }
        let side = if angle > (lo + hi) * T::HALF { -T::ONE } else { T::ONE };
        let d = depth / margin;
        let push = side * self.joint_limit_gain * d;
        (push * d, -(T::TWO * self.joint_limit_gain * d * dq) / margin)
    }

    /// Damping and climb of the manipulability, below the threshold.
    #[inline(never)]
    fn near_singularity(
        &self,
        robot: &Robot<T, N>,
        posture: &<Robot<T, N> as Mechanism<T, N>>::Posture,
        nu: &Velocity<T, N>,
        task: &mut PostureTask<T, N>,
    ) where
        Robot<T, N>: Mechanism<T, N>,
    {
        let per_threshold = T::ONE / (self.manipulability_threshold * self.manipulability_threshold);
        let slope = robot.manipulability_slope(posture, &nu.joints);
        let along = slope.gradient.iter().zip(&nu.joints).fold(T::ZERO, |sum, (&g, &dq)| sum + g * dq);
        let lack = T::ONE - task.manipulability_squared * per_threshold;
        let lack_rate = -(along * per_threshold);
        let (level, level_rate) = (lack * lack, T::TWO * lack * lack_rate);
        let most = self.damping_max * self.damping_max;
        task.damping_squared = most * level;
        task.damping_squared_rate = most * level_rate;
        let gain = self.manipulability_gain * per_threshold;
        let gradients = slope.gradient.iter().zip(&slope.rate);
        for ((z, dz), (&g, &dg)) in task.velocity.iter_mut().zip(&mut task.rate).zip(gradients) {
            *z += gain * level * g;
            *dz += gain * (level_rate * g + level * dg);
        }
    }
}
