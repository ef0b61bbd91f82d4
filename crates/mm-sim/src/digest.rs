//! A digest of the trajectory, to tell two runs apart by one bit.

use mm_model::{Configuration, Torque, Velocity};
use xxhash_rust::xxh3::Xxh3;

/// XXH3-128 over the little-endian bits of (t, q, nu, applied torque) at every control tick.
#[derive(Clone)]
pub struct Digest(Xxh3);

impl core::fmt::Debug for Digest {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "Digest({:032x})", self.0.digest128())
    }
}

impl Default for Digest {
    fn default() -> Self {
        Self::new()
    }
}

impl Digest {
    /// The digest of nothing.
    #[must_use]
    pub fn new() -> Self {
        Self(Xxh3::new())
    }

    /// Adds one control tick.
    #[inline]
    pub fn add(&mut self, t: f64, q: &Configuration<f64, 3>, nu: &Velocity<f64, 3>, torque: &Torque<f64, 3>) {
        let [q1, q2, q3] = q.joints;
        let [d1, d2, d3] = nu.joints;
        let [t1, t2, t3] = torque.joints;
        let numbers = [
            t,
            q.x,
            q.y,
            q.heading,
            q1,
            q2,
            q3,
            nu.forward,
            nu.yaw_rate,
            d1,
            d2,
            d3,
            torque.right,
            torque.left,
            t1,
            t2,
            t3,
        ];
        let mut bytes = [0_u8; 17 * 8];
        for (slot, number) in bytes.chunks_exact_mut(8).zip(numbers) {
            slot.copy_from_slice(&number.to_le_bytes());
        }
        self.0.update(&bytes);
    }

    /// The digest as 32 hexadecimal digits.
    #[must_use]
    pub fn finish(&self) -> String {
        format!("{:032x}", self.0.digest128())
    }
}
