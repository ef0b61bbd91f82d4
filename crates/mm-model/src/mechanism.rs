//! What a robot has to be able to compute: the contract between parameters and everything above.

use core::fmt::Debug;
use nalgebra::Vector3;

use crate::{Angle, Force, MassMatrix, Real, Robot, TipJacobian, Velocity};

/// A mechanism whose kinematics and equations of motion are known in closed form.
///
/// Implemented by [`Robot<T, 3>`](crate::Robot) (yaw-pitch-pitch arm on the base) and [`Robot<T, 0>`](crate::Robot) (the
/// base alone). The two associated types hold what several quantities share, so that a caller who needs more than one of
/// them pays for the sines and the common terms once:
///
/// ```text
/// joints --posture--> Posture --inertia--> Inertia --> M a, C nu, g, M^-1 f
///                        '--> tip, Jacobian, manipulability
/// ```
///
/// The equations of motion are `M(q) nu' + C(q, nu) nu + g(q) + friction = f`, already free of constraint forces (the
/// reduced form (3.100) and (4.16)), in the base frame: nothing here depends on x, y or, the tip aside, the heading.
pub trait Mechanism<T: Real, const N: usize> {
    /// Sines and cosines of the joints.
    type Posture: Copy + Debug;
    /// Posture-dependent terms of the equations of motion.
    type Inertia: Copy + Debug;

    /// Sines and cosines of the joint angles: the only transcendental functions of an evaluation.
    fn posture(&self, joints: &[T; N]) -> Self::Posture;

    /// Terms that the mass matrix, the Coriolis products and gravity share.
    fn inertia(&self, posture: &Self::Posture) -> Self::Inertia;

    /// Mass matrix M(q).
    fn mass_matrix(&self, inertia: &Self::Inertia) -> MassMatrix<T, N>;

    /// Product M(q) a, without forming M.
    fn mass_product(&self, inertia: &Self::Inertia, a: &Velocity<T, N>) -> Force<T, N>;

    /// Product C(q, nu) nu_r, without forming C, for the C that makes dM/dt - 2C skew (Property 3).
    fn coriolis_product(
        &self,
        inertia: &Self::Inertia,
        nu: &Velocity<T, N>,
        nu_r: &Velocity<T, N>,
    ) -> Force<T, N>;

    /// Product C(q, nu)' nu: with it, d(M nu)/dt = f + C' nu - g.
    fn coriolis_transpose_product(&self, inertia: &Self::Inertia, nu: &Velocity<T, N>) -> Force<T, N>;

    /// Gravity g(q), on the left-hand side: the force that holds the arm still.
    fn gravity(&self, inertia: &Self::Inertia) -> Force<T, N>;

    /// The acceleration a with M(q) a = `force`.
    fn solve(&self, inertia: &Self::Inertia, force: &Force<T, N>) -> Velocity<T, N>;

    /// Potential energy of the arm, zero with every link's centre of mass on the ground, J.
    fn potential_energy(&self, inertia: &Self::Inertia) -> T;

    /// Tip relative to the axle's midpoint on the ground, in world directions, m (3.55).
    fn tip_offset(&self, heading: Angle<T>, posture: &Self::Posture) -> Vector3<T>;

    /// Tip Jacobian J: dp/dt = J nu.
    fn tip_jacobian(&self, heading: Angle<T>, posture: &Self::Posture) -> TipJacobian<T, N>;

    /// Rate of the tip Jacobian at velocity `nu`.
    fn tip_jacobian_rate(
        &self,
        heading: Angle<T>,
        posture: &Self::Posture,
        nu: &Velocity<T, N>,
    ) -> TipJacobian<T, N>;

    /// Determinant of J J': the square of the manipulability, m^6 in mixed units.
    fn manipulability_squared(&self, posture: &Self::Posture) -> T;

    /// Gradient of det(J J') by the joint angles, and the rate of that gradient at joint rates `rates`.
    fn manipulability_slope(&self, posture: &Self::Posture, rates: &[T; N]) -> ManipulabilitySlope<T, N>;
}

/// Sines and cosines of a configuration: everything transcendental in it.
///
/// They depend on the angles alone, not on the robot's parameters: a simulator shares them between plant and controller.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sines<T, P> {
    /// Of the heading.
    pub heading: Angle<T>,
    /// Of the joints.
    pub posture: P,
}

/// [`Sines`] of a robot with N joints.
pub type SinesOf<T, const N: usize> = Sines<T, <Robot<T, N> as Mechanism<T, N>>::Posture>;

/// Gradient of det(J J') by the joint angles, and how it changes along a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManipulabilitySlope<T, const N: usize> {
    /// Partial derivatives of det(J J') by the joint angles, 1/rad.
    pub gradient: [T; N],
    /// Time derivative of `gradient`, 1/(rad s).
    pub rate: [T; N],
}
