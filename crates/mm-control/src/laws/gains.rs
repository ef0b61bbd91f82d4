//! The gains of all switching laws, with defaults that follow the robot.

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
        Self {
            switching,
            boundary_layer: width(switching, T::ONE),
            fuzzy,
            fuzzy_scale,
            observer_bandwidth: n(150.0).min(n(0.2) / period),
            learning_limit: most.scaled(T::HALF),
            reaching_margin: Force::zero(),
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
        for value in self.switching.channels() {
            check::non_negative(value, "switching_gain")?;
        }
        for value in self.boundary_layer.channels() {
            check::positive(value, "boundary_layer")?;
        }
        for value in self.fuzzy.channels() {
            check::non_negative(value, "fuzzy_gain")?;
        }
        for value in self.fuzzy_scale.channels() {
            check::positive(value, "fuzzy_scale")?;
        }
        if check::non_negative(self.observer_bandwidth, "observer_bandwidth_1_s")? > T::ZERO {
            check::positive(self.observer_bandwidth, "observer_bandwidth_1_s")?;
        }
        for value in self.learning_limit.channels() {
            check::non_negative(value, "learning_limit")?;
        }
        for value in self.reaching_margin.channels() {
            check::non_negative(value, "reaching_margin")?;
        }
        Ok(())
    }
}

/// The largest generalized forces that the actuators make: force and moment of the wheels each on its own.
fn force_limits<T: Real, const N: usize>(robot: &Robot<T, N>) -> Force<T, N>
where
    Robot<T, N>: Mechanism<T, N>,
{
    let limits = &robot.params().limits;
    let push = limits.wheel_torque;
    let wheels = |right, left| robot.force_of(&Torque { right, left, joints: [T::ZERO; N] });
    Force { forward: wheels(push, push).forward, yaw: wheels(push, -push).yaw, joints: limits.joint_torque }
}
