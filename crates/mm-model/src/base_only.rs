//! The mobile robot alone (3.76, 3.77): the mechanism without an arm.

use nalgebra::{Matrix2, SMatrix, Vector3};

use crate::mechanism::ManipulabilitySlope;
use crate::{Angle, Force, MassMatrix, Mechanism, Real, Robot, TipJacobian, Velocity};

/// The base alone. Its "tip" is the point on which an arm would stand.
///
/// Reducing (3.76), with its misprints mended, by S(q) gives (3.77) as M = diag(m, I_b + m d^2),
/// C nu = m d omega (-omega, v), no gravity. Two quasi-velocities cannot span three directions: det(J J') is 0.
impl<T: Real> Mechanism<T, 0> for Robot<T, 0> {
    type Posture = ();
    type Inertia = ();

    fn posture(&self, _joints: &[T; 0]) {}

    fn inertia(&self, _posture: &()) {}

    fn mass_matrix(&self, _inertia: &()) -> MassMatrix<T, 0> {
        let k = &self.lumped;
        MassMatrix {
            base: Matrix2::new(k.mass, T::ZERO, T::ZERO, k.base_yaw),
            coupling: SMatrix::zeros(),
            arm: SMatrix::zeros(),
        }
    }

    fn mass_product(&self, _inertia: &(), a: &Velocity<T, 0>) -> Force<T, 0> {
        let k = &self.lumped;
        Force { forward: k.mass * a.forward, yaw: k.base_yaw * a.yaw_rate, joints: [] }
    }

    fn coriolis_product(&self, _inertia: &(), nu: &Velocity<T, 0>, nu_r: &Velocity<T, 0>) -> Force<T, 0> {
        let turn = self.lumped.moment * nu.yaw_rate;
        Force { forward: -(turn * nu_r.yaw_rate), yaw: turn * nu_r.forward, joints: [] }
    }

    fn coriolis_transpose_product(&self, _inertia: &(), nu: &Velocity<T, 0>) -> Force<T, 0> {
        let turn = self.lumped.moment * nu.yaw_rate;
        Force { forward: turn * nu.yaw_rate, yaw: -(turn * nu.forward), joints: [] }
    }

    fn gravity(&self, _inertia: &()) -> Force<T, 0> {
        Force::zero()
    }

    fn solve(&self, _inertia: &(), force: &Force<T, 0>) -> Velocity<T, 0> {
        let k = &self.lumped;
        Velocity {
            forward: force.forward * k.inverse_mass,
            yaw_rate: force.yaw * k.inverse_base_yaw,
            joints: [],
        }
    }

    fn potential_energy(&self, _inertia: &()) -> T {
        T::ZERO
    }

    fn tip_offset(&self, heading: Angle<T>, _posture: &()) -> Vector3<T> {
        let p = self.params();
        Vector3::new(p.arm_offset * heading.cos, p.arm_offset * heading.sin, p.mount_height)
    }

    fn tip_jacobian(&self, heading: Angle<T>, _posture: &()) -> TipJacobian<T, 0> {
        let lb = self.params().arm_offset;
        TipJacobian {
            forward: Vector3::new(heading.cos, heading.sin, T::ZERO),
            yaw_rate: Vector3::new(-(lb * heading.sin), lb * heading.cos, T::ZERO),
            joints: [],
        }
    }

    fn tip_jacobian_rate(&self, heading: Angle<T>, _posture: &(), nu: &Velocity<T, 0>) -> TipJacobian<T, 0> {
        let (lb, omega) = (self.params().arm_offset, nu.yaw_rate);
        TipJacobian {
            forward: Vector3::new(-(omega * heading.sin), omega * heading.cos, T::ZERO),
            yaw_rate: Vector3::new(-(lb * omega * heading.cos), -(lb * omega * heading.sin), T::ZERO),
            joints: [],
        }
    }

    fn manipulability_squared(&self, _posture: &()) -> T {
        T::ZERO
    }

    fn manipulability_slope(&self, _posture: &(), _rates: &[T; 0]) -> ManipulabilitySlope<T, 0> {
        ManipulabilitySlope { gradient: [], rate: [] }
    }
}
