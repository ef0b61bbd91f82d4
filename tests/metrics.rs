//! The metrics and the digest of a run are what the interface says they are.
//!
//! Laws: every metric follows from the samples at the control ticks by the formula of its definition (rectangle rule, errors of
//! the true tip, torques at the plant's input); the digest is XXH3-128 over the little-endian bits of (t, q, nu, torque), and
//! depends on the trajectory alone.
//! Why: users compare runs by these numbers, and programs of theirs recompute them from logs.
//! Reference: recomputed here from a record of every tick; wheel rates, manipulability and percentile each by another formula
//! or algorithm than the simulator's.
//! Tolerances: 1e-9 relative for sums of 3000 terms in another order; 0.5 % for the sliding band, whose bins are 0.4 % wide.

use mm_sim::metrics::Metrics;
use mm_sim::simulation::RunResult;
use mm_tests::{Tick, build, load, load_text, measured, recorded, run};
use nalgebra::{Matrix3, Matrix3x5, Vector3};
use xxhash_rust::xxh3::xxh3_128;

const PERIOD: f64 = 1e-3;

fn torques(tick: &Tick) -> [f64; 5] {
    let [t1, t2, t3] = tick.torque.joints;
    [tick.torque.right, tick.torque.left, t1, t2, t3]
}

/// sqrt det(J J'), with the Jacobian of the thesis's robot by central differences of the tip.
fn manipulability(tick: &Tick) -> f64 {
    let (q, h) = (&tick.state.q, 1e-5);
    let tip = |forward: f64, turn: f64, joints: [f64; 3]| {
        let heading = q.heading + turn;
        let [q1, q2, q3] = [q.joints[0] + joints[0], q.joints[1] + joints[1], q.joints[2] + joints[2]];
        let reach = 0.5 * libm::cos(q2) + 0.5 * libm::cos(q2 + q3);
        Vector3::new(
            forward * libm::cos(q.heading) + 0.06 * libm::cos(heading) + reach * libm::cos(heading + q1),
            forward * libm::sin(q.heading) + 0.06 * libm::sin(heading) + reach * libm::sin(heading + q1),
            0.5 * libm::sin(q2) + 0.5 * libm::sin(q2 + q3),
        )
    };
    let along = |i: usize, h: f64| {
        let mut by = [0.0; 5];
        by[i] = h;
        tip(by[0], by[1], [by[2], by[3], by[4]])
    };
    let columns: [Vector3<f64>; 5] = core::array::from_fn(|i| (along(i, h) - along(i, -h)) / (2.0 * h));
    let jacobian = Matrix3x5::from_columns(&columns);
    let square: Matrix3<f64> = jacobian * jacobian.transpose();
    square.determinant().sqrt()
}

fn close(what: &str, got: f64, wanted: f64, relative: f64) {
    let off = (got - wanted).abs();
    assert!(off <= relative * wanted.abs() + 1e-15, "{what}: {got:e}, recomputed {wanted:e}");
}

/// The 99th percentile of |s| after a tenth of the run, by sorting.
fn band(ticks: &[Tick], duration: f64, channel: usize) -> f64 {
    let mut sizes: Vec<f64> = ticks
        .iter()
        .filter(|tick| tick.t >= 0.1 * duration)
        .filter_map(|tick| tick.output?.signals.sliding.channels().nth(channel))
        .map(f64::abs)
        .collect();
    sizes.sort_by(f64::total_cmp);
    sizes[(sizes.len() * 99).div_ceil(100) - 1]
}

