//! Sine and cosine in single precision without any double-precision operation.

/// Placeholder until the kernel lands.
pub(super) fn sin_cos(x: f32) -> (f32, f32) {
    (libm::sinf(x), libm::cosf(x))
}
