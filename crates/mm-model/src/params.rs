//! The numbers that make a robot, checked once.

use crate::error::check::{finite, non_negative, positive};
use crate::{ParamError, Real};

/// One link of the arm, as its maker would describe it.
///
/// Link 1 stands upright, so that its axis is the vertical; links 2 and 3 swing in the vertical plane of the arm.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Link<T> {
    /// Distance from this joint to the next, or to the tip, m.
    pub length: T,
    /// Mass, kg.
    pub mass: T,
    /// Centre of mass, measured from the joint along the link, m.
    pub com: T,
    /// Moment of inertia about the link's own axis, through its centre of mass, kg m^2.
    pub axial_inertia: T,
    /// Moment of inertia about the pitch axis, through the centre of mass, kg m^2.
    pub pitch_inertia: T,
    /// Moment of inertia about the third principal axis, kg m^2.
    pub normal_inertia: T,
}

/// Friction in the wheel bearings and the joints: viscous and, smoothed through zero speed, Coulomb.
///
/// Torque on an axis that turns at w: `viscous w + coulomb w / sqrt(w^2 + smoothing^2)`, against the motion.
/// The thesis names F(q') in (3.90), never specifies it and drops it in (3.100); zero is therefore the preset.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct Friction<T, const N: usize> {
    /// Viscous coefficient of each wheel, N m s/rad.
    pub wheel_viscous: T,
    /// Coulomb torque of each wheel, N m.
    pub wheel_coulomb: T,
    /// Viscous coefficient of each joint, N m s/rad.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub joint_viscous: [T; N],
    /// Coulomb torque of each joint, N m.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub joint_coulomb: [T; N],
    /// Speed at which the Coulomb torque has reached 71 % of its size, rad/s.
    pub smoothing: T,
}

impl<T: Real, const N: usize> Friction<T, N> {
    /// No friction at all.
    #[must_use]
    pub fn none() -> Self {
        Self {
            wheel_viscous: T::ZERO,
            wheel_coulomb: T::ZERO,
            joint_viscous: [T::ZERO; N],
            joint_coulomb: [T::ZERO; N],
            smoothing: T::from_f64(0.01),
        }
    }

    /// Whether no axis has any friction.
    #[must_use]
    pub fn is_none(&self) -> bool {
        let zero = |value: &T| !(*value > T::ZERO);
        zero(&self.wheel_viscous)
            && zero(&self.wheel_coulomb)
            && self.joint_viscous.iter().all(zero)
            && self.joint_coulomb.iter().all(zero)
    }
}

/// What the robot must not exceed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct Limits<T, const N: usize> {
    /// Lower and upper angle of each joint, rad.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub joints: [(T, T); N],
    /// Largest torque of each wheel, N m.
    pub wheel_torque: T,
    /// Largest torque of each joint, N m.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub joint_torque: [T; N],
    /// Forward speed up to which the model's assumptions hold, m/s (2 in the thesis, section 3.2).
    pub speed: T,
}

/// The parameters of a robot, not yet checked: fill the fields and give them to [`Robot::try_new`](crate::Robot::try_new).
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct RobotParams<T, const N: usize> {
    /// Mass of the base with its wheels, kg.
    pub base_mass: T,
    /// Moment of inertia of the base about the vertical through its centre of mass, kg m^2.
    pub base_yaw_inertia: T,
    /// Centre of mass of the base, ahead of the axle, m.
    pub base_com_offset: T,
    /// Yaw axis of the arm, ahead of the axle (l_b), m.
    pub arm_offset: T,
    /// Height of the arm's foot above the ground, m.
    pub mount_height: T,
    /// Wheel radius r, m.
    pub wheel_radius: T,
    /// Distance between the wheels (2 l: the thesis's b), m.
    pub track_width: T,
    /// Acceleration of gravity, m/s^2.
    pub gravity: T,
    /// Links, base to tip.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub links: [Link<T>; N],
    /// Joint angles that the arm returns to where the task leaves it free, rad.
    #[cfg_attr(feature = "serde", serde(with = "crate::array"))]
    pub rest_posture: [T; N],
    /// Friction.
    pub friction: Friction<T, N>,
    /// Limits.
    pub limits: Limits<T, N>,
}

impl<T: Real> RobotParams<T, 3> {
    /// The robot of the thesis: Table 5.1, and what that table leaves open.
    ///
    /// From Table 5.1: base 50 kg; links of 4, 6 and 4 kg and 0.5 m each; wheel radius 0.06 m; track 0.2 m;
    /// arm 0.06 m ahead of the axle. Chosen here, since the thesis does not say: centres of mass at the link tips (where
    /// (3.79) to (3.81) and (3.88) place them) and the base's at the arm's foot (3.67); link inertias m a^2 / 12
    /// about every axis; base inertia of a 0.5 m x 0.4 m box; mount height 0; torque limits of 60 N m a wheel and
    /// 150, 200, 150 N m; joint limits; rest posture (0, 60, -120) degrees; no friction.
    #[must_use]
    pub fn thesis() -> Self {
        let n = T::from_f64;
        let link = |mass: f64| {
            let inertia = n(mass * 0.25 / 12.0);
            Link {
                length: n(0.5),
                mass: n(mass),
                com: n(0.5),
                axial_inertia: inertia,
                pitch_inertia: inertia,
                normal_inertia: inertia,
            }
        };
        let third = core::f64::consts::FRAC_PI_3;
        Self {
            base_mass: n(50.0),
            base_yaw_inertia: n(50.0 * (0.25 + 0.16) / 12.0),
            base_com_offset: n(0.06),
            arm_offset: n(0.06),
            mount_height: T::ZERO,
            wheel_radius: n(0.06),
            track_width: n(0.2),
            gravity: n(9.81),
            links: [link(4.0), link(6.0), link(4.0)],
            rest_posture: [T::ZERO, n(third), n(-2.0 * third)],
            friction: Friction::none(),
            limits: Limits {
                joints: [(-T::PI, T::PI), (n(-0.35), n(1.92)), (n(-2.79), n(2.79))],
                wheel_torque: n(60.0),
                joint_torque: [n(150.0), n(200.0), n(150.0)],
                speed: n(2.0),
            },
        }
    }
}

