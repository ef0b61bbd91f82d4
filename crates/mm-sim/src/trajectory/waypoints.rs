//! Points to pass or to stop at, from rest to rest, within limits of speed, acceleration and jerk of the tip.

use mm_control::Reference;
use mm_model::Real;
use nalgebra::Vector3;
use thiserror::Error;

use super::scurve::{Limits, SCurve};
use super::spline::Spline;

/// Distance below which two points in a row count as the same, m.
pub const MIN_DISTANCE: f64 = 1e-6;

/// Curves tried for the points of a spline, for each kind of ends.
const ROUNDS: u8 = 30;

/// Cruise speeds tried for a curve.
const CRUISES: u8 = 32;

/// How points are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Joined {
    /// By one curve with continuous curvature.
    Spline,
    /// By straight lines, with a stop at each point.
    Lines,
}

/// Why points make no motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WaypointError {
    /// A motion needs two points.
    #[error("found {0} of at least 2 points")]
    TooFew(usize),
    /// A coordinate of the point of this index is NaN or infinite.
    #[error("point {0} is not finite")]
    NonFinite(usize),
    /// The point of this index is the same as the one before.
    #[error("point {0} is the same as the one before")]
    Same(usize),
    /// The limit of this name is not a number above 0.
    #[error("the limit of {0} is not a number above 0")]
    Limit(&'static str),
    /// The time for the motion is no number: distances or limits are out of all proportion.
    #[error("the motion has no finite duration")]
    Endless,
}

/// A curve passed from rest to rest.
#[derive(Debug, Clone, PartialEq)]
struct Run {
    start: f64,
    curve: Spline,
    timing: SCurve,
}

/// A motion through points.
#[derive(Debug, Clone, PartialEq)]
pub struct Waypoints {
    /// One for the spline, one for each line; not empty.
    runs: Vec<Run>,
    duration: f64,
}

impl Waypoints {
    /// The motion through the points in order, at rest at the first from time 0 and at the last for ever.
    ///
    /// The limits hold for the norms of velocity, acceleration and jerk, at every instant.
    ///
    /// # Errors
    /// As [`WaypointError`] lists them.
    pub fn try_new(points: &[Vector3<f64>], joined: Joined, limits: Limits) -> Result<Self, WaypointError> {
        let Limits { speed, acceleration, jerk } = limits;
        for (name, limit) in [("speed", speed), ("acceleration", acceleration), ("jerk", jerk)] {
            if !(limit > 0.0 && limit.is_finite()) {
                return Err(WaypointError::Limit(name));
            }
        }
        if points.len() < 2 {
            return Err(WaypointError::TooFew(points.len()));
        }
        if let Some(index) = points.iter().position(|point| !point.iter().all(|part| part.is_finite())) {
            return Err(WaypointError::NonFinite(index));
        }
        let is_same = |pair: &[Vector3<f64>]| match pair {
            [from, to] => (to - from).amax() < MIN_DISTANCE,
            _ => false,
        };
        if let Some(before) = points.windows(2).position(is_same) {
            return Err(WaypointError::Same(before + 1));
        }
        let mut motion = Self { runs: Vec::new(), duration: 0.0 };
        match joined {
            Joined::Spline => motion.push(points, limits)?,
            Joined::Lines => points.windows(2).try_for_each(|line| motion.push(line, limits))?,
        }
        Ok(motion)
    }

    fn push(&mut self, points: &[Vector3<f64>], limits: Limits) -> Result<(), WaypointError> {
        let (curve, timing) = balanced(points, limits).ok_or(WaypointError::Endless)?;
        let start = self.duration;
        self.duration += timing.duration();
        self.runs.push(Run { start, curve, timing });
        if self.duration.is_finite() { Ok(()) } else { Err(WaypointError::Endless) }
    }

    /// Time from rest to rest, s.
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// Direction in which the motion sets out, not of unit length.
    #[must_use]
    pub fn departure(&self) -> Vector3<f64> {
        self.runs.first().map_or_else(Vector3::zeros, |run| run.curve.at(0.0)[1])
    }

