//! The Coriolis matrix as one 5 x 5 matrix.

use mm_model::{Configuration, Mechanism, Real, Robot, Velocity};
use nalgebra::SMatrix;

use super::vectors::{Vector, of_force};

/// The Coriolis matrix of the robot, from its columns.
pub(crate) fn matrix<T: Real>(
    robot: &Robot<T, 3>,
    q: &Configuration<T, 3>,
    nu: &Velocity<T, 3>,
) -> SMatrix<f64, 5, 5>
where
    Robot<T, 3>: Mechanism<T, 3>,
{
    let columns: Vec<Vector> = robot.coriolis_columns(q, nu).map(|column| of_force(&column)).collect();
    SMatrix::from_columns(&columns)
}
