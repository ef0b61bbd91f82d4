//! The runs of a reproduction, and the files they leave.

use std::convert::Infallible;
use std::io::{self, Write as _};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use nalgebra::Vector3;

use super::catalogue::{EXPERIMENTS, Experiment, FIGURES, Figure};
use super::draw::draw;
use super::files::{write, write_csv};
use super::measure::Done;
use super::report::{FIGURES_HEADER, FigureFile, Report, RunReport, SCHEMA, TABLE_HEADER, table};
use crate::experiment::{Experiment as Built, controller_name};
use crate::figures::{FigureError, Recording, Run as Shown};
use crate::log::{RobotShape, urdf};
use crate::parallel::{Pool, PoolError};
use crate::report::{Group, Run as ShownRun, Signals, of_reproduction};
use crate::scenario::{self, Loaded, ScenarioError};
use crate::simulation::{Ending, Recorder, RunResult, Sample};
use crate::summary;

/// What a reproduction may be told.
#[derive(Debug, Clone, Default)]
pub struct Options {
    /// Threads; 0 for as many as there are cores. The result does not depend on it.
    pub jobs: usize,
    /// Edits of every scenario, `KEY=VALUE`: what comes of it is then no longer the thesis's experiment.
    pub sets: Vec<String>,
}

/// Follows a reproduction, from several threads, and may end it.
pub trait Watch: Sync {
    /// Whether to go on.
    fn goes_on(&self) -> bool {
        true
    }
    /// A run or a figure is done.
    fn done(&self, _what: &str) {}
}

/// Why a reproduction came to nothing.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A scenario does not take the edits.
    #[error("{0}")]
    Scenario(Box<ScenarioError>),
    /// A file cannot be written.
    #[error("cannot write {}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A figure cannot be drawn.
    #[error("figure {number}")]
    Figure {
        /// Its number.
        number: &'static str,
        /// Why.
        source: FigureError,
    },
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] PoolError),
    /// It was asked to end; the files written so far are whole.
    #[error("interrupted")]
    Interrupted,
}

/// All runs, checked and built before the first one starts.
#[derive(Debug)]
pub struct Plan {
    runs: Vec<Planned>,
    jobs: usize,
}

#[derive(Debug)]
struct Planned {
    experiment: &'static Experiment,
    controller: &'static str,
    loaded: Loaded,
    built: Built,
}

/// A run that has ended.
struct Ended<'a> {
    planned: &'a Planned,
    recording: Recording,
    result: RunResult,
    report: RunReport,
}

impl Plan {
    /// Loads and builds every run.
    ///
    /// # Errors
    /// What is wrong with the edits.
    pub fn new(options: &Options) -> Result<Self, ScenarioError> {
        let mut runs = Vec::new();
        for experiment in EXPERIMENTS {
            let found = scenario::bundled().iter().find(|(name, _)| *name == experiment.scenario);
            let Some((_, text)) = found else { continue };
            for &controller in experiment.controllers {
                runs.push(Planned::new((experiment, controller), text, &options.sets)?);
            }
        }
        Ok(Self { runs, jobs: options.jobs })
    }

