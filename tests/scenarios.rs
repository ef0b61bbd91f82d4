//! Every bundled scenario does what its file and the thesis's tables promise.
//!
//! Laws: each meets its own [expect]; the square's ITAE is at most 0.005 m s^2; with disturbance and a robot 25 % heavier than
//! the controller believes, the fuzzy law's ITAE is at most 0.20 m s^2 and at least 31.16 % (Table 5.2) below that of the
//! baseline, at a torque variation of at most 40 N m/s; all laws of a comparison share the outer loop.
//! Why: these are the experiments of chapters 3.7 and 5; they run here as on the command line, without a log.
//! Reference: the thesis's Table 5.2 for the improvement; bounds agreed for this implementation for the rest.
//! Tolerance: none, the bounds are inequalities; the runs are deterministic to the bit.

use mm_sim::metrics::Metrics;
use mm_sim::scenario;
use mm_sim::summary;
use mm_sim::trajectory::Path;
use mm_tests::{build, closed, finished, load, measured};

const LAWS: [&str; 4] = ["bsmc", "bsmc-sat", "bfsmc-thesis", "bfsmc"];

/// Runs a bundled scenario as it stands.
fn as_it_stands(name: &str) -> Metrics {
    let loaded = load(name, &[]);
    let metrics = finished(name, &build(&loaded)).metrics;
    let missed = summary::missed(&loaded.file.expect, &metrics);
    assert!(missed.is_empty(), "{name} misses {missed:?}");
    assert!(!loaded.is_modified(), "{name} is judged as it stands");
    measured(&format!("{name}: ITAE"), metrics.itae_m_s2.sum);
    measured(&format!("{name}: largest error, m"), metrics.max_error_m);
    measured(&format!("{name}: torque variation"), metrics.torque_tv_n_m_per_s.sum);
    metrics
}

#[test]
fn the_names_are_those_of_the_interface() {
    let mut names: Vec<&str> = scenario::bundled().iter().map(|(name, _)| *name).collect();
    names.sort_unstable();
    for name in [
        "sinusoid",
        "sinusoid-base-held",
        "spiral",
        "spiral-compare",
        "spiral-disturbed",
        "square",
        "square-compare",
        "square-smooth",
        "square-realistic",
        "payload-drop",
        "square-faults",
        "step-disturbed",
        "verify-circle",
        "verify-joint2",
        "verify-joints23",
        "verify-moving-base",
        "verify-reverse-circle",
        "verify-straight",
        "waypoints",
    ] {
        assert!(names.contains(&name), "{name} is bundled, among {names:?}");
    }
    for name in names {
        let file = load(name, &[]).file;
        assert_eq!(file.name, name, "the log of {name} carries its name");
        assert!(file.expect != scenario::Expect::default(), "{name} expects something");
    }
}

#[test]
fn sinusoid_and_step() {
    let m = as_it_stands("sinusoid");
    assert!(m.settling_time_s.is_some_and(|t| t < 1.0), "on a start beside nothing: {:?}", m.settling_time_s);
    let m = as_it_stands("step-disturbed");
    // The jump is 0.245 m, and the tip never goes farther away than that.
    assert!(m.max_error_m <= 0.25, "{} m after the jump", m.max_error_m);
}

#[test]
fn waypoints() {
    let m = as_it_stands("waypoints");
    assert!(m.max_speed_m_s <= 1.0, "the base keeps about to the tip's 0.5 m/s: {} m/s", m.max_speed_m_s);
    let Path::Waypoints(motion) = closed(&load("waypoints", &[])).trajectory.path else {
        panic!("a motion through points")
    };
    measured("waypoints: duration of the motion, s", motion.duration());
    assert!(motion.duration() < 23.0, "rests for the last second: {} s", motion.duration());
}

#[test]
fn spirals() {
    for name in ["spiral", "spiral-disturbed", "spiral-compare"] {
        let m = as_it_stands(name);
        // The start is 0.2 m above the reference; the base has to turn about its own axle first.
        assert!(m.max_error_m <= 0.25, "{name}: {} m", m.max_error_m);
    }
}

