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

    /// Sine and cosine of this angle turned on by `delta` radians.
    ///
    /// Equation: for |delta| <= 1/64 the addition theorem with sin(delta) and 1 - cos(delta) by their series, whose first neglected
    /// terms are below 1e-19 of the result; beyond it with [`Real::sin_cos`]. Integrators take small turns from a state whose sines
    /// they know: this costs a fraction of new ones and is as exact, to one rounding.
    #[must_use]
    #[inline(always)]
    pub fn turned_by(self, delta: T) -> Self {
        let n = T::from_f64;
        let (sin, versed) = if delta.abs() <= n(1.0 / 64.0) {
            let square = delta * delta;
            let sin = delta
                - delta * square * (n(1.0 / 6.0) - square * (n(1.0 / 120.0) - square * n(1.0 / 5040.0)));
            let versed = square * (T::HALF - square * (n(1.0 / 24.0) - square * n(1.0 / 720.0)));
            (sin, versed)
        } else {
            let (sin, cos) = delta.sin_cos();
            (sin, T::ONE - cos)
        };
        Self {
            sin: self.sin + (self.cos * sin - self.sin * versed),
            cos: self.cos - (self.sin * sin + self.cos * versed),
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

#[cfg(test)]
mod tests {
    use super::Angle;

    /// Law: a turned angle has the sine and cosine of the sum. Reference: libm at the sum. Tolerance: two roundings, and the
    /// rounding of the sum itself.
    #[test]
    fn a_turn_is_the_angle_of_the_sum() {
        for i in -2000..2000_i32 {
            for j in -40..40_i32 {
                let (angle, delta) = (f64::from(i) * 0.0137, f64::from(j) * 0.00079);
                let (turned, whole) = (Angle::of(angle).turned_by(delta), Angle::of(angle + delta));
                let worst = (turned.sin - whole.sin).abs().max((turned.cos - whole.cos).abs());
                let tolerance = f64::EPSILON * (2.0 + angle.abs());
                assert!(worst <= tolerance, "{worst} at {angle} turned by {delta}");
            }
        }
    }
}
