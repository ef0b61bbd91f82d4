//! `bfsmc-thesis`: sign plus the fuzzy system of Appendix C, as printed.

use mm_model::{Force, Real, Velocity};

use super::{Gains, RobustForce, channel_zip};
use crate::SetupError;
use crate::fuzzy::{FuzzySystem, RuleBase, THESIS};

/// The law of (4.33) and (4.41): f = -k sign(s) + k_f FIS(s / scale), with the rule base of Appendix C.
///
/// The rule base answers a positive s with a negative output, so that its term opposes s and the reaching condition of
/// [`Bsmc`](super::Bsmc) holds a fortiori. It is kept literal because it shows what it does: its output jumps from +0.889 to
/// -0.889 at s = 0 and falls off to 0.333 far away, so that near the surface it acts as a second relay and chatters more than
/// sign alone, not less. The thesis gives no scale for its input; 1 m/s and 1 rad/s are the default.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BfsmcThesis<T, const N: usize> {
    pub(super) gain: Force<T, N>,
    fuzzy_gain: Force<T, N>,
    per_scale: Velocity<T, N>,
    rules: RuleBase<T, 8, 7, 8>,
}

impl<T: Real, const N: usize> BfsmcThesis<T, N> {
    pub(super) fn try_new(gains: &Gains<T, N>) -> Result<Self, SetupError> {
        gains.check()?;
        let rules = THESIS.cast::<T>();
        rules.engine()?;
        Ok(Self {
            gain: gains.switching,
            fuzzy_gain: gains.fuzzy,
            per_scale: gains.fuzzy_scale.map(|scale| T::ONE / scale),
            rules,
        })
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> RobustForce<T, N> {
        let scaled = s.zip(self.per_scale, |s, w| s * w);
        // Checked at construction: the engine is always there.
        let fuzzy = self.rules.engine().map_or(Force::zero(), |engine| {
            channel_zip(&scaled, &self.fuzzy_gain, |x, k| k * engine.evaluate(x))
        });
        let switching = channel_zip(s, &self.gain, |s, k| -(k * s.sign()));
        RobustForce { total: switching.plus(fuzzy), fuzzy }
    }
}
