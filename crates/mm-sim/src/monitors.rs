//! What a run is watched for besides its metrics: Lyapunov function, reaching condition, saturation, restraints of the outer loop.
//!
//! What costs more than a comparison is evaluated at samples only, as often as the log is written.

mod lyapunov;

pub use lyapunov::Lyapunov;

use mm_control::{Output, Status};
use mm_model::{Force, Real};
use serde::Serialize;

use crate::metrics::PerTorque;

/// How long something lasted, and when it began.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Lasting {
    /// Fraction of the control periods.
    pub fraction: f64,
    /// First time, s; none if never.
    pub first_s: Option<f64>,
}

/// What the monitors saw. Channels are forward, yaw, joints 1 to 3.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MonitorReport {
    /// Largest V = s'Ms/2 at a sample, with the inertia of the true robot, J; none without a sample.
    pub lyapunov_max_j: Option<f64>,
    /// Largest V' at a sample, W: how fast V ever grew; none without a sample.
    pub lyapunov_rate_max_w: Option<f64>,
    /// Largest gain that the reaching condition (4.44) asked for at a sample, by channel, N and N m; none without a sample or for
    /// a law without a switching gain.
    pub reaching_bound_max: [Option<f64>; 5],
    /// Fraction of the samples at which the law's gain was enough, by channel; none without a sample or such a gain.
    pub reaching_met_fraction: [Option<f64>; 5],
    /// Fraction of the samples at which the law's gain was too small in some channel; none without a sample or such a gain.
    pub reaching_failed_fraction: Option<f64>,
    /// The controller or an actuator limited a torque.
    pub torque_limited: Lasting,
    /// Fraction of the control periods in which the controller cut its torque to the limit, by actuator.
    pub torque_limited_fraction: PerTorque,
    /// Near a singularity: the manipulability was below its threshold; the pseudo-inverse was damped if damping is on.
    pub near_singular: Lasting,
    /// The outer loop bounded the speed of its correction or the base's forward speed.
    pub speed_limited: Lasting,
    /// The outer loop held a joint's rate to the bound that keeps it within its limits.
    pub joint_limited: Lasting,
}

/// Counts one outcome.
#[derive(Debug, Clone, Copy, Default)]
struct Counter {
    ticks: u64,
    first: Option<f64>,
}

impl Counter {
    fn add(&mut self, t: f64, is: bool) {
        if is {
            self.ticks += 1;
            self.first.get_or_insert(t);
        }
    }

    fn over(&self, ticks: u64) -> Lasting {
        Lasting { fraction: fraction(self.ticks, ticks).unwrap_or(0.0), first_s: self.first }
    }
}

/// Gathers what the monitors see, in constant memory.
#[derive(Debug, Clone)]
pub struct Monitors {
    authority: Option<Force<f64, 3>>,
    near_singular: Counter,
    speed_limited: Counter,
    joint_limited: Counter,
    any_torque_limited: Counter,
    torque_limited: [u64; 5],
    samples: u64,
    lyapunov_max: f64,
    lyapunov_rate_max: f64,
    bound_max: [f64; 5],
    enough: [u64; 5],
    all_enough: u64,
}

impl Monitors {
    /// Nothing seen yet, of a law that can oppose `authority` to a large s; none for a law without a switching gain.
    #[must_use]
    pub fn new(authority: Option<Force<f64, 3>>) -> Self {
        Self {
            authority,
            near_singular: Counter::default(),
            speed_limited: Counter::default(),
            joint_limited: Counter::default(),
            any_torque_limited: Counter::default(),
            torque_limited: [0; 5],
            samples: 0,
            lyapunov_max: 0.0,
            lyapunov_rate_max: f64::NEG_INFINITY,
            bound_max: [0.0; 5],
            enough: [0; 5],
            all_enough: 0,
        }
    }

    /// Takes the outcomes of a control tick, most have none, and whether the controller or an actuator limited a torque.
    #[inline]
    pub fn tick(&mut self, t: f64, output: &Output<f64, 3>, torque_limited: bool) {
        let Status { near_singular, speed_limited, joint_limited, .. } = output.status;
        // One branch instead of four.
        if torque_limited | near_singular | speed_limited | joint_limited {
            self.count(t, output, torque_limited);
        }
    }

