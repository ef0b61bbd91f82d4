//! A way from rest to rest in the shortest time that limits of speed, acceleration and jerk allow.
//!
//! Seven phases, symmetric about the middle: jerk up, constant acceleration, jerk down, constant speed, and the first three
//! backwards. Where the way is too short for the full acceleration or speed, those phases have length zero. This is the one case
//! of Ruckig (Berscheid and Kroeger, "Jerk-limited Real-time Trajectory Generation with Arbitrary Target States", RSS 2021) that
//! a run needs, in closed form, exact at its end and with the same bits on every platform; the tests compare the two.

use mm_model::Real;

/// Limits of a motion, all above 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// m/s.
    pub speed: f64,
    /// m/s^2.
    pub acceleration: f64,
    /// m/s^3.
    pub jerk: f64,
}

/// A way from rest to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SCurve {
    length: f64,
    jerk: f64,
    /// Duration of each of the four phases with jerk, s.
    ramp: f64,
    /// Duration of each of the two phases of constant acceleration, s.
    hold: f64,
    /// Duration of the phase of constant speed, s.
    cruise: f64,
}

impl SCurve {
    /// The fastest way over `length`, above 0, within the limits.
    ///
    /// Equation: with T = a/j (or sqrt(v/j) where v < a^2/j) and a hold of v/a - T the full speed takes v (2 T + hold) of way.
    /// On a shorter way the peak speed solves v (v/a + a/j) = length; below 2 a^3/j^2 only jerk counts: T = cbrt(length/(2 j)).
    #[must_use]
    pub fn new(length: f64, limits: Limits) -> Self {
        let Limits { speed, acceleration, jerk } = limits;
        let full = acceleration / jerk;
        let (ramp, hold) = if speed < acceleration * full {
            (Real::sqrt(speed / jerk), 0.0)
        } else {
            (full, speed / acceleration - full)
        };
        let cruise = length / speed - (2.0 * ramp + hold);
        if cruise >= 0.0 {
            return Self { length, jerk, ramp, hold, cruise };
        }
        let (ramp, hold) = if length < 2.0 * acceleration * full * full {
            (libm::cbrt(length / (2.0 * jerk)), 0.0)
        } else {
            let peak = 0.5 * acceleration * (Real::sqrt(full * full + 4.0 * length / acceleration) - full);
            (full, (peak / acceleration - full).max(0.0))
        };
        Self { length, jerk, ramp, hold, cruise: 0.0 }
    }

    /// Time from rest to rest, s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        4.0 * self.ramp + 2.0 * self.hold + self.cruise
    }

    /// Way, speed and acceleration at time `t`; at rest before 0 and after the end.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 3] {
        let left = self.duration() - t;
        if t <= 0.0 {
            [0.0; 3]
        } else if left <= 0.0 {
            [self.length, 0.0, 0.0]
        } else if t <= left {
            self.rise(t)
        } else {
            let [way, speed, acceleration] = self.rise(left);
            [self.length - way, speed, -acceleration]
        }
    }

    /// The first half, up to the middle of the constant speed.
    fn rise(&self, t: f64) -> [f64; 3] {
        let Self { jerk, ramp, hold, .. } = *self;
        if t < ramp {
            let acceleration = jerk * t;
            return [acceleration * t * t / 6.0, 0.5 * acceleration * t, acceleration];
        }
        let peak = jerk * ramp;
        if t < ramp + hold {
            let since = t - ramp;
            let before = 0.5 * peak * ramp;
            let way = peak * ramp * ramp / 6.0 + since * (before + 0.5 * peak * since);
            return [way, before + peak * since, peak];
        }
        let speed = peak * (ramp + hold);
        let way = 0.5 * speed * (2.0 * ramp + hold);
        let until = 2.0 * ramp + hold - t;
        if until <= 0.0 {
            return [way - speed * until, speed, 0.0];
        }
        let missing = 0.5 * jerk * until * until;
        [way - until * (speed - missing / 3.0), speed - missing, jerk * until]
    }
}
