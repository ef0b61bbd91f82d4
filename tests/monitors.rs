//! The monitors of a run say what happened in it.
//!
//! Laws: (1) V' is the derivative of V along the run, torque limits included; (2) where no torque is limited, bsmc obeys
//! V' <= -sum (k_i - required_i) |s_i|, so that V falls wherever the reaching condition (4.44) holds; (3) counts, first times,
//! bounds and shares are those of the ticks and samples; (4) warnings tell them in words.
//! Why: (4.40) rests on M_dot = C + C', and a user who trusts the verdict "reaching condition met" trusts these numbers.
//! Reference: differences of V between ticks, whose error has to halve with the period; (4.36) to (4.44) with the external
//! force in the bound; counts by hand from a record of every tick.
//! Tolerance: first order in the period for (1); rounding for (2), 1e-9 of the terms; none for counts.

use mm_control::Output;
use mm_model::{Force, Real, Velocity};
use mm_sim::experiment::Experiment;
use mm_sim::monitors::{Lasting, Lyapunov};
use mm_sim::simulation::{Recorder, RunResult, Sample};
use mm_sim::summary;
use mm_tests::{build, closed, load, load_text, measured};

/// A sample as the monitors see it.
#[derive(Clone, Copy)]
struct Seen {
    t: f64,
    nu: Velocity<f64, 3>,
    lyapunov: Lyapunov,
    required: Force<f64, 3>,
    output: Output<f64, 3>,
}

#[derive(Default)]
struct Watch(Vec<Seen>);

impl Recorder for Watch {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        self.0.extend(sample.output.map(|output| Seen {
            t: sample.t,
            nu: sample.state.nu,
            lyapunov: sample.lyapunov,
            required: sample.required_gain,
            output: *output,
        }));
        Ok(true)
    }
}

fn watched(experiment: &Experiment) -> (Vec<Seen>, RunResult) {
    assert_eq!(experiment.clock().log_every, 1, "every tick is a sample");
    let mut watch = Watch::default();
    let Ok(result) = experiment.run(&mut watch);
    (watch.0, result)
}

/// A scenario over `duration` with every tick of `period` a sample.
fn fine(name: &str, (duration, period): (f64, f64), more: &[&str]) -> Experiment {
    let sets = [
        format!("simulation.duration_s={duration:?}"),
        format!("simulation.control_period_s={period:?}"),
        format!("simulation.plant_step_s={period:?}"),
        format!("simulation.log_rate_hz={:?}", 1.0 / period),
    ];
    let sets: Vec<&str> = sets.iter().map(String::as_str).chain(more.iter().copied()).collect();
    build(&load(name, &sets))
}

/// Mean distance of V' from the difference of V between ticks, and the mean size of V'.
fn off(seen: &[Seen], period: f64, of: impl Fn(&Seen) -> bool) -> (f64, f64) {
    let (mut error, mut size, mut count) = (0.0, 0.0, 0.0);
    for pair in seen.windows(2) {
        if of(&pair[0]) {
            let slope = (pair[1].lyapunov.value - pair[0].lyapunov.value) / period;
            error += (slope - pair[0].lyapunov.rate).abs();
            size += pair[0].lyapunov.rate.abs();
            count += 1.0;
        }
    }
    assert!(count > 10.0, "only {count} ticks");
    (error / count, size / count)
}

#[test]
fn the_rate_is_that_of_the_lyapunov_function() {
    // Nothing that jumps while it lasts: the correction of the step is not limited, the gains are those of the 1 ms loop.
    let step = [
        "controller.kind=bsmc-sat",
        "controller.outer.correction_speed_limit_m_s=1e6",
        "controller.gains.boundary_layer=[0.05, 0.3, 0.3, 0.3, 0.3]",
    ];
    let compare = ["controller.kind=bsmc-sat", "controller.gains.boundary_layer=[0.05, 0.3, 0.3, 0.3, 0.3]"];
    for (name, duration, sets, saturated) in
        [("square-compare", 0.5, &compare[..], false), ("step-disturbed", 1.1, &step[..], true)]
    {
        let errors = [1e-3, 5e-4, 2.5e-4].map(|period| {
            let (seen, _) = watched(&fine(name, (duration, period), sets));
            let (error, size) = off(&seen, period, |seen| seen.output.status.saturated == saturated);
            measured(&format!("{name}, {period} s: mean error of V', of {size:.3e} W"), error / size);
            error / size
        });
        assert!(errors[2] < 0.05, "{name}: {errors:?}");
        for pair in errors.windows(2) {
            assert!((1.6..2.5).contains(&(pair[0] / pair[1])), "{name}: not of the first order: {errors:?}");
        }
    }
}

