//! The gains of all laws, with defaults that follow the robot.

use super::Misprints;
use mm_model::{Force, Mechanism, ParamError, Real, Robot, Torque, Velocity, check};

/// Inertia that each channel feels while all others are free, 1/(M^-1)_ii, at the rest posture.
///
/// A gain of `bandwidth` times it closes a channel with that bandwidth, whatever the robot weighs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EffectiveInertia<T, const N: usize>(pub Force<T, N>);

impl<T: Real, const N: usize> EffectiveInertia<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// The effective inertia of a robot at its rest posture.
    #[must_use]
    pub fn of(robot: &Robot<T, N>) -> Self {
        let inertia = robot.inertia(&robot.posture(&robot.params().rest_posture));
        let channel = |i: usize| {
            let unit = (0..2 + N).map(|j| if i == j { T::ONE } else { T::ZERO });
            let response = robot.solve(&inertia, &Force::from_channels(unit));
            response.channels().nth(i).map_or(T::ONE, |rate| T::ONE / rate)
        };
        Self(Force::from_channels((0..2 + N).map(channel)))
    }
}

/// Gains of the inner laws, by generalized channel: forward, yaw, joints. A law takes the ones that it knows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct Gains<T, const N: usize> {
    /// k: switching gain of (4.30), N and N m.
    pub switching: Force<T, N>,
    /// Half-width of the boundary layer of `bsmc-sat`, m/s and rad/s.
    pub boundary_layer: Velocity<T, N>,
    /// k_f: force at an output of 1 of the fuzzy system, N and N m.
    pub fuzzy: Force<T, N>,
    /// Sliding variable that enters the fuzzy system as 1, m/s and rad/s.
    pub fuzzy_scale: Velocity<T, N>,
    /// L: bandwidth of the learned disturbance, 1/s; 0 switches learning off.
    pub observer_bandwidth: T,
    /// Largest learned disturbance, N and N m.
    pub learning_limit: Force<T, N>,
    /// eta: margin asked of the reaching condition (4.44), N and N m.
    pub reaching_margin: Force<T, N>,
    /// Gain on nu - nu_c (`ctc`, `pid`) or, with the effective inertia, on s (`backstepping-adaptive`), 1/s.
    pub damping: Velocity<T, N>,
    /// Gain on integral(nu - nu_c), 1/s^2.
    pub stiffness: Velocity<T, N>,
    /// Gain on the integral of that, of `pid`, 1/s^3.
    pub integral: Velocity<T, N>,
    /// Acceptable integral(nu - nu_c) of `lqr`, m and rad.
    pub acceptable_position: Velocity<T, N>,
    /// Acceptable nu - nu_c of `lqr`, m/s and rad/s.
    pub acceptable_velocity: Velocity<T, N>,
    /// Acceptable force of `lqr`, N and N m.
    pub acceptable_force: Force<T, N>,
    /// gamma: adaptation of the bodies' factors, 1/J.
    pub body_adaptation: T,
    /// Least and largest factor on a body's inertia.
    pub body_factor: (T, T),
    /// Adaptation of the learned force, with the effective inertia, 1/s^2.
    pub force_adaptation: T,
    /// k1 of `super-twisting`, N (m/s)^-1/2 and N m (rad/s)^-1/2.
    pub twisting: Force<T, N>,
    /// k2 of `super-twisting`, N/s and N m/s.
    pub twisting_rate: Force<T, N>,
    /// Misprints of the thesis that `bfsmc-thesis` shall keep.
    pub misprints: Misprints,
}

