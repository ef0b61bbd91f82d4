//! Membership functions: how far a number belongs to a linguistic term.

use super::FuzzyError;
use mm_model::Real;

/// A linguistic term: the degree between 0 and 1 to which a number belongs to it.
///
/// The parameters are those of a `.fis` file, in its order and in the unit of the variable.
///
/// | variant | `.fis` | degree of x |
/// |---|---|---|
/// | `Triangle([a, b, c])` | `trimf` | rises from `a` to 1 at `b`, falls to 0 at `c` |
/// | `Trapezoid([a, b, c, d])` | `trapmf` | rises from `a` to 1 at `b`, 1 up to `c`, falls to 0 at `d` |
/// | `LinearS([a, b])` | `linsmf` | 0 up to `a`, 1 from `b` on |
/// | `LinearZ([a, b])` | `linzmf` | 1 up to `a`, 0 from `b` on |
/// | `Gaussian([s, c])` | `gaussmf` | `exp(-((x - c)/s)^2 / 2)` |
/// | `Gaussian2([s1, c1, s2, c2])` | `gauss2mf` | the left side of the first times the right side of the second, each 1 beyond its centre |
/// | `Bell([a, b, c])` | `gbellmf` | `1 / (1 + abs((x - c)/a)^(2 b))` |
/// | `Sigmoid([a, c])` | `sigmf` | `1 / (1 + exp(-a (x - c)))` |
/// | `SigmoidDifference([a1, c1, a2, c2])` | `dsigmf` | the magnitude of the difference of two sigmoids |
/// | `SigmoidProduct([a1, c1, a2, c2])` | `psigmf` | the product of two sigmoids |
/// | `S([a, b])` | `smf` | 0 up to `a`, two parabolas, 1 from `b` on |
/// | `Z([a, b])` | `zmf` | 1 up to `a`, two parabolas, 0 from `b` on |
/// | `Pi([a, b, c, d])` | `pimf` | `S([a, b])` times `Z([c, d])` |
///
/// Convention: where breakpoints coincide the side is vertical and the degree there is 1, so that both
/// `Triangle([a, b, b])` and `Triangle([b, b, c])` reach 1 at the doubled breakpoint. An `S` or `Z` whose `a` is not
/// below `b` is a step halfway between them.
///
/// Precision: the first four are exact up to one division; the others go through `exp` and `powf` of
/// [`Real`], the same bits on every machine.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::MembershipFunction;
///
/// let small = MembershipFunction::Triangle([0.0, 0.25, 0.75]);
/// assert_eq!(small.degree(0.125), 0.5);
/// assert_eq!(small.degree(0.5), 0.5);
/// assert_eq!(small.degree(0.75), 0.0);
/// let near = MembershipFunction::Gaussian([0.5, 2.0]);
/// assert_eq!(near.degree(2.0), 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MembershipFunction<T> {
    /// `trimf`: feet `a` and `c`, peak `b`.
    Triangle([T; 3]),
    /// `trapmf`: feet `a` and `d`, shoulders `b` and `c`.
    Trapezoid([T; 4]),
    /// `linsmf`: rises linearly from `a` to `b` and stays.
    LinearS([T; 2]),
    /// `linzmf`: falls linearly from `a` to `b` and stays.
    LinearZ([T; 2]),
    /// `gaussmf`: width `s`, centre `c`.
    Gaussian([T; 2]),
    /// `gauss2mf`: width and centre of the left side, then of the right side.
    Gaussian2([T; 4]),
    /// `gbellmf`: half-width `a`, steepness `b`, centre `c`.
    Bell([T; 3]),
    /// `sigmf`: slope `a`, centre `c`.
    Sigmoid([T; 2]),
    /// `dsigmf`: slope and centre of each of two sigmoids.
    SigmoidDifference([T; 4]),
    /// `psigmf`: slope and centre of each of two sigmoids.
    SigmoidProduct([T; 4]),
    /// `smf`: rises smoothly from `a` to `b`.
    S([T; 2]),
    /// `zmf`: falls smoothly from `a` to `b`.
    Z([T; 2]),
    /// `pimf`: rises smoothly from `a` to `b`, falls smoothly from `c` to `d`.
    Pi([T; 4]),
}

