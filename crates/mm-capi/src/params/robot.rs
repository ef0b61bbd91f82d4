//! The robot's numbers, as structs of C.

use mm_model::{Limits, Real, RobotParams};

use crate::MM_JOINTS;

/// One link of the arm, base to tip; link 1 stands upright, so that its axis is the vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Link<T> {
    /// Distance from this joint to the next, or to the tip, m.
    pub length_m: T,
    /// Mass, kg.
    pub mass_kg: T,
    /// Centre of mass, from the joint along the link, m.
    pub com_m: T,
    /// Moments of inertia through the centre of mass: about the link's own axis, about the pitch axis, about the third, kg m^2.
    pub inertia_kg_m2: [T; 3],
    /// Least and largest angle of its joint, rad.
    pub joint_limit_rad: [T; 2],
    /// Largest torque of its joint, N m.
    pub torque_limit_n_m: T,
}

/// Friction in wheel bearings and joints: viscous, and Coulomb smoothed through zero speed.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Friction<T> {
    /// Viscous coefficient of each wheel, N m s/rad.
    pub wheel_viscous_n_m_s: T,
    /// Coulomb torque of each wheel, N m.
    pub wheel_coulomb_n_m: T,
    /// Viscous coefficient of each joint, N m s/rad.
    pub joint_viscous_n_m_s: [T; MM_JOINTS],
    /// Coulomb torque of each joint, N m.
    pub joint_coulomb_n_m: [T; MM_JOINTS],
    /// Speed at which the Coulomb torque has reached 71 % of its size, rad/s.
    pub smoothing_rad_s: T,
}

/// A robot: a base on two driven wheels that carries an arm of yaw, pitch and pitch.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Robot<T> {
    /// Mass of the base with its wheels, kg.
    pub base_mass_kg: T,
    /// Moment of inertia of the base about the vertical through its centre of mass, kg m^2.
    pub base_yaw_inertia_kg_m2: T,
    /// Centre of mass of the base, ahead of the axle, m.
    pub base_com_offset_m: T,
    /// Yaw axis of the arm, ahead of the axle, m.
    pub arm_offset_m: T,
    /// Height of the arm's foot above the ground, m.
    pub mount_height_m: T,
    /// Radius of the wheels, m.
    pub wheel_radius_m: T,
    /// Distance between the wheels, m.
    pub track_width_m: T,
    /// Acceleration of gravity, m/s^2.
    pub gravity_m_s2: T,
    /// Largest torque of each wheel, N m.
    pub wheel_torque_limit_n_m: T,
    /// Forward speed up to which the model's assumptions hold, m/s.
    pub speed_limit_m_s: T,
    /// Joint angles that the arm returns to where the task leaves it free, rad.
    pub rest_posture_rad: [T; MM_JOINTS],
    /// Links, base to tip.
    pub links: [Link<T>; MM_JOINTS],
    /// Friction; all zero but smoothing_rad_s for none.
    pub friction: Friction<T>,
}

impl<T: Real> Link<T> {
    const fn of(self) -> mm_model::Link<T> {
        let [axial_inertia, pitch_inertia, normal_inertia] = self.inertia_kg_m2;
        mm_model::Link {
            length: self.length_m,
            mass: self.mass_kg,
            com: self.com_m,
            axial_inertia,
            pitch_inertia,
            normal_inertia,
        }
    }
}

impl<T: Real> Robot<T> {
    pub(crate) fn of(self) -> RobotParams<T, 3> {
        let friction = self.friction;
        RobotParams {
            base_mass: self.base_mass_kg,
            base_yaw_inertia: self.base_yaw_inertia_kg_m2,
            base_com_offset: self.base_com_offset_m,
            arm_offset: self.arm_offset_m,
            mount_height: self.mount_height_m,
            wheel_radius: self.wheel_radius_m,
            track_width: self.track_width_m,
            gravity: self.gravity_m_s2,
            links: self.links.map(Link::of),
            rest_posture: self.rest_posture_rad,
            friction: mm_model::Friction {
                wheel_viscous: friction.wheel_viscous_n_m_s,
                wheel_coulomb: friction.wheel_coulomb_n_m,
                joint_viscous: friction.joint_viscous_n_m_s,
                joint_coulomb: friction.joint_coulomb_n_m,
                smoothing: friction.smoothing_rad_s,
            },
            limits: Limits {
                joints: self.links.map(|link| link.joint_limit_rad.into()),
                wheel_torque: self.wheel_torque_limit_n_m,
                joint_torque: self.links.map(|link| link.torque_limit_n_m),
                speed: self.speed_limit_m_s,
            },
        }
    }
}

impl<T: Real> From<RobotParams<T, 3>> for Robot<T> {
    fn from(robot: RobotParams<T, 3>) -> Self {
        let RobotParams { links: [one, two, three], friction, limits, .. } = robot;
        let [(range1, torque1), (range2, torque2), (range3, torque3)] = {
            let ([r1, r2, r3], [t1, t2, t3]) = (limits.joints, limits.joint_torque);
            [(r1, t1), (r2, t2), (r3, t3)]
        };
        let link = |link: mm_model::Link<T>, range: (T, T), torque_limit_n_m| Link {
            length_m: link.length,
            mass_kg: link.mass,
            com_m: link.com,
            inertia_kg_m2: [link.axial_inertia, link.pitch_inertia, link.normal_inertia],
            joint_limit_rad: range.into(),
            torque_limit_n_m,
        };
        Self {
            base_mass_kg: robot.base_mass,
            base_yaw_inertia_kg_m2: robot.base_yaw_inertia,
            base_com_offset_m: robot.base_com_offset,
            arm_offset_m: robot.arm_offset,
            mount_height_m: robot.mount_height,
            wheel_radius_m: robot.wheel_radius,
            track_width_m: robot.track_width,
            gravity_m_s2: robot.gravity,
            wheel_torque_limit_n_m: limits.wheel_torque,
            speed_limit_m_s: limits.speed,
            rest_posture_rad: robot.rest_posture,
            links: [link(one, range1, torque1), link(two, range2, torque2), link(three, range3, torque3)],
            friction: Friction {
                wheel_viscous_n_m_s: friction.wheel_viscous,
                wheel_coulomb_n_m: friction.wheel_coulomb,
                joint_viscous_n_m_s: friction.joint_viscous,
                joint_coulomb_n_m: friction.joint_coulomb,
                smoothing_rad_s: friction.smoothing,
            },
        }
    }
}