impl<T: Real, const N: usize> Gains<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    /// Gains that suit a robot and a control period, for one law.
    ///
    /// Forces follow the torque limits, widths the effective inertia and the period, so that the same loop results for a heavier
    /// robot or a slower clock:
    ///
    /// | gain | default |
    /// | --- | --- |
    /// | switching | 15 % of the generalized force limits |
    /// | boundary layer | k / (100/s x effective inertia): slope of a loop of 100/s, at most 0.1 per period |
    /// | fuzzy, `bfsmc-thesis` | equal to the switching gain; scale: 1 rad/s (m/s) is 1 |
    /// | fuzzy, `bfsmc` | 30 % of the force limits; scale: the same slope at s = 0 |
    /// | observer bandwidth | 150/s, at most 0.2 per period |
    /// | learning limit | 50 % of the force limits |
    /// | damping, stiffness, integral | b, b^2/4 for `ctc`; b, b^2/3, b^3/27 for `pid` (all poles equal), with b = 100/s, at most 0.1 per period |
    /// | acceptable force, position, velocity | the force limits; those that alone would give the same b |
    /// | body adaptation, its factors | 1/J, 0.5 to 2 |
    /// | force adaptation | b^2/4 |
    /// | twisting rate, twisting | twice the switching gain a second; 1.5 sqrt(effective inertia x rate) |
    #[must_use]
    pub fn for_robot(robot: &Robot<T, N>, kind: super::LawKind, period: T) -> Self {
        let switching = force_limits(robot).scaled(T::from_f64(0.15));
        Self::with_switching(robot, kind, period, switching)
    }

    /// The same with another switching gain, and what follows from it by the table of [`for_robot`](Self::for_robot).
    #[must_use]
    pub fn with_switching(
        robot: &Robot<T, N>,
        kind: super::LawKind,
        period: T,
        switching: Force<T, N>,
    ) -> Self {
        let n = T::from_f64;
        let most = force_limits(robot);
        let EffectiveInertia(inertia) = EffectiveInertia::of(robot);
        let bandwidth = n(100.0).min(n(0.1) / period);
        let width = |gain: Force<T, N>, slope: T| {
            // A channel that does not switch needs some width all the same.
            let ratio =
                gain.zip(inertia, |k, m| slope * if k > T::ZERO { k } else { T::ONE } / (bandwidth * m));
            Velocity::from_channels(ratio.channels())
        };
        let (fuzzy, fuzzy_scale) = match kind {
            super::LawKind::BfsmcThesis => (switching, Velocity::splat(T::ONE)),
            _ => {
                let fuzzy = most.scaled(n(0.3));
                (fuzzy, width(fuzzy, n(SMOOTH_SLOPE_AT_ZERO)))
            }
        };
        let quarter = bandwidth * bandwidth / n(4.0);
        let stiffness = if kind == super::LawKind::Pid { bandwidth * bandwidth / n(3.0) } else { quarter };
        let per_inertia =
            |rate: T| Velocity::from_channels(most.zip(inertia, |f, m| f / (m * rate)).channels());
        let twisting_rate = switching.scaled(n(2.0));
        Self {
            switching,
            boundary_layer: width(switching, T::ONE),
            fuzzy,
            fuzzy_scale,
            observer_bandwidth: n(150.0).min(n(0.2) / period),
            learning_limit: most.scaled(T::HALF),
            reaching_margin: Force::zero(),
            damping: Velocity::splat(bandwidth),
            stiffness: Velocity::splat(stiffness),
            integral: Velocity::splat(bandwidth * bandwidth * bandwidth / n(27.0)),
            acceptable_position: per_inertia(quarter),
            acceptable_velocity: per_inertia(bandwidth),
            acceptable_force: most,
            body_adaptation: T::ONE,
            body_factor: (T::HALF, T::TWO),
            force_adaptation: quarter,
            twisting: twisting_rate.zip(inertia, |rate, m| n(1.5) * (rate * m).sqrt()),
            twisting_rate,
            misprints: Misprints::default(),
        }
    }
}

/// Slope at zero of the default fuzzy surface as `bfsmc` tabulates it, which is its steepest: that of the rules is 2.
const SMOOTH_SLOPE_AT_ZERO: f64 = 1.7277;

impl<T: Real, const N: usize> Gains<T, N> {
    /// Checks every gain.
    ///
    /// # Errors
    /// Names the first that is infinite, NaN or of a sign that it cannot have.
    pub fn check(&self) -> Result<(), ParamError> {
        let velocities = |vector: &Velocity<T, N>, test: Test<T>, name| {
            vector.channels().try_for_each(|value| test(value, name).map(|_| ()))
        };
        let forces = |vector: &Force<T, N>, test: Test<T>, name| {
            vector.channels().try_for_each(|value| test(value, name).map(|_| ()))
        };
        let (positive, non_negative): (Test<T>, Test<T>) = (check::positive, check::non_negative);
        forces(&self.switching, non_negative, "switching_gain")?;
        velocities(&self.boundary_layer, positive, "boundary_layer")?;
        forces(&self.fuzzy, non_negative, "fuzzy_gain")?;
        velocities(&self.fuzzy_scale, positive, "fuzzy_scale")?;
        if check::non_negative(self.observer_bandwidth, "observer_bandwidth_1_s")? > T::ZERO {
            check::positive(self.observer_bandwidth, "observer_bandwidth_1_s")?;
        }
        forces(&self.learning_limit, non_negative, "learning_limit")?;
        forces(&self.reaching_margin, non_negative, "reaching_margin")?;
        velocities(&self.damping, non_negative, "damping_gain_1_s")?;
        velocities(&self.stiffness, non_negative, "stiffness_gain_1_s2")?;
        velocities(&self.integral, non_negative, "integral_gain_1_s3")?;
        velocities(&self.acceptable_position, positive, "acceptable_position")?;
        velocities(&self.acceptable_velocity, positive, "acceptable_velocity")?;
        forces(&self.acceptable_force, positive, "acceptable_force")?;
        check::non_negative(self.body_adaptation, "body_adaptation_gain_1_j")?;
        let (least, largest) = self.body_factor;
        check::positive(least, "body_factor")?;
        check::positive(largest, "body_factor")?;
        if least > T::ONE || largest < T::ONE {
            return Err(ParamError::OutOfRange("body_factor"));
        }
        check::non_negative(self.force_adaptation, "force_adaptation_gain_1_s2")?;
        forces(&self.twisting, non_negative, "twisting_gain")?;
        forces(&self.twisting_rate, non_negative, "twisting_rate_gain")?;
        Ok(())
    }
}

/// A check of one number that carries the name given.
type Test<T> = fn(T, &'static str) -> Result<T, ParamError>;

/// The largest generalized forces that the actuators make: force and moment of the wheels each on its own.
pub(crate) fn force_limits<T: Real, const N: usize>(robot: &Robot<T, N>) -> Force<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let limits = &robot.params().limits;
    let push = limits.wheel_torque;
    let wheels = |right, left| robot.force_of(&Torque { right, left, joints: [T::ZERO; N] });
    Force { forward: wheels(push, push).forward, yaw: wheels(push, -push).yaw, joints: limits.joint_torque }
}