#[test]
fn v_falls_wherever_the_reaching_condition_holds() {
    let experiment = fine("square-compare", (12.0, 1e-3), &["controller.kind=bsmc"]);
    let (seen, _) = watched(&experiment);
    let authority =
        closed(&load("square-compare", &["controller.kind=bsmc"])).stack.law().authority().unwrap();
    let (mut met, mut most) = (0, f64::NEG_INFINITY);
    for Seen { t, nu, lyapunov, required, output } in &seen {
        if output.status.saturated {
            continue;
        }
        let s = nu.minus(output.signals.nu_r);
        let terms = s.channels().zip(authority.channels()).zip(required.channels());
        let bound: f64 = terms.map(|((s, k), needed)| -((k - needed) * s.abs())).sum();
        let size: f64 = s.channels().map(f64::abs).sum::<f64>() * 1e3;
        assert!(lyapunov.rate <= bound + 1e-9 * size, "t = {t}: V' = {} above {bound}", lyapunov.rate);
        if required.channels().zip(authority.channels()).all(|(needed, k)| needed < k) {
            assert!(lyapunov.rate < 0.0, "t = {t}: V' = {} although the gains are enough", lyapunov.rate);
            met += 1;
            most = Real::max(most, lyapunov.rate / lyapunov.value.sqrt());
        }
    }
    measured("square-compare with bsmc: V'/sqrt(V) where the condition holds, at most", most);
    measured("and that is at ticks", f64::from(met));
    assert!(met > 8_000, "the condition holds at {met} of {} ticks", seen.len());
}

/// Fraction and first time of what holds at some ticks.
fn lasting(seen: &[Seen], is: impl Fn(&Seen) -> bool) -> Lasting {
    let count = u32::try_from(seen.iter().filter(|seen| is(seen)).count()).unwrap_or(u32::MAX);
    let all = u32::try_from(seen.len()).unwrap_or(u32::MAX);
    Lasting {
        fraction: f64::from(count) / f64::from(all),
        first_s: seen.iter().find(|seen| is(seen)).map(|seen| seen.t),
    }
}

/// Down beyond reach, from the side: every status comes up.
const BELOW: &str = r#"
name = "below"
[simulation]
duration_s = 4.0
log_rate_hz = 1000.0
[initial]
base_pose = [0.0, 0.0, 0.0]
[trajectory]
kind = "hold"
point_m = [0.8, 0.6, -0.6]
allow_unreachable = true
[controller]
kind = "bsmc-sat"
[controller.outer]
correction_speed_limit_m_s = 1.9
"#;

