//! The crate's block vectors and matrices as plain 5-vectors and 5 x 5 matrices.

use mm_model::{Configuration, Force, MassMatrix, Mechanism, Real, Robot, Velocity};
use nalgebra::{SMatrix, SVector};

pub(crate) type Vector = SVector<f64, 5>;
pub(crate) type Matrix = SMatrix<f64, 5, 5>;

pub(crate) fn of_velocity<T: Real>(nu: &Velocity<T, 3>) -> Vector {
    Vector::from_iterator(nu.channels().map(Real::to_f64))
}

pub(crate) fn of_force<T: Real>(force: &Force<T, 3>) -> Vector {
    Vector::from_iterator(force.channels().map(Real::to_f64))
}

pub(crate) fn of_mass<T: Real>(mass: &MassMatrix<T, 3>) -> Matrix {
    let mut m = SMatrix::<T, 5, 5>::zeros();
    m.fixed_view_mut::<2, 2>(0, 0).copy_from(&mass.base);
    m.fixed_view_mut::<2, 3>(0, 2).copy_from(&mass.coupling);
    m.fixed_view_mut::<3, 2>(2, 0).copy_from(&mass.coupling.transpose());
    m.fixed_view_mut::<3, 3>(2, 2).copy_from(&mass.arm);
    m.map(Real::to_f64)
}

/// The Coriolis matrix of the robot, from its columns.
pub(crate) fn coriolis<T: Real>(robot: &Robot<T, 3>, q: &Configuration<T, 3>, nu: &Velocity<T, 3>) -> Matrix
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    let columns: Vec<Vector> = robot.coriolis_columns(q, nu).map(|column| of_force(&column)).collect();
    Matrix::from_columns(&columns)
}