fn recompute(name: &str, ticks: &[Tick], m: &Metrics) {
    let duration = ticks.len() as f64 * PERIOD;
    let errors: Vec<Vector3<f64>> = ticks.iter().map(|tick| tick.tip - tick.desired).collect();
    let sum = |f: &dyn Fn(usize) -> f64| (0..ticks.len()).map(f).sum::<f64>();
    let axes = [
        (m.itae_m_s2.x, m.iae_m_s.x, m.ise_m2_s.x, m.rmse_m.x),
        (m.itae_m_s2.y, m.iae_m_s.y, m.ise_m2_s.y, m.rmse_m.y),
        (m.itae_m_s2.z, m.iae_m_s.z, m.ise_m2_s.z, m.rmse_m.z),
    ];
    for (axis, (itae, iae, ise, rmse)) in axes.into_iter().enumerate() {
        let at = |what: &str| format!("{name}: {what} of axis {axis}");
        close(&at("ITAE"), itae, PERIOD * sum(&|k| k as f64 * PERIOD * errors[k][axis].abs()), 1e-9);
        close(&at("IAE"), iae, PERIOD * sum(&|k| errors[k][axis].abs()), 1e-9);
        let squares = sum(&|k| errors[k][axis].powi(2));
        close(&at("ISE"), ise, PERIOD * squares, 1e-9);
        close(&at("RMSE"), rmse, (squares / ticks.len() as f64).sqrt(), 1e-9);
    }
    close("ITAE's sum", m.itae_m_s2.sum, axes.iter().map(|a| a.0).sum(), 1e-12);
    close("IAE's sum", m.iae_m_s.sum, axes.iter().map(|a| a.1).sum(), 1e-12);
    close("ISE's sum", m.ise_m2_s.sum, axes.iter().map(|a| a.2).sum(), 1e-12);
    close("RMSE's norm", m.rmse_m.norm, axes.iter().map(|a| a.3 * a.3).sum::<f64>().sqrt(), 1e-12);
    close("largest error", m.max_error_m, errors.iter().map(|e| e.norm()).fold(0.0, f64::max), 1e-12);
    let outside = (0..ticks.len()).rev().find(|&k| errors[k].norm() > 0.01);
    let settled = errors.iter().any(|e| e.norm() <= 0.01);
    let settling = settled.then(|| outside.map_or(0.0, |k| ticks[k].t));
    assert_eq!(m.settling_time_s, settling, "{name}: settling time");

    let (tv, peak) = (&m.torque_tv_n_m_per_s, &m.peak_torque_n_m);
    let variation = [tv.right, tv.left, tv.joints[0], tv.joints[1], tv.joints[2]];
    let peaks = [peak.right, peak.left, peak.joints[0], peak.joints[1], peak.joints[2]];
    for (i, (variation, peak)) in variation.into_iter().zip(peaks).enumerate() {
        let moved: f64 =
            ticks.windows(2).map(|pair| (torques(&pair[1])[i] - torques(&pair[0])[i]).abs()).sum();
        close(&format!("{name}: variation of torque {i}"), variation, moved / duration, 1e-9);
        let largest = ticks.iter().map(|tick| torques(tick)[i].abs()).fold(0.0, f64::max);
        close(&format!("{name}: peak of torque {i}"), peak, largest, 1e-15);
    }
    close("variation's sum", tv.sum, variation.iter().sum(), 1e-12);
    close(
        "effort",
        m.effort_n2_m2_s,
        PERIOD * sum(&|k| torques(&ticks[k]).iter().map(|t| t * t).sum()),
        1e-9,
    );
    let power = |tick: &Tick| {
        let nu = &tick.state.nu;
        // Wheels of 60 mm, 100 mm to either side.
        let (right, left) =
            ((nu.forward + 0.1 * nu.yaw_rate) / 0.06, (nu.forward - 0.1 * nu.yaw_rate) / 0.06);
        let rates = [right, left, nu.joints[0], nu.joints[1], nu.joints[2]];
        torques(tick).iter().zip(rates).map(|(torque, rate)| torque * rate).sum::<f64>().abs()
    };
    close("energy", m.energy_j, PERIOD * sum(&|k| power(&ticks[k])), 1e-9);
    let limited = ticks.iter().filter(|tick| tick.output.is_some_and(|o| o.status.saturated)).count();
    close("saturated", m.saturated_fraction, limited as f64 / ticks.len() as f64, 1e-15);
    let cut =
        ticks.iter().filter(|tick| tick.output.is_some_and(|o| o.signals.commanded != tick.torque)).count();
    assert_eq!(limited, cut, "{name}: saturated is where the command was cut");
    close(
        "speed",
        m.max_speed_m_s,
        ticks.iter().map(|k| k.state.nu.forward.abs()).fold(0.0, f64::max),
        1e-15,
    );
    let least = ticks.iter().step_by(10).map(manipulability).fold(f64::INFINITY, f64::min);
    assert!(m.min_manipulability <= least + 1e-8, "{name}: manipulability {least} was seen");
    close("manipulability", m.min_manipulability, least, 1e-3);
    for channel in 0..5 {
        let exact = band(ticks, duration, channel);
        close(
            &format!("{name}: band of channel {channel}"),
            m.sliding_band[channel].unwrap_or(f64::NAN),
            exact,
            5e-3,
        );
    }
}

fn digest(ticks: &[Tick]) -> String {
    let mut bytes = Vec::new();
    for tick in ticks {
        let q = &tick.state.q;
        let pose = [tick.t, q.x, q.y, q.heading].into_iter().chain(q.joints);
        for number in pose.chain(tick.state.nu.channels()).chain(torques(tick)) {
            bytes.extend(number.to_bits().to_le_bytes());
        }
    }
    format!("{:032x}", xxh3_128(&bytes))
}

/// A run with every tick recorded.
fn full(name: &str, sets: &[&str]) -> (Vec<Tick>, RunResult) {
    let mut all = vec!["simulation.log_rate_hz=1000"];
    all.extend(sets);
    recorded(&build(&load(name, &all)))
}

