//! From rest to rest along any path: the path's own clock against the run's.

/// How a motion comes to rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// When it rests, s; not before both ramps are over.
    pub at: f64,
    /// Time over which it slows down, s; above 0.
    pub ramp: f64,
}

/// The path's own time, its rate and the change of its rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct OwnTime {
    /// s.
    pub(super) time: f64,
    /// 0 at rest, 1 at full speed.
    pub(super) rate: f64,
    /// 1/s.
    pub(super) change: f64,
}

impl OwnTime {
    /// The own time at time `t`.
    ///
    /// Equation, during a start of length T with u = t/T: the own time is T (u^3 - u^4/2), whose rate 3 u^2 - 2 u^3 rises from
    /// 0 to 1 with continuous change; after it the path lags T/2 behind the clock. A stop is a start run backwards. The change
    /// is at most 3/(2T), its own rate of change at most 6/T^2.
    pub(super) fn at(t: f64, start_ramp: f64, stop: Option<Stop>) -> Self {
        if t < start_ramp {
            let (time, rate, change) = rise(t, start_ramp);
            return Self { time, rate, change };
        }
        if let Some(Stop { at, ramp }) = stop
            && t > at - ramp
        {
            let end = at - 0.5 * (start_ramp + ramp);
            let (time, rate, change) = rise((at - t).max(0.0), ramp);
            return Self { time: end - time, rate, change: -change };
        }
        Self { time: t - 0.5 * start_ramp, rate: 1.0, change: 0.0 }
    }
}

/// Own time, rate and its change a time `t` after the beginning of a ramp.
fn rise(t: f64, ramp: f64) -> (f64, f64, f64) {
    let u = t / ramp;
    (ramp * u * u * u * (1.0 - 0.5 * u), u * u * (3.0 - 2.0 * u), 6.0 * u * (1.0 - u) / ramp)
}
