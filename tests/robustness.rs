//! The default gains work for robots that nobody tuned them for.
//!
//! Laws: a robot with other masses, lengths, wheels and track follows sinusoid and square with the gains that
//! `Gains::for_robot` derives from it, within 10 mm from 5 s on; a plant whose masses are 40 % off what the controller knows
//! still finishes.
//! Why: the gains are scaled by the robot's own inertias and limits, and the outer loop works on lengths alone.
//! Reference: none but the bound; 20 random robots, the same in every run.
//! Tolerance: 10 mm from 5 s on, which leaves 90 time constants of the outer loop for the start above or below the reference.

use core::fmt::Write as _;

use mm_model::Real;
use mm_sim::experiment::Experiment;
use mm_sim::simulation::{Ending, Recorder, Sample};
use mm_tests::{Random, build, finished, load, load_text, measured};

/// The largest error from 5 s on.
struct Late(f64);

impl Recorder for Late {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        if sample.t >= 5.0 {
            self.0 = self.0.max((sample.tip - sample.reference.position).norm());
        }
        Ok(true)
    }
}

/// The `[robot]` of a scenario: masses by 0.5 to 2, lengths by 0.7 to 1.3, wheels and track by as much.
fn random_robot(seed: u64) -> String {
    let mut random = Random::seeded(seed);
    let base = 50.0 * random.between(0.5, 2.0);
    let mut text = format!(
        "[robot]\npreset = \"thesis\"\nbase_mass_kg = {base:?}\nbase_yaw_inertia_kg_m2 = {:?}\nwheel_radius_m = {:?}\n\
         track_width_m = {:?}\n",
        base * 0.41 / 12.0,
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
    text
}

fn late_error(what: &str, experiment: &Experiment) -> Result<f64, String> {
    let mut late = Late(0.0);
    let Ok(result) = experiment.run(&mut late);
    match result.ending {
        Ending::Finished => Ok(late.0),
        other => Err(format!("{what}: {other:?}")),
    }
}

/// Runs 20 random robots on a path; says which fail.
fn twenty(kind: &str, duration_s: f64) {
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for seed in 1..=20 {
        let text = format!(
            "name = \"random\"\n[simulation]\nduration_s = {duration_s:?}\n[trajectory]\nkind = \"{kind}\"\n{}",
            random_robot(seed)
        );
        let what = format!("robot {seed} on the {kind}");
        match late_error(&what, &build(&load_text("random.toml", &text, &[]))) {
            Ok(error) if error <= 0.01 => worst = Real::max(worst, error),
            Ok(error) => failures.push(format!("{what}: {error} m")),
            Err(message) => failures.push(message),
        }
    }
    measured(&format!("{kind}: largest error from 5 s on, m"), worst);
    assert!(failures.is_empty(), "{} of 20 fail:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn random_robots_follow_the_sinusoid() {
    twenty("sinusoid", 60.0);
}

#[test]
fn random_robots_follow_the_square() {
    twenty("square", 98.0);
}

#[test]
fn a_plant_forty_percent_off_finishes() {
    for scale in ["0.6", "1.4"] {
        for name in ["sinusoid", "square", "square-compare"] {
            let set = format!("plant.mass_scale={scale}");
            let what = format!("{name} with masses times {scale}");
            let metrics = finished(&what, &build(&load(name, &[&set, "simulation.duration_s=30"]))).metrics;
            measured(&format!("{what}: largest error, m"), metrics.max_error_m);
            assert!(metrics.max_error_m < 0.1, "{what}: {} m", metrics.max_error_m);
        }
    }
}
