//! Tuning: the gains of a law that cost least on a scenario, found by a particle swarm.
//!
//! What moves are factors on groups of the law's default gains, in the logarithm; the outer loop stays. Each candidate is the
//! scenario with ordinary edits laid over it. The result depends on the scenario, the law and the seed alone.

mod output;
mod swarm;
mod tunables;

use mm_control::{Gains, LawKind};

use crate::experiment::Experiment;
use crate::metrics::Metrics;
use crate::parallel::Pool;
use crate::scenario::{Loaded, Tune};
use crate::simulation::Ending;
use crate::stopper::Stopper;

pub use output::to_toml;
pub use swarm::{Point, Swarm};
pub use tunables::{Gain, Group, Key, scaled, tunables};

/// Cost of a run that lasts to its end, at most; one that ends at once costs twice as much.
pub const EARLY_END: f64 = 1e6;

/// Why a law was not tuned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum TuneError {
    /// The scenario imposes velocities, or the law has no gains to tune.
    #[error("{law} has no gains that could be tuned on this scenario")]
    NothingToTune {
        /// Name of the law.
        law: &'static str,
    },
    /// Every candidate ended early.
    #[error("no gains within the bounds bring {law} to the end of the scenario")]
    NoneFinished {
        /// Name of the law.
        law: &'static str,
    },
    /// It was asked to stop.
    #[error("interrupted")]
    Stopped,
}

/// A run of a candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Its cost.
    pub cost: f64,
    /// Its metrics and the digest of its trajectory; none if the gains do not even make a controller.
    pub result: Option<(Metrics, String)>,
}

/// The best gains of a law.
#[derive(Debug, Clone, PartialEq)]
pub struct Tuned {
    /// The law.
    pub law: LawKind,
    /// Factors on the default gains, one a group.
    pub factors: Vec<f64>,
    /// The gains, by key.
    pub gains: Vec<(&'static str, Gain)>,
    /// Their run.
    pub trial: Trial,
    /// Cost of the default gains.
    pub default_cost: f64,
    /// Cost of the gains that the scenario gives.
    pub given_cost: f64,
    /// Gains that a file of gains gave and that were not tuned, by key, as TOML: without them the tuned ones would be others.
    pub kept: Vec<(String, String)>,
}

/// A law and what came of its tuning.
pub type Outcome = (LawKind, Result<Tuned, TuneError>);

/// Cost of a run that ended at time `t` of `duration`, early or not.
#[must_use]
pub fn cost(tune: &Tune, metrics: &Metrics, ending: &Ending, duration: f64) -> f64 {
    match *ending {
        Ending::Finished => {
            let sum = metrics.itae_m_s2.sum
                + tune.torque_variation_weight * metrics.torque_tv_n_m_per_s.sum
                + tune.effort_weight * metrics.effort_n2_m2_s;
            if sum <= EARLY_END { sum } else { EARLY_END }
        }
        Ending::Stopped { t }
        | Ending::Diverged { t, .. }
        | Ending::Faulted { t, .. }
        | Ending::Refused { t, .. } => EARLY_END * (2.0 - t / duration),
    }
}

/// The search for the gains of one law.
struct Search<'a> {
    loaded: &'a Loaded,
    law: LawKind,
    default: Gains<f64, 3>,
    /// Logarithm of the least factor of each group and of the ratio of the greatest to it.
    ranges: Vec<[f64; 2]>,
    stop: &'a (dyn Fn() -> bool + Sync),
}

impl Search<'_> {
    /// Factors at a point of the unit cube.
    fn factors(&self, position: &[f64]) -> Vec<f64> {
        position.iter().zip(&self.ranges).map(|(x, [low, span])| libm::exp(low + x * span)).collect()
    }

    /// The point of the unit cube at which every factor is 1, or as near as the bounds let it.
    fn start(&self) -> Vec<f64> {
        self.ranges.iter().map(|[low, span]| (-low / span).clamp(0.0, 1.0)).collect()
    }

    /// Runs the scenario and its other versions with the gains that factors make; none if it was asked to stop.
    ///
    /// The cost is that of the worst version, the result that of the scenario itself.
    fn trial(&self, factors: &[f64]) -> Option<Trial> {
        let law = self.law.name();
        let gains: Vec<String> = scaled(self.law, &self.default, factors)
            .iter()
            // What is meant for one law and said last comes before everything else.
            .map(|(key, gain)| format!("controller.gains_for.{law}.{key}={gain}"))
            .collect();
        self.worst(&gains)
    }

    /// Runs the scenario and its other versions with more edits, as [`Self::trial`].
    fn worst(&self, edits: &[String]) -> Option<Trial> {
        let mut trial = self.run(edits)?;
        for version in &self.loaded.file.tune.also {
            if trial.cost > EARLY_END {
                break;
            }
            trial.cost = trial.cost.max(self.run(&[version.as_slice(), edits].concat())?.cost);
        }
        Some(trial)
    }

    /// Runs the scenario with edits; none if it was asked to stop.
    fn run(&self, edits: &[String]) -> Option<Trial> {
        let impossible = Trial { cost: 2.0 * EARLY_END, result: None };
        let Ok(edited) = self.loaded.edited(edits) else { return Some(impossible) };
        let Ok(experiment) = Experiment::build(&edited) else { return Some(impossible) };
        let Ok(result) = experiment.run(&mut Stopper(self.stop));
        if matches!(result.ending, Ending::Stopped { .. }) {
            return None;
        }
        let duration = experiment.clock().duration();
        let cost = cost(&edited.file.tune, &result.metrics, &result.ending, duration);
        Some(Trial { cost, result: Some((result.metrics, result.digest)) })
    }
}