#[test]
fn square() {
    let m = as_it_stands("square");
    assert!(m.itae_m_s2.sum <= 0.005, "ITAE {}", m.itae_m_s2.sum);
    let smooth = as_it_stands("square-smooth");
    // Only the printed square starts with a jump of speed.
    let ratio = smooth.max_error_m / m.max_error_m;
    assert!(ratio < 1e-3, "without jumps the largest error is {ratio:e} of that with them");
}

#[test]
fn square_compare_as_in_table_5_2() {
    let fuzzy = as_it_stands("square-compare");
    assert!(fuzzy.itae_m_s2.sum <= 0.20, "ITAE {}", fuzzy.itae_m_s2.sum);
    assert!(fuzzy.torque_tv_n_m_per_s.sum <= 40.0, "variation {}", fuzzy.torque_tv_n_m_per_s.sum);
    let experiment = build(&load("square-compare", &["controller.kind=bsmc"]));
    let base = finished("square-compare with bsmc", &experiment).metrics;
    let percent = (base.itae_m_s2.sum - fuzzy.itae_m_s2.sum) / base.itae_m_s2.sum * 100.0;
    measured("square-compare: ITAE of bsmc", base.itae_m_s2.sum);
    measured("square-compare: bfsmc below bsmc by, %", percent);
    assert!(percent >= 31.16, "bfsmc is {percent} % below bsmc");
    for (axis, b, f) in [
        ("x", base.itae_m_s2.x, fuzzy.itae_m_s2.x),
        ("y", base.itae_m_s2.y, fuzzy.itae_m_s2.y),
        ("z", base.itae_m_s2.z, fuzzy.itae_m_s2.z),
    ] {
        assert!(f < b, "along {axis}: {f} of bfsmc is not below {b} of bsmc");
    }
}

#[test]
fn all_laws_share_the_outer_loop_and_the_start() {
    for name in ["square-compare", "spiral-compare"] {
        let stacks: Vec<_> =
            LAWS.iter().map(|law| closed(&load(name, &[&format!("controller.kind={law}")]))).collect();
        for (law, simulation) in LAWS.iter().zip(&stacks) {
            let first = &stacks[0];
            assert_eq!(simulation.stack.law().kind().name(), *law, "{name}: the law asked for");
            let outer = simulation.stack.outer().params();
            assert_eq!(outer, first.stack.outer().params(), "{name}: {law} has the outer loop of all");
            assert_eq!(simulation.stack.robot(), first.stack.robot(), "{name}: {law} knows the same robot");
            assert_eq!(simulation.plant, first.plant, "{name}: {law} drives the same plant");
            assert_eq!(simulation.initial, first.initial, "{name}: {law} starts where all do");
            assert_eq!(simulation.trajectory, first.trajectory, "{name}: {law} follows the same reference");
        }
        let given = r#"controller.outer.weights=[1, 2, 3, 4, 5]"#;
        let others: Vec<_> = LAWS
            .iter()
            .map(|law| {
                *closed(&load(name, &[given, &format!("controller.kind={law}")])).stack.outer().params()
            })
            .collect();
        assert!(others.iter().all(|outer| *outer == others[0]), "{name}: given weights reach every law");
        assert!(others[0] != *stacks[0].stack.outer().params(), "{name}: and change the outer loop");
    }
}

#[test]
fn every_law_survives_every_tracking_scenario() {
    for name in [
        "sinusoid",
        "sinusoid-base-held",
        "spiral",
        "square",
        "spiral-disturbed",
        "step-disturbed",
        "spiral-compare",
        "square-compare",
    ] {
        // Long enough for every disturbance to set in.
        let duration = if name == "step-disturbed" { 12 } else { 30 };
        for law in ["bsmc", "bsmc-sat", "bfsmc-thesis"] {
            let sets = [format!("controller.kind={law}"), format!("simulation.duration_s={duration}")];
            let what = format!("{name} with {law}");
            let metrics = finished(&what, &build(&load(name, &[&sets[0], &sets[1]]))).metrics;
            // The spirals start 0.2 m off, the step jumps by 0.245 m; nothing makes it worse.
            assert!(metrics.max_error_m <= 0.25, "{what}: {} m", metrics.max_error_m);
            let settled = metrics.settling_time_s.is_some_and(|t| t < 2.0);
            assert!(settled, "{what} stays within 10 mm from 2 s on: {:?}", metrics.settling_time_s);
        }
    }
}
