//! A robot: checked parameters, and the quantities that a user asks of it.

use nalgebra::Vector3;

use crate::params::RobotParams;
use crate::{
    Angle, Configuration, Force, MassMatrix, Mechanism, ParamError, Real, Sines, SinesOf, TipJacobian,
    Torque, Velocity,
};

/// A robot with checked parameters: a differential-drive base and an arm of N joints.
///
/// N = 3 is the yaw-pitch-pitch arm, N = 0 the base alone. All quantities follow from the [`Mechanism`] of that N; the methods
/// here are for one quantity at a time and evaluate the sines anew on each call.
///
/// # Examples
/// ```
/// use mm_model::{Configuration, Robot, RobotParams};
/// let robot = Robot::try_new(RobotParams::<f64, 3>::thesis())?;
/// // Stretched out forwards: 0.06 m to the arm, two links of 0.5 m, 0.5 m high.
/// let tip = robot.tip_position(&Configuration::zero());
/// assert_eq!((tip.x, tip.y, tip.z), (1.06, 0.0, 0.5));
/// # Ok::<(), mm_model::ParamError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Robot<T, const N: usize> {
    pub(crate) params: RobotParams<T, N>,
    pub(crate) lumped: Lumped<T>,
}

/// What the formulas need of the parameters, formed once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lumped<T> {
    /// Total mass and its inverse.
    pub(crate) mass: T,
    pub(crate) inverse_mass: T,
    /// Yaw inertia of the base about the axle's midpoint, the arm's masses standing on its yaw axis: J0.
    pub(crate) base_yaw: T,
    pub(crate) inverse_base_yaw: T,
    /// l_b, l_b / J0 and l_b^2 / J0.
    pub(crate) arm_offset: T,
    pub(crate) offset_per_yaw: T,
    pub(crate) offset2_per_yaw: T,
    /// First moment of all masses ahead of the axle, the arm's standing on its yaw axis: m_b d + m_a l_b.
    pub(crate) moment: T,
    /// First moments of the pitching links: A2 = m2 com2 + m3 a2, A3 = m3 com3.
    pub(crate) moment2: T,
    pub(crate) moment3: T,
    /// Theta = yaw0 + yaw22 c2^2 + yaw33 c23^2 + 2 yaw23 c2 c23.
    pub(crate) yaw0: T,
    pub(crate) yaw22: T,
    pub(crate) yaw33: T,
    pub(crate) yaw23: T,
    /// M44 = pitch22 + 2 yaw23 cos q3, M55 = pitch33.
    pub(crate) pitch22: T,
    pub(crate) pitch33: T,
    pub(crate) gravity: T,
    /// Mass-weighted height of the arm above the ground, links 2 and 3 standing at the shoulder, kg m.
    pub(crate) height: T,
    pub(crate) half_track: T,
    pub(crate) inverse_radius: T,
    pub(crate) half_radius: T,
    pub(crate) track_per_radius: T,
    pub(crate) radius_per_track: T,
    pub(crate) frictionless: bool,
}

impl<T: Real> Lumped<T> {
    pub(crate) fn of<const N: usize>(p: &RobotParams<T, N>) -> Self {
        let sq = |x: T| x * x;
        let arm_mass = p.links.iter().fold(T::ZERO, |sum, link| sum + link.mass);
        let mass = p.base_mass + arm_mass;
        let base_yaw = p.base_yaw_inertia + p.base_mass * sq(p.base_com_offset) + arm_mass * sq(p.arm_offset);
        let half_track = p.track_width * T::HALF;
        let mut k = Self {
            mass,
            inverse_mass: T::ONE / mass,
            base_yaw,
            inverse_base_yaw: T::ONE / base_yaw,
            arm_offset: p.arm_offset,
            offset_per_yaw: p.arm_offset / base_yaw,
            offset2_per_yaw: sq(p.arm_offset) / base_yaw,
            moment: p.base_mass * p.base_com_offset + arm_mass * p.arm_offset,
            moment2: T::ZERO,
            moment3: T::ZERO,
            yaw0: T::ZERO,
            yaw22: T::ZERO,
            yaw33: T::ZERO,
            yaw23: T::ZERO,
            pitch22: T::ZERO,
            pitch33: T::ZERO,
            gravity: p.gravity,
            height: T::ZERO,
            half_track,
            inverse_radius: T::ONE / p.wheel_radius,
            half_radius: p.wheel_radius * T::HALF,
            track_per_radius: half_track / p.wheel_radius,
            radius_per_track: p.wheel_radius / p.track_width,
            frictionless: p.friction.is_none(),
        };
        if let [one, two, three] = p.links.as_slice() {
            k.moment2 = two.mass * two.com + three.mass * two.length;
            k.moment3 = three.mass * three.com;
            k.yaw0 = one.axial_inertia + two.axial_inertia + three.axial_inertia;
            k.yaw22 =
                two.normal_inertia - two.axial_inertia + two.mass * sq(two.com) + three.mass * sq(two.length);
            k.yaw33 = three.normal_inertia - three.axial_inertia + three.mass * sq(three.com);
            k.yaw23 = three.mass * two.length * three.com;
            k.pitch33 = three.pitch_inertia + three.mass * sq(three.com);
            k.pitch22 = two.pitch_inertia + two.mass * sq(two.com) + three.mass * sq(two.length) + k.pitch33;
            let above = two.mass + three.mass;
            k.height = arm_mass * p.mount_height + one.mass * one.com + above * one.length;
        }
        k
    }
}

