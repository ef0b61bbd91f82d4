//! Reference trajectories of the tip, with their first and second derivatives in closed form.

mod ramps;
mod scurve;
mod smooth_square;
mod spline;
mod square;
mod waypoints;

use std::sync::Arc;

use mm_control::Reference;
use mm_model::Real;
use nalgebra::Vector3;

use ramps::OwnTime;
pub use ramps::Stop;
pub use scurve::{Limits, SCurve};
pub use spline::Spline;
pub use waypoints::{Joined, MIN_DISTANCE, WaypointError, Waypoints};

/// A path of the tip in time.
#[derive(Debug, Clone, PartialEq)]
pub enum Path {
    /// Appendix B of the thesis, literally: straights and arcs of radius 1 m at 0.31416 m/s.
    Square,
    /// The same square from exact constants, its joints blended to continuous acceleration and bounded jerk.
    SmoothSquare {
        /// Time over which the motion is averaged, s.
        window: f64,
    },
    /// (5.1) to (5.3): x = 0.5 + 0.2 t, y = 0.3 sin 0.4t, z = 0.5 + 0.1 sin 0.4t.
    Sinusoid,
    /// (5.4) to (5.6): x = 0.1 t sin 0.25t, y = 0.1 t cos 0.25t, z = 0.3 + 0.008 t.
    Spiral,
    /// A point, and from `at` on another one, at once.
    Step {
        /// Point before the step, m.
        from: Vector3<f64>,
        /// Displacement, m.
        by: Vector3<f64>,
        /// Time of the step, s.
        at: f64,
    },
    /// A straight line at constant velocity.
    Line {
        /// Point at time 0, m.
        from: Vector3<f64>,
        /// Velocity, m/s.
        velocity: Vector3<f64>,
    },
    /// A horizontal circle at constant speed.
    Circle {
        /// Centre, m.
        center: Vector3<f64>,
        /// Radius, m.
        radius: f64,
        /// Angular speed, counter-clockwise positive, rad/s.
        rate: f64,
        /// Direction from the centre to the point at time 0, rad.
        start: f64,
    },
    /// A fixed point.
    Hold(Vector3<f64>),
    /// Through points, from rest to rest.
    Waypoints(Arc<Waypoints>),
}

/// A path, started smoothly from rest and brought to rest again if asked to.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// The path.
    pub path: Path,
    /// Time over which the motion along the path comes up to speed, s; 0 starts at full speed.
    pub start_ramp: f64,
    /// How the motion along the path comes to rest; it does not without one.
    pub stop: Option<Stop>,
}

impl Trajectory {
    /// Position, velocity and acceleration at time `t`.
    ///
    /// Equation: with ramps the path p runs on its own time s(t), so that velocity is p' s' and acceleration p'' s'^2 + p' s''.
    /// s' rises from 0 to 1 as the cubic 3 u^2 - 2 u^3 of u = t/T and falls in the same way, with s'' continuous.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Reference<f64> {
        if self.start_ramp > 0.0 || self.stop.is_some() { self.ramped(t) } else { self.path.at(t) }
    }

    /// Time that a motion through points takes from rest to rest, its ramps included, s; none for any other path.
    ///
    /// Each ramp lets the path lag half the ramp's time behind the clock.
    #[must_use]
    pub fn motion_duration(&self) -> Option<f64> {
        let Path::Waypoints(waypoints) = &self.path else { return None };
        let ramps = self.start_ramp + self.stop.map_or(0.0, |stop| stop.ramp);
        Some(waypoints.duration() + 0.5 * ramps)
    }

    fn ramped(&self, t: f64) -> Reference<f64> {
        let OwnTime { time, rate, change } = OwnTime::at(t, self.start_ramp, self.stop);
        let at = self.path.at(time);
        Reference {
            position: at.position,
            velocity: at.velocity * rate,
            acceleration: at.acceleration * (rate * rate) + at.velocity * change,
        }
    }
}

impl Path {
    /// Position, velocity and acceleration at time `t` of the path's own clock.
    #[must_use]
    #[inline]
    pub fn at(&self, t: f64) -> Reference<f64> {
        match self {
            Self::Square => square::at(t),
            Self::SmoothSquare { window } => smooth_square::at(t, *window),
            Self::Sinusoid => sinusoid(t),
            Self::Spiral => spiral(t),
            Self::Step { from, by, at } => fixed(if t < *at { *from } else { from + by }),
            Self::Line { from, velocity } => Reference {
                position: from + velocity * t,
                velocity: *velocity,
                acceleration: Vector3::zeros(),
            },
            Self::Circle { center, radius, rate, start } => {
                let (sin, cos) = Real::sin_cos(start + rate * t);
                let out = Vector3::new(cos, sin, 0.0) * *radius;
                Reference {
                    position: center + out,
                    velocity: Vector3::new(-out.y, out.x, 0.0) * *rate,
                    acceleration: out * -(rate * rate),
                }
            }
            Self::Hold(point) => fixed(*point),
            Self::Waypoints(waypoints) => waypoints.at(t),
        }
    }

    /// Direction in which the path sets out, not of unit length; zero where it does not move.
    #[must_use]
    pub fn departure(&self) -> Vector3<f64> {
        match self {
            Self::Waypoints(waypoints) => waypoints.departure(),
            _ => self.at(0.0).velocity,
        }
    }
}

fn fixed(position: Vector3<f64>) -> Reference<f64> {
    Reference { position, velocity: Vector3::zeros(), acceleration: Vector3::zeros() }
}

fn sinusoid(t: f64) -> Reference<f64> {
    let w = 0.4;
    let (sin, cos) = Real::sin_cos(w * t);
    Reference {
        position: Vector3::new(0.5 + 0.2 * t, 0.3 * sin, 0.5 + 0.1 * sin),
        velocity: Vector3::new(0.2, 0.3 * w * cos, 0.1 * w * cos),
        acceleration: Vector3::new(0.0, -(0.3 * w * w * sin), -(0.1 * w * w * sin)),
    }
}

fn spiral(t: f64) -> Reference<f64> {
    let w = 0.25;
    let (sin, cos) = Real::sin_cos(w * t);
    let (r, dr) = (0.1 * t, 0.1);
    Reference {
        position: Vector3::new(r * sin, r * cos, 0.3 + 0.008 * t),
        velocity: Vector3::new(dr * sin + r * w * cos, dr * cos - r * w * sin, 0.008),
        acceleration: Vector3::new(
            2.0 * dr * w * cos - r * w * w * sin,
            -(2.0 * dr * w * sin) - r * w * w * cos,
            0.0,
        ),
    }
}
