//! Monte-Carlo: one scenario with many random plants, disturbances and starts.
//!
//! A sample is the scenario with a list of ordinary edits laid over it, which follow from the seed of the sweep and the number of
//! the sample alone: anybody can run it again by itself. Samples are run on all cores, taken in their order, and appended to a
//! file that a later call goes on with.

mod draw;
mod report;
mod statistics;
mod store;

use std::ops::{ControlFlow, Range};

use crate::experiment::Experiment;
use crate::metrics::Metrics;
use crate::parallel::Pool;
use crate::scenario::{Loaded, ScenarioError};
use crate::simulation::Ending;
use crate::stopper::Stopper;

pub use draw::{edits, sample_seed};
pub use report::{Failure, Quantity, Report, SCHEMA, Worst};
pub use statistics::{Interval, clopper_pearson, quantile};
pub use store::{Store, StoreError};

/// How a sample ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ended {
    /// The whole duration was simulated.
    Finished,
    /// The loop ran away.
    Diverged,
    /// The controller refused its input.
    Refused,
    /// The supervisor gave the robot up.
    Faulted,
}

impl Ended {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Finished, Self::Diverged, Self::Refused, Self::Faulted];

    /// The word for it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Finished => "finished",
            Self::Diverged => "diverged",
            Self::Refused => "refused",
            Self::Faulted => "fault",
        }
    }

    /// What a word stands for.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|ended| ended.name() == name)
    }
}

/// What is kept of a sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its number, from 0.
    pub sample: u64,
    /// Its seed.
    pub seed: u64,
    /// How it ended.
    pub ended: Ended,
    /// Time simulated, s.
    pub simulated_s: f64,
    /// The numbers of [`QUANTITIES`].
    pub values: [f64; QUANTITIES.len()],
    /// Digest of its trajectory.
    pub digest: String,
}

/// Names of the numbers that are kept of a sample, as in the summary of a run.
pub const QUANTITIES: [&str; 6] =
    ["rmse_m", "max_error_m", "itae_m_s2", "torque_tv_n_m_per_s", "saturated_fraction", "max_speed_m_s"];

/// The numbers that are kept of a run, in the order of [`QUANTITIES`]: norms over the axes, sums over axes and torques.
fn values(m: &Metrics) -> [f64; QUANTITIES.len()] {
    [
        m.rmse_m.norm,
        m.max_error_m,
        m.itae_m_s2.sum,
        m.torque_tv_n_m_per_s.sum,
        m.saturated_fraction,
        m.max_speed_m_s,
    ]
}

/// Why a sweep ended before its time.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The scenario does not work with the edits of a sample.
    #[error("sample {sample} is no scenario that can be run")]
    Scenario {
        /// Its number.
        sample: u64,
        /// What is wrong with it.
        #[source]
        source: Box<ScenarioError>,
    },
    /// The file of samples.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// It was asked to stop.
    #[error("interrupted after {done} of {samples} samples")]
    Stopped {
        /// Samples in the file.
        done: u64,
        /// Samples asked for.
        samples: u64,
    },
}

/// Runs one sample; none if it was asked to stop.
fn run_sample(
    loaded: &Loaded,
    (seed, sample): (u64, u64),
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Row>, ScenarioError> {
    let edited = loaded.edited(&edits(&loaded.file, seed, sample))?;
    let experiment = Experiment::build(&edited)?;
    let Ok(result) = experiment.run(&mut Stopper(stop));
    let ended = match result.ending {
        Ending::Finished => Ended::Finished,
        Ending::Diverged { .. } => Ended::Diverged,
        Ending::Refused { .. } => Ended::Refused,
        Ending::Faulted { .. } => Ended::Faulted,
        Ending::Stopped { .. } => return Ok(None),
    };
    let simulated_s = result.simulated_s(experiment.clock());
    let seed = sample_seed(seed, sample);
    Ok(Some(Row { sample, seed, ended, simulated_s, values: values(&result.metrics), digest: result.digest }))
}

/// Runs samples and hands each, in their order, to `take`; the first error ends it.
///
/// `stop` is asked all the time.
///
/// # Errors
/// A sample that is no scenario, a stop, those of `take`.
pub fn samples(
    loaded: &Loaded,
    seed: u64,
    numbers: Range<u64>,
    (pool, stop): (&Pool, &(dyn Fn() -> bool + Sync)),
    mut take: impl FnMut(Row) -> Result<(), SweepError>,
) -> Result<(), SweepError> {
    let (mut failed, end) = (Ok(()), numbers.end);
    pool.in_order(
        numbers,
        |sample| run_sample(loaded, (seed, sample), stop),
        |sample, outcome| {
            failed = match outcome {
                Ok(Some(row)) => take(row),
                Ok(None) => Err(SweepError::Stopped { done: sample, samples: end }),
                Err(source) => Err(SweepError::Scenario { sample, source: Box::new(source) }),
            };
            if failed.is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        },
    );
    failed
}

/// Goes on with a sweep from where its file ends to `samples` samples, and returns the file's rows up to there.
///
/// `stop` is asked all the time; `progress` hears of every sample that is in the file.
///
/// # Errors
/// A sample that is no scenario, a file that cannot be written, a stop; what was done up to there is in the file.
pub fn run(
    loaded: &Loaded,
    (seed, samples): (u64, u64),
    (pool, store): (&Pool, &mut Store),
    stop: &(dyn Fn() -> bool + Sync),
    mut progress: impl FnMut(&Row),
) -> Result<Vec<Row>, SweepError> {
    let missing = store.rows().len() as u64..samples;
    self::samples(loaded, seed, missing, (pool, stop), |row| {
        progress(&row);
        store.append(row).map_err(SweepError::from)
    })?;
    Ok(store.rows().iter().take(usize::try_from(samples).unwrap_or(usize::MAX)).cloned().collect())
}