    #[inline(never)]
    fn count(&mut self, t: f64, output: &Output<f64, 3>, torque_limited: bool) {
        let status = &output.status;
        self.any_torque_limited.add(t, torque_limited);
        self.near_singular.add(t, status.near_singular);
        self.speed_limited.add(t, status.speed_limited);
        self.joint_limited.add(t, status.joint_limited);
        for (count, cut) in self.torque_limited.iter_mut().zip(cut_torques(output)) {
            *count += u64::from(cut);
        }
    }

    /// Judges by another law's authority from now on.
    pub const fn retune(&mut self, authority: Option<Force<f64, 3>>) {
        self.authority = authority;
    }

    /// Takes a sample: the Lyapunov function and the gain that the reaching condition asks for, which means nothing to a law
    /// without a switching gain.
    pub fn sample(&mut self, lyapunov: &Lyapunov, required: &Force<f64, 3>) {
        self.samples += 1;
        self.lyapunov_max = Real::max(self.lyapunov_max, lyapunov.value);
        self.lyapunov_rate_max = Real::max(self.lyapunov_rate_max, lyapunov.rate);
        let Some(authority) = &self.authority else { return };
        for (most, needed) in self.bound_max.iter_mut().zip(required.channels()) {
            *most = Real::max(*most, needed);
        }
        let mut all = true;
        for ((count, needed), offered) in
            self.enough.iter_mut().zip(required.channels()).zip(authority.channels())
        {
            // A law has to offer what is asked for but for rounding.
            let enough = needed <= offered + 1e-9 * (1.0 + offered);
            *count += u64::from(enough);
            all &= enough;
        }
        self.all_enough += u64::from(all);
    }

    /// Whether the law's gain met the reaching condition at every sample; none without a sample or such a gain.
    #[must_use]
    pub fn reaching(&self) -> Option<bool> {
        (self.samples > 0 && self.authority.is_some()).then_some(self.all_enough == self.samples)
    }

    /// What was seen over a number of control ticks.
    #[must_use]
    pub fn report(&self, ticks: u64) -> MonitorReport {
        let of_samples = |count| fraction(count, self.samples);
        let sampled = self.samples > 0;
        let judged = sampled && self.authority.is_some();
        let [right, left, j1, j2, j3] =
            self.torque_limited.map(|count| fraction(count, ticks).unwrap_or(0.0));
        MonitorReport {
            lyapunov_max_j: sampled.then_some(self.lyapunov_max),
            lyapunov_rate_max_w: sampled.then_some(self.lyapunov_rate_max),
            reaching_bound_max: self.bound_max.map(|most| judged.then_some(most)),
            reaching_met_fraction: self.enough.map(|count| judged.then_some(count).and_then(of_samples)),
            reaching_failed_fraction: judged.then_some(self.samples - self.all_enough).and_then(of_samples),
            torque_limited: self.any_torque_limited.over(ticks),
            torque_limited_fraction: PerTorque { right, left, joints: [j1, j2, j3] },
            near_singular: self.near_singular.over(ticks),
            speed_limited: self.speed_limited.over(ticks),
            joint_limited: self.joint_limited.over(ticks),
        }
    }
}

/// Which torques the controller cut to their limits: right wheel, left wheel, joints.
#[must_use]
pub fn cut_torques(output: &Output<f64, 3>) -> [bool; 5] {
    let (given, asked) = (&output.torque, &output.signals.commanded);
    // Cut or not, a torque is copied: any difference is a cut.
    let differs = |a: f64, b: f64| a.to_bits() != b.to_bits();
    let [g1, g2, g3] = given.joints;
    let [a1, a2, a3] = asked.joints;
    [
        differs(given.right, asked.right),
        differs(given.left, asked.left),
        differs(g1, a1),
        differs(g2, a2),
        differs(g3, a3),
    ]
}

#[expect(clippy::cast_precision_loss, reason = "a tick count is far below 2^53")]
fn fraction(count: u64, of: u64) -> Option<f64> {
    (of > 0).then(|| count as f64 / of as f64)
}
