//! The tip Jacobian, column by column.

use nalgebra::{SMatrix, Vector3};

use crate::{Force, Real, Velocity};

/// A 3 x (2 + N) matrix that maps quasi-velocities to the velocity of the tip, kept as its columns.
///
/// The columns carry the names of the velocities that they multiply; each is a vector in world directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipJacobian<T, const N: usize> {
    /// Tip velocity per forward speed, 1.
    pub forward: Vector3<T>,
    /// Tip velocity per yaw rate, m/rad.
    pub yaw_rate: Vector3<T>,
    /// Tip velocity per joint rate, m/rad.
    pub joints: [Vector3<T>; N],
}

impl<T: Real, const N: usize> TipJacobian<T, N> {
    /// The product J nu: a velocity of the tip, m/s.
    #[must_use]
    #[inline]
    pub fn product(&self, nu: &Velocity<T, N>) -> Vector3<T> {
        let base = self.forward * nu.forward + self.yaw_rate * nu.yaw_rate;
        self.joints.iter().zip(nu.joints).fold(base, |sum, (column, rate)| sum + column * rate)
    }

    /// The product J_arm dq: the tip velocity of the joints alone, the base standing still, m/s.
    #[must_use]
    #[inline]
    pub fn joint_product(&self, rates: &[T; N]) -> Vector3<T> {
        self.joints.iter().zip(rates).fold(Vector3::zeros(), |sum, (column, &rate)| sum + column * rate)
    }

    /// The product J' f by channel: what a force `f` at the tip, N, does along each quasi-velocity.
    ///
    /// For the joints these are the torques of (3.49), there written the other way round.
    #[must_use]
    #[inline]
    pub fn transpose_product(&self, f: &Vector3<T>) -> Force<T, N> {
        Force {
            forward: dot(&self.forward, f),
            yaw: dot(&self.yaw_rate, f),
            joints: self.joints.map(|column| dot(&column, f)),
        }
    }

    /// Folds over the columns, each with the weight of its channel, in the order of the channels.
    #[inline]
    pub fn fold_weighted<A>(
        &self,
        weights: &Velocity<T, N>,
        first: A,
        mut fold: impl FnMut(A, &Vector3<T>, T) -> A,
    ) -> A {
        let base = fold(first, &self.forward, weights.forward);
        let base = fold(base, &self.yaw_rate, weights.yaw_rate);
        self.joints.iter().zip(&weights.joints).fold(base, |sum, (column, &weight)| fold(sum, column, weight))
    }

    /// The column of a channel, by its number; none beyond the last.
    #[must_use]
    #[inline]
    pub fn column(&self, channel: usize) -> Option<&Vector3<T>> {
        match channel {
            0 => Some(&self.forward),
            1 => Some(&self.yaw_rate),
            _ => self.joints.get(channel - 2),
        }
    }

    /// The columns in the order of the channels.
    #[inline]
    pub fn columns(&self) -> impl Iterator<Item = &Vector3<T>> {
        [&self.forward, &self.yaw_rate].into_iter().chain(&self.joints)
    }
}

impl<T: Real> TipJacobian<T, 3> {
    /// The same Jacobian as one 3 x 5 matrix.
    #[must_use]
    pub fn to_matrix(&self) -> SMatrix<T, 3, 5> {
        let [j1, j2, j3] = self.joints;
        SMatrix::from_columns(&[self.forward, self.yaw_rate, j1, j2, j3])
    }
}

/// Inner product of two vectors, in a fixed order.
#[inline]
pub(crate) fn dot<T: Real>(a: &Vector3<T>, b: &Vector3<T>) -> T {
    a.x * b.x + a.y * b.y + a.z * b.z
}
