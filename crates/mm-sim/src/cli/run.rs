//! `mmsim run`: one scenario, one controller.

use std::error::Error;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use super::recorder::RunRecorder;
use super::{Common, Exit, RunArgs, complain, interrupt, print, table};
use crate::experiment::Experiment;
use crate::live::{self, Live, LiveError};
use crate::log::{LogError, Outcome, RunLog};
use crate::scenario::{self, Loaded};
use crate::simulation::RunResult;
use crate::summary::{self, Summary};

/// Runs the scenario that the arguments name.
pub(super) fn run(args: &RunArgs) -> Result<Exit, clap::Error> {
    let common = &args.common;
    let spec = common.scenario()?;
    if common.json {
        common.refuse_stdout("leaves no room for --json")?;
    }
    if std::io::stdout().is_terminal() {
        common.refuse_stdout("would write a binary log to the terminal")?;
    }
    let sets = common.sets(args.controller.as_deref());
    let prepared = match prepare(spec, &sets) {
        Ok(prepared) => prepared,
        Err(exit) => return Ok(exit),
    };
    let path = (!common.no_log).then(|| log_path(&common.out, prepared.0.name()));
    let live = match args.live.then(|| serve(&prepared, args)).transpose() {
        Ok(live) => live,
        Err(exit) => return Ok(exit),
    };
    let show_progress = !(common.quiet || common.json);
    let run = |recorder: &mut RunRecorder| {
        if let Some(live) = live {
            live.wait_for_viewer(interrupt::asked);
            recorder.serve(live);
        }
        prepared.1.run(recorder)
    };
    let (ran, mut exit) = match execute_with(&prepared, path, show_progress, run) {
        Ok(ran) => {
            let exit = ran.exit;
            (ran, exit)
        }
        Err(exit) => return Ok(exit),
    };
    let summary = &ran.summary;
    let (loaded, _) = &prepared;
    if exit == Exit::Done && !loaded.is_modified() && !ran.retuned {
        let missed = summary::missed(&loaded.file.expect, &summary.metrics);
        for miss in &missed {
            complain(&format_args!("error: {}: [expect] missed: {miss}", loaded.source_name()));
        }
        if !missed.is_empty() {
            exit = Exit::Missed;
        }
    }
    Ok(exit.max(report(common, &ran, exit)))
}

/// Serves a run, which waits for its first viewer.
fn serve((loaded, experiment): &(Loaded, Experiment), args: &RunArgs) -> Result<Live, Exit> {
    let options = live::Options { address: args.live_address, speed: args.live_speed };
    let live = Live::start((loaded, experiment), options).map_err(|error| {
        complain(&format_args!("error: {}", with_causes(&error)));
        if matches!(error, LiveError::Server { .. }) { Exit::Failed } else { Exit::Usage }
    })?;
    interrupt::install();
    complain(&format_args!("waiting for a viewer at {} (Ctrl-C ends)", live.url()));
    Ok(live)
}

/// Prints the summary in the form asked for.
fn report(common: &Common, Ran { summary, error, .. }: &Ran, exit: Exit) -> Exit {
    complain_of(summary, exit, "");
    let table = || table::single(summary, error.as_deref());
    if common.json {
        print(&summary.to_json())
    } else if common.quiet {
        Exit::Done
    } else if common.logs_to_stdout() {
        complain(&table());
        Exit::Done
    } else {
        print(&table())
    }
}

/// Prints the warnings of a run; how it failed, the last of them, was said as an error already.
pub(super) fn complain_of(summary: &Summary, exit: Exit, prefix: &str) {
    let said = usize::from(exit == Exit::Failed);
    let count = summary.warnings.len().saturating_sub(said);
    for warning in summary.warnings.iter().take(count) {
        complain(&format_args!("warning: {prefix}{warning}"));
    }
}

/// Loads and builds a scenario; complains of what is wrong with it.
pub(super) fn prepare(spec: &str, sets: &[String]) -> Result<(Loaded, Experiment), Exit> {
    let refuse = |error: scenario::ScenarioError| {
        complain(&error);
        Exit::Usage
    };
    let loaded = scenario::load(spec, sets).map_err(refuse)?;
    let experiment = Experiment::build(&loaded).map_err(refuse)?;
    Ok((loaded, experiment))
}

/// An error and what caused it: an error does not repeat its source.
pub(super) fn with_causes(error: &dyn Error) -> String {
    let causes = core::iter::successors(error.source(), |&cause| cause.source());
    causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}

/// Path of a log in a folder; that of standard output stays as it is.
pub(super) fn log_path(out: &Path, name: &str) -> PathBuf {
    if out == RunLog::STDOUT { out.to_owned() } else { out.join(format!("{name}.mcap")) }
}

/// What a run left.
pub(super) struct Ran {
    pub(super) summary: Summary,
    pub(super) exit: Exit,
    /// Its error over time, as a line of text.
    pub(super) error: Option<String>,
    /// Whether somebody changed its gains on the way.
    pub(super) retuned: bool,
}

/// Runs a built scenario; the log, if there is one, is finished however the run ends.
pub(super) fn execute(
    prepared: &(Loaded, Experiment),
    log: Option<PathBuf>,
    show_progress: bool,
) -> Result<Ran, Exit> {
    execute_with(prepared, log, show_progress, |recorder| prepared.1.run(recorder))
}

/// The same for a caller that runs it in its own way.
pub(super) fn execute_with(
    (loaded, experiment): &(Loaded, Experiment),
    log: Option<PathBuf>,
    show_progress: bool,
    run: impl FnOnce(&mut RunRecorder) -> Result<RunResult, LogError>,
) -> Result<Ran, Exit> {
    let fail = |error: &LogError| {
        if error.is_broken_pipe() {
            return Exit::Done; // whoever reads the log has enough of it
        }
        complain(&format_args!("error: {}", with_causes(error)));
        Exit::Failed
    };
    if let Some(folder) = log.as_deref().and_then(Path::parent) {
        std::fs::create_dir_all(folder).map_err(|error| {
            complain(&format_args!("error: cannot make the folder {}: {error}", folder.display()));
            Exit::Failed
        })?;
    }
    let mut recorder =
        RunRecorder::open(loaded, experiment, log.as_deref(), show_progress).map_err(|error| fail(&error))?;
    let ran = run(&mut recorder);
    let wall_s = recorder.elapsed_s();
    recorder.clear();
    let result = ran.map_err(|error| fail(&error))?;

    let mut summary = Summary::of((loaded, experiment), &result, wall_s, log.as_deref());
    let changes = recorder.changes().iter().map(|change| format!("changed by a viewer: {change}"));
    summary.warnings.splice(0..0, changes);
    let retuned = !recorder.changes().is_empty();
    let ended = summary::describe(&result.ending);
    let outcome = Outcome::from(&result.ending);
    let error = recorder.error();
    let exit = if outcome == Outcome::Finished { Exit::Done } else { Exit::Failed };
    recorder.finish(outcome, &summary.to_json(), &summary.digest).map_err(|error| fail(&error))?;
    if let Some(text) = ended {
        complain(&format_args!("error: {}: {text}", loaded.source_name()));
        if let Some(path) = &summary.log {
            complain(&format_args!("the log up to there is {path}"));
        }
    }
    Ok(Ran { summary, exit, error, retuned })
}
