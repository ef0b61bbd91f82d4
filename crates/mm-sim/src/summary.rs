//! The summary of a run: the `--json` object, its warnings and the judgement of `[expect]`.

use std::path::Path;

use mm_control::supervisor::Findings;
use serde::Serialize;

use crate::experiment::{Experiment, controller_name};
use crate::log::Outcome;
use crate::metrics::Metrics;
use crate::monitors::{Lasting, MonitorReport};
use crate::scenario::{Bounds, Expect, Loaded};
use crate::simulation::{Ending, RunResult, SupervisorReport};

/// The `--json` summary of one run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Name and version of this format.
    pub schema: &'static str,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the controller.
    pub controller: &'static str,
    /// Duration of the scenario, s.
    pub duration_s: f64,
    /// Integration step of the plant, s.
    pub plant_step_s: f64,
    /// Control period, s.
    pub control_period_s: f64,
    /// Seed of everything random.
    pub seed: u64,
    /// How it ended: finished, interrupted, diverged, refused or fault.
    pub ended: &'static str,
    /// Time simulated, s: less than the duration of a run that ended early.
    pub simulated_s: f64,
    /// Metrics over the ticks simulated.
    pub metrics: Metrics,
    /// What the monitors saw; none for an imposed motion.
    pub monitors: Option<MonitorReport>,
    /// What the supervisor did; none without one.
    pub supervisor: Option<SupervisorReport>,
    /// XXH3-128 of the trajectory.
    pub digest: String,
    /// Simulated seconds per second of wall time.
    pub real_time_factor: f64,
    /// Wall time of the run, s.
    pub wall_s: f64,
    /// Path of the log; none without one.
    pub log: Option<String>,
    /// What a reader should know besides the numbers.
    pub warnings: Vec<String>,
}

/// Name and version of the summary's format.
pub const SCHEMA: &str = "mmsim.summary/1";

impl Summary {
    /// The summary of a run of a scenario that took `wall_s`.
    #[must_use]
    pub fn of(
        (loaded, experiment): (&Loaded, &Experiment),
        result: &RunResult,
        wall_s: f64,
        log: Option<&Path>,
    ) -> Self {
        let file = &loaded.file;
        let simulated = result.simulated_s(experiment.clock());
        let mut warnings = warnings(result, experiment.plant().robot().params().limits.speed);
        warnings.extend(experiment.reference_warnings(simulated));
        if loaded.is_modified() {
            let missed = missed(&file.expect, &result.metrics);
            warnings.extend(missed.into_iter().map(|miss| format!("[expect] missed: {miss}")));
        }
        warnings.extend(describe(&result.ending));
        Self {
            schema: SCHEMA,
            scenario: loaded.name().to_owned(),
            controller: controller_name(file.controller.kind),
            duration_s: file.simulation.duration_s,
            plant_step_s: file.simulation.plant_step_s,
            control_period_s: file.simulation.control_period_s,
            seed: file.simulation.seed,
            ended: ended(&result.ending),
            simulated_s: simulated,
            metrics: result.metrics,
            monitors: result.monitors,
            supervisor: result.supervisor.clone(),
            digest: result.digest.clone(),
            real_time_factor: simulated / wall_s,
            wall_s,
            log: log.map(|path| path.display().to_string()),
            warnings,
        }
    }

