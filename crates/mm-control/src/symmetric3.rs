//! A symmetric 3 x 3 system, solved by L D L'.

use mm_model::Real;
use nalgebra::Vector3;

/// The six entries of a symmetric 3 x 3 matrix.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Symmetric3<T> {
    xx: T,
    xy: T,
    xz: T,
    yy: T,
    yz: T,
    zz: T,
}

/// L D L' of such a matrix, with the pivots inverted.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Factor3<T> {
    per_x: T,
    per_y: T,
    per_z: T,
    yx: T,
    zx: T,
    zy: T,
}

impl<T: Real> Symmetric3<T> {
    #[inline]
    pub(crate) fn scaled_identity(value: T) -> Self {
        Self { xx: value, xy: T::ZERO, xz: T::ZERO, yy: value, yz: T::ZERO, zz: value }
    }

    /// This matrix plus `weight v v'`.
    #[inline]
    pub(crate) fn plus_outer(self, v: &Vector3<T>, weight: T) -> Self {
        let (x, y) = (v.x * weight, v.y * weight);
        Self {
            xx: self.xx + x * v.x,
            xy: self.xy + x * v.y,
            xz: self.xz + x * v.z,
            yy: self.yy + y * v.y,
            yz: self.yz + y * v.z,
            zz: self.zz + v.z * weight * v.z,
        }
    }

    /// This matrix plus `weight (a b' + b a')`.
    pub(crate) fn plus_both(self, a: &Vector3<T>, b: &Vector3<T>, weight: T) -> Self {
        let (x, y, z) = (a.x * weight, a.y * weight, a.z * weight);
        Self {
            xx: self.xx + T::TWO * x * b.x,
            xy: self.xy + x * b.y + y * b.x,
            xz: self.xz + x * b.z + z * b.x,
            yy: self.yy + T::TWO * y * b.y,
            yz: self.yz + y * b.z + z * b.y,
            zz: self.zz + T::TWO * z * b.z,
        }
    }

    /// The determinant, and its rate where this matrix changes at `rate`: the adjugate times the rate, summed over all entries.
    pub(crate) fn determinant(&self, rate: &Self) -> (T, T) {
        let Self { xx, xy, xz, yy, yz, zz } = *self;
        let (axx, ayy, azz) = (yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
        let (axy, axz, ayz) = (xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz);
        let diagonal = axx * rate.xx + ayy * rate.yy + azz * rate.zz;
        let beside = axy * rate.xy + axz * rate.xz + ayz * rate.yz;
        (xx * axx + xy * axy + xz * axz, diagonal + T::TWO * beside)
    }

    /// Factorizes; a pivot that rounding has eaten up is replaced by the smallest that it can be told from.
    #[inline]
    pub(crate) fn factor(&self) -> Factor3<T> {
        let floor = (self.xx + self.yy + self.zz) * T::EPSILON;
        let inverse = |pivot: T| T::ONE / if pivot > floor { pivot } else { floor };
        let per_x = inverse(self.xx);
        let (yx, zx) = (self.xy * per_x, self.xz * per_x);
        let per_y = inverse(self.yy - yx * self.xy);
        let rest = self.yz - zx * self.xy;
        let zy = rest * per_y;
        let per_z = inverse(self.zz - zx * self.xz - zy * rest);
        Factor3 { per_x, per_y, per_z, yx, zx, zy }
    }
}

impl<T: Real> Factor3<T> {
    #[inline]
    pub(crate) fn solve(&self, b: &Vector3<T>) -> Vector3<T> {
        let y = b.y - self.yx * b.x;
        let z = (b.z - self.zx * b.x - self.zy * y) * self.per_z;
        let y = y * self.per_y - self.zy * z;
        let x = b.x * self.per_x - self.yx * y - self.zx * z;
        Vector3::new(x, y, z)
    }
}
