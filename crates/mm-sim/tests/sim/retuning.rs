//! A controller that takes over in the middle of a run.
//!
//! Laws: one with the same gains changes no bit; other gains change nothing before they come, and everything after; under a supervisor
//! that finds nothing the bits are the same as without; what the observer has learned outlives another bandwidth. Reference: digests and samples of the runs themselves.

#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use core::convert::Infallible;

use mm_sim::experiment::{self, Experiment};
use mm_sim::scenario;
use mm_sim::simulation::{Recorder, Retuned, RunResult, Sample};

/// Asks for another controller at a time, and keeps the tip of every sample.
struct Turner {
    at: f64,
    to: Option<Box<Retuned>>,
    now: bool,
    tips: Vec<(f64, [f64; 3])>,
}

impl Recorder for Turner {
    type Error = Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Infallible> {
        self.now = sample.t >= self.at;
        self.tips.push((sample.t, sample.tip.into()));
        Ok(true)
    }

    fn retuned(&mut self) -> Option<Box<Retuned>> {
        if self.now { self.to.take() } else { None }
    }
}

fn experiment_with(sets: &[&str]) -> (Experiment, Box<Retuned>) {
    let mut all = vec!["simulation.duration_s=1.0".to_owned()];
    all.extend(sets.iter().map(|set| (*set).to_owned()));
    let loaded = scenario::load("square-compare", &all).unwrap_or_else(|error| panic!("{error}"));
    let built = Experiment::build(&loaded).and_then(|experiment| {
        let stack = experiment::stack(&loaded)?;
        let supervised = Some(experiment::supervised(&loaded)?);
        Ok((experiment, Box::new(Retuned { stack, supervised })))
    });
    built.unwrap_or_else(|error| panic!("{error}"))
}

/// A run that goes on with the controller of `to` from half a second on.
fn run(from: &[&str], to: Option<&[&str]>) -> (RunResult, Vec<(f64, [f64; 3])>) {
    let to = to.map(|sets| experiment_with(sets).1);
    let mut turner = Turner { at: 0.5, to, now: false, tips: Vec::new() };
    let Ok(result) = experiment_with(from).0.run(&mut turner);
    (result, turner.tips)
}

const SOFT: &[&str] = &["controller.outer.position_gain_1_s=4.0"];
const SUPERVISED: &str = "controller.supervisor.enabled=true";

#[test]
fn the_same_gains_change_no_bit() {
    assert_eq!(run(&[], Some(&[])).0.digest, run(&[], None).0.digest);
    assert_eq!(run(&[SUPERVISED], Some(&[SUPERVISED])).0.digest, run(&[SUPERVISED], None).0.digest);
}

#[test]
fn other_gains_change_what_comes_after_them() {
    let (before, steady) = run(&[], None);
    let (after, turned) = run(&[], Some(SOFT));
    assert_ne!(before.digest, after.digest);
    assert_eq!(steady.len(), turned.len());
    let differs = |at: f64| steady.iter().zip(&turned).any(|(a, b)| a.0 <= at && a != b);
    assert!(!differs(0.5), "something changed before the gains did");
    assert!(differs(0.6), "nothing changed in a tenth of a second");
}

#[test]
fn a_supervisor_goes_over_to_the_new_gains_too() {
    let alone = run(&[], Some(SOFT)).0.digest;
    let supervised = run(&[SUPERVISED], Some(&[SUPERVISED, "controller.outer.position_gain_1_s=4.0"])).0;
    assert_eq!(alone, supervised.digest);
    assert!(supervised.supervisor.is_some_and(|report| report.findings.is_empty()));
}

/// How far the tips of two runs are apart at most from the change on, in 50 ms.
fn apart(one: &[(f64, [f64; 3])], other: &[(f64, [f64; 3])]) -> f64 {
    let soon = one.iter().zip(other).filter(|(a, _)| (0.5..0.55).contains(&a.0));
    soon.map(|(a, b)| a.1.iter().zip(b.1).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)).fold(0.0, f64::max)
}

/// Bound: nine tenths of a load of 30 N m on the shoulder, lost for 50 ms, move the tip by 0.27 mm.
#[test]
fn what_was_learned_outlives_another_bandwidth() {
    let payload = "plant.payload_kg=3.0";
    let slower = "controller.gains.observer_bandwidth_1_s=15.0";
    for supervised in ["controller.supervisor.enabled=false", SUPERVISED] {
        let (_, steady) = run(&[payload, supervised], None);
        let (_, turned) = run(&[payload, supervised], Some(&[payload, supervised, slower]));
        let apart = apart(&steady, &turned);
        assert!(apart < 1e-4, "{supervised}: {apart} m apart");
    }
}
