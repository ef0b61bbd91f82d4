//! Bounds on the rates asked for, prepared so that to check them costs little.

use mm_model::{Configuration, Real, Velocity};

/// -gamma (q - lo) <= dq_c <= gamma (hi - q) for each joint, |v_c| at most the largest forward speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct RateBounds<T, const N: usize> {
    /// Largest forward speed, m/s.
    forward: T,
    gamma: T,
    /// gamma times the middle of each joint's range, and gamma times half of it.
    joints: [(T, T); N],
}

/// The bounds in a configuration, and how they move with the measured velocity.
pub(super) struct RateBox<'a, T, const N: usize> {
    bounds: &'a RateBounds<T, N>,
    q: &'a Configuration<T, N>,
    nu: &'a Velocity<T, N>,
}

/// A channel asked for more than its bound.
pub(super) struct Violation<T> {
    pub(super) channel: usize,
    /// The bound, and its rate along the motion.
    pub(super) bound: (T, T),
    /// What was asked for beyond it, with its sign.
    pub(super) excess: T,
}

impl<T: Real, const N: usize> RateBounds<T, N> {
    /// Bounds that gamma and the robot's limits make; none for a gamma of 0.
    pub(super) fn new(gamma: T, speed: T, limits: &[(T, T); N]) -> Self {
        let prepared = |(lo, hi): (T, T)| {
            let half = gamma * T::HALF;
            (half * (hi + lo), if gamma > T::ZERO { half * (hi - lo) } else { none() })
        };
        let forward = if gamma > T::ZERO { speed } else { none() };
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

    /// The bounds in a configuration, and how they move with the measured velocity.
    #[inline]
    pub(super) fn at<'a>(&'a self, q: &'a Configuration<T, N>, nu: &'a Velocity<T, N>) -> RateBox<'a, T, N> {
        RateBox { bounds: self, q, nu }
    }
}

impl<T: Real, const N: usize> RateBox<'_, T, N> {
    /// The channel farthest beyond its bound, if there is one; those of `aside`, one bit each, are left out.
    #[inline]
    pub(super) fn worst(&self, asked: &Velocity<T, N>, aside: u32) -> Option<Violation<T>> {
        let candidates = (0..2 + N).filter(|channel| aside & (1 << channel) == 0);
        candidates.filter_map(|channel| self.violation(channel, asked)).fold(None, |worst, other| match worst
        {
            Some(Violation { excess, .. }) if !(other.excess.abs() > excess.abs()) => worst,
            _ => Some(other),
        })
    }

    /// Cuts what is beyond its bound, and its rate to that of the bound; tells which channels, one bit each.
    pub(super) fn cut(&self, asked: &mut Velocity<T, N>, change: &mut Velocity<T, N>) -> u32 {
        let mut cut = 0;
        for channel in 0..2 + N {
            let Some(Violation { bound, .. }) = self.violation(channel, asked) else { continue };
            if let (Some(rate), Some(change)) = (asked.channel_mut(channel), change.channel_mut(channel)) {
                (*rate, *change) = bound;
                cut |= 1 << channel;
            }
        }
        cut
    }

    /// Whether and how far a channel is beyond its bound.
    #[inline]
    fn violation(&self, channel: usize, asked: &Velocity<T, N>) -> Option<Violation<T>> {
        let RateBounds { forward, gamma, ref joints } = *self.bounds;
        let (middle, half, rate) = match channel {
            0 => (T::ZERO, forward, T::ZERO),
            1 => return None,
            _ => {
                let &(middle, half) = joints.get(channel - 2)?;
                let (angle, speed) = (*self.q.joints.get(channel - 2)?, *self.nu.joints.get(channel - 2)?);
                (middle - gamma * angle, half, -(gamma * speed))
            }
        };
        let off = asked.channel(channel)? - middle;
        let beyond = off.abs() - half;
        if !(beyond > T::ZERO) {
            return None;
        }
        let (bound, excess) = if off > T::ZERO { (middle + half, beyond) } else { (middle - half, -beyond) };
        Some(Violation { channel, bound: (bound, rate), excess })
    }
}

/// A bound that nothing reaches.
fn none<T: Real>() -> T {
    T::ONE / T::ZERO
}
