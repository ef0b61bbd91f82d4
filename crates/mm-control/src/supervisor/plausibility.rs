//! Plausibility: whether a state, a reference and a time can be what they say.

use mm_model::{Configuration, Real, Robot, Velocity};
use nalgebra::Vector3;

use super::{Findings, SupervisorParams, Timing};
use crate::Reference;

/// The limits, as an update needs them.
///
/// A good input is let through by a few sums of squares below the smallest limit squared, which is sufficient for all limits of
/// its kind: no division, no root, one comparison for several numbers. What fails there is looked at number by number, with
/// the time that has really passed. A NaN makes its sum a NaN, which is not below anything.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plausibility<T, const N: usize> {
    params: SupervisorParams<T, N>,
    period: T,
    /// Middle and half width of the range of each joint, margin included.
    range: [(T, T); N],
    /// Earliest and latest update that is on time, s.
    on_time: (T, T),
    near: Squares<T>,
    /// How much of a doubt stays after an update, and what one in which a coordinate is pushed hard adds, m and rad.
    memory: T,
    push: T,
}

/// Squares of what is certainly within the limits.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Squares<T> {
    origin: T,
    moved: T,
    speed: T,
    accelerated: T,
    step: T,
    reference_acceleration: T,
}

/// What was last believed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Believed<T, const N: usize> {
    pub(super) q: Configuration<T, N>,
    pub(super) nu: Velocity<T, N>,
    /// Position of the reference, m.
    pub(super) reference: Vector3<T>,
}

/// How far each coordinate should have moved while it did not, m and rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Doubt<T, const N: usize> {
    pub(super) of: Velocity<T, N>,
    /// The largest of them, by its amount.
    largest: T,
}

/// What the clock says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Clocked<T> {
    pub(super) findings: Findings,
    /// Time since the update before, s; not negative, finite.
    pub(super) elapsed: T,
    /// Whole updates that are missing.
    pub(super) missing: u32,
}

impl<T: Real, const N: usize> Doubt<T, N> {
    pub(super) fn none() -> Self {
        Self { of: Velocity::zero(), largest: T::ZERO }
    }

    /// Doubts that are finite or infinite: nobody doubts before he knows that state and time are numbers.
    #[inline]
    pub(super) fn new(of: Velocity<T, N>) -> Self {
        let mut largest = of.forward.abs().max(of.yaw_rate.abs());
        for joint in &of.joints {
            largest = largest.max(joint.abs());
        }
        Self { of, largest }
    }

    #[inline]
    pub(super) fn is_none(&self) -> bool {
        self.largest <= T::ZERO
    }
}

impl<T: Real, const N: usize> Plausibility<T, N> {
    pub(super) fn new(params: &SupervisorParams<T, N>, robot: &Robot<T, N>, period: T) -> Self {
        let long = (T::ONE + T::HALF) * period;
        let square = |limit: T| {
            let square = limit * limit;
            if square.is_finite() { square } else { T::ZERO }
        };
        let least = |limits: &Velocity<T, N>| limits.channels().fold(limits.forward, |a, b| a.min(b));
        let within = |(lo, hi): (T, T)| (T::HALF * (lo + hi), T::HALF * (hi - lo) + params.joint_margin);
        Self {
            params: *params,
            period,
            range: robot.params().limits.joints.map(within),
            on_time: (T::HALF * period, long),
            near: Squares {
                origin: square(params.position),
                moved: square(least(&params.speed) * long + params.position_noise),
                speed: square(least(&params.speed)),
                accelerated: square(least(&params.acceleration) * long + params.velocity_noise),
                step: square(params.reference_step),
                reference_acceleration: square(params.reference_acceleration),
            },
            push: params.position_noise / T::from_u32(STRAINED),
            memory: (T::ONE - period / T::from_f64(MEMORY)).max(T::ZERO),
        }
    }

    pub(super) const fn params(&self) -> &SupervisorParams<T, N> {
        &self.params
    }

