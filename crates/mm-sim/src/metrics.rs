//! What a run is judged by, accumulated tick by tick in constant memory.

mod histogram;
mod values;

pub use values::{Metrics, PerAxisNorm, PerAxisSum, PerTorque, PerTorqueSum};

use histogram::MagnitudeHistogram;
use mm_model::{Real, Torque, Velocity};
use nalgebra::Vector3;

/// Error beyond which the tip counts as not settled, m.
const SETTLED_M: f64 = 0.01;

/// One control tick as the metrics see it.
#[derive(Debug, Clone, Copy)]
pub struct Tick<'a> {
    /// Time, s.
    pub t: f64,
    /// Error of the true tip, actual minus desired, m.
    pub error: Vector3<f64>,
    /// True velocity.
    pub nu: &'a Velocity<f64, 3>,
    /// Rates of the right and the left wheel, rad/s.
    pub wheels: (f64, f64),
    /// Torque at the plant's input.
    pub torque: &'a Torque<f64, 3>,
    /// Sliding variable; zero for an imposed motion.
    pub sliding: &'a Velocity<f64, 3>,
    /// det(J J') of the true robot.
    pub manipulability_squared: f64,
    /// Whether a torque was limited.
    pub saturated: bool,
    /// Whether each joint is within its limits.
    pub within_limits: [bool; 3],
}

/// Accumulates the metrics over the control ticks, by the rectangle rule.
#[derive(Debug, Clone)]
pub struct Accumulator {
    period: f64,
    /// Time from which the sliding band counts.
    band_from: f64,
    ticks: u64,
    itae: Vector3<f64>,
    iae: Vector3<f64>,
    ise: Vector3<f64>,
    max_error_squared: f64,
    last_outside: Option<f64>,
    ever_settled: bool,
    variation: [f64; 5],
    peak: [f64; 5],
    last_torque: Option<[f64; 5]>,
    effort: f64,
    energy: f64,
    saturated: u64,
    max_speed: f64,
    min_manipulability_squared: f64,
    band: [MagnitudeHistogram; 5],
    was_within: [bool; 3],
    crossings: u64,
}

impl Accumulator {
    /// Nothing seen yet, of a run of `duration` at control period `period`, both in s.
    #[must_use]
    pub fn new(duration: f64, period: f64) -> Self {
        Self {
            period,
            band_from: 0.1 * duration,
            ticks: 0,
            itae: Vector3::zeros(),
            iae: Vector3::zeros(),
            ise: Vector3::zeros(),
            max_error_squared: 0.0,
            last_outside: None,
            ever_settled: false,
            variation: [0.0; 5],
            peak: [0.0; 5],
            last_torque: None,
            effort: 0.0,
            energy: 0.0,
            saturated: 0,
            max_speed: 0.0,
            min_manipulability_squared: f64::INFINITY,
            band: core::array::from_fn(|_| MagnitudeHistogram::default()),
            was_within: [true; 3],
            crossings: 0,
        }
    }

    /// Adds one control tick.
    #[inline]
    pub fn add(&mut self, tick: &Tick<'_>) {
        self.ticks += 1;
        let e = tick.error.map(Real::abs);
        let squares = e.component_mul(&e);
        self.iae += e;
        self.itae += e * tick.t;
        self.ise += squares;
        let error_squared = squares.x + squares.y + squares.z;
        self.max_error_squared = Real::max(self.max_error_squared, error_squared);
        if error_squared > SETTLED_M * SETTLED_M {
            self.last_outside = Some(tick.t);
        } else {
            self.ever_settled = true;
        }
        self.add_torque(tick);
        self.saturated += u64::from(tick.saturated);
        self.max_speed = Real::max(self.max_speed, Real::abs(tick.nu.forward));
        self.min_manipulability_squared =
            Real::min(self.min_manipulability_squared, tick.manipulability_squared);
        if tick.t >= self.band_from {
            let [s1, s2, s3] = tick.sliding.joints;
            let all = [tick.sliding.forward, tick.sliding.yaw_rate, s1, s2, s3];
            for (channel, s) in self.band.iter_mut().zip(all) {
                channel.add(s);
            }
        }
        for (was, &is) in self.was_within.iter_mut().zip(&tick.within_limits) {
            self.crossings += u64::from(*was && !is);
            *was = is;
        }
    }

    #[inline]
    fn add_torque(&mut self, tick: &Tick<'_>) {
        let [j1, j2, j3] = tick.torque.joints;
        let torque = [tick.torque.right, tick.torque.left, j1, j2, j3];
        let [d1, d2, d3] = tick.nu.joints;
        let rates = [tick.wheels.0, tick.wheels.1, d1, d2, d3];
        let mut power = 0.0;
        for ((value, rate), peak) in torque.iter().zip(rates).zip(&mut self.peak) {
            *peak = Real::max(*peak, Real::abs(*value));
            self.effort += value * value;
            power += value * rate;
        }
        if let Some(last) = &self.last_torque {
            for ((sum, value), before) in self.variation.iter_mut().zip(&torque).zip(last) {
                *sum += Real::abs(value - before);
            }
        }
        self.last_torque = Some(torque);
        self.energy += Real::abs(power);
    }

    /// Counts the error of a tick that ended the run, if it is a number.
    pub fn note_last_error(&mut self, error: &Vector3<f64>) {
        let squared = error.norm_squared();
        self.max_error_squared = Real::max(squared, self.max_error_squared);
    }

    /// Number of ticks seen.
    #[must_use]
    pub const fn ticks(&self) -> u64 {
        self.ticks
    }

    /// The metrics of the ticks seen, over the time that they cover; `reaching` is the monitors' verdict.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "a tick count is far below 2^53")]
    pub fn finish(&self, reaching: Option<bool>) -> Metrics {
        let ticks = self.ticks as f64;
        let duration = ticks * self.period;
        let integral = |v: Vector3<f64>| PerAxisSum::of(v * self.period);
        let mean_square = self.ise / ticks;
        let root = |x: f64| Real::sqrt(x);
        let [right, left, j1, j2, j3] = self.variation.map(|sum| sum / duration);
        let [peak_right, peak_left, p1, p2, p3] = self.peak;
        Metrics {
            itae_m_s2: integral(self.itae),
            iae_m_s: integral(self.iae),
            ise_m2_s: integral(self.ise),
            rmse_m: PerAxisNorm {
                x: root(mean_square.x),
                y: root(mean_square.y),
                z: root(mean_square.z),
                norm: root(mean_square.x + mean_square.y + mean_square.z),
            },
            max_error_m: root(self.max_error_squared),
            settling_time_s: self.ever_settled.then(|| self.last_outside.unwrap_or(0.0)),
            torque_tv_n_m_per_s: PerTorqueSum {
                right,
                left,
                joints: [j1, j2, j3],
                sum: right + left + j1 + j2 + j3,
            },
            peak_torque_n_m: PerTorque { right: peak_right, left: peak_left, joints: [p1, p2, p3] },
            effort_n2_m2_s: self.effort * self.period,
            energy_j: self.energy * self.period,
            saturated_fraction: self.saturated as f64 / ticks,
            max_speed_m_s: self.max_speed,
            min_manipulability: root(Real::max(self.min_manipulability_squared, 0.0)),
            sliding_band: self.band.each_ref().map(|channel| channel.percentile(0.99)),
            joint_limit_crossings: self.crossings,
            reaching_condition_met: reaching,
        }
    }
}
