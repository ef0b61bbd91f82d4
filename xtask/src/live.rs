//! Watches runs that are served: `tests/live`, with a build that has the feature `live` and Python in an environment of its own.

use std::process::ExitCode;

use anyhow::Result;

use crate::python::environment;
use crate::shell::{cargo, command, root, run as run_command, target_directory, watch};

/// Where the tests and the list of their packages are, from the root of the workspace.
const TESTS: &str = "tests/live";

/// Lints and builds the command with its server and runs the tests.
pub(crate) fn run() -> Result<ExitCode> {
    let target = target_directory()?;
    // Apart from the other builds: a hundred crates that these do without.
    let folder = target.join("live");
    let features = ["--package=mm-sim", "--features=live", "--locked", "--target-dir"];
    let mut clippy = cargo(&["clippy", "--all-targets"]);
    run_command(clippy.args(features).arg(&folder).args(["--", "-D", "warnings"]))?;
    run_command(cargo(&["build", "--bin=mmsim"]).args(features).arg(&folder))?;
    let python = environment(&target.join("live-python"), &root().join(TESTS).join("requirements.txt"))?;
    let mut tests = command(python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", TESTS]);
    tests.env("MMSIM", folder.join("debug/mmsim")).env("PYTHONDONTWRITEBYTECODE", "1");
    watch(&mut tests, |_| ())?;
    Ok(ExitCode::SUCCESS)
}