/// Tunes a law on a scenario that names it as its controller.
///
/// `stop` is asked all the time; `progress` hears how many runs were done more.
///
/// # Errors
/// Nothing to tune, no candidate that lasts, a stop.
pub fn tune(
    (loaded, experiment): (&Loaded, &Experiment),
    (law, seed): (LawKind, u64),
    pool: &Pool,
    stop: &(dyn Fn() -> bool + Sync),
    mut progress: impl FnMut(u64),
) -> Result<Tuned, TuneError> {
    let settings = &loaded.file.tune;
    let Experiment::Closed(simulation) = experiment else {
        return Err(TuneError::NothingToTune { law: law.name() });
    };
    let groups = tunables(law);
    if groups.is_empty() {
        return Err(TuneError::NothingToTune { law: law.name() });
    }
    let ranges = groups.iter().map(|group| {
        let [lo, hi] = settings.bounds.unwrap_or(group.bounds);
        [libm::log(lo), libm::log(hi / lo)]
    });
    let default = Gains::for_robot(simulation.stack.robot(), law, simulation.clock.period);
    let search = Search { loaded, law, default, ranges: ranges.collect(), stop };
    let swarm = Swarm {
        particles: settings.particles,
        iterations: settings.iterations,
        seed,
        inertia_weight: settings.inertia_weight,
        cognitive: settings.cognitive,
        social: settings.social,
    };
    let best = swarm.minimize(&search.start(), |positions| {
        let trials = pool.map(positions, |position| search.trial(&search.factors(position)));
        progress(positions.len() as u64);
        trials.into_iter().map(|trial| Some(trial?.cost)).collect()
    });
    let factors = search.factors(&best.ok_or(TuneError::Stopped)?.position);
    let trial = search.trial(&factors).ok_or(TuneError::Stopped)?;
    if trial.cost > EARLY_END {
        return Err(TuneError::NoneFinished { law: law.name() });
    }
    let default_cost = search.trial(&vec![1.0; factors.len()]).ok_or(TuneError::Stopped)?.cost;
    let given_cost = search.worst(&[]).ok_or(TuneError::Stopped)?.cost;
    let gains = scaled(law, &search.default, &factors);
    let is_kept = |key: &str| gains.iter().all(|(tuned, _)| *tuned != key);
    let of_file = loaded.gains_of_file().into_iter();
    let kept = of_file.filter(|(key, _)| is_kept(key)).map(|(key, gain)| (key.to_owned(), gain)).collect();
    Ok(Tuned { law, factors, gains, trial, default_cost, given_cost, kept })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario;
    use crate::simulation::NoRecorder;

    /// Law: the cost of a finished run is the weighted sum; one that ends early costs more than any that finishes, and the more the
    /// earlier. Reference: the sum by hand. No tolerance.
    #[test]
    fn the_earlier_a_run_ends_the_more_it_costs() {
        let sets = ["simulation.duration_s=0.01".to_owned(), "tune.effort_weight=0.5".to_owned()];
        let loaded = scenario::load("square", &sets).expect("a scenario");
        let experiment = Experiment::build(&loaded).expect("a loop");
        let Ok(result) = experiment.run(&mut NoRecorder);
        let m = result.metrics;
        let of = |m: &Metrics, ending| Some(cost(&loaded.file.tune, m, &ending, 10.0));
        let wanted = m.itae_m_s2.sum + 1e-4 * m.torque_tv_n_m_per_s.sum + 0.5 * m.effort_n2_m2_s;
        assert_eq!(of(&m, Ending::Finished), Some(wanted), "the weighted sum");
        let diverged = |t| of(&m, Ending::Diverged { t, state: "", value: 0.0 });
        assert!(diverged(0.0) > diverged(5.0) && diverged(5.0) > diverged(9.999), "earlier is worse");
        let mut huge = m;
        for effort in [1e300, f64::INFINITY, f64::NAN] {
            huge.effort_n2_m2_s = effort;
            assert_eq!(of(&huge, Ending::Finished), Some(EARLY_END), "the most that a finished run costs");
        }
        assert!(diverged(9.999) > Some(EARLY_END), "worse than any that finishes");
        assert_eq!(diverged(0.0), Some(2.0 * EARLY_END), "the most of all");
    }
}