impl<T: Real, const N: usize> Robot<T, N>
where
    Self: Mechanism<T, N>,
{
    /// A robot of checked parameters.
    ///
    /// # Errors
    /// The first field that no robot can have; see [`RobotParams::check`].
    pub fn try_new(params: RobotParams<T, N>) -> Result<Self, ParamError> {
        params.check()?;
        Ok(Self { params, lumped: Lumped::of(&params) })
    }

    /// Sines and cosines of a configuration.
    #[must_use]
    #[inline]
    pub fn sines(&self, q: &Configuration<T, N>) -> SinesOf<T, N> {
        Sines { heading: Angle::of(q.heading), posture: self.posture(&q.joints) }
    }

    /// Tip in the world frame, m (3.55).
    #[must_use]
    pub fn tip_position(&self, q: &Configuration<T, N>) -> Vector3<T> {
        self.tip_offset(Angle::of(q.heading), &self.posture(&q.joints)) + Vector3::new(q.x, q.y, T::ZERO)
    }

    /// Tip Jacobian at a configuration: dp/dt = J nu.
    #[must_use]
    pub fn jacobian(&self, q: &Configuration<T, N>) -> TipJacobian<T, N> {
        self.tip_jacobian(Angle::of(q.heading), &self.posture(&q.joints))
    }

    /// The part of the tip's acceleration that the velocity alone makes: (dJ/dt) nu, m/s^2.
    #[must_use]
    pub fn jacobian_bias(&self, q: &Configuration<T, N>, nu: &Velocity<T, N>) -> Vector3<T> {
        self.tip_jacobian_rate(Angle::of(q.heading), &self.posture(&q.joints), nu).product(nu)
    }

    /// Manipulability sqrt(det(J J')) of the full, unweighted Jacobian.
    #[must_use]
    pub fn manipulability(&self, q: &Configuration<T, N>) -> T {
        self.manipulability_squared(&self.posture(&q.joints)).max(T::ZERO).sqrt()
    }

    /// Reduced mass matrix M(q).
    #[must_use]
    pub fn mass_matrix_at(&self, q: &Configuration<T, N>) -> MassMatrix<T, N> {
        self.mass_matrix(&self.inertia(&self.posture(&q.joints)))
    }

    /// Bias force h = C(q, nu) nu + g(q) + friction(nu): what holds the velocity.
    #[must_use]
    #[inline(always)]
    pub fn bias(&self, inertia: &<Self as Mechanism<T, N>>::Inertia, nu: &Velocity<T, N>) -> Force<T, N> {
        let h = self.coriolis_product(inertia, nu, nu).plus(self.gravity(inertia));
        if self.lumped.frictionless { h } else { h.plus(self.friction(nu)) }
    }

    /// Forward dynamics: the acceleration under actuator torques and an external generalized force.
    ///
    /// Equation: `nu' = M^-1 (B tau + f_ext - C nu - g - friction)`. Cost for N = 3: three sine/cosine pairs, three divisions,
    /// about 250 multiplications and additions.
    #[must_use]
    #[inline]
    pub fn forward_dynamics(
        &self,
        q: &Configuration<T, N>,
        nu: &Velocity<T, N>,
        torque: &Torque<T, N>,
        external: &Force<T, N>,
    ) -> Velocity<T, N> {
        let inertia = self.inertia(&self.posture(&q.joints));
        self.acceleration(&inertia, nu, &self.force_of(torque).plus(*external))
    }

    /// The acceleration under a generalized force, from terms already known: M^-1 (f - C nu - g - friction).
    #[must_use]
    #[inline(always)]
    pub fn acceleration(
        &self,
        inertia: &<Self as Mechanism<T, N>>::Inertia,
        nu: &Velocity<T, N>,
        force: &Force<T, N>,
    ) -> Velocity<T, N> {
        self.solve(inertia, &force.minus(self.bias(inertia, nu)))
    }

    /// Inverse dynamics: the generalized force `f = M nu' + C nu + g + friction`; torques follow by
    /// [`torque_of`](Self::torque_of).
    #[must_use]
    pub fn inverse_dynamics(
        &self,
        q: &Configuration<T, N>,
        nu: &Velocity<T, N>,
        acceleration: &Velocity<T, N>,
    ) -> Force<T, N> {
        let inertia = self.inertia(&self.posture(&q.joints));
        self.mass_product(&inertia, acceleration).plus(self.bias(&inertia, nu))
    }

    /// Coriolis matrix C(q, nu), column by column: entry i of column j is its force on channel i per velocity of channel j.
    ///
    /// For inspection; the laws use the products. dM/dt - 2C is skew (Property 3).
    pub fn coriolis_columns(
        &self,
        q: &Configuration<T, N>,
        nu: &Velocity<T, N>,
    ) -> impl Iterator<Item = Force<T, N>> {
        let inertia = self.inertia(&self.posture(&q.joints));
        let (robot, nu) = (*self, *nu);
        (0..2 + N).map(move |j| {
            let unit = (0..2 + N).map(|i| if i == j { T::ONE } else { T::ZERO });
            robot.coriolis_product(&inertia, &nu, &Velocity::from_channels(unit))
        })
    }

    /// Kinetic energy nu' M nu / 2, J.
    #[must_use]
    pub fn kinetic_energy(&self, q: &Configuration<T, N>, nu: &Velocity<T, N>) -> T {
        let inertia = self.inertia(&self.posture(&q.joints));
        T::HALF * nu.power(&self.mass_product(&inertia, nu))
    }

    /// Potential energy of the arm, J; zero with every link's centre of mass on the ground.
    #[must_use]
    pub fn potential_energy_at(&self, q: &Configuration<T, N>) -> T {
        self.potential_energy(&self.inertia(&self.posture(&q.joints)))
    }
}