#[test]
fn metrics_and_digest_follow_from_the_samples() {
    // A jump that saturates, a switching law that chatters, a smooth law under disturbance.
    let runs: [(&str, &[&str]); 4] = [
        ("step-disturbed", &["simulation.duration_s=3"]),
        ("step-disturbed", &["simulation.duration_s=3", "controller.kind=bsmc"]),
        ("square-compare", &["simulation.duration_s=12"]),
        ("spiral", &["simulation.duration_s=3", "controller.kind=bsmc-sat"]),
    ];
    let mut saturated: f64 = 0.0;
    for (name, sets) in runs {
        let (ticks, result) = full(name, sets);
        recompute(name, &ticks, &result.metrics);
        assert_eq!(result.digest, digest(&ticks), "{name} {sets:?}: the digest");
        saturated = saturated.max(result.metrics.saturated_fraction);
    }
    measured("largest saturated fraction of the runs", saturated);
    assert!(saturated > 0.0, "one of the runs has to reach the torque limits");
}

#[test]
fn settling_time_is_null_when_never_settled_and_zero_when_never_outside() {
    let text = |point: &str| {
        format!(
            "name = \"hold\"\n[simulation]\nduration_s = 0.05\nlog_rate_hz = 1000\n[initial]\nbase_pose = [0.0, 0.0, 0.0]\n\
             [trajectory]\nkind = \"hold\"\n{point}"
        )
    };
    let far = build(&load_text("far.toml", &text("point_m = [0.9, 0.2, 0.6]"), &[]));
    let (ticks, result) = recorded(&far);
    assert!(ticks.iter().all(|tick| (tick.tip - tick.desired).norm() > 0.01), "50 ms do not reach there");
    assert_eq!(result.metrics.settling_time_s, None, "never below 10 mm");
    let there = run(&build(&load_text("there.toml", &text(""), &[])));
    assert_eq!(there.metrics.settling_time_s, Some(0.0), "never above 10 mm");
}

#[test]
fn a_crossing_is_counted_when_a_limit_is_left_and_not_again_while_beyond() {
    // Joint 2 starts at 1.047 rad and its limit is set just above: the step's swing crosses it.
    let sets = [
        "simulation.duration_s=3",
        "robot.link=[{}, {joint_limit_rad=[-0.35, 1.06]}, {}]",
        "controller.outer.joint_limit_gain_rad_s=0",
    ];
    let (ticks, result) = full("step-disturbed", &sets);
    let outside: Vec<bool> = ticks.iter().map(|tick| tick.state.q.joints[1] > 1.06).collect();
    let entered = outside.windows(2).filter(|pair| !pair[0] && pair[1]).count();
    measured("crossings", entered as f64);
    assert_eq!(result.metrics.joint_limit_crossings, entered as u64, "crossings of joint 2");
    let first = ticks.iter().zip(&outside).find(|(_, outside)| **outside).map(|(tick, _)| tick.t);
    assert_eq!(result.joint_limit_crossed_at, first, "the first of them");
}

#[test]
fn the_digest_is_that_of_the_trajectory_alone() {
    let short = "simulation.duration_s=1";
    let of = |sets: &[&str]| run(&build(&load("square-compare", sets)));
    let base = of(&[short]);
    assert_eq!(of(&[short]).digest, base.digest, "two runs give the same bits");
    assert_eq!(of(&[short]), base, "and the same metrics");
    for rate in ["1000", "250", "1", "0.1"] {
        let set = format!("simulation.log_rate_hz={rate}");
        let other = of(&[short, &set]);
        assert_eq!(other.digest, base.digest, "a log of {rate} Hz changes nothing");
        assert_eq!(other.metrics.itae_m_s2, base.metrics.itae_m_s2, "nor the metrics, at {rate} Hz");
    }
    assert_eq!(of(&[short, "simulation.seed=7"]).digest, base.digest, "no noise, no seed");
    // The last bits of one number of the robot, of a gain, of the plant; a single one may be lost where numbers are added.
    for (key, value) in [
        ("robot.base_mass_kg", 50.0_f64),
        ("controller.outer.position_gain_1_s", 18.0),
        ("plant.mass_scale", 1.25),
        ("robot.gravity_m_s2", 9.81),
    ] {
        let same = of(&[short, &format!("{key}={value:?}")]);
        assert_eq!(same.digest, base.digest, "{key} = {value} is what it was before");
        let other = of(&[short, &format!("{key}={:?}", value * (1.0 + 8.0 * f64::EPSILON))]);
        assert_ne!(other.digest, base.digest, "{key} a few bits off");
    }
}

#[test]
fn noise_follows_its_seed() {
    let text = "name = \"noisy\"\n[simulation]\nduration_s = 0.5\n[trajectory]\nkind = \"spiral\"\n\
                [[disturbance]]\non = \"joint2\"\nshape = \"noise\"\namplitude_n_m = 5.0\n";
    let of =
        |seed: u32| run(&build(&load_text("noisy.toml", text, &[&format!("simulation.seed={seed}")]))).digest;
    assert_eq!(of(1), of(1), "the same seed, the same noise");
    assert_ne!(of(1), of(2), "another seed, another noise");
}
