//! The yaw-pitch-pitch arm on the base, in closed form.
//!
//! Symbols of these files: `rho` is the distance of the tip from the arm's yaw axis, `psi` = heading + q1 the direction in
//! which the arm points, `q23` = q2 + q3, `Omega` = yaw rate + dq1 the yaw rate of the arm, l_b the arm's offset.

mod inertia;
mod inverse;
mod manipulability;
mod posture;

pub use inertia::ArmInertia;
pub use inverse::{InverseKinematics, JointSolution};
pub use posture::ArmPosture;

use nalgebra::Vector3;

use crate::mechanism::ManipulabilitySlope;
use crate::{Angle, Force, MassMatrix, Mechanism, Real, Robot, TipJacobian, Velocity};

impl<T: Real> Mechanism<T, 3> for Robot<T, 3> {
    type Posture = ArmPosture<T>;
    type Inertia = ArmInertia<T>;

    #[inline]
    fn posture(&self, joints: &[T; 3]) -> ArmPosture<T> {
        ArmPosture::of(joints)
    }

    #[inline]
    fn inertia(&self, posture: &ArmPosture<T>) -> ArmInertia<T> {
        ArmInertia::new(&self.lumped, posture)
    }

    fn mass_matrix(&self, inertia: &ArmInertia<T>) -> MassMatrix<T, 3> {
        inertia.mass_matrix(&self.lumped)
    }

    #[inline]
    fn mass_product(&self, inertia: &ArmInertia<T>, a: &Velocity<T, 3>) -> Force<T, 3> {
        inertia.mass_product(&self.lumped, a)
    }

    #[inline]
    fn coriolis_product(
        &self,
        inertia: &ArmInertia<T>,
        nu: &Velocity<T, 3>,
        nu_r: &Velocity<T, 3>,
    ) -> Force<T, 3> {
        inertia.coriolis_product(&self.lumped, nu, nu_r)
    }

    #[inline]
    fn coriolis_transpose_product(&self, inertia: &ArmInertia<T>, nu: &Velocity<T, 3>) -> Force<T, 3> {
        inertia.coriolis_transpose_product(&self.lumped, nu)
    }

    #[inline]
    fn gravity(&self, inertia: &ArmInertia<T>) -> Force<T, 3> {
        inertia.gravity(&self.lumped)
    }

    #[inline]
    fn solve(&self, inertia: &ArmInertia<T>, force: &Force<T, 3>) -> Velocity<T, 3> {
        inertia.solve(&self.lumped, force)
    }

    fn potential_energy(&self, inertia: &ArmInertia<T>) -> T {
        inertia.potential_energy(&self.lumped)
    }

    #[inline]
    fn tip_offset(&self, heading: Angle<T>, posture: &ArmPosture<T>) -> Vector3<T> {
        posture.tip_offset(self.params(), heading)
    }

    #[inline]
    fn tip_jacobian(&self, heading: Angle<T>, posture: &ArmPosture<T>) -> TipJacobian<T, 3> {
        posture.tip_jacobian(self.params(), heading)
    }

    #[inline]
    fn tip_jacobian_rate(
        &self,
        heading: Angle<T>,
        posture: &ArmPosture<T>,
        nu: &Velocity<T, 3>,
    ) -> TipJacobian<T, 3> {
        posture.tip_jacobian_rate(self.params(), heading, nu)
    }

    #[inline]
    fn manipulability_squared(&self, posture: &ArmPosture<T>) -> T {
        manipulability::squared(self.params(), posture)
    }

    #[inline]
    fn manipulability_slope(&self, posture: &ArmPosture<T>, rates: &[T; 3]) -> ManipulabilitySlope<T, 3> {
        manipulability::slope(self.params(), posture, rates)
    }
}
