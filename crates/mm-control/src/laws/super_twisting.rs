//! `super-twisting`: a continuous sliding mode of second order.

use mm_model::{Force, Mechanism, ParamError, Real, Robot, Velocity};

use super::{Drive, Gains, InnerLaw, LawMemory, RobustForce, Tracking, channel_zip};

/// Super-twisting: f = equivalent - k1 sqrt(|s|) sign(s) + v, v' = -k2 sign(s), |v_i| <= limit_i.
///
/// Stability: for one channel of inertia m with M s' = f + w and |w'| <= W, s and s' reach zero in finite time if k2 > W and
/// k1^2 >= 4 m W (k2 + W)/(k2 - W) (Levant, 1993; sufficient); the force is continuous, its derivative switches. For coupled channels
/// that holds as far as the coupling can be counted into w. Sampled with period dt the band is of the order k2 dt^2/m,
/// and the torque varies by k2 dt a tick. While a torque is limited v is held.
///
/// Uses the gains `twisting` (k1), `twisting_rate` (k2) and `learning_limit`.
///
/// # Source
/// A. Levant, Sliding order and sliding accuracy in sliding mode control, International Journal of Control 58 (1993).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuperTwisting<T, const N: usize> {
    root: Force<T, N>,
    rate: Force<T, N>,
    limit: Force<T, N>,
}

impl<T: Real, const N: usize> SuperTwisting<T, N> {
    /// The law with checked gains.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(gains: &Gains<T, N>) -> Result<Self, ParamError> {
        gains.check()?;
        Ok(Self { root: gains.twisting, rate: gains.twisting_rate, limit: gains.learning_limit })
    }
}

impl<T: Real, const N: usize> InnerLaw<T, N> for SuperTwisting<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    fn drive(&self, at: &Tracking<'_, T, N>, memory: &LawMemory<T, N>) -> Drive<T, N> {
        let v = if let LawMemory::Force(v) = memory { *v } else { Force::zero() };
        let s: &Velocity<T, N> = &at.sliding;
        let root = channel_zip(s, &self.root, |s, k| -(k * s.abs().sqrt() * s.sign()));
        let turn = channel_zip(s, &self.rate, |s, k| -(k * s.sign()));
        let next = v.plus(turn.scaled(at.period)).zip(self.limit, |v, most| v.clamp_to(-most, most));
        let drive = at.switching(RobustForce { total: root.plus(v), fuzzy: Force::zero() });
        Drive { learned: Some(v.map(|v| -v)), memory: Some(LawMemory::Force(next)), ..drive }
    }
}
