//! Random velocities.

use mm_model::Velocity;

use super::random::Random;

impl Random {
    pub(crate) fn velocity(&mut self) -> Velocity<f64, 3> {
        Velocity {
            forward: self.between(-2.0, 2.0),
            yaw_rate: self.between(-3.0, 3.0),
            joints: [(); 3].map(|()| self.between(-5.0, 5.0)),
        }
    }
}