    /// Position, velocity and acceleration at time `t`; allocation-free, two binary searches.
    #[must_use]
    pub fn at(&self, t: f64) -> Reference<f64> {
        let next = self.runs.partition_point(|run| run.start <= t);
        let zero = Vector3::zeros();
        let Some(run) = self.runs.get(next.saturating_sub(1)) else {
            return Reference { position: zero, velocity: zero, acceleration: zero };
        };
        let [u, rate, change] = run.timing.at(t - run.start);
        let [position, by_u, by_u2] = run.curve.at(u);
        Reference { position, velocity: by_u * rate, acceleration: by_u2 * (rate * rate) + by_u * change }
    }
}

/// The fastest of some curves through the points, and its timing.
///
/// The first has the distances of the points as its intervals. Where it needs a limit most, all of it has to wait: so each
/// interval is stretched by what its piece asks of the limits, half of acceleration and jerk being left for speeding up, until
/// the pieces ask much the same. Both kinds of ends are tried: straight ones suit few points, parabolas many.
fn balanced(points: &[Vector3<f64>], limits: Limits) -> Option<(Spline, SCurve)> {
    let Limits { speed, acceleration, jerk } = limits;
    let way = |pair: (&Vector3<f64>, &Vector3<f64>)| pair.1 - pair.0;
    let norm = |way: Vector3<f64>| Real::sqrt(way.dot(&way));
    let distances: Vec<f64> = points.iter().zip(points.iter().skip(1)).map(way).map(norm).collect();
    let mut best: Option<(Spline, SCurve)> = None;
    for end in [0.0, 1.0] {
        let mut intervals = distances.clone();
        for _ in 0..ROUNDS {
            let curve = Spline::through(points, &intervals, end);
            for (interval, [b1, b2, b3]) in intervals.iter_mut().zip(curve.bounds_by_piece()) {
                let asked = (b1 / speed)
                    .max(Real::sqrt(b2 / (0.5 * acceleration)))
                    .max(libm::cbrt(b3 / (0.5 * jerk)));
                *interval *= Real::sqrt(asked);
            }
            if let Some(timing) = fastest(curve.length(), curve.bounds(), limits)
                && best.as_ref().is_none_or(|(_, so_far)| timing.duration() < so_far.duration())
            {
                best = Some((curve, timing));
            }
            if distances.len() < 2 {
                return best; // the straight line
            }
        }
    }
    best
}

/// The fastest of the S-curves over a curve's parameter that keep the limits by the bounds of the curve's derivatives.
///
/// Equation: with bounds b1, b2, b3 on the derivatives of p by u, the velocity p' u', the acceleration p'' u'^2 + p' u'' and the
/// jerk p''' u'^3 + 3 p'' u' u'' + p' u''' stay within the limits v, a, j for u' <= V <= v/b1, u'' <= A with b2 V^2 + b1 A <= a,
/// and u''' <= J with b3 V^3 + 3 b2 V A + b1 J <= j. Of what the speed V leaves of the jerk, at most half goes to A. A high
/// cruise speed leaves little for speeding up: 32 of them are tried. A straight line has b1 alone and meets its limits.
fn fastest(length: f64, [b1, b2, b3]: [f64; 3], limits: Limits) -> Option<SCurve> {
    let Limits { speed, acceleration, jerk } = limits;
    let cap = (speed / b1).min(Real::sqrt(acceleration / b2)).min(libm::cbrt(jerk / b3));
    let candidate = |number: u8| {
        let v = cap * f64::from(number) / f64::from(CRUISES);
        let left = jerk - b3 * v * v * v;
        let a = ((acceleration - b2 * v * v) / b1).min(0.5 * left / (3.0 * b2 * v));
        let j = (left - 3.0 * b2 * v * a) / b1;
        let curve = SCurve::new(length, Limits { speed: v, acceleration: a, jerk: j });
        (a > 0.0 && j > 0.0 && curve.duration().is_finite()).then_some(curve)
    };
    (1..=CRUISES).filter_map(candidate).min_by(|one, other| one.duration().total_cmp(&other.duration()))
}
