//! Double precision that notes how large and how small its results become, and how many there are.

use core::cell::Cell;
use core::fmt;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use mm_control::fuzzy::{Bundled, MamdaniTables};
use mm_model::Real;

/// What was seen since the last [`Seen::take`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub(crate) largest: f64,
    /// Smallest magnitude but zero.
    pub(crate) smallest: f64,
    pub(crate) sums: u64,
    pub(crate) products: u64,
    pub(crate) quotients: u64,
}

const NOTHING: Seen = Seen { largest: 0.0, smallest: f64::INFINITY, sums: 0, products: 0, quotients: 0 };

thread_local! {
    static SEEN: Cell<Seen> = const { Cell::new(NOTHING) };
}

impl Seen {
    pub(crate) fn take() -> Self {
        SEEN.replace(NOTHING)
    }
}

#[derive(Clone, Copy, Default, PartialEq, PartialOrd)]
pub(crate) struct Watched(f64);

fn note(value: f64, count: impl FnOnce(&mut Seen)) -> Watched {
    let mut seen = SEEN.get();
    count(&mut seen);
    let size = Real::abs(value);
    if size > 0.0 {
        seen.largest = Real::max(seen.largest, size);
        seen.smallest = Real::min(seen.smallest, size);
    }
    SEEN.set(seen);
    Watched(value)
}

macro_rules! operators {
    ($($trait:ident $name:ident $assign:ident $assign_name:ident $count:ident;)*) => {$(
        impl $trait for Watched {
            type Output = Self;
            fn $name(self, other: Self) -> Self {
                note($trait::$name(self.0, other.0), |seen| seen.$count += 1)
            }
        }
        impl $assign for Watched {
            fn $assign_name(&mut self, other: Self) {
                *self = $trait::$name(*self, other);
            }
        }
    )*};
}

operators! {
    Add add AddAssign add_assign sums;
    Sub sub SubAssign sub_assign sums;
    Mul mul MulAssign mul_assign products;
    Div div DivAssign div_assign quotients;
}

impl Neg for Watched {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl fmt::Debug for Watched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.0, f)
    }
}

impl fmt::Display for Watched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

impl num_traits::Zero for Watched {
    fn zero() -> Self {
        Self(0.0)
    }
    fn is_zero(&self) -> bool {
        num_traits::Zero::is_zero(&self.0)
    }
}

impl num_traits::One for Watched {
    fn one() -> Self {
        Self(1.0)
    }
}

impl Real for Watched {
    const ZERO: Self = Self(0.0);
    const ONE: Self = Self(1.0);
    const TWO: Self = Self(2.0);
    const HALF: Self = Self(0.5);
    const PI: Self = Self(core::f64::consts::PI);
    const TAU: Self = Self(core::f64::consts::TAU);
    const EPSILON: Self = Self(f64::EPSILON);

    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn from_u32(value: u32) -> Self {
        Self(f64::from(value))
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = Real::sin_cos(self.0);
        (Self(sin), Self(cos))
    }
    fn atan2(self, x: Self) -> Self {
        Self(Real::atan2(self.0, x.0))
    }
    fn acos(self) -> Self {
        Self(Real::acos(self.0))
    }
    fn exp(self) -> Self {
        Self(Real::exp(self.0))
    }
    fn powf(self, exponent: Self) -> Self {
        Self(Real::powf(self.0, exponent.0))
    }
    fn sqrt(self) -> Self {
        note(Real::sqrt(self.0), |_| ())
    }
    fn abs(self) -> Self {
        Self(Real::abs(self.0))
    }
    fn floor(self) -> Self {
        Self(Real::floor(self.0))
    }
    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
    fn split_index(self) -> (usize, Self) {
        let (whole, rest) = self.0.split_index();
        (whole, Self(rest))
    }
}

/// The default law takes the knots only.
impl Bundled for Watched {
    const THESIS: &'static MamdaniTables<'static, Self> = &NO_RULES;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &NO_RULES;
    const SMOOTH_KNOTS: &'static [Self; 65] = &{
        let mut knots = [Self(0.0); 65];
        let mut i = 0;
        while i < knots.len() {
            knots[i] = Self(f64::SMOOTH_KNOTS[i]);
            i += 1;
        }
        knots
    };
}

const NO_RULES: MamdaniTables<'static, Watched> = MamdaniTables {
    inputs: &[],
    outputs: &[],
    rules: &[],
    operators: mm_control::fuzzy::SMOOTH.operators,
    defuzzifier: mm_control::fuzzy::Defuzzifier::Centroid,
};