#[test]
fn counts_are_those_of_the_ticks() {
    let loaded = load_text("below.toml", BELOW, &[]);
    let experiment = build(&loaded);
    let (seen, result) = watched(&experiment);
    let Some(monitors) = result.monitors else { panic!("a closed loop has monitors") };
    assert_eq!(monitors.near_singular, lasting(&seen, |s| s.output.status.near_singular), "near singular");
    assert_eq!(monitors.speed_limited, lasting(&seen, |s| s.output.status.speed_limited), "speed limited");
    assert_eq!(monitors.joint_limited, lasting(&seen, |s| s.output.status.joint_limited), "joint limited");
    for what in [monitors.near_singular, monitors.speed_limited, monitors.joint_limited] {
        assert!(what.fraction > 0.0 && what.first_s.is_some(), "everything came up: {monitors:?}");
    }
    let cut = monitors.torque_limited_fraction;
    let [c1, c2, c3] = cut.joints;
    let mut any: f64 = 0.0;
    for (i, got) in [cut.right, cut.left, c1, c2, c3].into_iter().enumerate() {
        let pair = |s: &Seen| s.output.torque.channels().zip(s.output.signals.commanded.channels()).nth(i);
        let expected =
            lasting(&seen, |s| pair(s).is_some_and(|(given, asked)| given.to_bits() != asked.to_bits()));
        assert_eq!(got.to_bits(), expected.fraction.to_bits(), "actuator {i}");
        any = Real::max(any, got);
    }
    let saturated = result.metrics.saturated_fraction;
    assert!(any > 0.0 && any <= saturated, "{any} of one actuator, {saturated} of any");

    let largest = |of: &dyn Fn(&Seen) -> f64| seen.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
    assert_eq!(monitors.lyapunov_max_j, Some(largest(&|s| s.lyapunov.value)), "largest V");
    assert_eq!(monitors.lyapunov_rate_max_w, Some(largest(&|s| s.lyapunov.rate)), "largest V'");
    let authority = closed(&loaded).stack.law().authority().unwrap();
    for (i, offered) in authority.channels().enumerate() {
        let needed = |s: &Seen| s.required.channels().nth(i).unwrap_or(f64::NAN);
        assert_eq!(monitors.reaching_bound_max[i], Some(largest(&needed)), "bound of channel {i}");
        let enough = lasting(&seen, |s| needed(s) <= offered * (1.0 + 1e-9) + 1e-9);
        assert_eq!(monitors.reaching_met_fraction[i], Some(enough.fraction), "share of channel {i}");
    }
}

#[test]
fn a_cut_torque_is_lost_authority() {
    // The wheels need more than 0.1 N m; with their ordinary limit nothing is cut and the gains are enough.
    let weak = ["simulation.duration_s=5", "robot.wheel_torque_limit_n_m=0.1"];
    let cut = mm_tests::run(&build(&load("square", &weak)));
    let whole = mm_tests::run(&build(&load("square", &weak[..1])));
    assert_eq!(whole.metrics.reaching_condition_met, Some(true), "with the ordinary limit");
    assert!(cut.metrics.saturated_fraction > 0.0, "the limit cuts");
    assert_eq!(cut.metrics.reaching_condition_met, Some(false), "and what it cuts is missed");
    // |gap| + |f_ext + B(torque - commanded)| + eta without an external force: at least what was cut off.
    let experiment =
        fine("square", (5.0, 1e-3), &["controller.kind=bsmc", "robot.wheel_torque_limit_n_m=0.1"]);
    let robot = *experiment.plant().robot();
    let (seen, result) = watched(&experiment);
    let mut most: f64 = 0.0;
    for s in seen.iter().filter(|s| s.output.status.saturated) {
        let (given, asked) = (&s.output.torque, &s.output.signals.commanded);
        let lost = robot.force_of(given).minus(robot.force_of(asked));
        for (needed, lost) in s.required.channels().zip(lost.channels()) {
            assert!(needed >= lost.abs() - 1e-12, "t = {}: {needed} does not cover the {lost} cut off", s.t);
            most = Real::max(most, lost.abs());
        }
    }
    measured("square at 0.1 N m: most that the limit cut off", most);
    assert!(most > 0.0, "something was cut");
    let Some(monitors) = result.monitors else { panic!("a closed loop has monitors") };
    let Experiment::Closed(simulation) = &experiment else { panic!("a closed loop") };
    let authority = simulation.stack.law().authority().unwrap();
    let fails = |s: &Seen| {
        s.required.channels().zip(authority.channels()).any(|(needed, k)| needed > k * (1.0 + 1e-9) + 1e-9)
    };
    assert_eq!(monitors.reaching_failed_fraction, Some(lasting(&seen, fails).fraction), "share of failures");
    let any = lasting(&seen, |s| s.output.status.saturated);
    assert_eq!(monitors.torque_limited, any, "a torque was limited");
}

#[test]
fn a_law_without_a_switching_gain_has_no_reaching_bound() {
    for law in ["ctc", "pid", "lqr", "super-twisting", "backstepping-adaptive"] {
        let kind = format!("controller.kind={law}");
        let (seen, result) = watched(&fine("square", (0.2, 1e-3), &[&kind]));
        assert!(seen.iter().all(|s| s.required == Force::zero()), "{law}: no bound in a sample");
        let Some(monitors) = result.monitors else { panic!("a closed loop has monitors") };
        assert_eq!(monitors.reaching_bound_max, [None; 5], "{law}: none in the report");
        assert_eq!(monitors.reaching_failed_fraction, None, "{law}: and no share");
        assert_eq!(result.metrics.reaching_condition_met, None, "{law}: nor a verdict");
        assert!(monitors.lyapunov_max_j.is_some(), "{law}: V is defined");
    }
}