    /// Number of times that [`Watch::done`] will be called: for every run and every figure.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.runs.len() + self.figures().count()
    }

    /// Runs everything and writes `data/*.csv`, `figures/*.svg`, `figures.csv`, `table.csv` and `report.html` into a folder.
    ///
    /// Each file is written beside its place first, so that none is ever half there; what else is in the folder stays.
    ///
    /// # Errors
    /// A file that cannot be written, or that the watch asked to end. A run that fails is no error: the report has it.
    pub fn run(&self, out: &Path, watch: &dyn Watch) -> Result<Report, ReproduceError> {
        let begin = Instant::now();
        for folder in [out.join("data"), out.join("figures")] {
            std::fs::create_dir_all(&folder)
                .map_err(|source| ReproduceError::File { path: folder.clone(), source })?;
        }
        let pool = Pool::new((self.jobs > 0).then_some(self.jobs))?;
        let ended = all(&pool, &self.runs, |run| run.perform(out, watch))?;
        let figures: Vec<&Figure> = self.figures().collect();
        let drawn = all(&pool, &figures, |figure| picture(figure, &ended, out, watch))?;
        let (figures, pictures): (Vec<FigureFile>, Vec<String>) = drawn.into_iter().unzip();
        let find = |experiment: &str, law: &str| {
            let is_it =
                |run: &&Ended<'_>| run.planned.experiment.name == experiment && run.planned.controller == law;
            ended.iter().find(is_it).filter(|run| run.report.finished).map(Ended::measured)
        };
        let table = table(|experiment| self.has(experiment), find);
        let lines = table.iter().map(super::Row::fields);
        write_csv(&out.join("table.csv"), &TABLE_HEADER, lines)?;
        let lines = figures.iter().map(FigureFile::fields);
        write_csv(&out.join("figures.csv"), &FIGURES_HEADER, lines)?;
        let groups = groups(&ended);
        let mut report = Report {
            schema: SCHEMA,
            out: out.display().to_string(),
            wall_s: 0.0,
            runs: ended.into_iter().map(|run| run.report).collect(),
            table,
            figures,
        };
        let page = of_reproduction(&report, &pictures, &groups);
        write(&out.join("report.html"), |file| file.write_all(page.as_bytes()))?;
        report.wall_s = begin.elapsed().as_secs_f64();
        Ok(report)
    }

    /// The figures of the experiments that there are.
    fn figures(&self) -> impl Iterator<Item = &'static Figure> {
        FIGURES.iter().filter(|figure| self.has(figure.experiment))
    }

    fn has(&self, experiment: &str) -> bool {
        self.runs.iter().any(|run| run.experiment.name == experiment)
    }
}

/// Does the work of all items, in parallel, or up to the first that fails.
fn all<'a, I: Sync, T: Send>(
    pool: &Pool,
    items: &'a [I],
    work: impl Fn(&'a I) -> Result<T, ReproduceError> + Sync,
) -> Result<Vec<T>, ReproduceError> {
    let mut done = Ok(Vec::with_capacity(items.len()));
    let at = |number: u64| usize::try_from(number).ok().and_then(|index| items.get(index));
    pool.in_order(
        0..items.len() as u64,
        |number| at(number).map(&work),
        |_, result| match (result, &mut done) {
            (Some(Err(error)), _) => {
                done = Err(error);
                ControlFlow::Break(())
            }
            (Some(Ok(one)), Ok(done)) => {
                done.push(one);
                ControlFlow::Continue(())
            }
            (None, _) | (_, Err(_)) => ControlFlow::Continue(()),
        },
    );
    done
}

impl Planned {
    fn new(
        (experiment, controller): (&'static Experiment, &'static str),
        text: &str,
        extra: &[String],
    ) -> Result<Self, ScenarioError> {
        let mut sets: Vec<String> = experiment.sets.iter().map(|&set| set.to_owned()).collect();
        sets.extend_from_slice(extra);
        let mut loaded = scenario::from_text(experiment.scenario, text, &sets)?;
        if controller_name(loaded.file.controller.kind) != controller {
            // The law that the scenario has is not set: a run of the file as it stands is judged by its [expect].
            sets.push(format!("controller.kind=\"{controller}\""));
            loaded = scenario::from_text(experiment.scenario, text, &sets)?;
        }
        let mut built = Built::build(&loaded)?;
        let clock = match &mut built {
            Built::Closed(simulation) => &mut simulation.clock,
            Built::Open(imposed) => &mut imposed.clock,
        };
        // A relay that turns at every tick would look constant in every tenth one: an odd stride sees both its sides.
        clock.log_every |= 1;
        Ok(Self { experiment, controller, loaded, built })
    }

    /// Path of its data in the folder.
    fn data(&self) -> String {
        match self.controller {
            "none" => format!("data/{}.csv", self.experiment.name),
            law => format!("data/{}.{law}.csv", self.experiment.name),
        }
    }

