//! Quantities measured on the runs of an experiment.

use mm_model::Real;
use nalgebra::Vector3;

use crate::figures::{Group, Recording};
use crate::metrics::{Metrics, PerAxisSum};

/// A direction, or the sum over all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Axis {
    X,
    Y,
    Z,
    Sum,
}

impl Axis {
    const fn of(self, values: &PerAxisSum) -> f64 {
        match self {
            Self::X => values.x,
            Self::Y => values.y,
            Self::Z => values.z,
            Self::Sum => values.sum,
        }
    }
}

/// A quantity measured on one run, or on two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Measure {
    /// ITAE along an axis, m s^2.
    Itae(Axis),
    /// How far the ITAE is below that of another law, (other - this)/other in percent.
    ItaeBelow(&'static str, Axis),
    /// Root mean square of the error, mm.
    Rms,
    /// Largest error, mm.
    Largest,
    /// Largest error from a time on, mm.
    LargestFrom(f64),
    /// Last time with an error above 10 mm, s.
    Settled,
    /// Total variation of all torques, N m/s.
    Variation,
    /// Periods with a limited torque, percent.
    Saturated,
    /// Largest forward speed, m/s.
    TopSpeed,
    /// Distance of the base's last position from its first in the time between, m/s.
    MeanSpeed,
    /// Largest distance of the base from the x axis, m.
    Sideways,
    /// Radius of the circle through three points of the base's path, m.
    BaseRadius,
    /// Radius of the circle through three points of the tip's path, m.
    TipRadius,
    /// Distance of the base's last position from its first, m.
    BaseTravel,
    /// Distance of the tip's last position from its first, seen from above, m.
    TipSpan,
}

/// What is known of a run that went to its end.
#[derive(Debug, Clone, Copy)]
pub(super) struct Done<'a> {
    pub(super) metrics: &'a Metrics,
    pub(super) recording: &'a Recording,
    /// Base and tip after the last step.
    pub(super) last: [Vector3<f64>; 2],
    pub(super) duration_s: f64,
}

impl Measure {
    /// The value on a run; `other` finds the run of another law.
    pub(super) fn of<'a>(self, run: Done<'a>, other: impl Fn(&str) -> Option<Done<'a>>) -> Option<f64> {
        let m = run.metrics;
        let pose = || run.recording.points(Group::Pose).into_iter().map(|[x, y, _]| Vector3::new(x, y, 0.0));
        let travelled = || {
            let first = pose().next()?;
            Some((run.last[0] - first).norm())
        };
        let value = match self {
            Self::Itae(axis) => axis.of(&m.itae_m_s2),
            Self::ItaeBelow(law, axis) => {
                below(axis.of(&other(law)?.metrics.itae_m_s2), axis.of(&m.itae_m_s2))
            }
            Self::Rms => m.rmse_m.norm * 1e3,
            Self::Largest => m.max_error_m * 1e3,
            Self::LargestFrom(t) => run.recording.largest_error(t)? * 1e3,
            Self::Settled => m.settling_time_s?,
            Self::Variation => m.torque_tv_n_m_per_s.sum,
            Self::Saturated => m.saturated_fraction * 100.0,
            Self::TopSpeed => m.max_speed_m_s,
            Self::MeanSpeed => travelled()? / run.duration_s,
            Self::Sideways => pose().map(|p| Real::abs(p.y)).fold(0.0, f64::max),
            Self::BaseRadius => radius(&pose().collect::<Vec<_>>())?,
            Self::TipRadius => radius(&tips(run.recording))?,
            Self::BaseTravel => travelled()?,
            Self::TipSpan => (run.last[1] - tips(run.recording).first()?).xy().norm(),
        };
        value.is_finite().then_some(value)
    }
}

/// (before - after)/before in percent: the form behind Table 5.2, not (5.8) as printed.
fn below(before: f64, after: f64) -> f64 {
    (before - after) / before * 100.0
}

fn tips(recording: &Recording) -> Vec<Vector3<f64>> {
    recording.points(Group::Tip).into_iter().map(Vector3::from).collect()
}

/// Radius of the circle through the first point and those at one and two thirds: abc over four times the area.
fn radius(points: &[Vector3<f64>]) -> Option<f64> {
    let third = points.len() / 3;
    let (p, q, r) = (points.first()?, points.get(third)?, points.get(2 * third)?);
    let (a, b, c) = (q - p, r - q, p - r);
    let twice_area = a.cross(&b).norm();
    Some(a.norm() * b.norm() * c.norm() / (2.0 * twice_area))
}

#[cfg(test)]
mod tests {
    use super::{below, radius};
    use nalgebra::Vector3;

    #[test]
    fn table_5_2_is_made_with_the_baseline_as_the_divisor() {
        for (before, after, printed) in
            [(3.91, 2.06, 47.31), (4.637, 4.265, 8.02), (2.431, 1.232, 49.32), (10.978, 7.557, 31.16)]
        {
            let percent = below(before, after);
            assert!(
                (percent - printed).abs() < 0.005 + 1e-9,
                "{before} to {after}: {percent} against {printed}"
            );
        }
    }

    #[test]
    fn three_points_give_the_radius() {
        let circle: Vec<_> = (0..600)
            .map(|i| {
                let (sin, cos) = mm_model::Real::sin_cos(f64::from(i) * 0.001);
                Vector3::new(1.0 + 0.5 * cos, 0.3, 0.5 * sin)
            })
            .collect();
        let got = radius(&circle).expect("a circle has a radius");
        assert!((got - 0.5).abs() < 1e-12, "{got}: rounding over an angle of 0.2");
        assert_eq!(radius(&[]), None, "no points");
    }
}
