//! Estimator: from what sensors read to the configuration and the velocity that the laws need.

mod difference;
mod observer;
mod pose;

use mm_model::{Configuration, Mechanism, ParamError, Real, Robot, Velocity, WheelRates, check};

use difference::{DifferenceFilter, DifferenceState};
use observer::{TrackingObserver, TrackingState};
use pose::PoseFusion;

use crate::ControlError;

/// Angles of the two driving wheels, as their encoders read them.
///
/// Only differences between two measurements count, and they are taken modulo a whole turn: an encoder may count turns or start
/// anew at each.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WheelAngles<T> {
    /// Right wheel, rad, positive forwards.
    pub right: T,
    /// Left wheel, rad, positive forwards.
    pub left: T,
}

/// What the sensors read at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Copy + serde::Deserialize<'de>"))
)]
pub struct Measurement<T, const N: usize> {
    /// Configuration: the pose by whatever locates the base, the joints by their encoders.
    pub q: Configuration<T, N>,
    /// Wheel angles, where the wheels have encoders.
    pub wheels: Option<WheelAngles<T>>,
}

/// How the velocity is found where only positions are measured.
///
/// The default is none: [`ControlStack::update`](crate::ControlStack::update) takes the velocity from its caller.
///
/// With wheel encoders both kinds also fuse them with the measured pose: the encoders move the estimated pose along, the
/// measured one corrects it with a time constant of 16/(2 pi cutoff). Noise of the pose is thereby cut (to 11 % at a cutoff of
/// 60 Hz and 1 kHz), and in the long run the measured pose decides, so that a wheel that slips does no lasting harm.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Estimator<T> {
    /// The caller knows the velocity.
    #[default]
    None,
    /// Differences of the measured coordinates through a low-pass of second order (Butterworth), which is 3 dB down at the cutoff.
    ///
    /// It knows nothing of the robot and lags by sqrt(2)/(2 pi cutoff).
    FilteredDifference {
        /// Cutoff of the low-pass, Hz; below half the update rate.
        cutoff_hz: T,
    },
    /// A tracking observer with the nominal dynamics under the applied torque, and an acceleration that it learns for what they miss.
    ///
    /// It does not lag behind motion that the model explains.
    Observer {
        /// Rate, over 2 pi, at which a measured position corrects the estimated one: the sum of the three poles of the error, which
        /// are equal; Hz, below half the update rate.
        cutoff_hz: T,
    },
}

/// The estimator of a stack, its coefficients formed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stage<T> {
    kind: Kind<T>,
    fusion: PoseFusion<T>,
    /// Age of the measurement when it is used, s.
    delay: T,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind<T> {
    None,
    Difference(DifferenceFilter<T>),
    Observer(TrackingObserver<T>),
}

/// What the estimator remembers: nothing before the first measurement.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Memory<T, const N: usize>(Option<Seen<T, N>>);

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
struct Seen<T, const N: usize> {
    last: Measurement<T, N>,
    /// Estimated configuration at the last measurement.
    q: Configuration<T, N>,
    channels: Channels<T, N>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
enum Channels<T, const N: usize> {
    Difference(DifferenceState<T, N>),
    Observer(TrackingState<T, N>),
}

impl<T, const N: usize> Memory<T, N> {
    /// Nothing measured yet.
    pub(crate) const fn initial() -> Self {
        Self(None)
    }
}

impl<T: Real, const N: usize> Memory<T, N> {
    /// Tells an observer which acceleration the model expects until the next measurement.
    pub(crate) fn foresee(&mut self, acceleration: &Velocity<T, N>) {
        if let Some(Seen { channels: Channels::Observer(state), .. }) = &mut self.0 {
            state.model = *acceleration;
        }
    }

    /// Whether nothing in it is infinite or NaN.
    pub(crate) fn is_finite(&self) -> bool {
        self.0.is_none_or(|seen| {
            seen.q.is_finite()
                && match seen.channels {
                    Channels::Difference(state) => state.velocity.is_finite(),
                    Channels::Observer(state) => state.is_finite(),
                }
        })
    }
}

impl<T: Real> Stage<T> {
    /// The stage of a kind, at an update period in s.
    pub(crate) fn try_new(kind: Estimator<T>, period: T) -> Result<Self, ParamError> {
        let (kind, cutoff) = match kind {
            Estimator::None => (Kind::None, T::ONE),
            Estimator::FilteredDifference { cutoff_hz } => (
                Kind::Difference(DifferenceFilter::new(below_nyquist(cutoff_hz, period)?, period)),
                cutoff_hz,
            ),
            Estimator::Observer { cutoff_hz } => {
                (Kind::Observer(TrackingObserver::new(below_nyquist(cutoff_hz, period)?, period)), cutoff_hz)
            }
        };
        Ok(Self { kind, fusion: PoseFusion::new(cutoff, period), delay: T::ZERO })
    }

    /// The same for measurements that are `delay` s old when they are used.
    pub(crate) fn with_delay(self, delay: T) -> Result<Self, ParamError> {
        Ok(Self { delay: check::non_negative(delay, "delay_s")?, ..self })
    }

