//! What the tests across crates share: scenarios by name, recorded runs, random numbers, worst cases.
//!
//! Nothing here computes what a test checks. A scenario that does not load is a failed test, so the helpers panic with the
//! message a user would see.

#![expect(clippy::panic, clippy::missing_panics_doc, reason = "a helper of tests reports like a test")]

use mm_control::Output;
use mm_model::Torque;
use mm_sim::experiment::Experiment;
use mm_sim::plant::PlantState;
use mm_sim::scenario::{self, Loaded};
use mm_sim::simulation::{Ending, NoRecorder, Recorder, RunResult, Sample, Simulation};
use nalgebra::Vector3;

/// A bundled scenario with edits laid over it.
#[must_use]
pub fn load(name: &str, sets: &[&str]) -> Loaded {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::load(name, &sets).unwrap_or_else(|error| panic!("{name}:\n{error}"))
}

/// A scenario from its text.
#[must_use]
pub fn load_text(name: &str, text: &str, sets: &[&str]) -> Loaded {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    scenario::from_text(name, text, &sets).unwrap_or_else(|error| panic!("{name}:\n{error}"))
}

/// What a scenario becomes.
#[must_use]
pub fn build(loaded: &Loaded) -> Experiment {
    Experiment::build(loaded).unwrap_or_else(|error| panic!("{}:\n{error}", loaded.name()))
}

/// The closed loop of a scenario.
#[must_use]
pub fn closed(loaded: &Loaded) -> Simulation {
    match build(loaded) {
        Experiment::Closed(simulation) => simulation,
        Experiment::Open(_) => panic!("{} has no controller", loaded.name()),
    }
}

/// A run without a record.
#[must_use]
pub fn run(experiment: &Experiment) -> RunResult {
    let Ok(result) = experiment.run(&mut NoRecorder);
    result
}

/// A run that has to reach its end.
#[must_use]
pub fn finished(name: &str, experiment: &Experiment) -> RunResult {
    let result = run(experiment);
    assert_eq!(result.ending, Ending::Finished, "{name} has to reach its end");
    result
}

/// One recorded instant.
#[derive(Debug, Clone, Copy)]
pub struct Tick {
    /// Time, s.
    pub t: f64,
    /// True state.
    pub state: PlantState,
    /// True tip, m.
    pub tip: Vector3<f64>,
    /// Where the tip should be, m.
    pub desired: Vector3<f64>,
    /// Torque at the plant's input.
    pub torque: Torque<f64, 3>,
    /// The controller's output; none for an imposed motion.
    pub output: Option<Output<f64, 3>>,
}

/// Keeps every sample it is given.
#[derive(Debug, Clone, Default)]
pub struct Record(pub Vec<Tick>);

impl Recorder for Record {
    type Error = core::convert::Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Self::Error> {
        self.0.push(Tick {
            t: sample.t,
            state: *sample.state,
            tip: sample.tip,
            desired: sample.reference.position,
            torque: *sample.torque,
            output: sample.output.copied(),
        });
        Ok(true)
    }
}

/// A run with every control tick recorded; the scenario has to log every one of them.
#[must_use]
pub fn recorded(experiment: &Experiment) -> (Vec<Tick>, RunResult) {
    assert_eq!(experiment.clock().log_every, 1, "the scenario has to log every tick");
    let mut record = Record::default();
    let Ok(result) = experiment.run(&mut record);
    (record.0, result)
}

/// SplitMix64 (Steele, Lea and Flood, 2014): every run of a test draws the same numbers.
#[derive(Debug, Clone, Copy)]
pub struct Random(u64);

impl Random {
    /// A generator that starts from a seed.
    #[must_use]
    pub const fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniform in [`lo`, `hi`).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    pub fn between(&mut self, lo: f64, hi: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        let unit = ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64;
        lo + (hi - lo) * unit
    }

    /// Three numbers, each uniform in [`lo`, `hi`).
    pub fn three(&mut self, lo: f64, hi: f64) -> [f64; 3] {
        [(); 3].map(|()| self.between(lo, hi))
    }
}

/// A test report that is only shown with `--nocapture`: a number that was measured.
pub fn measured(what: &str, value: f64) {
    use std::io::Write as _;
    let _ = writeln!(std::io::stderr(), "{what}: {value:.6e}");
}
