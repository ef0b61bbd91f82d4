//! Tracking observer: the velocity by the nominal dynamics, corrected by the measured positions.

use mm_model::{Real, Velocity};

/// A Luenberger observer of position, velocity and unmodelled acceleration in every channel.
///
/// Equation, for the displacement D since the last measurement, period dt, and a_m = M^-1 (B tau - C nu - g - friction) of the nominal
/// robot at the last update; lag = measured less estimated position:
///
/// ```text
/// innovation = lag + D - dt nu - dt^2/2 (a_m + a_d)
/// lag  = theta^3 innovation
/// nu   = nu + dt (a_m + a_d) + h/dt innovation,   h = 3/2 (1 - theta)^2 (1 + theta)
/// a_d  = a_d + (1 - theta)^3/dt^2 innovation,     theta = exp(-2 pi cutoff dt / 3)
/// ```
/// With the corner w = 2 pi cutoff/3 of its three poles, the estimated position follows the measured one as (3 w s^2 + 3 w^2 s + w^3)/(s + w)^3:
/// at high frequencies that is 2 pi cutoff/s, a low-pass of first order at the cutoff.
///
/// Stability: the error obeys a linear recursion whose three poles are all at theta, inside the unit circle for any cutoff, and which an error
/// of a_m drives. A constant one (payload, wrong gravity, a steady push) is learned in a_d and leaves no error of the velocity; one that
/// changes at the rate j leaves an error of 3 j/w^2. The acceleration is kept apart from the law's learned disturbance, so that
/// every law has it.
///
/// White noise of standard deviation sigma in the positions becomes 58/s times sigma in the velocity at 60 Hz and 1 kHz, as much as from
/// the low-pass of filtered differences at 34 Hz.
///
/// Only differences of positions enter: single precision loses nothing far from the origin.
///
/// # Source
/// The gains are those of the critically damped g-h-k filter: E. Brookner, Tracking and Kalman Filtering Made Easy, 1998, section 2.5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TrackingObserver<T> {
    period: T,
    half_square: T,
    keep: T,
    to_velocity: T,
    to_acceleration: T,
}

/// What the observer knows of each channel.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(super) struct TrackingState<T, const N: usize> {
    /// Measured less estimated position, m and rad.
    pub(super) lag: Velocity<T, N>,
    pub(super) velocity: Velocity<T, N>,
    /// Acceleration that the model does not explain.
    unmodelled: Velocity<T, N>,
    /// Acceleration that the model expects until the next measurement.
    pub(super) model: Velocity<T, N>,
}

impl<T: Real, const N: usize> TrackingState<T, N> {
    pub(super) fn at_rest() -> Self {
        let zero = Velocity::zero();
        Self { lag: zero, velocity: zero, unmodelled: zero, model: zero }
    }

    pub(super) fn is_finite(&self) -> bool {
        [&self.lag, &self.velocity, &self.unmodelled, &self.model].into_iter().all(Velocity::is_finite)
    }
}

impl<T: Real> TrackingObserver<T> {
    pub(super) fn new(cutoff_hz: T, period: T) -> Self {
        let theta = (-T::TAU * cutoff_hz * period / T::from_f64(3.0)).exp();
        let rest = T::ONE - theta;
        let square = rest * rest;
        Self {
            period,
            half_square: T::HALF * period * period,
            keep: theta * theta * theta,
            to_velocity: (T::ONE + T::HALF) * square * (T::ONE + theta) / period,
            to_acceleration: square * rest / (period * period),
        }
    }

    #[inline]
    pub(super) fn next<const N: usize>(
        &self,
        state: &TrackingState<T, N>,
        moved: &Velocity<T, N>,
    ) -> TrackingState<T, N> {
        let acceleration = state.model.plus(state.unmodelled);
        let went = state.velocity.scaled(self.period).plus(acceleration.scaled(self.half_square));
        let innovation = state.lag.plus(moved.minus(went));
        TrackingState {
            lag: innovation.scaled(self.keep),
            velocity: state
                .velocity
                .plus(acceleration.scaled(self.period))
                .plus(innovation.scaled(self.to_velocity)),
            unmodelled: state.unmodelled.plus(innovation.scaled(self.to_acceleration)),
            model: state.model,
        }
    }
}
