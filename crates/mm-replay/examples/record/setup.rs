//! The stack of a scenario as a message.

use anyhow::{Context, Result, ensure};
use mm_control::{Estimator, StackParams, SupervisorParams};
use mm_link::{Fuzzy, Pace, Setup};
use mm_sim::experiment::law_kind;
use mm_sim::scenario::{EstimatorKind, FuzzyEngine, Loaded};
use mm_sim::simulation::Simulation;

/// The setup that makes the simulation's stack.
pub(crate) fn of(loaded: &Loaded, simulation: &Simulation) -> Result<Setup<f64>> {
    let stack = &simulation.stack;
    let controller = &loaded.file.controller;
    ensure!(loaded.fis.is_none(), "a fuzzy system from a file does not travel");
    let fuzzy = match controller.fuzzy_engine {
        None => Fuzzy::Own,
        Some(FuzzyEngine::Table) => Fuzzy::Table,
        Some(FuzzyEngine::Exact) => Fuzzy::Rules,
        Some(FuzzyEngine::Q15) => Fuzzy::Q15,
        Some(other) => anyhow::bail!("the fuzzy engine {other:?} does not travel"),
    };
    let cutoff_hz = controller.estimator.cutoff_hz;
    let estimator = match controller.estimator.kind {
        _ if !stack.estimates() => Estimator::None,
        Some(EstimatorKind::Observer) => Estimator::Observer { cutoff_hz },
        _ => Estimator::FilteredDifference { cutoff_hz },
    };
    let period = simulation.clock.period;
    let params = StackParams { period, outer: *stack.outer().params(), gains: *stack.gains(), estimator };
    let setup = Setup {
        law: law_kind(controller.kind).context("no law")?,
        fuzzy,
        pace: Pace::Lockstep,
        robot: *stack.robot().params(),
        stack: params,
        delay: controller.estimator.delay_s,
        supervisor: SupervisorParams::for_robot(stack.robot(), period),
    };
    let built = setup.build().map_err(|error| anyhow::anyhow!("{error}"))?;
    ensure!(built.stack() == stack, "the setup makes another stack");
    Ok(setup)
}

/// The same in f32, every number rounded.
pub(crate) fn rounded(setup: &Setup<f64>) -> Result<Setup<f32>> {
    // TOML has infinities, and hands a number on as f64 whatever is asked for: each is rounded once.
    Ok(toml::Value::try_from(setup)?.try_into()?)
}