    /// The summary as one line of JSON.
    #[must_use]
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Fraction of the control periods above which limited torques are worth a warning: a start or a step may take less.
const LIMITED_WORTH_SAYING: f64 = 0.01;
/// Fraction of the samples above which a failing reaching condition is worth a warning.
const FAILED_WORTH_SAYING: f64 = 0.05;

/// What is worth saying about a run besides its numbers.
#[must_use]
pub fn warnings(result: &RunResult, speed_limit: f64) -> Vec<String> {
    let mut all = Vec::new();
    let m = &result.metrics;
    if m.max_speed_m_s > speed_limit {
        all.push(format!(
            "the base reached {:.3} m/s, beyond the {speed_limit} m/s up to which the model's assumptions hold",
            m.max_speed_m_s
        ));
    }
    if let Some(t) = result.joint_limit_crossed_at {
        let times = m.joint_limit_crossings.max(1);
        all.push(format!("a joint was outside its limits, first at t = {t:.3} s, {times} time(s) in all"));
    }
    all.extend(result.supervisor.as_ref().and_then(supervised));
    if let Some(monitors) = &result.monitors {
        let told = [
            ("the outer loop limited its speed", monitors.speed_limited),
            ("the outer loop held a joint back from its limit", monitors.joint_limited),
            ("the arm was near a singularity", monitors.near_singular),
        ];
        all.extend(told.into_iter().filter_map(|(what, lasting)| during(what, lasting)));
        if monitors.torque_limited.fraction > LIMITED_WORTH_SAYING {
            all.extend(during("a torque was limited", monitors.torque_limited));
        }
        if let Some(failed) = monitors.reaching_failed_fraction
            && failed > FAILED_WORTH_SAYING
        {
            all.push(format!("the reaching condition failed at {:.1} % of the samples", 100.0 * failed));
        }
    }
    all
}

/// Names of findings.
fn found(findings: Findings) -> String {
    let names = Findings::ALL.into_iter().filter(|(finding, _)| findings.contains(*finding));
    let names: Vec<_> = names.map(|(_, name)| name).collect();
    if names.is_empty() { "not at rest in time".to_owned() } else { names.join(", ") }
}

/// What a supervisor did, in words; none if it had nothing to do.
fn supervised(report: &SupervisorReport) -> Option<String> {
    let first = report.findings.iter().min_by(|a, b| a.first_s.total_cmp(&b.first_s))?;
    let stops = report.first_stop_s.map_or_else(String::new, |t| {
        format!(
            ", stopped it {} time(s), first at t = {t:.3} s, for {} updates",
            report.stops, report.stopped_periods
        )
    });
    let names: Vec<_> =
        report.findings.iter().map(|found| format!("{} {}", found.periods, found.finding)).collect();
    Some(format!(
        "the supervisor found {}, first {} at t = {:.3} s; it held the torque for {} updates{stops}",
        names.join(", "),
        first.finding,
        first.first_s,
        report.held_periods
    ))
}

/// What was so in some part of the run, in words; none if it never was.
fn during(what: &str, Lasting { fraction, first_s }: Lasting) -> Option<String> {
    let percent = 100.0 * fraction;
    let part = if percent < 0.1 { "less than 0.1".to_owned() } else { format!("{percent:.1}") };
    first_s.map(|t| format!("{what} in {part} % of the run, first at t = {t:.3} s"))
}

/// How a run ended, in a word.
#[must_use]
pub fn ended(ending: &Ending) -> &'static str {
    Outcome::from(ending).as_str()
}

/// How a run ended, unless it finished.
#[must_use]
pub fn describe(ending: &Ending) -> Option<String> {
    match ending {
        Ending::Finished => None,
        Ending::Stopped { t } => Some(format!("interrupted at t = {t:.3} s")),
        Ending::Diverged { t, state, value } => {
            let value = if value.abs() < 1e5 { format!("{value:.3}") } else { format!("{value:.3e}") };
            Some(format!("diverged at t = {t:.3} s: {state} was {value}"))
        }
        Ending::Faulted { t, findings } => Some(format!(
            "the supervisor gave up at t = {t:.3} s ({}); the simulated robot has no brakes",
            found(*findings)
        )),
        Ending::Refused { t, error } => {
            Some(format!("the controller refused its input at t = {t:.3} s: {error}"))
        }
    }
}