impl<T: Real, const N: usize> Robot<T, N> {
    /// The parameters.
    #[must_use]
    #[inline]
    pub const fn params(&self) -> &RobotParams<T, N> {
        &self.params
    }

    /// Whether every joint angle is within its limits.
    #[must_use]
    #[inline]
    pub fn within_joint_limits(&self, joints: &[T; N]) -> bool {
        self.each_within_limits(joints).into_iter().all(|within| within)
    }

    /// Whether each joint angle is within its limits.
    #[must_use]
    #[inline]
    pub fn each_within_limits(&self, joints: &[T; N]) -> [bool; N] {
        let mut within = [false; N];
        let limits = &self.params.limits.joints;
        for ((is, &angle), &(lo, hi)) in within.iter_mut().zip(joints).zip(limits) {
            *is = angle >= lo && angle <= hi;
        }
        within
    }

    /// The torques cut to the limits of the actuators, and whether any of them was cut.
    ///
    /// A NaN passes: telling it from a torque is the caller's business.
    #[must_use]
    #[inline]
    pub fn limit_torque(&self, torque: &Torque<T, N>) -> (Torque<T, N>, bool) {
        let limits = &self.params.limits;
        let mut cut = false;
        let mut limit = |value: T, bound: T| {
            let limited = value.clamp_to(-bound, bound);
            cut |= limited != value;
            limited
        };
        let mut joints = torque.joints;
        for (joint, &bound) in joints.iter_mut().zip(&limits.joint_torque) {
            *joint = limit(*joint, bound);
        }
        let right = limit(torque.right, limits.wheel_torque);
        let left = limit(torque.left, limits.wheel_torque);
        (Torque { right, left, joints }, cut)
    }

    /// Rate of the configuration at a velocity: dq/dt = S(q) nu, as (x', y', heading', joints').
    #[must_use]
    #[inline]
    pub fn configuration_rate(heading: Angle<T>, nu: &Velocity<T, N>) -> Configuration<T, N> {
        Configuration {
            x: nu.forward * heading.cos,
            y: nu.forward * heading.sin,
            heading: nu.yaw_rate,
            joints: nu.joints,
        }
    }
}
