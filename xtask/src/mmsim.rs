//! The mmsim command as a user has it: built once, then run with `--json`.

use std::path::PathBuf;
use std::process::{Command, Output};

use anyhow::{Context, Result};
use serde_json::Value;

use crate::shell::{cargo, command, run, target_directory};

/// How the command is built.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Profile {
    /// What a user gets.
    Release,
    /// What the tests have built already.
    TestRelease,
}

/// The command.
pub(crate) struct Mmsim(PathBuf);

/// The end of one run.
pub(crate) struct Outcome {
    /// Exit code; none if it was killed.
    pub(crate) code: Option<i32>,
    /// The summary, if there is one.
    pub(crate) summary: Option<Value>,
    /// What it said besides.
    pub(crate) messages: String,
}

impl Mmsim {
    /// The command at a path, or the one of this workspace, built now.
    pub(crate) fn find(path: Option<String>, profile: Profile) -> Result<Self> {
        if let Some(path) = path {
            return Ok(Self(std::path::absolute(path)?));
        }
        let (name, build) = match profile {
            Profile::Release => ("release", ["build", "--workspace", "--bin=mmsim"].as_slice()),
            // With a test of it, since features and with them all objects are then those of the test steps.
            Profile::TestRelease => {
                ("testrelease", ["test", "--workspace", "--no-run", "--test=plant_variation"].as_slice())
            }
        };
        run(cargo(build).args(["--locked", "--profile", name]))?;
        Ok(Self(target_directory()?.join(name).join("mmsim")))
    }

    /// Runs one scenario without a log.
    pub(crate) fn simulate(&self, scenario: &str, more: &[String]) -> Result<Outcome> {
        let mut command = self.command();
        command.args(["run", "--scenario", scenario, "--no-log", "--json"]).args(more);
        let output = command.output().with_context(|| format!("cannot start {}", self.0.display()))?;
        let Output { status, stdout, stderr } = output;
        Ok(Outcome {
            code: status.code(),
            summary: serde_json::from_slice(&stdout).ok(),
            messages: String::from_utf8_lossy(&stderr).into_owned(),
        })
    }

    /// What a run with any arguments gives.
    pub(crate) fn output(&self, arguments: &[&str]) -> Result<Output> {
        let output = self.command().args(arguments).output();
        output.with_context(|| format!("cannot start {}", self.0.display()))
    }

    /// A run that is to be started, with any arguments.
    pub(crate) fn with(&self, arguments: &[&str]) -> Command {
        let mut command = self.command();
        command.args(arguments);
        command
    }

    /// Runs it with any arguments; it has to end well.
    pub(crate) fn succeed(&self, arguments: &[&str]) -> Result<()> {
        run(self.command().args(arguments))
    }

    fn command(&self) -> Command {
        command(&self.0)
    }
}

impl Outcome {
    /// A number of the summary, by its dotted name.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        name.split('.').try_fold(self.summary.as_ref()?, |value, key| value.get(key))?.as_f64()
    }

    /// What the exit code means.
    pub(crate) fn verdict(&self) -> String {
        match (self.code, &self.summary) {
            (Some(0), Some(_)) => "ok".to_owned(),
            (Some(0), None) => "no summary".to_owned(),
            (Some(1), _) => "run failed".to_owned(),
            (Some(2), _) => "bad input".to_owned(),
            (Some(3), _) => "[expect] missed".to_owned(),
            (Some(code), _) => format!("exit code {code}"),
            (None, _) => "killed".to_owned(),
        }
    }

    /// Whether everything went as it should.
    pub(crate) fn is_good(&self) -> bool {
        self.code == Some(0) && self.summary.is_some()
    }
}
