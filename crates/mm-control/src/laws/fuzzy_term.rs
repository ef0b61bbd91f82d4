//! The fuzzy system of a law: the same rules as an engine, as integers or as a table.

use mm_model::{Force, Real, Velocity};

use super::channel_zip;
use crate::fuzzy::{Bundled, Curve, FuzzyError, FuzzySystem, MamdaniTables, Surface};

/// Knots of the tabulated fuzzy surface.
const KNOTS: usize = 65;

/// How a law evaluates its fuzzy system.
///
/// | variant | accuracy | memory | speed |
/// | --- | --- | --- | --- |
/// | `Table` | linear between 65 equally spaced knots; a jump becomes a slope | 70 numbers | fastest in floating point |
/// | `Rules` | exact | the tables, in flash | a few hundred instructions |
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum FuzzyTerm<T: 'static> {
    /// A table of knots in floating point.
    Table(Surface<T, KNOTS>),
    /// The rules themselves.
    Rules(Curve<'static, T, 32>),
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

    /// What [`Bfsmc`](super::Bfsmc) uses unless told otherwise.
    pub(super) fn smooth() -> Result<Self, FuzzyError>
    where
        T: Bundled,
    {
        Self::table(&Curve::<T>::try_new(T::SMOOTH)?)
    }

    /// What [`BfsmcThesis`](super::BfsmcThesis) uses unless told otherwise.
    pub(super) fn thesis() -> Result<Self, FuzzyError>
    where
        T: Bundled,
    {
        Self::rules(T::THESIS)
    }
}

impl<T: Real> FuzzyTerm<T> {
    /// The force of every channel, k times the output for the scaled sliding variable x.
    #[inline]
    pub(super) fn force<const N: usize>(&self, x: &Velocity<T, N>, k: &Force<T, N>) -> Force<T, N> {
        match self {
            Self::Table(table) => channel_zip(x, k, |x, k| k * table.evaluate(x)),
            Self::Rules(rules) => by_rules(rules, x, k),
        }
    }

    /// Whether no input is answered with an output of its own sign, and zero with zero, up to rounding.
    ///
    /// Seen at 1,024 equally spaced inputs on either side of zero.
    #[must_use]
    pub fn opposes(&self) -> bool {
        let rounding = T::from_u32(64) * T::EPSILON;
        let (lo, hi) = self.input_range();
        let against = |k: u32| {
            let part = T::from_u32(k) / T::from_u32(1024);
            self.evaluate(hi * part) <= rounding && self.evaluate(lo * part) >= -rounding
        };
        self.evaluate(T::ZERO).abs() <= rounding && lo < T::ZERO && hi > T::ZERO && (1..=1024).all(against)
    }
}

/// The force by the rules, out of line: it shall not grow the code of the usual case.
#[inline(never)]
fn by_rules<T: Real, const N: usize>(
    rules: &impl FuzzySystem<T>,
    x: &Velocity<T, N>,
    k: &Force<T, N>,
) -> Force<T, N> {
    channel_zip(x, k, |x, k| k * rules.evaluate(x))
}

impl<T: Real> FuzzySystem<T> for FuzzyTerm<T> {
    fn evaluate(&self, x: T) -> T {
        match self {
            Self::Table(table) => table.evaluate(x),
            Self::Rules(rules) => rules.evaluate(x),
        }
    }

    fn input_range(&self) -> (T, T) {
        match self {
            Self::Table(table) => table.input_range(),
            Self::Rules(rules) => rules.input_range(),
        }
    }
}
