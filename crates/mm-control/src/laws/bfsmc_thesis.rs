//! `bfsmc-thesis`: sign plus the fuzzy system of Appendix C, as printed.

use mm_model::{Force, Mechanism, Real, Robot, RobotParams, Velocity};

use super::fuzzy_term::opposes;
use super::{FuzzyTerm, Gains, InnerLaw, RobustForce, SwitchingTerm, channel_zip};
use crate::SetupError;
use crate::fuzzy::Bundled;

/// Readings of the printed equations that contradict its proof, to see what they do. None by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Misprints {
    /// The error of (4.17), desired minus actual, in (4.30) and in the fuzzy system's input as printed: the switching force then aids s.
    pub sign: bool,
    /// The forces of (4.31) and (4.41) as torques: s_v drives the right wheel, s_omega the left one.
    pub channels: bool,
}

/// The law of (4.33) and (4.41): f = -k sign(s) + k_f FIS(s / scale), with the rule base of Appendix C.
///
/// The rule base answers a positive s with a negative output, so that its term opposes s and the reaching condition of
/// [`Bsmc`](super::Bsmc) holds a fortiori. It is kept literal because it shows what it does: its output jumps from +0.889 to
/// -0.889 at s = 0 and falls off to 0.333 far away, so that near the surface it acts as a second relay and chatters more than
/// sign alone, not less. The thesis gives no scale for its input; 1 m/s and 1 rad/s are the default.
///
/// [`Misprints`] puts back what the derivation here corrects; with them no reaching condition holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BfsmcThesis<T: 'static, const N: usize, F = FuzzyTerm<T>> {
    gain: Force<T, N>,
    fuzzy_gain: Force<T, N>,
    per_scale: Velocity<T, N>,
    term: F,
    opposes: bool,
    misprints: Misprints,
    /// 1/r and l/r, half the track over the wheel's radius: forces of torques at the wheels.
    wheels: (T, T),
}

impl<T: Real, const N: usize> BfsmcThesis<T, N> {
    /// The law with the rules of Appendix C.
    ///
    /// # Errors
    /// The first gain that does not work, by name.
    pub fn try_new(robot: &RobotParams<T, N>, gains: &Gains<T, N>) -> Result<Self, SetupError>
    where
        T: Bundled,
    {
        Self::with_term(robot, gains, FuzzyTerm::thesis()?)
    }
}

impl<T: Real, const N: usize, F: SwitchingTerm<T>> BfsmcThesis<T, N, F> {
    /// The law with a fuzzy system of the user's own instead of Appendix C.
    ///
    /// # Errors
    /// A gain.
    pub fn with_term(robot: &RobotParams<T, N>, gains: &Gains<T, N>, term: F) -> Result<Self, SetupError> {
        gains.check()?;
        let per_radius = T::ONE / robot.wheel_radius;
        Ok(Self {
            gain: gains.switching,
            fuzzy_gain: gains.fuzzy,
            per_scale: gains.fuzzy_scale.map(|scale| T::ONE / scale),
            opposes: opposes(&term),
            term,
            misprints: gains.misprints,
            wheels: (per_radius, T::HALF * robot.track_width * per_radius),
        })
    }

    /// Largest force that surely opposes s; none where a misprint turns or diverts it, or the fuzzy system aids s somewhere.
    pub(super) fn authority(&self) -> Option<Force<T, N>> {
        (self.opposes && self.misprints == Misprints::default()).then_some(self.gain)
    }

    #[inline]
    pub(super) fn force(&self, s: &Velocity<T, N>) -> RobustForce<T, N> {
        let scaled = s.zip(self.per_scale, |s, w| s * w);
        let fuzzy = self.term.force(&scaled, &self.fuzzy_gain);
        let switching = channel_zip(s, &self.gain, |s, k| -(k * s.sign()));
        RobustForce { total: self.misprinted(switching.plus(fuzzy)), fuzzy: self.misprinted(fuzzy) }
    }

    fn misprinted(&self, force: Force<T, N>) -> Force<T, N> {
        let Misprints { sign, channels } = self.misprints;
        let Force { forward: right, yaw: left, joints } = if sign { force.map(|f| -f) } else { force };
        if !channels {
            return Force { forward: right, yaw: left, joints };
        }
        let (per_radius, lever) = self.wheels;
        Force { forward: per_radius * (right + left), yaw: lever * (right - left), joints }
    }
}

impl<T: Real, const N: usize, F: SwitchingTerm<T>> InnerLaw<T, N> for BfsmcThesis<T, N, F>
where
    Robot<T, N>: Mechanism<T, N>,
{
    #[inline(always)]
    fn switching_force(&self, s: &Velocity<T, N>) -> Option<RobustForce<T, N>> {
        Some(self.force(s))
    }
}
