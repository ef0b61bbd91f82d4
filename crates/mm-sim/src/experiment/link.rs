//! What a target at the end of a link needs to know to compute the torques of a scenario.

use mm_control::{LawKind, SupervisorParams};
use mm_link::{Fuzzy, Pace, Setup};

use super::{Simulation, controller};
use crate::scenario::{FuzzyEngine, Loaded, ScenarioError};

/// The controller of a closed loop as a message; its supervisor has the limits of the scenario, or those that follow from the robot.
///
/// # Errors
/// Faults, which corrupt what a controller here would see; a fuzzy system from a file, or evaluated in a way that no target has: its tables do not travel.
pub fn setup(loaded: &Loaded, simulation: &Simulation) -> Result<Setup<f64>, ScenarioError> {
    let robot = simulation.stack.robot();
    let (law, stack) = controller::params(loaded, robot)?;
    let guard = simulation.guard.as_deref();
    if guard.is_some_and(|guard| !guard.faults.is_empty()) {
        let message = "faults are not injected into what a target sees";
        return Err(loaded.problem("fault", message, "none; `--inject` damages frames instead"));
    }
    let supervised = guard.and_then(|guard| guard.supervisor.as_ref());
    let supervisor = supervised
        .map_or_else(|| SupervisorParams::for_robot(robot, stack.period), |supervised| *supervised.params());
    Ok(Setup {
        law,
        fuzzy: fuzzy(loaded, law)?,
        pace: Pace::Lockstep,
        robot: *robot.params(),
        stack,
        delay: loaded.file.controller.estimator.delay_s,
        supervisor,
    })
}

fn fuzzy(loaded: &Loaded, law: LawKind) -> Result<Fuzzy, ScenarioError> {
    if !matches!(law, LawKind::Bfsmc | LawKind::BfsmcThesis) {
        return Ok(Fuzzy::Own);
    }
    if loaded.fis.is_some() {
        let message = "a fuzzy system from a file does not travel to a target";
        return Err(loaded.problem("controller.fis", message, "the law's own, which is in the firmware"));
    }
    Ok(match loaded.file.controller.fuzzy_engine {
        None => Fuzzy::Own,
        Some(FuzzyEngine::Table) => Fuzzy::Table,
        Some(FuzzyEngine::Exact) => Fuzzy::Rules,
        Some(FuzzyEngine::Q15) => Fuzzy::Q15,
        Some(FuzzyEngine::Surface) => Fuzzy::Surface,
        Some(FuzzyEngine::Sampled) => {
            let message = "no firmware samples the output sets";
            let expected = "`table`, `exact`, `q15` or `surface`";
            return Err(loaded.problem("controller.fuzzy_engine", message, expected));
        }
    })
}
