//! The law with channels at the bounds of their rates: the others take over what these cannot do.

use mm_model::{Configuration, Real, Velocity};
use nalgebra::Vector3;

use super::correction::dot;
use super::rate_bounds::Violation;
use super::solution::Solution;
use super::{OuterLoop, OuterOutput, channels_of};

/// What has to be left of det(A) without a channel so that the others take over all that it cannot do.
const ALL: f64 = 0.3;
/// What has to be left so that they take over anything.
const NOTHING: f64 = 0.1;

/// A solution from which channels are taken out one by one.
struct Free<'a, T, const N: usize> {
    solution: &'a mut Solution<T, N>,
    /// c = A^-1 j and w/left of each channel that was taken out, in their order.
    taken: [Option<(Vector3<T>, T)>; N],
}

impl<T: Real, const N: usize> OuterLoop<T, N> {
    /// Holds channels beyond their bounds to them, the farthest first (m/s and rad/s compared as numbers), and lets the others take over as far as they can.
    ///
    /// Equation, for a channel of inverse weight w, Jacobian column j, bound b and excess e = nu_i - b:
    ///
    /// ```text
    /// A c = j,   left = 1 - w j'c = det(A - w j j') / det(A),   m = h e / left
    /// nu_k := nu_k + m w_k J_k'c,   nu_i := b,   A := A - w j j'
    /// ```
    /// which solves the problem without the channel for the tip velocity u - (1 - h) e j. Where enough is left, h = 1 and the tip gets
    /// all that it was asked for; h falls smoothly to 0 as the others lose the direction j, in which the tip then falls
    /// behind. At the bound e = 0, so that nu_c does not jump when a channel comes to it. nu_c' is the derivative of these lines.
    ///
    /// After as many channels as the robot has more than the tip has directions nobody is left to take over: the rest is cut to its
    /// bounds. A channel once held is not let go within the same update, so that the result need not be the best one where several
    /// are at their bounds.
    ///
    /// # Source
    /// F. Flacco, A. De Luca, O. Khatib, Motion control of redundant robots under joint constraints: saturation in the null
    /// space, ICRA 2012. There the task is scaled down where the joints do not suffice, here in the directions that are lost.
    /// The update of the inverse: J. Sherman, W. J. Morrison, Annals of Mathematical Statistics 21 (1950).
    #[inline(never)]
    pub(super) fn restrain(
        &self,
        solution: &mut Solution<T, N>,
        (q, nu): (&Configuration<T, N>, &Velocity<T, N>),
        output: &mut OuterOutput<T, N>,
    ) {
        let bounds = self.bounds.at(q, nu);
        let mut free = Free::all(solution);
        let (mut aside, mut held) = (0, 0);
        for _ in 1..N {
            let Some(violation) = bounds.worst(&output.nu_c, aside) else { break };
            let bit = 1 << violation.channel;
            aside |= bit;
            let taken = free.hold(&violation, (&mut output.nu_c, &mut output.dnu_c));
            held |= if matches!(taken, Taken::Nothing) { 0 } else { bit };
            output.near_singular |= !matches!(taken, Taken::All);
        }
        held |= bounds.cut(&mut output.nu_c, &mut output.dnu_c);
        output.speed_limited |= held & 1 != 0;
        output.joint_limited |= held & !1 != 0;
    }
}

impl<'a, T: Real, const N: usize> Free<'a, T, N> {
    fn all(solution: &'a mut Solution<T, N>) -> Self {
        Self { solution, taken: [None; N] }
    }

    /// Holds a channel to its bound; tells what the others take over of what it does not do.
    ///
    /// Where they can take over nothing, nothing changes.
    #[inline]
    fn hold(
        &mut self,
        violation: &Violation<T>,
        (asked, change): (&mut Velocity<T, N>, &mut Velocity<T, N>),
    ) -> Taken {
        let Violation { channel, bound, excess } = *violation;
        let Solution { jacobian, jacobian_rate, weights, base_rates, damping_rate, .. } = &*self.solution;
        let (Some(column), Some(turn)) = (jacobian.column(channel), jacobian_rate.column(channel)) else {
            return Taken::Nothing;
        };
        let of = |values: &Velocity<T, N>| values.channel(channel).unwrap_or(T::ZERO);
        let weight = of(weights);
        let weight_rate = if channel == 0 { base_rates.0 } else { T::ZERO };
        let c = self.solve(column);
        let along = dot(column, &c);
        let left = T::ONE - weight * along;
        if !(left > T::from_f64(NOTHING)) {
            return Taken::Nothing;
        }
        // Along the motion: A c' = j' - A'c, and w J'c with its rate.
        let pull = channels_of(jacobian.transpose_product(&c));
        let step = pull.zip(*weights, |p, w| p * w);
        let part = channels_of(jacobian_rate.transpose_product(&c)).zip(*weights, |p, w| p * w);
        let part = self.solution.with_base_rates(part, &pull);
        let drift = jacobian_rate.product(&step) + jacobian.product(&part) + c * *damping_rate;
        let dc = self.solve(&(turn - drift));
        let step_rate = part.plus(channels_of(jacobian.transpose_product(&dc)).zip(*weights, |p, w| p * w));
        let left_rate = -(weight * (dot(turn, &c) + dot(column, &dc)) + weight_rate * along);

        let share = Share::of(left, left_rate);
        let (m, dm) = (excess * share.value, (of(change) - bound.1) * share.value + excess * share.rate);
        *asked = asked.plus(step.scaled(m));
        *change = change.plus(step.scaled(dm)).plus(step_rate.scaled(m));
        let set = |values: &mut Velocity<T, N>, value: T| {
            if let Some(channel) = values.channel_mut(channel) {
                *channel = value;
            }
        };
        set(asked, bound.0);
        set(change, bound.1);
        set(&mut self.solution.weights, T::ZERO);
        // The yaw rate, the other channel of the base, has no bound.
        if channel == 0 {
            self.solution.base_rates.0 = T::ZERO;
        }
        if let Some(place) = self.taken.iter_mut().find(|place| place.is_none()) {
            *place = Some((c, weight / left));
        }
        if share.is_short { Taken::Part } else { Taken::All }
    }

    /// A^-1 b for the channels that are free, by the formula of Sherman and Morrison.
    #[inline]
    fn solve(&self, b: &Vector3<T>) -> Vector3<T> {
        let all = self.solution.factor.solve(b);
        self.taken.iter().flatten().fold(all, |x, (c, gain)| x + c * (*gain * dot(c, b)))
    }
}

/// What others take over of what a held channel does not do.
enum Taken {
    All,
    Part,
    /// The channel is not held.
    Nothing,
}

/// h/left, its rate, and whether h is below 1.
struct Share<T> {
    value: T,
    rate: T,
    is_short: bool,
}

impl<T: Real> Share<T> {
    /// h = r (2 - r) with r rising from 0 where nothing is left to 1 where enough is.
    #[inline]
    fn of(left: T, left_rate: T) -> Self {
        let (nothing, all) = (T::from_f64(NOTHING), T::from_f64(ALL));
        let per_left = T::ONE / left;
        if left >= all {
            return Self { value: per_left, rate: -(left_rate * per_left * per_left), is_short: false };
        }
        let slope = T::ONE / (all - nothing);
        let lack = (all - left) * slope;
        let value = (T::ONE - lack * lack) * per_left;
        let rate = (T::TWO * lack * slope - value) * left_rate * per_left;
        Self { value, rate, is_short: true }
    }
}
