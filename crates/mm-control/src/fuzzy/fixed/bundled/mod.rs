//! The shipped rule bases in fixed point; `mm-fis` writes these files.

mod smooth_q15;
mod smooth_surface;
mod thesis_q15;
mod thesis_surface;

pub use smooth_q15::SMOOTH_Q15;
pub use smooth_surface::SMOOTH_SURFACE;
pub use thesis_q15::THESIS_Q15;
pub use thesis_surface::THESIS_SURFACE;
