//! The mass matrix in blocks, and its factorization.

use nalgebra::{Matrix2, SMatrix};

use crate::{Force, Real, Velocity};

/// The reduced mass matrix M(q), symmetric and positive definite, in blocks of base and arm.
///
/// ```text
/// M = [ base       coupling ]     base 2 x 2, coupling 2 x N, arm N x N
///     [ coupling'  arm      ]
/// ```
/// Rows and columns follow [`Velocity`]: forward, yaw rate, joints. Units kg, kg m, kg m^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassMatrix<T: Real, const N: usize> {
    /// Forward speed and yaw rate among themselves.
    pub base: Matrix2<T>,
    /// Base against joints.
    pub coupling: SMatrix<T, 2, N>,
    /// Joints among themselves.
    pub arm: SMatrix<T, N, N>,
}

/// A Cholesky factorization of a [`MassMatrix`], base first.
///
/// With M = L L': `base` is the lower triangle of L's base block, `coupling` holds the rows of the joints against the
/// base, transposed, and `arm` the lower triangle of what is left for the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassFactor<T: Real, const N: usize> {
    base: (T, T, T),
    coupling: [(T, T); N],
    arm: [[T; N]; N],
}

impl<T: Real, const N: usize> MassMatrix<T, N> {
    /// The product M a: the generalized force that gives the acceleration `a`, all else left out.
    #[must_use]
    pub fn product(&self, a: &Velocity<T, N>) -> Force<T, N> {
        let [[b11, b21], [b12, b22]] = self.base.data.0;
        let mut out = Force {
            forward: b11 * a.forward + b12 * a.yaw_rate,
            yaw: b21 * a.forward + b22 * a.yaw_rate,
            joints: [T::ZERO; N],
        };
        let columns = self.coupling.column_iter().zip(self.arm.column_iter());
        for (((couple, column), &rate), force) in columns.clone().zip(&a.joints).zip(&mut out.joints) {
            let [c1, c2] = [couple.x, couple.y];
            out.forward += c1 * rate;
            out.yaw += c2 * rate;
            *force = c1 * a.forward + c2 * a.yaw_rate;
            // The matrix is symmetric, so that its column is its row.
            for (&entry, &other) in column.iter().zip(&a.joints) {
                *force += entry * other;
            }
        }
        out
    }

    /// The Cholesky factorization M = L L', base first; `None` where M is not positive definite.
    ///
    /// Cost: 2 + N square roots and divisions, O(N^3) multiplications.
    #[must_use]
    pub fn factor(&self) -> Option<MassFactor<T, N>> {
        let [[b11, b21], [_, b22]] = self.base.data.0;
        let l11 = positive_root(b11)?;
        let l21 = b21 / l11;
        let l22 = positive_root(b22 - l21 * l21)?;
        let mut coupling = [(T::ZERO, T::ZERO); N];
        for (out, column) in coupling.iter_mut().zip(self.coupling.column_iter()) {
            let first = column.x / l11;
            *out = (first, (column.y - l21 * first) / l22);
        }
        let mut arm = [[T::ZERO; N]; N];
        for (i, row_of_m) in self.arm.column_iter().enumerate() {
            let &(ci1, ci2) = coupling.get(i)?;
            let mut row = [T::ZERO; N];
            for (j, &entry) in row_of_m.iter().enumerate().take(i + 1) {
                let &(cj1, cj2) = coupling.get(j)?;
                let mut rest = entry - ci1 * cj1 - ci2 * cj2;
                let other = if j == i { row } else { *arm.get(j)? };
                for (&a, &b) in row.iter().zip(&other).take(j) {
                    rest -= a * b;
                }
                *row.get_mut(j)? = if j == i { positive_root(rest)? } else { rest / *other.get(j)? };
            }
            *arm.get_mut(i)? = row;
        }
        Some(MassFactor { base: (l11, l21, l22), coupling, arm })
    }
}

impl<T: Real, const N: usize> MassFactor<T, N> {
    /// The acceleration a with M a = `force`.
    #[must_use]
    pub fn solve(&self, force: &Force<T, N>) -> Velocity<T, N> {
        let (l11, l21, l22) = self.base;
        let y1 = force.forward / l11;
        let y2 = (force.yaw - l21 * y1) / l22;
        let mut y = force.joints;
        for (i, (row, &(c1, c2))) in self.arm.iter().zip(&self.coupling).enumerate() {
            let (done, rest) = y.split_at_mut(i);
            if let ([value, ..], Some(&pivot)) = (rest, row.get(i)) {
                let known = row.iter().zip(done.iter()).fold(c1 * y1 + c2 * y2, |sum, (&a, &b)| sum + a * b);
                *value = (*value - known) / pivot;
            }
        }
        for (i, row) in self.arm.iter().enumerate().rev() {
            let (before, rest) = y.split_at_mut(i);
            if let ([value, ..], Some(&pivot)) = (rest, row.get(i)) {
                *value /= pivot;
                for (other, &entry) in before.iter_mut().zip(row) {
                    *other -= entry * *value;
                }
            }
        }
        let (mut z1, mut z2) = (y1, y2);
        for (&(c1, c2), &joint) in self.coupling.iter().zip(&y) {
            z1 -= c1 * joint;
            z2 -= c2 * joint;
        }
        let yaw_rate = z2 / l22;
        Velocity { forward: (z1 - l21 * yaw_rate) / l11, yaw_rate, joints: y }
    }
}

/// The square root of a number above zero.
fn positive_root<T: Real>(value: T) -> Option<T> {
    (value > T::ZERO).then(|| value.sqrt())
}
