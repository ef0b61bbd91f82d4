//! What is refused before a stack is made, and before an update.

use mm_model::Real;
use nalgebra::Vector3;

use crate::outer::OuterParams;
use crate::{ControlError, Input, SetupError};

/// Lets only finite inputs through.
#[inline]
pub(super) fn supervise<T: Real, const N: usize>(input: &Input<T, N>) -> Result<(), ControlError> {
    // A finite number times zero is zero, any other is NaN.
    let gap = |v: &Vector3<T>| v.x * T::ZERO + v.y * T::ZERO + v.z * T::ZERO;
    if !input.q.is_finite() {
        return Err(ControlError::NonFinite("configuration"));
    }
    if !input.nu.is_finite() {
        return Err(ControlError::NonFinite("velocity"));
    }
    let reference = &input.reference;
    let gaps = gap(&reference.position) + gap(&reference.velocity) + gap(&reference.acceleration);
    if !(gaps == T::ZERO) {
        return Err(ControlError::NonFinite("reference"));
    }
    Ok(())
}

/// Checks that nothing is asked to decay within less than a period: e(k+1) = (1 - K T) e(k) overshoots beyond K T = 1 and grows beyond 2.
pub(super) fn check_rates<T: Real, const N: usize>(
    period: T,
    bandwidth: T,
    outer: &OuterParams<T, N>,
) -> Result<(), SetupError> {
    let rates = [
        (bandwidth, "observer_bandwidth_1_s"),
        (outer.position_gain.iter().fold(T::ZERO, |most, gain| most.max(*gain)), "position_gain_1_s"),
        (outer.sliding_gain.channels().fold(T::ZERO, |most, gain| most.max(gain)), "sliding_gain_1_s"),
        (outer.posture_gain, "posture_gain_1_s"),
    ];
    for (rate, name) in rates {
        if rate * period > T::ONE {
            return Err(mm_model::ParamError::OutOfRange(name).into());
        }
    }
    Ok(())
}
