//! The fuzzy system of a law: the same rules as an engine, as integers or as a table.

use mm_model::{Force, Real, Velocity};

use super::channel_zip;
use crate::fuzzy::fixed::{self, Evaluate, Scaled, Surface1};
use crate::fuzzy::{Bundled, Curve, FuzzyError, FuzzySystem, MamdaniTables, Surface};

/// Knots of the tabulated fuzzy surface.
const KNOTS: usize = 65;

/// How a law evaluates its fuzzy system.
///
/// | variant | accuracy | memory | speed |
/// | --- | --- | --- | --- |
/// | `Table` | linear between 65 equally spaced knots; a jump becomes a slope | 70 numbers | fastest in floating point |
/// | `Rules` | exact | the tables, in flash | a few hundred instructions |
/// | `Q15` | 16 bits: two units of 2^-15 of half the range beyond the rounding of input and breakpoints | the tables, in flash | as `Rules`, without floating point |
/// | `Surface` | the bound it was compiled for, beyond the rounding of the input; a jump stays one | the knots, in flash | fastest without floating point |
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FuzzyTerm<T: 'static> {
    /// A table of knots in floating point.
    Table(Surface<T, KNOTS>),
    /// The rules themselves.
    Rules(Curve<'static, T, 32>),
    /// The rules in whole numbers.
    Q15(Scaled<T, fixed::Curve<'static, 32>>),
    /// A compiled table of whole numbers.
    Surface(Scaled<T, Surface1<'static>>),
}

impl<T: Real> FuzzyTerm<T> {
    /// A table of any system.
    ///
    /// # Errors
    /// As [`Surface::from_engine`].
    pub fn table(system: &impl FuzzySystem<T>) -> Result<Self, FuzzyError> {
        Surface::from_engine(system).map(Self::Table)
    }

    /// The rules of a system of one input and one output.
    ///
    /// # Errors
    /// As [`Curve::try_new`].
    pub fn rules(tables: &'static MamdaniTables<'static, T>) -> Result<Self, FuzzyError> {
        Curve::try_new(tables).map(Self::Rules)
    }

    /// A rule base in whole numbers between the ranges of its input and output.
    ///
    /// # Errors
    /// As [`fixed::Curve::try_new`] and [`Scaled::try_new`].
    pub fn q15(
        tables: &'static fixed::Tables<'static>,
        input_range: (T, T),
        output_range: (T, T),
    ) -> Result<Self, FuzzyError> {
        Scaled::try_new(fixed::Curve::try_new(tables)?, input_range, output_range).map(Self::Q15)
    }

    /// A compiled surface between the ranges of its input and output.
    ///
    /// # Errors
    /// As [`Scaled::try_new`]; [`FuzzyError::OutOfRange`] (`surface`) for one that [`Surface1::check`] refuses.
    pub fn surface(
        surface: Surface1<'static>,
        input_range: (T, T),
        output_range: (T, T),
    ) -> Result<Self, FuzzyError> {
        if !surface.check() {
            return Err(FuzzyError::OutOfRange("surface"));
        }
        Scaled::try_new(surface, input_range, output_range).map(Self::Surface)
    }

    /// What [`Bfsmc`](super::Bfsmc) uses unless told otherwise.
    pub(super) fn smooth() -> Result<Self, FuzzyError>
    where
        T: Bundled,
    {
        Surface::smooth().map(Self::Table)
    }

    /// What [`BfsmcThesis`](super::BfsmcThesis) uses unless told otherwise.
    pub(super) fn thesis() -> Result<Self, FuzzyError>
    where
        T: Bundled,
    {
        Self::rules(T::THESIS)
    }
}

/// A fuzzy system as the term of a law.
pub trait SwitchingTerm<T: Real>: FuzzySystem<T> {
    /// The force of every channel, k times the output for the scaled sliding variable x.
    #[must_use]
    #[inline]
    fn force<const N: usize>(&self, x: &Velocity<T, N>, k: &Force<T, N>) -> Force<T, N> {
        channel_zip(x, k, |x, k| k * self.evaluate(x))
    }
}

impl<T: Real, const KNOTS: usize> SwitchingTerm<T> for Surface<T, KNOTS> {}
impl<T: Real, const WORK: usize> SwitchingTerm<T> for Curve<'_, T, WORK> {}
impl<T: Real, E: Evaluate> SwitchingTerm<T> for Scaled<T, E> {}

impl<T: Real> SwitchingTerm<T> for FuzzyTerm<T> {
    #[inline]
    fn force<const N: usize>(&self, x: &Velocity<T, N>, k: &Force<T, N>) -> Force<T, N> {
        match self {
            Self::Table(table) => table.force(x, k),
            Self::Rules(rules) => out_of_line(rules, x, k),
            Self::Q15(rules) => out_of_line(rules, x, k),
            Self::Surface(surface) => out_of_line(surface, x, k),
        }
    }
}

impl<T: Real> FuzzyTerm<T> {
    /// Whether no input is answered with an output of its own sign, and zero with zero, up to rounding.
    ///
    /// Seen at 1,024 equally spaced inputs on either side of zero.
    #[must_use]
    pub fn opposes(&self) -> bool {
        opposes(self)
    }
}

/// See [`FuzzyTerm::opposes`].
pub(super) fn opposes<T: Real>(term: &impl FuzzySystem<T>) -> bool {
    let rounding = T::from_u32(64) * T::EPSILON;
    let (lo, hi) = term.input_range();
    let against = |k: u32| {
        let part = T::from_u32(k) / T::from_u32(1024);
        term.evaluate(hi * part) <= rounding && term.evaluate(lo * part) >= -rounding
    };
    term.evaluate(T::ZERO).abs() <= rounding && lo < T::ZERO && hi > T::ZERO && (1..=1024).all(against)
}

/// The force by what is no table of floating-point knots, out of line: it shall not grow the code of the usual case.
#[inline(never)]
fn out_of_line<T: Real, const N: usize>(
    system: &impl FuzzySystem<T>,
    x: &Velocity<T, N>,
    k: &Force<T, N>,
) -> Force<T, N> {
    channel_zip(x, k, |x, k| k * system.evaluate(x))
}

impl<T: Real> FuzzySystem<T> for FuzzyTerm<T> {
    fn evaluate(&self, x: T) -> T {
        match self {
            Self::Table(table) => table.evaluate(x),
            Self::Rules(rules) => rules.evaluate(x),
            Self::Q15(rules) => rules.evaluate(x),
            Self::Surface(surface) => surface.evaluate(x),
        }
    }

    fn input_range(&self) -> (T, T) {
        match self {
            Self::Table(table) => table.input_range(),
            Self::Rules(rules) => rules.input_range(),
            Self::Q15(rules) => rules.input_range(),
            Self::Surface(surface) => surface.input_range(),
        }
    }
}
