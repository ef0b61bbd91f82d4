//! The bundled rule bases by precision.

use super::smooth_knots::{SMOOTH_KNOTS, SMOOTH_KNOTS_F32};
use super::{MamdaniTables, SMOOTH, SMOOTH_F32, THESIS, THESIS_F32};
use mm_model::Real;

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