impl<T: Real, const N: usize> RobotParams<T, N> {
    /// The same robot with every mass and moment of inertia multiplied by `factor`.
    #[must_use]
    pub fn with_mass_scaled(mut self, factor: T) -> Self {
        self.base_mass *= factor;
        self.base_yaw_inertia *= factor;
        for link in &mut self.links {
            link.mass *= factor;
            link.axial_inertia *= factor;
            link.pitch_inertia *= factor;
            link.normal_inertia *= factor;
        }
        self
    }

    /// The same robot with a point mass at the tip, as a part of its last link.
    ///
    /// Equation: m = m3 + mp, com = (m3 com3 + mp a3)/m, and m3 mp/m (a3 - com3)^2 more inertia across the link.
    #[must_use]
    pub fn with_payload(mut self, payload: T) -> Self {
        if let Some(link) = self.links.last_mut() {
            let mass = link.mass + payload;
            let arm = link.length - link.com;
            let across = link.mass * payload / mass * arm * arm;
            link.com = (link.mass * link.com + payload * link.length) / mass;
            link.pitch_inertia += across;
            link.normal_inertia += across;
            link.mass = mass;
        }
        self
    }

    /// Checks every field.
    ///
    /// # Errors
    /// The first field that no robot can have, by name and unit. Fields of links carry the name without the link's
    /// number.
    pub fn check(&self) -> Result<(), ParamError> {
        positive(self.base_mass, "base_mass_kg")?;
        positive(self.base_yaw_inertia, "base_yaw_inertia_kg_m2")?;
        finite(self.base_com_offset, "base_com_offset_m")?;
        finite(self.arm_offset, "arm_offset_m")?;
        finite(self.mount_height, "mount_height_m")?;
        positive(self.wheel_radius, "wheel_radius_m")?;
        positive(self.track_width, "track_width_m")?;
        non_negative(self.gravity, "gravity_m_s2")?;
        for link in &self.links {
            positive(link.length, "length_m")?;
            positive(link.mass, "mass_kg")?;
            non_negative(link.com, "com_m")?;
            for inertia in [link.axial_inertia, link.pitch_inertia, link.normal_inertia] {
                non_negative(inertia, "inertia_kg_m2")?;
            }
        }
        self.check_positive_definite()?;
        for &angle in &self.rest_posture {
            finite(angle, "rest_posture_rad")?;
        }
        self.check_friction()?;
        self.check_limits()
    }

    /// Every joint must move some inertia in every posture; the bounds used are sufficient ones.
    fn check_positive_definite(&self) -> Result<(), ParamError> {
        let yaw = self.links.iter().enumerate().fold(T::ZERO, |sum, (i, link)| {
            sum + if i == 0 { link.axial_inertia } else { link.axial_inertia.min(link.normal_inertia) }
        });
        if N > 0 && !(yaw > T::ZERO) {
            return Err(ParamError::NotPositiveDefinite("inertia_kg_m2"));
        }
        for link in self.links.iter().skip(1) {
            if !(link.pitch_inertia + link.mass * link.com * link.com > T::ZERO) {
                return Err(ParamError::NotPositiveDefinite("inertia_kg_m2"));
            }
        }
        Ok(())
    }

    fn check_friction(&self) -> Result<(), ParamError> {
        non_negative(self.friction.wheel_viscous, "wheel_viscous_n_m_s")?;
        non_negative(self.friction.wheel_coulomb, "wheel_coulomb_n_m")?;
        for &value in &self.friction.joint_viscous {
            non_negative(value, "joint_viscous_n_m_s")?;
        }
        for &value in &self.friction.joint_coulomb {
            non_negative(value, "joint_coulomb_n_m")?;
        }
        positive(self.friction.smoothing, "smoothing_rad_s")?;
        // Its square is what is divided by.
        positive(self.friction.smoothing * self.friction.smoothing, "smoothing_rad_s")?;
        Ok(())
    }

    fn check_limits(&self) -> Result<(), ParamError> {
        for &(lo, hi) in &self.limits.joints {
            finite(lo, "joint_limit_rad")?;
            finite(hi, "joint_limit_rad")?;
            if !(lo < hi) {
                return Err(ParamError::Inverted("joint_limit_rad"));
            }
        }
        positive(self.limits.wheel_torque, "wheel_torque_limit_n_m")?;
        for &limit in &self.limits.joint_torque {
            positive(limit, "torque_limit_n_m")?;
        }
        positive(self.limits.speed, "speed_limit_m_s")?;
        Ok(())
    }
}
