//! Runs of scenarios.

use std::path::PathBuf;
use std::time::Instant;

use mm_sim::experiment::Experiment;
use mm_sim::log::{LogError, Outcome, RunLog};
use mm_sim::simulation::{RunResult, Simulation};
use mm_sim::summary::Summary;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::outside::Outside;
use crate::recording::Recording;
use crate::scenario::Scenario;
use crate::{errors, json};

/// Runs a scenario: a dict of arrays, with the summary under ``"summary"``.
#[pyfunction]
#[pyo3(signature = (scenario, controller = None, plant = None, log = None, progress = None))]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    controller: Option<Py<PyAny>>,
    plant: Option<Py<PyAny>>,
    log: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let Scenario { loaded, experiment } = scenario;
    if (controller.is_some() || plant.is_some()) && !outside_is_possible(experiment, plant.is_some()) {
        return Err(PyValueError::new_err(
            "a controller or plant in Python takes a closed loop without faults, supervisor, sensors and actuators",
        ));
    }
    let clock = experiment.clock();
    let samples = usize::try_from(clock.ticks / clock.log_every).unwrap_or(usize::MAX);
    let writer = open(scenario, log.as_ref())?;
    let mut recording = Recording::new(clock.duration(), samples, writer, progress);
    let begin = Instant::now();
    let ran = py.detach(|| match (controller.as_ref(), plant.as_ref(), experiment) {
        (None, None, _) | (_, _, Experiment::Open(_)) => (experiment.run(&mut recording), None),
        (Some(_), None, Experiment::Closed(s)) => {
            run::<true, false>(s, &mut recording, (controller.as_ref(), None))
        }
        (None, Some(_), Experiment::Closed(s)) => {
            run::<false, true>(s, &mut recording, (None, plant.as_ref()))
        }
        (Some(_), Some(_), Experiment::Closed(s)) => {
            run::<true, true>(s, &mut recording, (controller.as_ref(), plant.as_ref()))
        }
    });
    let wall_s = begin.elapsed().as_secs_f64();
    let (result, raised) = ran;
    let result = result.map_err(|error| errors::system(&error))?;
    let mut summary = Summary::of((loaded, experiment), &result, wall_s, log.as_deref());
    if controller.is_some() {
        summary.controller = "python";
    }
    if let Some(log) = recording.log.take() {
        let text = summary.to_json();
        log.finish(Outcome::from(&result.ending), &text, &result.digest)
            .map_err(|error| errors::system(&error))?;
    }
    // The log of what was done is whole now.
    if let Some(error) = raised.or_else(|| recording.raised.take()) {
        return Err(error);
    }
    let table = recording.arrays(py)?;
    table.set_item("summary", json::object(py, &summary.to_json())?)?;
    Ok(table)
}

fn outside_is_possible(experiment: &Experiment, moves: bool) -> bool {
    match experiment {
        Experiment::Closed(simulation) => {
            simulation.guard.is_none() && (simulation.hardware.is_none() || !moves)
        }
        Experiment::Open(_) => false,
    }
}

fn open(scenario: &Scenario, path: Option<&PathBuf>) -> PyResult<Option<RunLog>> {
    let Some(path) = path else { return Ok(None) };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let log = RunLog::create(&scenario.loaded, &scenario.experiment, path);
    log.map(Some).map_err(|error| errors::system(&error))
}

/// Functions in Python: the controller and the plant.
type Functions<'a> = (Option<&'a Py<PyAny>>, Option<&'a Py<PyAny>>);

fn run<const C: bool, const P: bool>(
    simulation: &Simulation,
    recording: &mut Recording,
    (controller, plant): Functions<'_>,
) -> (Result<RunResult, LogError>, Option<PyErr>) {
    let mut outside = Outside::<C, P>::new(controller, plant, simulation.stack.robot());
    let result = simulation.run_with(recording, &mut outside);
    (result, outside.raised)
}

/// Runs a scenario again and writes its log; the digest of the run.
#[pyfunction]
pub(crate) fn log_run<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    path: PathBuf,
) -> PyResult<Bound<'py, PyAny>> {
    let run = simulate(py, scenario, None, None, Some(path), None)?;
    run.get_item("summary")?
        .map_or_else(|| Err(PyValueError::new_err("no summary")), |summary| summary.get_item("digest"))
}
