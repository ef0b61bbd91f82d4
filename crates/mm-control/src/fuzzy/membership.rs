//! The trapezoid as a membership function.

use super::FuzzyError;
use mm_model::Real;

/// A linguistic term: how far a number belongs to it, between 0 and 1, as a trapezoid.
///
/// Equation: `mu(x) = max(0, min((x - a)/(b - a), 1, (d - x)/(d - c)))` with breakpoints `a <= b <= c <= d`.
///
/// | name | meaning | unit |
/// |---|---|---|
/// | `a`, `d` | feet: degree 0 up to `a` and from `d` on | of the variable |
/// | `b`, `c` | shoulders: degree 1 between them, both included | of the variable |
///
/// Convention: a triangle is a trapezoid with `b = c`. Where breakpoints coincide the side is vertical and the
/// degree there is 1, so that `trimf [a b b]` and `trimf [a a b]` both reach 1 at the doubled breakpoint.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::MembershipFunction;
///
/// let small = MembershipFunction::try_triangle(0.0, 0.25, 0.75)?;
/// assert_eq!(small.degree(0.125), 0.5);
/// assert_eq!(small.degree(0.5), 0.5);
/// assert_eq!(small.degree(0.75), 0.0);
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MembershipFunction<T> {
    a: T,
    b: T,
    c: T,
    d: T,
}

impl<T: Copy> MembershipFunction<T> {
    /// Takes a trapezoid as it is written, for tables in constants; [`Mamdani::try_new`] checks them.
    ///
    /// [`Mamdani::try_new`]: super::Mamdani::try_new
    #[must_use]
    pub const fn from_breakpoints([a, b, c, d]: [T; 4]) -> Self {
        Self { a, b, c, d }
    }

    /// Takes a triangle with its feet at `a` and `d` and its peak at `b`, unchecked like
    /// [`from_breakpoints`](Self::from_breakpoints).
    #[must_use]
    pub const fn from_triangle([a, b, d]: [T; 3]) -> Self {
        Self { a, b, c: b, d }
    }

    /// The breakpoints (a, b, c, d), in the unit of the variable.
    #[must_use]
    pub const fn breakpoints(&self) -> [T; 4] {
        [self.a, self.b, self.c, self.d]
    }
}

impl<T: Real> MembershipFunction<T> {
    /// Builds a trapezoid from its breakpoints, which must be finite and ordered `a <= b <= c <= d`.
    ///
    /// # Errors
    /// [`FuzzyError::NonFinite`] or [`FuzzyError::Inverted`], both naming `breakpoints`.
    pub fn try_trapezoid(a: T, b: T, c: T, d: T) -> Result<Self, FuzzyError> {
        let mf = Self { a, b, c, d };
        mf.check("breakpoints")?;
        Ok(mf)
    }

    /// Builds a triangle with feet `a`, `d` and peak `b`; the trapezoid with `b = c`.
    ///
    /// # Errors
    /// As [`try_trapezoid`](Self::try_trapezoid).
    pub fn try_triangle(a: T, b: T, d: T) -> Result<Self, FuzzyError> {
        Self::try_trapezoid(a, b, b, d)
    }

    /// Degree in [0, 1] to which `x` belongs to this term; 0 for a NaN.
    ///
    /// Cost: four comparisons and at most one division.
    #[must_use]
    #[inline]
    pub fn degree(&self, x: T) -> T {
        if x >= self.b {
            if x <= self.c {
                T::ONE
            } else if x < self.d {
                (self.d - x) / (self.d - self.c)
            } else {
                T::ZERO
            }
        } else if x > self.a {
            (x - self.a) / (self.b - self.a)
        } else {
            T::ZERO
        }
    }

    /// The same breakpoints in another precision, each rounded to the nearest number of it.
    #[must_use]
    pub fn cast<U: Real>(&self) -> MembershipFunction<U> {
        MembershipFunction::from_breakpoints(self.breakpoints().map(|p| U::from_f64(p.to_f64())))
    }

    /// Checks that the breakpoints are finite and ordered, naming `field` in the error.
    pub(super) fn check(&self, field: &'static str) -> Result<(), FuzzyError> {
        if !self.breakpoints().iter().all(|p| p.is_finite()) {
            return Err(FuzzyError::NonFinite(field));
        }
        if self.a <= self.b && self.b <= self.c && self.c <= self.d {
            Ok(())
        } else {
            Err(FuzzyError::Inverted(field))
        }
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the degrees asserted here are exact")]
mod tests {
    use super::{FuzzyError, MembershipFunction};

    #[test]
    fn doubled_breakpoint_belongs_to_the_term() {
        let falling = MembershipFunction::try_triangle(0.0, 0.0, 0.25).unwrap();
        let rising = MembershipFunction::try_triangle(-0.25, 0.0, 0.0).unwrap();
        assert_eq!(falling.degree(0.0), 1.0, "trimf [0 0 0.25] at 0");
        assert_eq!(rising.degree(0.0), 1.0, "trimf [-0.25 0 0] at 0");
        assert_eq!(rising.degree(-0.0), 1.0, "negative zero is zero");
        assert_eq!(falling.degree(-f64::MIN_POSITIVE), 0.0, "left of a vertical side");
        assert_eq!(rising.degree(f64::MIN_POSITIVE), 0.0, "right of a vertical side");
        let spike = MembershipFunction::try_trapezoid(1.0, 1.0, 1.0, 1.0).unwrap();
        assert_eq!((spike.degree(1.0), spike.degree(1.0 + f64::EPSILON)), (1.0, 0.0), "a singleton");
    }

    #[test]
    fn trapezoid_by_hand() {
        let mf = MembershipFunction::try_trapezoid(-1.0_f32, 0.0, 2.0, 6.0).unwrap();
        for (x, degree) in
            [(-2.0, 0.0), (-1.0, 0.0), (-0.5, 0.5), (0.0, 1.0), (1.0, 1.0), (2.0, 1.0), (5.0, 0.25)]
        {
            assert_eq!(mf.degree(x), degree, "degree of {x}");
        }
        assert_eq!(mf.degree(6.0), 0.0, "the right foot");
        assert_eq!(mf.degree(f32::NAN), 0.0, "NaN belongs nowhere");
        assert_eq!(mf.degree(f32::INFINITY), 0.0, "infinity lies beyond the foot");
    }

    #[test]
    fn refuses_disorder_and_nan() {
        let refused = MembershipFunction::try_trapezoid(0.0, 2.0, 1.0, 3.0);
        assert_eq!(refused, Err(FuzzyError::Inverted("breakpoints")), "b > c");
        let refused = MembershipFunction::try_triangle(0.0, f64::NAN, 1.0);
        assert_eq!(refused, Err(FuzzyError::NonFinite("breakpoints")), "NaN peak");
        let refused = MembershipFunction::try_triangle(0.0, 1.0, f64::INFINITY);
        assert_eq!(refused, Err(FuzzyError::NonFinite("breakpoints")), "infinite foot");
    }
}
