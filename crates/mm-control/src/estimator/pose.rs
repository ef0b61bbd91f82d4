//! Pose fusion: the way by the wheels, the place by the measured pose.

use mm_model::{Configuration, Real, Velocity};

/// Ratio of the estimator's cutoff to that of the pose.
const SLOWER: f64 = 16.0;

/// A complementary filter of odometry and measured pose.
///
/// Equation, for the displacement D = (way, turn) since the last measurement and g = 1 - exp(-2 pi cutoff dt / 16):
///
/// ```text
/// pose = pose + (way cos(heading + turn/2), way sin(heading + turn/2), turn)
/// pose = pose + g (measured - pose), the heading the short way round
/// ```
/// White noise of the measured pose is cut to sqrt(g/(2 - g)) of its standard deviation. A slip at the rate u leaves the error u dt (1 - g)/g,
/// about 16 u/(2 pi cutoff), while it lasts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PoseFusion<T> {
    gain: T,
}

impl<T: Real> PoseFusion<T> {
    pub(super) fn new(cutoff_hz: T, period: T) -> Self {
        let rate = T::TAU * cutoff_hz / T::from_f64(SLOWER);
        Self { gain: T::ONE - (-rate * period).exp() }
    }

    /// The pose at this measurement; the joints are those of the measurement.
    #[inline]
    pub(super) fn next<const N: usize>(
        &self,
        pose: &Configuration<T, N>,
        way: &Velocity<T, N>,
        measured: &Configuration<T, N>,
    ) -> Configuration<T, N> {
        let pose = moved(pose, way);
        let g = self.gain;
        Configuration {
            x: pose.x + g * (measured.x - pose.x),
            y: pose.y + g * (measured.y - pose.y),
            heading: pose.heading + g * (measured.heading - pose.heading).wrap_to_pi(),
            joints: measured.joints,
        }
    }
}

/// The pose after a way and a turn of the base; the joints stay.
#[inline]
pub(super) fn moved<T: Real, const N: usize>(
    pose: &Configuration<T, N>,
    way: &Velocity<T, N>,
) -> Configuration<T, N> {
    let (sin, cos) = (pose.heading + T::HALF * way.yaw_rate).sin_cos();
    Configuration {
        x: pose.x + way.forward * cos,
        y: pose.y + way.forward * sin,
        heading: pose.heading + way.yaw_rate,
        joints: pose.joints,
    }
}