/// The entries of `[expect]` that the metrics miss, in words.
#[must_use]
pub fn missed(expect: &Expect, m: &Metrics) -> Vec<String> {
    let mut checks: Vec<(String, Option<Bounds>, Option<f64>)> = Vec::new();
    let axes = [
        ("itae_m_s2", &expect.itae_m_s2, m.itae_m_s2),
        ("iae_m_s", &expect.iae_m_s, m.iae_m_s),
        ("ise_m2_s", &expect.ise_m2_s, m.ise_m2_s),
    ];
    let mut add = |key: String, bounds: Option<Bounds>, value: Option<f64>| checks.push((key, bounds, value));
    for (key, bounds, value) in axes {
        add(format!("{key}.x"), bounds.x, Some(value.x));
        add(format!("{key}.y"), bounds.y, Some(value.y));
        add(format!("{key}.z"), bounds.z, Some(value.z));
        add(format!("{key}.sum"), bounds.sum, Some(value.sum));
    }
    add("rmse_m.x".into(), expect.rmse_m.x, Some(m.rmse_m.x));
    add("rmse_m.y".into(), expect.rmse_m.y, Some(m.rmse_m.y));
    add("rmse_m.z".into(), expect.rmse_m.z, Some(m.rmse_m.z));
    add("rmse_m.norm".into(), expect.rmse_m.norm, Some(m.rmse_m.norm));
    let (tv, peak) = (&m.torque_tv_n_m_per_s, &m.peak_torque_n_m);
    add("torque_tv_n_m_per_s.right".into(), expect.torque_tv_n_m_per_s.right, Some(tv.right));
    add("torque_tv_n_m_per_s.left".into(), expect.torque_tv_n_m_per_s.left, Some(tv.left));
    add("torque_tv_n_m_per_s.sum".into(), expect.torque_tv_n_m_per_s.sum, Some(tv.sum));
    add("peak_torque_n_m.right".into(), expect.peak_torque_n_m.right, Some(peak.right));
    add("peak_torque_n_m.left".into(), expect.peak_torque_n_m.left, Some(peak.left));
    let lists = [
        ("torque_tv_n_m_per_s.joints", &expect.torque_tv_n_m_per_s.joints, tv.joints.as_slice()),
        ("peak_torque_n_m.joints", &expect.peak_torque_n_m.joints, peak.joints.as_slice()),
    ];
    for (key, bounds, values) in lists {
        for (i, (bounds, value)) in bounds.iter().zip(values).enumerate() {
            add(format!("{key}.{i}"), Some(*bounds), Some(*value));
        }
    }
    for (i, (bounds, value)) in expect.sliding_band.iter().zip(m.sliding_band).enumerate() {
        add(format!("sliding_band.{i}"), Some(*bounds), value);
    }
    add("max_error_m".into(), expect.max_error_m, Some(m.max_error_m));
    add("settling_time_s".into(), expect.settling_time_s, m.settling_time_s);
    add("effort_n2_m2_s".into(), expect.effort_n2_m2_s, Some(m.effort_n2_m2_s));
    add("energy_j".into(), expect.energy_j, Some(m.energy_j));
    add("saturated_fraction".into(), expect.saturated_fraction, Some(m.saturated_fraction));
    add("max_speed_m_s".into(), expect.max_speed_m_s, Some(m.max_speed_m_s));
    add("min_manipulability".into(), expect.min_manipulability, Some(m.min_manipulability));
    #[expect(clippy::cast_precision_loss, reason = "a count of crossings is far below 2^53")]
    let crossings = m.joint_limit_crossings as f64;
    add("joint_limit_crossings".into(), expect.joint_limit_crossings, Some(crossings));
    let mut misses: Vec<String> =
        checks.into_iter().filter_map(|(key, bounds, value)| miss(&key, bounds?, value)).collect();
    if let Some(wanted) = expect.reaching_condition_met
        && m.reaching_condition_met != Some(wanted)
    {
        let got = m.reaching_condition_met.map_or("not defined".to_owned(), |met| met.to_string());
        misses.push(format!("reaching_condition_met is {got}, expected {wanted}"));
    }
    misses
}

/// How a value misses its bounds, if it does; an undefined value misses any bound.
fn miss(key: &str, bounds: Bounds, value: Option<f64>) -> Option<String> {
    let Some(value) = value else {
        return Some(format!("{key} is not defined, expected {}", in_words(bounds)));
    };
    let above = bounds.min.is_none_or(|min| value >= min);
    let below = bounds.max.is_none_or(|max| value <= max);
    (!(above && below)).then(|| format!("{key} is {value}, expected {}", in_words(bounds)))
}

fn in_words(bounds: Bounds) -> String {
    match (bounds.min, bounds.max) {
        (Some(min), Some(max)) => format!("from {min} to {max}"),
        (Some(min), None) => format!("at least {min}"),
        (None, Some(max)) => format!("at most {max}"),
        (None, None) => "a value".to_owned(),
    }
}