    /// Whether an update that follows an ordinary one is ordinary too: on time, and within every limit by a wide margin. And whether every
    /// coordinate has changed since, the position of the base as one: where one stands still, somebody has to look closer.
    #[inline(always)]
    pub(super) fn is_ordinary(
        &self,
        last: &Believed<T, N>,
        timing: Timing<T>,
        (q, nu): (&Configuration<T, N>, &Velocity<T, N>),
        reference: &Reference<T>,
    ) -> (bool, bool) {
        let near = &self.near;
        let on_time = timing.elapsed >= self.on_time.0
            && timing.elapsed <= self.on_time.1
            && timing.age.abs() <= self.params.age;
        let (dx, dy, turn) = (q.x - last.q.x, q.y - last.q.y, q.heading - last.q.heading);
        let (mut moved, mut in_range) = (dx * dx + dy * dy + turn * turn, true);
        let mut moves = (dx != T::ZERO || dy != T::ZERO) && turn != T::ZERO;
        for ((&now, before), &(middle, half)) in q.joints.iter().zip(last.q.joints).zip(&self.range) {
            let way = now - before;
            moved += way * way;
            moves = moves && way != T::ZERO;
            in_range = in_range && (now - middle).abs() <= half;
        }
        let (speed, accelerated) = (sum_of_squares(nu), sum_of_squares(&nu.minus(last.nu)));
        let Reference { position, velocity, acceleration } = reference;
        let ordinary = on_time
            && in_range
            && moved <= near.moved
            && accelerated <= near.accelerated
            && speed <= near.speed
            && q.x * q.x + q.y * q.y + squared(position) <= near.origin
            && squared(&(position - last.reference)) <= near.step
            && squared(velocity) <= near.speed
            && squared(acceleration) <= near.reference_acceleration;
        (ordinary, moves)
    }

    /// Reads the clock; `waited` is the time of early updates before this one, which were not used, s.
    pub(super) fn clocked(&self, timing: Timing<T>, waited: T) -> Clocked<T> {
        let mut findings = Findings::NONE;
        let backwards = !(timing.elapsed >= T::ZERO);
        let elapsed = if backwards { T::ZERO } else { timing.elapsed + waited };
        // A clock that stood still for ages says no more than one that stood still for an hour of updates.
        let elapsed = elapsed.min(T::from_u32(MOST_PERIODS) * self.period);
        if backwards || !(elapsed >= self.on_time.0) {
            findings = findings.and(Findings::EARLY);
        }
        let mut missing = 0;
        if elapsed > self.on_time.1 {
            findings = findings.and(Findings::LATE);
            let (whole, _) = (elapsed / self.period - T::HALF).split_index();
            missing = u32::try_from(whole).unwrap_or(u32::MAX);
        }
        if !(timing.age.abs() <= self.params.age) {
            findings = findings.and(Findings::STALE);
        }
        Clocked { findings, elapsed, missing }
    }

    /// What is wrong with a measured configuration, `since` s after the last one that was believed, if there was any.
    pub(super) fn configuration(
        &self,
        last: Option<&Believed<T, N>>,
        q: &Configuration<T, N>,
        since: T,
    ) -> Findings {
        if !q.is_finite() {
            return Findings::STATE_NOT_FINITE;
        }
        let mut findings = Findings::NONE;
        let joints = q.joints.iter().zip(&self.range);
        let far = |value: T| !(value.abs() <= self.params.position);
        if far(q.x) || far(q.y) || joints.into_iter().any(|(q, (mid, half))| !((*q - *mid).abs() <= *half)) {
            findings = findings.and(Findings::STATE_RANGE);
        }
        let Some(last) = last else { return findings };
        let time = self.allowed(since);
        let too_far = |way: T, speed: T| !(way.abs() <= speed * time + self.params.position_noise);
        let speed = &self.params.speed;
        let joints = q.joints.iter().zip(last.q.joints).zip(speed.joints);
        if too_far(q.x - last.q.x, speed.forward)
            || too_far(q.y - last.q.y, speed.forward)
            || too_far((q.heading - last.q.heading).wrap_to_pi(), speed.yaw_rate)
            || joints.into_iter().any(|((now, before), speed)| too_far(*now - before, speed))
        {
            findings = findings.and(Findings::STATE_RATE);
        }
        findings
    }