    fn perform(&self, out: &Path, watch: &dyn Watch) -> Result<Ended<'_>, ReproduceError> {
        if !watch.goes_on() {
            return Err(ReproduceError::Interrupted);
        }
        let begin = Instant::now();
        let mut recorder = Watched { recording: Recording::of(&self.built), watch };
        let Ok(result) = self.built.run(&mut recorder);
        if matches!(result.ending, Ending::Stopped { .. }) {
            return Err(ReproduceError::Interrupted);
        }
        let wall_s = begin.elapsed().as_secs_f64();
        let recording = recorder.recording;
        write(&out.join(self.data()), |file| recording.write_csv(file))?;
        let mut warnings = summary::warnings(&result, self.built.plant().robot().params().limits.speed);
        warnings.extend(self.built.reference_warnings(result.simulated_s(self.built.clock())));
        warnings.extend(summary::describe(&result.ending));
        let finished = matches!(result.ending, Ending::Finished);
        let is_judged = finished && !self.loaded.is_modified();
        let missed = summary::missed(&self.loaded.file.expect, &result.metrics);
        let report = RunReport {
            experiment: self.experiment.name,
            section: self.experiment.section,
            scenario: self.experiment.scenario,
            controller: self.controller,
            finished,
            metrics: result.metrics,
            digest: result.digest.clone(),
            wall_s,
            data: self.data(),
            warnings,
            missed: if is_judged { missed } else { Vec::new() },
        };
        watch.done(&format!("{} {}", self.experiment.name, self.controller));
        Ok(Ended { planned: self, recording, result, report })
    }
}

impl Ended<'_> {
    /// The run as the report shows it.
    fn shown(&self) -> ShownRun {
        let shape = RobotShape::from(self.planned.built.plant().robot().params());
        let law = self.planned.controller;
        let name = if law == "none" { self.planned.experiment.name } else { law };
        ShownRun::new((name, law), &urdf(&shape), Signals::Recording(&self.recording))
    }

    fn measured(&self) -> Done<'_> {
        let q = &self.result.last.q;
        Done {
            metrics: &self.result.metrics,
            recording: &self.recording,
            last: [Vector3::new(q.x, q.y, 0.0), self.planned.built.plant().robot().tip_position(q)],
            duration_s: self.result.simulated_s(self.planned.built.clock()),
        }
    }
}

/// The runs of each experiment, to be replayed side by side.
fn groups(ended: &[Ended<'_>]) -> Vec<Group> {
    let of = |experiment: &Experiment| {
        let runs = ended.iter().filter(|run| run.planned.experiment == experiment);
        let runs: Vec<ShownRun> = runs.map(Ended::shown).collect();
        (!runs.is_empty()).then(|| Group::new(format!("{} {}", experiment.section, experiment.name), runs))
    };
    EXPERIMENTS.iter().filter_map(of).collect()
}

/// A recording that can be ended.
struct Watched<'a> {
    recording: Recording,
    watch: &'a dyn Watch,
}

impl Recorder for Watched<'_> {
    type Error = Infallible;

    fn record(&mut self, sample: &Sample<'_>) -> Result<bool, Infallible> {
        self.recording.record(sample)
    }

    fn goes_on(&mut self) -> bool {
        self.watch.goes_on()
    }
}

/// Draws a figure of the runs that it shows.
fn picture(
    figure: &'static Figure,
    ended: &[Ended<'_>],
    out: &Path,
    watch: &dyn Watch,
) -> Result<(FigureFile, String), ReproduceError> {
    if !watch.goes_on() {
        return Err(ReproduceError::Interrupted);
    }
    let is_shown = |run: &&Ended<'_>| {
        run.planned.experiment.name == figure.experiment
            && (figure.controllers.is_empty() || figure.controllers.contains(&run.planned.controller))
    };
    let shown: Vec<&Ended<'_>> = ended.iter().filter(is_shown).collect();
    let runs: Vec<Shown<'_>> =
        shown.iter().map(|run| Shown { name: run.planned.controller, data: &run.recording }).collect();
    let file = draw(figure, &runs, shown.iter().map(|run| run.planned.data()).collect(), out)?;
    watch.done(&format!("figure {}", figure.number));
    Ok(file)
}
