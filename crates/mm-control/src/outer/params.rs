//! Gains of the outer loop.

use mm_model::{Mechanism, ParamError, Real, Robot, Velocity, check};
use nalgebra::Vector3;

/// Gains of the outer loop and of the sliding surface: the same for all laws of a fair comparison.
///
/// The tip's error falls roughly as 1/(K c) whatever the inner law, so that laws with different K or c are not compared.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct OuterParams<T, const N: usize> {
    /// K: decay rate of the tip's error along x, y, z, 1/s.
    #[cfg_attr(feature = "serde", serde(with = "crate::vector"))]
    pub position_gain: Vector3<T>,
    /// c: gain on the integral of nu - nu_c in the sliding variable, 1/s (4.21).
    pub sliding_gain: Velocity<T, N>,
    /// W: weight of each quasi-velocity in the pseudo-inverse; carries the units of m/s against rad/s.
    pub weights: Velocity<T, N>,
    /// Pull towards the rest posture: z = gain (q_rest - q), 1/s.
    pub posture_gain: T,
    /// Push off a joint limit: z = -+gain d^2, with d rising from 0 at the margin to 1 at the limit, rad/s.
    pub joint_limit_gain: T,
    /// Distance from a joint limit at which the push begins, rad.
    pub joint_limit_margin: T,
    /// Climb of the manipulability w below its threshold w0: z = gain (1 - w^2/w0^2)^2 grad(w^2)/w0^2, rad^2/s.
    pub manipulability_gain: T,
    /// Manipulability w0 below which damping and climb set in.
    pub manipulability_threshold: T,
    /// Largest damping: lambda^2 = max^2 (1 - w^2/w0^2)^2 below the threshold, 0 above it.
    pub damping_max: T,
    /// Largest speed |K e| that the correction of the tip's error asks for, m/s; a large number switches the limit off.
    pub correction_speed_limit: T,
    /// gamma: -gamma (q - lo) <= dq_c <= gamma (hi - q) holds for the joint rates asked for, 1/s; up to one over the control period it keeps
    /// the joints from overshooting. 0 sets no bound, on the forward speed neither.
    pub joint_limit_rate: T,
    /// Time from the first update over which the base is held and the arm alone follows, s.
    pub base_hold: T,
    /// Time over which the base's share then rises smoothly from 0 to 1, s.
    pub base_release: T,
    /// Plain minimum norm (3.62): no posture task, no damping, no bounds on rates, W = I. The arm then drifts until it is
    /// stretched.
    pub minimum_norm: bool,
}

impl<T: Real, const N: usize> Default for OuterParams<T, N> {
    /// K = 18/s up to 1 m/s, c = 20/s, W = I, posture gain 1/s, gamma = 10/s; limits, damping and climb as their fields say.
    fn default() -> Self {
        let n = T::from_f64;
        Self {
            position_gain: Vector3::repeat(n(18.0)),
            sliding_gain: Velocity::splat(n(20.0)),
            weights: Velocity::splat(T::ONE),
            posture_gain: T::ONE,
            joint_limit_gain: n(2.0),
            joint_limit_margin: n(0.1),
            manipulability_gain: n(0.01),
            manipulability_threshold: n(0.1),
            damping_max: n(0.1),
            correction_speed_limit: T::ONE,
            joint_limit_rate: n(10.0),
            base_hold: T::ZERO,
            base_release: T::ZERO,
            minimum_norm: false,
        }
    }
}

impl<T: Real, const N: usize> OuterParams<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The defaults for a robot: a small arm, whose manipulability is small everywhere, counts as near a singularity only below
    /// 22 % of what it has in its rest posture, a joint with little room is pushed off its limits in a quarter of it, and errors are
    /// corrected at half the speed up to which the model holds, which leaves the other half to the reference.
    #[must_use]
    pub fn for_robot(robot: &Robot<T, N>) -> Self {
        let rest = robot.manipulability_squared(&robot.posture(&robot.params().rest_posture));
        let own = T::from_f64(0.22) * rest.max(T::ZERO).sqrt();
        let default = Self::default();
        let usual = default.manipulability_threshold;
        let manipulability_threshold = if own > T::ZERO { own.min(usual) } else { usual };
        let quarter = T::HALF * T::HALF;
        let joint_limit_margin = robot
            .params()
            .limits
            .joints
            .iter()
            .fold(default.joint_limit_margin, |least, &(lo, hi)| least.min(quarter * (hi - lo)));
        let correction_speed_limit = T::HALF * robot.params().limits.speed;
        Self { manipulability_threshold, joint_limit_margin, correction_speed_limit, ..default }
    }
}

impl<T: Real, const N: usize> OuterParams<T, N> {
    /// Checks every gain; the fields that [`minimum_norm`](Self::minimum_norm) overrides are set to what it means.
    ///
    /// # Errors
    /// Names the first gain that is infinite, NaN or of a sign that it cannot have.
    pub fn checked(mut self) -> Result<Self, ParamError> {
        for &gain in self.position_gain.iter() {
            check::positive(gain, "position_gain_1_s")?;
        }
        for gain in self.sliding_gain.channels() {
            check::non_negative(gain, "sliding_gain_1_s")?;
        }
        for weight in self.weights.channels() {
            check::positive(weight, "weights")?;
        }
        check::non_negative(self.posture_gain, "posture_gain_1_s")?;
        check::non_negative(self.joint_limit_gain, "joint_limit_gain_rad_s")?;
        check::positive(self.joint_limit_margin, "joint_limit_margin_rad")?;
        check::non_negative(self.manipulability_gain, "manipulability_gain_rad_s")?;
        check::positive(self.manipulability_threshold, "manipulability_threshold")?;
        check::non_negative(self.damping_max, "damping_max")?;
        check::positive(self.correction_speed_limit, "correction_speed_limit_m_s")?;
        check::non_negative(self.joint_limit_rate, "joint_limit_rate_1_s")?;
        check::non_negative(self.base_hold, "base_hold_s")?;
        check::non_negative(self.base_release, "base_release_s")?;
        if self.minimum_norm {
            self.weights = Velocity::splat(T::ONE);
            self.posture_gain = T::ZERO;
            self.joint_limit_gain = T::ZERO;
            self.manipulability_gain = T::ZERO;
            self.damping_max = T::ZERO;
            self.joint_limit_rate = T::ZERO;
        }
        Ok(self)
    }
}
