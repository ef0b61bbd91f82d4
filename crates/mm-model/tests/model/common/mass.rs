//! The mass matrix in blocks as one 5 x 5 matrix.

use mm_model::{MassMatrix, Real};
use nalgebra::SMatrix;

pub(crate) fn dense<T: Real>(mass: &MassMatrix<T, 3>) -> SMatrix<f64, 5, 5> {
    let mut m = SMatrix::<T, 5, 5>::zeros();
    m.fixed_view_mut::<2, 2>(0, 0).copy_from(&mass.base);
    m.fixed_view_mut::<2, 3>(0, 2).copy_from(&mass.coupling);
    m.fixed_view_mut::<3, 2>(2, 0).copy_from(&mass.coupling.transpose());
    m.fixed_view_mut::<3, 3>(2, 2).copy_from(&mass.arm);
    m.map(Real::to_f64)
}
