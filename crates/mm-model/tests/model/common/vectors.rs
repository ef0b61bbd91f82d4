//! The crate's block vectors as plain 5-vectors.

use mm_model::{Force, Real, Velocity};
use nalgebra::SVector;

pub(crate) type Vector = SVector<f64, 5>;

pub(crate) fn of_velocity<T: Real>(nu: &Velocity<T, 3>) -> Vector {
    Vector::from_iterator(nu.channels().map(Real::to_f64))
}

pub(crate) fn of_force<T: Real>(force: &Force<T, 3>) -> Vector {
    Vector::from_iterator(force.channels().map(Real::to_f64))
}
