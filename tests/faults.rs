//! Thirty-odd faults in three scenarios and on robots that nobody tuned anything for, under the supervisor.
//!
//! Laws: whatever reaches the controller, (1) every torque is finite and within the limits; (2) the state stays finite; (3) at the end the
//! robot is bounded, or the supervisor had stopped it within two periods of what it found; (4) without a fault every bundled
//! scenario runs from its begin to its end in Run, with the bits of the unsupervised run.
//!
//! Reference: the limits of the robot; the unsupervised run.
//!
//! Tolerance: none for torques and bits. Bounded is: slower than 2.5 m/s and 4 rad/s, where the loops here move at most half as fast,
//! and a tip within 1.5 m of its reference, where the largest offset of a fault is 1 m and the reference goes on for a second or so while
//! the robot stands.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use core::fmt::Write as _;

use mm_model::Robot;
use mm_sim::scenario::bundled;
use mm_sim::simulation::{Ending, Recorder, Sample, SupervisorReport};
use mm_tests::{Random, build, closed, load, load_text, measured, run};

/// Name and keys of a fault that begins at 3 s.
const PATTERNS: [(&str, &str); 36] = [
    ("nan state, 50 ms", r#"on="state", kind="nan", to_s=3.05"#),
    ("nan joint for good", r#"on="joints", kind="nan", channel=1"#),
    ("nan pose, one period", r#"on="pose", kind="nan", to_s=3.001"#),
    ("nan heading, 0.3 s", r#"on="pose", kind="nan", channel=2, to_s=3.3"#),
    ("infinite velocity, 10 ms", r#"on="velocity", kind="infinite", to_s=3.01"#),
    ("infinite state for good", r#"on="state", kind="infinite""#),
    ("pose 1 m off for good", r#"on="pose", kind="offset", channel=0, amplitude_m=1.0"#),
    ("pose 0.02 m off for good", r#"on="pose", kind="offset", amplitude_m=0.02"#),
    ("heading 0.3 rad off, 1 s", r#"on="pose", kind="offset", amplitude_rad=0.3, to_s=4.0"#),
    ("joints 0.3 rad off, 1 s", r#"on="joints", kind="offset", amplitude_rad=0.3, to_s=4.0"#),
    ("joints 0.02 rad off for good", r#"on="joints", kind="offset", amplitude_rad=0.02"#),
    ("pose spikes of 0.5 m", r#"on="pose", kind="spike", amplitude_m=0.5, every_s=0.05"#),
    ("joint spikes of 0.2 rad", r#"on="joints", kind="spike", amplitude_rad=0.2, every_s=0.01"#),
    ("speed spikes of 5 m/s", r#"on="velocity", kind="spike", amplitude_m_s=5.0, every_s=0.02"#),
    ("rate spikes of 1e6 rad/s", r#"on="velocity", kind="spike", amplitude_rad_s=1e6, every_s=0.005"#),
    ("state stuck for good", r#"on="state", kind="stuck""#),
    ("joints stuck, 1 s", r#"on="joints", kind="stuck", to_s=4.0"#),
    ("joint 2 stuck for good", r#"on="joints", kind="stuck", channel=1"#),
    ("pose stuck, 2 s", r#"on="pose", kind="stuck", to_s=5.0"#),
    ("velocity stuck, 50 ms", r#"on="velocity", kind="stuck", to_s=3.05"#),
    ("state 5 periods late", r#"on="state", kind="delay", delay_periods=5"#),
    ("state 100 periods late, 0.5 s", r#"on="state", kind="delay", delay_periods=100, to_s=3.5"#),
    ("velocity times 1.5", r#"on="velocity", kind="scale", factor=1.5"#),
    ("velocity times 1e30", r#"on="velocity", kind="scale", factor=1e30"#),
    ("noise of 1 mrad on joints", r#"on="joints", kind="noise", amplitude_rad=0.001"#),
    (
        "noise of 0.05 on velocities",
        r#"on="velocity", kind="noise", amplitude_m_s=0.05, amplitude_rad_s=0.05"#,
    ),
    ("nan reference, 0.1 s", r#"on="reference", kind="nan", to_s=3.1"#),
    ("reference 5 m off, 1 s", r#"on="reference", kind="offset", amplitude_m=5.0, to_s=4.0"#),
    ("reference stuck, 1 s", r#"on="reference", kind="stuck", to_s=4.0"#),
    ("reference times 1e9", r#"on="reference", kind="scale", factor=1e9"#),
    ("no input for 20 periods", r#"on="clock", kind="drop", to_s=3.02"#),
    ("no input for good", r#"on="clock", kind="drop""#),
    ("every input twice", r#"on="clock", kind="duplicate""#),
    ("controller stalls for 10 periods", r#"on="clock", kind="stall", to_s=3.01"#),
    ("clock jitters by 0.2 ms", r#"on="clock", kind="noise", amplitude_s=0.0002"#),
    ("input 10 ms old, 0.2 s", r#"on="age", kind="offset", amplitude_s=0.01, to_s=3.2"#),
];

/// Looks at every period.
struct Watch {
    robot: Robot<f64, 3>,
    wrong: Option<String>,
    error: f64,
}

impl Recorder for Watch {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        let (limited, cut) = self.robot.limit_torque(sample.torque);
        let fine = sample.torque.is_finite() && !cut && limited == *sample.torque;
        if !(fine && sample.state.q.is_finite() && sample.state.nu.is_finite()) {
            self.wrong.get_or_insert_with(|| format!("at t = {}: {:?}", sample.t, sample.torque));
        }
        self.error = (sample.tip - sample.reference.position).norm();
        Ok(true)
    }
}

/// Whether the stop began within two periods of the first finding.
fn stopped_in_time(report: &SupervisorReport, period: f64) -> bool {
    let first = report.findings.iter().map(|found| found.first_s).fold(f64::INFINITY, f64::min);
    let stopped = ["stop", "fault"].contains(&report.mode);
    stopped && report.first_stop_s.is_some_and(|stop| stop <= first + 2.5 * period)
}

/// Runs every pattern on a scenario, given as its text or its name; says what fails.
fn all_patterns(name: &str, text: Option<&str>, own: &[&str]) {
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for (pattern, keys) in PATTERNS {
        let fault = format!("fault.0={{{keys}, from_s=3.0}}");
        let mut sets = vec![
            fault.as_str(),
            "controller.supervisor.enabled=true",
            "simulation.duration_s=5.5",
            "simulation.log_rate_hz=1000",
        ];
        sets.extend(own);
        let loaded = text.map_or_else(|| load(name, &sets), |text| load_text(name, text, &sets));
        let simulation = closed(&loaded);
        let period = simulation.clock.period;
        let mut watch = Watch { robot: *simulation.stack.robot(), wrong: None, error: 0.0 };
        let Ok(result) = simulation.run(&mut watch);
        let Some(report) = &result.supervisor else { panic!("{name} has no supervisor") };
        let nu = &result.last.nu;
        let slow =
            nu.forward.abs() < 2.5 && nu.yaw_rate.abs() < 4.0 && nu.joints.iter().all(|nu| nu.abs() < 4.0);
        let bounded = result.ending == Ending::Finished && slow && watch.error < 1.5;
        if !(bounded || stopped_in_time(report, period)) {
            failures
                .push(format!("{pattern}: {:?}, error {}, {nu:?}, {report:?}", result.ending, watch.error));
        }
        if let Some(wrong) = watch.wrong {
            failures.push(format!("{pattern}: {wrong}"));
        }
        if bounded && report.mode == "run" {
            worst = worst.max(watch.error);
        }
    }
    measured(&format!("{name}: largest error at the end of a run that goes on, m"), worst);
    assert!(failures.is_empty(), "{name}: {} fail:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn the_disturbed_square_survives_every_fault() {
    all_patterns("square-compare", None, &[]);
}

#[test]
fn the_disturbed_spiral_survives_every_fault() {
    all_patterns("spiral-disturbed", None, &[]);
}

#[test]
fn the_step_survives_every_fault() {
    // The faults come while the robot moves: what stands still at rest is not seen before the law pushes hard.
    all_patterns("step-disturbed", None, &["trajectory.at_s=2.8"]);
}

#[test]
fn an_unseen_robot_survives_every_fault() {
    let mut random = Random::seeded(4711);
    let mut text = format!(
        "name = \"unseen\"\n[simulation]\nduration_s = 6.0\n[trajectory]\nkind = \"sinusoid\"\n[robot]\npreset = \"thesis\"\n\
         base_mass_kg = {:?}\nwheel_radius_m = {:?}\ntrack_width_m = {:?}\n",
        50.0 * random.between(0.5, 2.0),
        0.06 * random.between(0.7, 1.5),
        0.2 * random.between(0.7, 2.0),
    );
    for mass in [4.0, 6.0, 4.0] {
        let (mass, length) = (mass * random.between(0.5, 2.0), 0.5 * random.between(0.7, 1.3));
        let inertia = mass * length * length / 12.0;
        let _ = write!(
            text,
            "[[robot.link]]\nlength_m = {length:?}\nmass_kg = {mass:?}\ncom_m = {length:?}\n\
             inertia_kg_m2 = [{inertia:?}, {inertia:?}, {inertia:?}]\n"
        );
    }
    all_patterns("unseen", Some(&text), &[]);
}

#[test]
fn without_a_fault_the_supervisor_is_not_noticed() {
    for (name, text) in bundled() {
        if text.contains("kind = \"velocities\"") || text.contains("[[fault]]") {
            continue;
        }
        let short =
            format!("simulation.duration_s={}", if text.contains("duration_s = 98.0") { 20 } else { 12 });
        let of = |sets: &[&str]| run(&build(&load(name, sets)));
        let alone = of(&[&short, "controller.supervisor.enabled=false"]);
        let supervised = of(&[&short, "controller.supervisor.enabled=true"]);
        let Some(report) = &supervised.supervisor else { panic!("{name} has no supervisor") };
        assert_eq!((report.mode, report.held_periods, report.stops), ("run", 0, 0), "{name}");
        assert_eq!(report.findings, [], "{name}");
        assert_eq!(supervised.digest, alone.digest, "{name}: the same bits");
        assert_eq!(supervised.ending, Ending::Finished, "{name}");
        assert_eq!(alone.supervisor, None, "{name}: no report without one");
    }
}