    /// What is wrong with a measured velocity.
    pub(super) fn velocity(&self, last: Option<&Believed<T, N>>, nu: &Velocity<T, N>, since: T) -> Findings {
        if !nu.is_finite() {
            return Findings::STATE_NOT_FINITE;
        }
        let mut findings = Findings::NONE;
        if !self.within_speed(nu) {
            findings = findings.and(Findings::STATE_RANGE);
        }
        let Some(last) = last else { return findings };
        let time = self.allowed(since);
        let change = nu.minus(last.nu);
        let change = change.channels().zip(self.params.acceleration.channels());
        if change
            .into_iter()
            .any(|(change, most)| !(change.abs() <= most * time + self.params.velocity_noise))
        {
            findings = findings.and(Findings::STATE_RATE);
        }
        findings
    }

    /// Whether no channel is faster than it can be.
    pub(super) fn within_speed(&self, nu: &Velocity<T, N>) -> bool {
        nu.channels().zip(self.params.speed.channels()).all(|(nu, most)| nu.abs() <= most)
    }

    /// Whether every number of a reference can be, and whether it follows from the one before.
    pub(super) fn reference(
        &self,
        last: Option<&Vector3<T>>,
        reference: &Reference<T>,
        elapsed: T,
    ) -> (bool, bool) {
        let within = |vector: &Vector3<T>, limit: T| vector.iter().all(|value| value.abs() <= limit);
        let can_be = within(&reference.position, self.params.position)
            && within(&reference.velocity, self.params.speed.forward)
            && within(&reference.acceleration, self.params.reference_acceleration);
        let follows = last.is_none_or(|last| {
            let pairs = reference.position.iter().zip(last.iter()).zip(reference.velocity.iter());
            pairs.into_iter().all(|((now, before), rate)| {
                (*now - *before).abs() <= self.params.reference_step + rate.abs() * elapsed
            })
        });
        (can_be, follows)
    }

    /// How far a coordinate should have moved while it kept the very same bits, m and rad, after an update in which it kept them.
    ///
    /// d <- (1 - T/0.256 s) d + nu elapsed, signed, so that the noise of a velocity at rest goes to and fro. A coordinate that is pushed
    /// hard and does not move is given 1/16 of the noise an update. Beyond the noise a doubt stays until the coordinate moves.
    #[inline]
    pub(super) fn doubt(&self, doubt: T, way: T, strained: bool) -> T {
        let noise = self.params.position_noise;
        let next = if doubt.abs() > noise { doubt } else { doubt * self.memory + way };
        if !strained {
            return next;
        }
        if next < T::ZERO { next - self.push } else { next + self.push }
    }

    /// Whether a doubt has become certainty.
    #[inline]
    pub(super) fn is_frozen(&self, doubt: &Doubt<T, N>) -> bool {
        !(doubt.largest <= self.params.position_noise)
    }

    /// Whether a doubt is larger than a sensor's resolution explains: 1/16 of what makes it certain.
    #[inline]
    pub(super) fn is_doubtful(&self, doubt: &Doubt<T, N>) -> bool {
        !(doubt.largest <= self.push)
    }

    /// The time that a change is measured against, s: one and a half of what has passed, at least of a period.
    fn allowed(&self, since: T) -> T {
        (T::ONE + T::HALF) * since.max(self.period)
    }
}

/// Time over which a doubt is remembered, s.
const MEMORY: f64 = 0.256;
/// Updates after which a coordinate that is pushed hard and does not move counts as frozen.
const STRAINED: u32 = 16;
/// Longest time that a clock is believed to have passed at once, in periods.
const MOST_PERIODS: u32 = 1 << 20;

/// Sum of the squares of all channels, in their order; not by [`Velocity::channels`], whose chain no compiler unrolls.
#[inline(always)]
fn sum_of_squares<T: Real, const N: usize>(nu: &Velocity<T, N>) -> T {
    let mut sum = nu.forward * nu.forward + nu.yaw_rate * nu.yaw_rate;
    for rate in &nu.joints {
        sum += *rate * *rate;
    }
    sum
}

fn squared<T: Real>(vector: &Vector3<T>) -> T {
    vector.x * vector.x + vector.y * vector.y + vector.z * vector.z
}
