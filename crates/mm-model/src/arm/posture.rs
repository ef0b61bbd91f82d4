//! Where the tip is, and how it moves: forward kinematics, Jacobian and its rate.

use nalgebra::Vector3;

use crate::params::RobotParams;
use crate::{Angle, Real, TipJacobian, Velocity};

/// Sines and cosines of the three joints: of q1, q2 and q2 + q3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ArmPosture<T> {
    /// Arm yaw q1.
    pub yaw: Angle<T>,
    /// Shoulder pitch q2: direction of link 2 above the horizontal.
    pub shoulder: Angle<T>,
    /// q2 + q3: direction of link 3 above the horizontal.
    pub forearm: Angle<T>,
}

/// The arm's plane: distances from the yaw axis and heights, with their derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reach<T> {
    /// Distance of the tip from the yaw axis, `a2 c2 + a3 c23`; negative when the tip is behind it.
    pub(super) rho: T,
    /// d rho / d q2 = -(a2 s2 + a3 s23): the height of the tip above the shoulder, negated.
    pub(super) rho_2: T,
    /// d rho / d q3 = -a3 s23.
    pub(super) rho_3: T,
    /// d z / d q3 = a3 c23.
    pub(super) z_3: T,
}

impl<T: Real> ArmPosture<T> {
    /// Sines and cosines of the joint angles (q1, q2, q3).
    #[must_use]
    #[inline]
    pub fn of(joints: &[T; 3]) -> Self {
        let [q1, q2, q3] = *joints;
        Self { yaw: Angle::of(q1), shoulder: Angle::of(q2), forearm: Angle::of(q2 + q3) }
    }

    /// Sines and cosines after the joints have turned on by small angles; see [`Angle::turned_by`].
    #[must_use]
    #[inline(always)]
    pub fn turned_by(&self, joints: [T; 3]) -> Self {
        let [d1, d2, d3] = joints;
        Self {
            yaw: self.yaw.turned_by(d1),
            shoulder: self.shoulder.turned_by(d2),
            forearm: self.forearm.turned_by(d2 + d3),
        }
    }

    #[inline]
    pub(super) fn reach(&self, params: &RobotParams<T, 3>) -> Reach<T> {
        let [_, link2, link3] = &params.links;
        let z_3 = link3.length * self.forearm.cos;
        let rho_3 = -(link3.length * self.forearm.sin);
        Reach {
            rho: link2.length * self.shoulder.cos + z_3,
            rho_2: rho_3 - link2.length * self.shoulder.sin,
            rho_3,
            z_3,
        }
    }

    /// Tip relative to the axle's midpoint (3.55):
    /// (l_b cos phi + rho cos psi, l_b sin phi + rho sin psi, z_mount + a1 + a2 s2 + a3 s23).
    #[inline]
    pub(super) fn tip_offset(&self, params: &RobotParams<T, 3>, heading: Angle<T>) -> Vector3<T> {
        let reach = self.reach(params);
        let psi = heading.plus(self.yaw);
        let [link1, ..] = &params.links;
        Vector3::new(
            params.arm_offset * heading.cos + reach.rho * psi.cos,
            params.arm_offset * heading.sin + reach.rho * psi.sin,
            params.mount_height + link1.length - reach.rho_2,
        )
    }

    /// Columns of the tip Jacobian, the matrix after (3.61) with its misprints mended.
    #[inline]
    pub(super) fn tip_jacobian(&self, params: &RobotParams<T, 3>, heading: Angle<T>) -> TipJacobian<T, 3> {
        let reach = self.reach(params);
        let psi = heading.plus(self.yaw);
        let turn = Vector3::new(-reach.rho * psi.sin, reach.rho * psi.cos, T::ZERO);
        let lb = params.arm_offset;
        TipJacobian {
            forward: Vector3::new(heading.cos, heading.sin, T::ZERO),
            yaw_rate: Vector3::new(turn.x - lb * heading.sin, turn.y + lb * heading.cos, T::ZERO),
            joints: [
                turn,
                Vector3::new(reach.rho_2 * psi.cos, reach.rho_2 * psi.sin, reach.rho),
                Vector3::new(reach.rho_3 * psi.cos, reach.rho_3 * psi.sin, reach.z_3),
            ],
        }
    }

    /// Columns of dJ/dt at velocity `nu`.
    #[inline]
    pub(super) fn tip_jacobian_rate(
        &self,
        params: &RobotParams<T, 3>,
        heading: Angle<T>,
        nu: &Velocity<T, 3>,
    ) -> TipJacobian<T, 3> {
        let [_, link2, _] = &params.links;
        let [dq1, dq2, dq3] = nu.joints;
        let (omega, omega_arm, dq23) = (nu.yaw_rate, nu.yaw_rate + dq1, dq2 + dq3);
        let reach = self.reach(params);
        let psi = heading.plus(self.yaw);
        let d_rho = reach.rho_2 * dq2 + reach.rho_3 * dq3;
        let d_rho_3 = -(reach.z_3 * dq23);
        let d_rho_2 = d_rho_3 - link2.length * self.shoulder.cos * dq2;
        let (along, across) = (d_rho, reach.rho * omega_arm);
        let turn =
            Vector3::new(-(along * psi.sin + across * psi.cos), along * psi.cos - across * psi.sin, T::ZERO);
        let lb_omega = params.arm_offset * omega;
        let pitch = |d_radius: T, radius: T, d_height: T| {
            let sideways = radius * omega_arm;
            Vector3::new(
                d_radius * psi.cos - sideways * psi.sin,
                d_radius * psi.sin + sideways * psi.cos,
                d_height,
            )
        };
        TipJacobian {
            forward: Vector3::new(-(omega * heading.sin), omega * heading.cos, T::ZERO),
            yaw_rate: Vector3::new(turn.x - lb_omega * heading.cos, turn.y - lb_omega * heading.sin, T::ZERO),
            joints: [
                turn,
                pitch(d_rho_2, reach.rho_2, d_rho),
                pitch(d_rho_3, reach.rho_3, reach.rho_3 * dq23),
            ],
        }
    }
}
