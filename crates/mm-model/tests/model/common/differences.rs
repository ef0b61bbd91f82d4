//! Derivatives by central differences of eighth order.

use nalgebra::SMatrix;

/// Derivative of `f` at 0, where one unit of its argument moves the angles by up to `speed` radians.
///
/// The step moves the angles by 0.02 rad. Sines up to the fourth harmonic then leave a truncation error of about
/// (4 * 0.02)^8 / 630 = 3e-12, relative, and the rounding of `f` is magnified 1 / 0.02 = 50 times.
pub(crate) fn derivative<const R: usize, const C: usize>(
    speed: f64,
    f: impl Fn(f64) -> SMatrix<f64, R, C>,
) -> SMatrix<f64, R, C> {
    let h = 0.02 / speed;
    let weights = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];
    weights.iter().zip(1_i32..).fold(SMatrix::zeros(), |sum, (&weight, k)| {
        let t = f64::from(k) * h;
        sum + (f(t) - f(-t)) * (weight / h)
    })
}