impl<T: Real> MembershipFunction<T> {
    /// Degree in [0, 1] to which `x` belongs to this term; 0 for a NaN.
    ///
    /// Cost: comparisons and at most one division for the piecewise-linear shapes.
    #[must_use]
    #[inline]
    pub fn degree(&self, x: T) -> T {
        match *self {
            Self::Triangle([a, b, c]) => trapezoid(x, a, b, b, c),
            Self::Trapezoid([a, b, c, d]) => trapezoid(x, a, b, c, d),
            _ => self.rarer_degree(x),
        }
    }

    /// The other shapes; kept out of line, they are the rarer ones on a small machine.
    #[inline(never)]
    fn rarer_degree(&self, x: T) -> T {
        let degree = match *self {
            Self::LinearS([a, b]) => rising(x, a, b),
            Self::LinearZ([a, b]) => rising(-x, -b, -a),
            Self::Gaussian([s, c]) => bell_curve(x, s, c),
            Self::Gaussian2([s1, c1, s2, c2]) => {
                let left = if x < c1 { bell_curve(x, s1, c1) } else { T::ONE };
                let right = if x > c2 { bell_curve(x, s2, c2) } else { T::ONE };
                left * right
            }
            Self::Bell([a, b, c]) => T::ONE / (T::ONE + ((x - c) / a).abs().powf(b + b)),
            Self::Sigmoid([a, c]) => sigmoid(x, a, c),
            Self::SigmoidDifference([a1, c1, a2, c2]) => (sigmoid(x, a1, c1) - sigmoid(x, a2, c2)).abs(),
            Self::SigmoidProduct([a1, c1, a2, c2]) => sigmoid(x, a1, c1) * sigmoid(x, a2, c2),
            Self::S([a, b]) => parabolas(x, a, b),
            Self::Z([a, b]) => parabolas(-x, -b, -a),
            Self::Pi([a, b, c, d]) => parabolas(x, a, b) * parabolas(-x, -d, -c),
            Self::Triangle(_) | Self::Trapezoid(_) => T::ZERO,
        };
        if degree >= T::ZERO && x.abs() >= T::ZERO { degree } else { T::ZERO }
    }

    /// The parameters as a `.fis` file lists them.
    #[must_use]
    pub const fn parameters(&self) -> &[T] {
        match self {
            Self::Triangle(p) | Self::Bell(p) => p,
            Self::Trapezoid(p)
            | Self::Gaussian2(p)
            | Self::SigmoidDifference(p)
            | Self::SigmoidProduct(p)
            | Self::Pi(p) => p,
            Self::LinearS(p)
            | Self::LinearZ(p)
            | Self::Gaussian(p)
            | Self::Sigmoid(p)
            | Self::S(p)
            | Self::Z(p) => p,
        }
    }

    /// The breakpoints (a, b, c, d) of a piecewise-linear shape over the range [`lo`, `hi`]: feet and shoulders.
    ///
    /// A side that never ends is cut off where it no longer matters. `None` for a curved shape.
    #[must_use]
    pub fn corners(&self, lo: T, hi: T) -> Option<[T; 4]> {
        match *self {
            Self::Triangle([a, b, c]) => Some([a, b, b, c]),
            Self::Trapezoid(corners) => Some(corners),
            Self::LinearS([a, b]) => Some([a, b, b.max(hi), b.max(hi)]),
            Self::LinearZ([a, b]) => Some([a.min(lo), a.min(lo), a, b]),
            _ => None,
        }
    }

