//! One body of a robot on its own: the model is linear in each.

use crate::robot::Lumped;
use crate::{Real, Robot};

impl<T: Real, const N: usize> Robot<T, N> {
    /// The same robot with all bodies but one weightless: 0 is the base, i the i-th link; beyond the last, all of them.
    ///
    /// M, C and g are sums over the bodies, so that those of this robot are the sums of those of its bodies: the regressor of
    /// adaptive control, column by column. Geometry, limits and friction are kept. Not to be asked for an acceleration: a
    /// weightless body has none that is defined.
    #[must_use]
    pub fn body_alone(&self, body: usize) -> Self {
        let mut params = *self.params();
        if body != 0 {
            (params.base_mass, params.base_yaw_inertia) = (T::ZERO, T::ZERO);
        }
        for (i, link) in params.links.iter_mut().enumerate() {
            if i + 1 != body {
                link.mass = T::ZERO;
                (link.axial_inertia, link.pitch_inertia, link.normal_inertia) = (T::ZERO, T::ZERO, T::ZERO);
            }
        }
        let lumped = Lumped::of(&params);
        Self { params, lumped }
    }
}