#[test]
fn warnings_tell_what_a_user_should_know() {
    let result = mm_tests::run(&build(&load_text("below.toml", BELOW, &[])));
    let Some(monitors) = result.monitors else { panic!("a closed loop has monitors") };
    let warnings = summary::warnings(&result, 2.0);
    for (what, lasting) in [
        ("the outer loop limited its speed", monitors.speed_limited),
        ("the outer loop held a joint back from its limit", monitors.joint_limited),
        ("the arm was near a singularity", monitors.near_singular),
    ] {
        let percent = 100.0 * lasting.fraction;
        let first = lasting.first_s.unwrap_or(f64::NAN);
        let expected = format!("{what} in {percent:.1} % of the run, first at t = {first:.3} s");
        assert!(warnings.contains(&expected), "{expected:?} is not among {warnings:?}");
    }
    // An ordinary run has nothing to say.
    let quiet = mm_tests::run(&build(&load("square", &["simulation.duration_s=2"])));
    assert!(summary::warnings(&quiet, 2.0).is_empty(), "{:?}", summary::warnings(&quiet, 2.0));
    let Some(monitors) = quiet.monitors else { panic!("a closed loop has monitors") };
    assert_eq!(monitors.speed_limited, Lasting::default(), "never limited");
    assert!(mm_tests::run(&build(&load("verify-circle", &[]))).monitors.is_none(), "no loop, no monitors");
}

#[test]
fn warnings_tell_of_limited_torques_and_of_too_small_gains() {
    let weak = ["simulation.duration_s=5", "robot.wheel_torque_limit_n_m=0.1"];
    let result = mm_tests::run(&build(&load("square", &weak)));
    let Some(monitors) = result.monitors else { panic!("a closed loop has monitors") };
    let Lasting { fraction, first_s } = monitors.torque_limited;
    assert_eq!(fraction.to_bits(), result.metrics.saturated_fraction.to_bits(), "the same count");
    let failed = monitors.reaching_failed_fraction.unwrap_or(f64::NAN);
    assert!(fraction > 0.01 && failed > 0.05, "worth saying: {fraction}, {failed}");
    let (limited, first) = (100.0 * fraction, first_s.unwrap_or(f64::NAN));
    let limited = format!("a torque was limited in {limited:.1} % of the run, first at t = {first:.3} s");
    let failing = format!("the reaching condition failed at {:.1} % of the samples", 100.0 * failed);
    let warnings = summary::warnings(&result, 2.0);
    for expected in [&limited, &failing] {
        assert!(warnings.contains(expected), "{expected:?} is not among {warnings:?}");
    }
    // A little of either is no news.
    let mut little = result.clone();
    if let Some(monitors) = &mut little.monitors {
        monitors.torque_limited.fraction = 0.01;
        monitors.reaching_failed_fraction = Some(0.05);
    }
    let warnings = summary::warnings(&little, 2.0);
    for said in [&limited[..20], &failing[..29]] {
        assert!(!warnings.iter().any(|warning| warning.starts_with(said)), "{said:?} is among {warnings:?}");
    }
}

/// Up through the edge of reach, 0.3 um below 1.5 m, at 0.1 m/s from 1.3 m: beyond it after 2 s.
const ABOVE: &str = r#"
name = "above"
[simulation]
duration_s = 4.0
[trajectory]
kind = "line"
from_m = [0.3, 0.0, 1.3]
velocity_m_s = [0.0, 0.0, 0.1]
allow_unreachable = true
"#;

