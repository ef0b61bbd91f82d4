//! The bundled rule bases by precision.

use super::smooth_knots::{SMOOTH_KNOTS, SMOOTH_KNOTS_F32};
use super::{MamdaniTables, SMOOTH, SMOOTH_F32, SMOOTH_Q32, THESIS, THESIS_F32, THESIS_Q32};
use mm_model::{Q32, Real};

/// A literal as it is, of the precision that is asked for.
pub(super) const fn same<T: Copy>(literal: T) -> T {
    literal
}

/// The knots in double precision, each to the nearest number in fixed point.
#[expect(clippy::indexing_slicing, reason = "evaluated by the compiler, which would report it")]
const SMOOTH_KNOTS_Q32: [Q32; 65] = {
    let mut knots = [Q32::NAN; 65];
    let mut i = 0;
    while i < knots.len() {
        knots[i] = Q32::from_f64(SMOOTH_KNOTS[i]);
        i += 1;
    }
    knots
};

/// A precision in which the bundled rule bases are stored, so that none is converted at run time.
pub trait Bundled: Real {
    /// The rule base of Appendix C, [`THESIS`].
    const THESIS: &'static MamdaniTables<'static, Self>;
    /// The smooth rule base, [`SMOOTH`].
    const SMOOTH: &'static MamdaniTables<'static, Self>;
    /// The same as a table over [-1, 1]: what [`Surface::from_engine`](super::Surface::from_engine) makes of it, so that who uses the table need not link the rules.
    const SMOOTH_KNOTS: &'static [Self; 65];
}

impl Bundled for f64 {
    const THESIS: &'static MamdaniTables<'static, Self> = &THESIS;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &SMOOTH;
    const SMOOTH_KNOTS: &'static [Self; 65] = &SMOOTH_KNOTS;
}

impl Bundled for f32 {
    const THESIS: &'static MamdaniTables<'static, Self> = &THESIS_F32;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &SMOOTH_F32;
    const SMOOTH_KNOTS: &'static [Self; 65] = &SMOOTH_KNOTS_F32;
}

impl Bundled for Q32 {
    const THESIS: &'static MamdaniTables<'static, Self> = &THESIS_Q32;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &SMOOTH_Q32;
    const SMOOTH_KNOTS: &'static [Self; 65] = &SMOOTH_KNOTS_Q32;
}
