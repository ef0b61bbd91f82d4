//! Sine and cosine kept together: the only form in which the formulas take an angle.

use crate::Real;

/// Sine and cosine of one angle.
///
/// Sums of angles are formed from them by the addition theorems, which cost four multiplications instead of two
/// more transcendental functions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Angle<T> {
    /// Sine.
    pub sin: T,
    /// Cosine.
    pub cos: T,
}

impl<T: Real> Angle<T> {
    /// Sine and cosine of `radians`.
    #[must_use]
    #[inline]
    pub fn of(radians: T) -> Self {
        let (sin, cos) = radians.sin_cos();
        Self { sin, cos }
    }

    /// Sine and cosine of the sum of two angles.
    #[must_use]
    #[inline]
    pub fn plus(self, other: Self) -> Self {
        Self {
            sin: self.sin * other.cos + self.cos * other.sin,
            cos: self.cos * other.cos - self.sin * other.sin,
        }
    }

    /// Sine and cosine of this angle less another.
    #[must_use]
    #[inline]
    pub fn minus(self, other: Self) -> Self {
        Self {
            sin: self.sin * other.cos - self.cos * other.sin,
            cos: self.cos * other.cos + self.sin * other.sin,
        }
    }
}