    /// Checks the parameters, naming `field` in the error.
    ///
    /// # Errors
    /// [`FuzzyError::NonFinite`] numbers, [`FuzzyError::Inverted`] breakpoints of a piecewise-linear shape, and
    /// [`FuzzyError::OutOfRange`] for a width of zero.
    pub fn check(&self, field: &'static str) -> Result<(), FuzzyError> {
        if !self.parameters().iter().all(|p| p.is_finite()) {
            return Err(FuzzyError::NonFinite(field));
        }
        match *self {
            Self::Gaussian([s, _]) | Self::Bell([s, ..]) if s.abs() <= T::ZERO => {
                Err(FuzzyError::OutOfRange(field))
            }
            Self::Gaussian2([s1, _, s2, _]) if s1.abs() <= T::ZERO || s2.abs() <= T::ZERO => {
                Err(FuzzyError::OutOfRange(field))
            }
            Self::Triangle(_) | Self::Trapezoid(_) | Self::LinearS(_) | Self::LinearZ(_) => {
                let ordered = self.parameters().is_sorted();
                if ordered { Ok(()) } else { Err(FuzzyError::Inverted(field)) }
            }
            _ => Ok(()),
        }
    }
}

#[inline]
fn trapezoid<T: Real>(x: T, a: T, b: T, c: T, d: T) -> T {
    if x >= b {
        if x <= c {
            T::ONE
        } else if x < d {
            (d - x) / (d - c)
        } else {
            T::ZERO
        }
    } else if x > a {
        (x - a) / (b - a)
    } else {
        T::ZERO
    }
}

#[inline]
fn rising<T: Real>(x: T, a: T, b: T) -> T {
    if x >= b {
        T::ONE
    } else if x > a {
        (x - a) / (b - a)
    } else {
        T::ZERO
    }
}

fn bell_curve<T: Real>(x: T, s: T, c: T) -> T {
    let z = (x - c) / s;
    (-T::HALF * z * z).exp()
}

fn sigmoid<T: Real>(x: T, a: T, c: T) -> T {
    T::ONE / (T::ONE + (-(a * (x - c))).exp())
}