#[test]
fn warnings_tell_of_a_reference_beyond_reach() {
    let experiment = build(&load_text("above.toml", ABOVE, &[]));
    let (_, high) = experiment.plant().robot().tip_height_range();
    assert!((1.499_999..1.5).contains(&high), "the edge is at {high} m");
    // 4000 ticks of 1 ms, each looked at; that at 2 s is beyond the edge, the last is at 3.999 s.
    let expected = "the reference was beyond the arm's reach in height for 50.0 % of the run, \
                    first at t = 2.000 s, last at t = 3.999 s";
    assert_eq!(experiment.reference_warnings(4.0), [expected], "a run to its end");
    assert!(experiment.reference_warnings(1.5).is_empty(), "a run that ended before");
    assert!(build(&load("square", &[])).reference_warnings(98.0).is_empty(), "an ordinary reference");
    // At the edge the message has the digits that tell the two apart.
    let edge = "name = \"edge\"\n[simulation]\nduration_s = 1.0\n[trajectory]\nkind = \"hold\"\npoint_m = [0.3, 0.0, 1.5]\n";
    let Err(error) = Experiment::build(&load_text("edge.toml", edge, &[])) else { panic!("beyond reach") };
    let error = error.to_string();
    for part in ["should be 1.500000 m high", "to 1.499999 m"] {
        assert!(error.contains(part), "{part:?} is not in:\n{error}");
    }
}

/// 1 m at 0.5 m/s: with 1 m/s^2 and a jerk of 10 m/s^3 the S-curve takes 1/0.5 + 0.5/1 + 1/10 = 2.6 s.
const POINTS: &str = r#"
name = "points"
[simulation]
duration_s = 2.0
[trajectory]
kind = "waypoints"
points_m = [[0.5, 0.0, 0.5], [1.5, 0.0, 0.5]]
speed_m_s = 0.5
acceleration_m_s2 = 1.0
jerk_m_s3 = 10.0
"#;

#[test]
fn warnings_tell_of_a_motion_longer_than_the_run() {
    let warned = |sets: &[&str]| build(&load_text("points.toml", POINTS, sets)).reference_warnings(1e9);
    let told = |motion: &str, run: &str| {
        vec![format!("the motion through the way points takes {motion} s; the run ends after {run} s")]
    };
    assert_eq!(warned(&[]), told("2.600", "2.000"), "cut off");
    assert!(warned(&["simulation.duration_s=2.7"]).is_empty(), "long enough");
    // A ramp, which a scenario does not give such a motion, delays it by half its time.
    let mut ramped = closed(&load_text("points.toml", POINTS, &[])).trajectory;
    ramped.start_ramp = 0.4;
    let motion = ramped.motion_duration().unwrap();
    assert!((motion - 2.8).abs() < 1e-12, "{motion} s");
    let before = ramped.at(motion - 0.01).velocity.norm();
    assert!(before > 0.0 && ramped.at(motion + 1e-9).velocity.norm() < 1e-12, "at rest from then on");
}

#[test]
fn the_base_stands_still_while_it_is_held() {
    let (seen, _) = watched(&fine("sinusoid-base-held", (6.0, 1e-3), &[]));
    let asked = |s: &Seen| (s.output.signals.nu_c.forward.abs(), s.output.signals.nu_c.yaw_rate.abs());
    let (mut speed, mut turn): (f64, f64) = (0.0, 0.0);
    for s in seen.iter().filter(|s| s.t < 2.0) {
        assert_eq!(asked(s), (0.0, 0.0), "t = {}: the base is asked to move", s.t);
        (speed, turn) = (speed.max(s.nu.forward.abs()), turn.max(s.nu.yaw_rate.abs()));
    }
    measured("sinusoid-base-held: forward speed in the first 2 s", speed);
    measured("sinusoid-base-held: yaw rate in the first 2 s", turn);
    // What the arm's start at full speed pushes through the inner loop.
    assert!(speed < 0.02 && turn < 0.1, "the base moves at {speed} m/s and {turn} rad/s");
    assert!(seen.iter().any(|s| s.t > 3.0 && asked(s).0 > 0.1), "it is released");
    // Smooth: nu_c of the base changes no faster than its rate says.
    for pair in seen.windows(2).filter(|pair| pair[0].t > 0.5) {
        let jump = (asked(&pair[1]).0 - asked(&pair[0]).0).abs();
        assert!(jump < 5e-3, "t = {}: nu_c jumps by {jump}", pair[0].t);
    }
}