    /// Whether anything is estimated.
    pub(crate) const fn is_some(&self) -> bool {
        !matches!(self.kind, Kind::None)
    }

    /// Whether it wants to know the acceleration that the model expects.
    pub(crate) const fn wants_model(&self) -> bool {
        matches!(self.kind, Kind::Observer(_))
    }

    /// The configuration and the velocity now, and the memory after it.
    ///
    /// The first measurement after none, or after those of another kind of estimator, gives velocity zero.
    pub(crate) fn estimate<const N: usize>(
        &self,
        robot: &Robot<T, N>,
        memory: &Memory<T, N>,
        now: &Measurement<T, N>,
    ) -> Result<Estimate<T, N>, ControlError>
    where
        Robot<T, N>: Mechanism<T, N>,
    {
        supervise(now)?;
        let (q, nu, channels) = match (&self.kind, &memory.0) {
            (Kind::None, _) => return Err(ControlError::NoEstimator),
            (Kind::Difference(filter), Some(Seen { last, q, channels: Channels::Difference(state) })) => {
                let moved = displacement(robot, last, now);
                let next = filter.next(state, &moved);
                let estimated =
                    if now.wheels.is_some() { self.fusion.next(q, &moved, &now.q) } else { now.q };
                (
                    Configuration { joints: now.q.joints, ..estimated },
                    next.velocity,
                    Channels::Difference(next),
                )
            }
            (Kind::Observer(observer), Some(Seen { last, q, channels: Channels::Observer(state) })) => {
                let moved = displacement(robot, last, now);
                let next = observer.next(state, &moved);
                let smooth = moved.minus(next.lag.minus(state.lag));
                let mut estimated = self.fusion.next(q, &smooth, &now.q);
                for ((joint, &read), lag) in
                    estimated.joints.iter_mut().zip(&now.q.joints).zip(next.lag.joints)
                {
                    *joint = read - lag;
                }
                (estimated, next.velocity, Channels::Observer(next))
            }
            (Kind::Difference(_), _) => {
                (now.q, Velocity::zero(), Channels::Difference(DifferenceState::at_rest()))
            }
            (Kind::Observer(_), _) => (now.q, Velocity::zero(), Channels::Observer(TrackingState::at_rest())),
        };
        let memory = Memory(Some(Seen { last: *now, q, channels }));
        let mut ahead = pose::moved(&q, &nu.scaled(self.delay));
        for (joint, rate) in ahead.joints.iter_mut().zip(nu.joints) {
            *joint += self.delay * rate;
        }
        Ok(Estimate { q: ahead, nu, memory })
    }
}

/// What an estimator gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate<T, const N: usize> {
    pub(crate) q: Configuration<T, N>,
    pub(crate) nu: Velocity<T, N>,
    pub(crate) memory: Memory<T, N>,
}

/// How far the robot went between two measurements, along the quasi-velocities: m, rad.
///
/// Base: from the wheels, r (d_r + d_l)/2 and r (d_r - d_l)/(2 l); without them the way along the mean heading, and the turn. Angles
/// of wheels and heading are taken the short way round.
fn displacement<T: Real, const N: usize>(
    robot: &Robot<T, N>,
    last: &Measurement<T, N>,
    now: &Measurement<T, N>,
) -> Velocity<T, N> {
    let mut joints = now.q.joints;
    for (joint, before) in joints.iter_mut().zip(last.q.joints) {
        *joint -= before;
    }
    let (forward, yaw_rate) = match (&last.wheels, &now.wheels) {
        (Some(before), Some(after)) => robot.base_speed(WheelRates {
            right: (after.right - before.right).wrap_to_pi(),
            left: (after.left - before.left).wrap_to_pi(),
        }),
        _ => {
            let turn = (now.q.heading - last.q.heading).wrap_to_pi();
            let (sin, cos) = (last.q.heading + T::HALF * turn).sin_cos();
            ((now.q.x - last.q.x) * cos + (now.q.y - last.q.y) * sin, turn)
        }
    };
    Velocity { forward, yaw_rate, joints }
}

/// Lets only finite measurements through.
fn supervise<T: Real, const N: usize>(now: &Measurement<T, N>) -> Result<(), ControlError> {
    if !now.q.is_finite() {
        return Err(ControlError::NonFinite("configuration"));
    }
    if now.wheels.is_some_and(|wheels| !(wheels.right.is_finite() && wheels.left.is_finite())) {
        return Err(ControlError::NonFinite("wheel angles"));
    }
    Ok(())
}

/// Passes a cutoff above zero and below half the update rate.
fn below_nyquist<T: Real>(cutoff_hz: T, period: T) -> Result<T, ParamError> {
    check::positive(cutoff_hz, "cutoff_hz")?;
    if cutoff_hz * period < T::HALF { Ok(cutoff_hz) } else { Err(ParamError::OutOfRange("cutoff_hz")) }
}
