//! The bundled rule bases by precision.

use super::{MamdaniTables, SMOOTH, SMOOTH_F32, THESIS, THESIS_F32};
use mm_model::Real;

/// A precision in which the bundled rule bases are stored, so that none is converted at run time.
pub trait Bundled: Real {
    /// The rule base of Appendix C, [`THESIS`].
    const THESIS: &'static MamdaniTables<'static, Self>;
    /// The smooth rule base, [`SMOOTH`].
    const SMOOTH: &'static MamdaniTables<'static, Self>;
}

impl Bundled for f64 {
    const THESIS: &'static MamdaniTables<'static, Self> = &THESIS;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &SMOOTH;
}

impl Bundled for f32 {
    const THESIS: &'static MamdaniTables<'static, Self> = &THESIS_F32;
    const SMOOTH: &'static MamdaniTables<'static, Self> = &SMOOTH_F32;
}