/// Two parabolas from 0 at `a` to 1 at `b`, or a step halfway between where `a` is not below `b`.
fn parabolas<T: Real>(x: T, a: T, b: T) -> T {
    let middle = T::HALF * a + T::HALF * b;
    if a >= b {
        return if x >= middle { T::ONE } else { T::ZERO };
    }
    if x >= b {
        T::ONE
    } else if x > middle {
        let u = (b - x) / (b - a);
        T::ONE - T::TWO * u * u
    } else if x > a {
        let u = (x - a) / (b - a);
        T::TWO * u * u
    } else {
        T::ZERO
    }
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the degrees asserted here are exact")]
mod tests {
    use super::{FuzzyError, MembershipFunction as Mf};

    #[test]
    fn doubled_breakpoint_belongs_to_the_term() {
        let falling = Mf::Triangle([0.0, 0.0, 0.25]);
        let rising = Mf::Triangle([-0.25, 0.0, 0.0]);
        assert_eq!(falling.degree(0.0), 1.0, "trimf [0 0 0.25] at 0");
        assert_eq!(rising.degree(0.0), 1.0, "trimf [-0.25 0 0] at 0");
        assert_eq!(rising.degree(-0.0), 1.0, "negative zero is zero");
        assert_eq!(falling.degree(-f64::MIN_POSITIVE), 0.0, "left of a vertical side");
        assert_eq!(rising.degree(f64::MIN_POSITIVE), 0.0, "right of a vertical side");
        let spike = Mf::Trapezoid([1.0, 1.0, 1.0, 1.0]);
        assert_eq!((spike.degree(1.0), spike.degree(1.0 + f64::EPSILON)), (1.0, 0.0), "a singleton");
        let (s, z) = (Mf::LinearS([1.0, 1.0]), Mf::LinearZ([1.0, 1.0]));
        assert_eq!(
            (s.degree(1.0), s.degree(0.99), z.degree(1.0), z.degree(1.01)),
            (1.0, 0.0, 1.0, 0.0),
            "steps"
        );
    }

    #[test]
    fn shapes_by_hand() {
        let trapezoid = Mf::Trapezoid([-1.0_f32, 0.0, 2.0, 6.0]);
        for (x, degree) in [
            (-2.0, 0.0),
            (-1.0, 0.0),
            (-0.5, 0.5),
            (0.0, 1.0),
            (1.0, 1.0),
            (2.0, 1.0),
            (5.0, 0.25),
            (6.0, 0.0),
        ] {
            assert_eq!(trapezoid.degree(x), degree, "degree of {x}");
        }
        let cases: [(Mf<f64>, f64, f64); 16] = [
            (Mf::LinearS([0.0, 4.0]), 1.0, 0.25),
            (Mf::LinearZ([0.0, 4.0]), 1.0, 0.75),
            (Mf::Gaussian([1.0, 0.0]), 1.0, 0.606_530_659_712_633_4),
            (Mf::Gaussian2([1.0, 0.0, 2.0, 3.0]), 2.0, 1.0),
            (Mf::Gaussian2([1.0, 0.0, 2.0, 3.0]), 5.0, 0.606_530_659_712_633_4),
            (Mf::Gaussian2([1.0, 0.0, 2.0, 3.0]), -1.0, 0.606_530_659_712_633_4),
            (Mf::Bell([2.0, 1.0, 0.0]), 2.0, 0.5),
            (Mf::Bell([2.0, 2.0, 0.0]), 4.0, 1.0 / 17.0),
            (Mf::Sigmoid([2.0, 1.0]), 1.0, 0.5),
            (Mf::SigmoidDifference([1e3, 0.0, 1e3, 2.0]), 1.0, 1.0),
            (Mf::SigmoidProduct([1e3, 0.0, -1e3, 2.0]), 1.0, 1.0),
            (Mf::S([0.0, 4.0]), 1.0, 0.125),
            (Mf::S([0.0, 4.0]), 3.0, 0.875),
            (Mf::Z([0.0, 4.0]), 1.0, 0.875),
            (Mf::Pi([0.0, 4.0, 5.0, 9.0]), 3.0, 0.875),
            (Mf::S([3.0, 1.0]), 2.0, 1.0),
        ];
        for (shape, x, degree) in cases {
            assert!((shape.degree(x) - degree).abs() < 1e-15, "{shape:?} at {x}: {}", shape.degree(x));
        }
    }

    #[test]
    fn every_shape_is_zero_at_nan_and_bounded_far_away() {
        let shapes = [
            Mf::Triangle([0.0, 1.0, 2.0]),
            Mf::Trapezoid([0.0, 1.0, 2.0, 3.0]),
            Mf::LinearS([0.0, 1.0]),
            Mf::LinearZ([0.0, 1.0]),
            Mf::Gaussian([0.1, 0.0]),
            Mf::Gaussian2([0.1, 0.0, 0.2, 1.0]),
            Mf::Bell([0.5, -2.0, 0.0]),
            Mf::Bell([0.5, 0.0, 0.0]),
            Mf::Sigmoid([-40.0, 0.0]),
            Mf::SigmoidDifference([40.0, 0.0, 40.0, 1.0]),
            Mf::SigmoidProduct([40.0, 0.0, -40.0, 1.0]),
            Mf::S([0.0, 1.0]),
            Mf::Z([0.0, 1.0]),
            Mf::Pi([0.0, 1.0, 2.0, 3.0]),
        ];
        for shape in shapes {
            assert_eq!(shape.check("terms"), Ok(()), "{shape:?}");
            assert_eq!(shape.degree(f64::NAN), 0.0, "{shape:?} at NaN");
            for x in [f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -0.0] {
                let degree = shape.degree(x);
                assert!((0.0..=1.0).contains(&degree), "{shape:?} at {x}: {degree}");
            }
        }
    }

    #[test]
    fn refuses_disorder_nan_and_no_width() {
        let refused = Mf::Trapezoid([0.0, 2.0, 1.0, 3.0]).check("terms");
        assert_eq!(refused, Err(FuzzyError::Inverted("terms")), "b > c");
        let refused = Mf::Triangle([0.0, f64::NAN, 1.0]).check("terms");
        assert_eq!(refused, Err(FuzzyError::NonFinite("terms")), "NaN peak");
        for flat in
            [Mf::Gaussian([0.0, 1.0]), Mf::Gaussian2([1.0, 0.0, -0.0, 1.0]), Mf::Bell([0.0, 1.0, 1.0])]
        {
            assert_eq!(flat.check("terms"), Err(FuzzyError::OutOfRange("terms")), "{flat:?}");
        }
    }
}
