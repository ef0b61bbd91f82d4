//! The speed asked of the tip: that of the reference and a correction of limited size.

use mm_model::Real;
use nalgebra::Vector3;

use super::OuterParams;
use crate::Reference;

/// Velocity u that the tip should have, its rate, and whether the correction in it was cut.
pub(super) struct TipTask<T> {
    pub(super) velocity: Vector3<T>,
    pub(super) rate: Vector3<T>,
    pub(super) limited: bool,
}

impl<T: Real, const N: usize> OuterParams<T, N> {
    /// u = p_d' - L(K e) for the tip's error and its rate.
    ///
    /// L leaves a vector of length up to `correction_speed_limit` as it is and shortens a longer one to that length: continuous and
    /// radial, so that the direction of the correction is kept. Its rate is that of the direction alone then.
    #[inline]
    pub(super) fn tip_task(
        &self,
        reference: &Reference<T>,
        error: &Vector3<T>,
        error_rate: &Vector3<T>,
    ) -> TipTask<T> {
        let mut correction = self.position_gain.component_mul(error);
        let mut rate = self.position_gain.component_mul(error_rate);
        let most = self.correction_speed_limit;
        let limited = dot(&correction, &correction) > most * most;
        if limited {
            (correction, rate) = shortened(&correction, &rate, most);
        }
        TipTask { velocity: reference.velocity - correction, rate: reference.acceleration - rate, limited }
    }
}

/// The vector of length `most` along `v`, and its rate where `v` changes at `rate`.
#[inline(never)]
fn shortened<T: Real>(v: &Vector3<T>, rate: &Vector3<T>, most: T) -> (Vector3<T>, Vector3<T>) {
    // Divided by its largest part first, so that no square overflows.
    let part = v.iter().fold(T::ZERO, |most, x| most.max(x.abs()));
    let scaled = v / part;
    let length = dot(&scaled, &scaled).sqrt();
    let direction = scaled / length;
    let turn = rate / part / length;
    (direction * most, (turn - direction * dot(&direction, &turn)) * most)
}

/// Inner product of two vectors, in a fixed order.
#[inline]
pub(super) fn dot<T: Real>(a: &Vector3<T>, b: &Vector3<T>) -> T {
    a.x * b.x + a.y * b.y + a.z * b.z
}
