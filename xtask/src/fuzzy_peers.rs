//! Compares the fuzzy engine with engines from PyPI: `tests/fuzzy_peers`, run in a virtual environment of its own.

use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result};

use crate::shell::{answers, cargo, command, install, root, run, target_directory, watch};

/// Where the tests and the list of their packages are, from the root of the workspace.
const TESTS: &str = "tests/fuzzy_peers";

/// Debian's packages for a virtual environment.
const PACKAGES: [&str; 2] = ["python3", "python3-venv"];

/// Builds our side, makes the environment if the list of packages has changed, and runs the tests; `see` gets each line they print.
pub(crate) fn check(see: impl FnMut(&str)) -> Result<()> {
    let target = target_directory()?;
    // Of the whole workspace, so that features and with them all objects are those of the test steps.
    let build = ["build", "--workspace", "--locked", "--example", "evaluate", "--profile", "testrelease"];
    run(&mut cargo(&build))?;
    let python = environment(&target.join("fuzzy-peers"))?;
    let mut tests = command(python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", TESTS]);
    tests.env("FUZZY_EVALUATE", target.join("testrelease/examples/evaluate"));
    tests.env("PYTHONDONTWRITEBYTECODE", "1");
    watch(&mut tests, see)
}

/// The Python of a virtual environment with the listed packages; a copy of the list in it says that it is complete.
fn environment(directory: &Path) -> Result<PathBuf> {
    let python = directory.join("bin/python");
    let list = root().join(TESTS).join("requirements.txt");
    let wanted = std::fs::read_to_string(&list).with_context(|| format!("cannot read {}", list.display()))?;
    let stamp = directory.join("requirements.txt");
    let is_complete = std::fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted)
        && python.to_str().is_some_and(|python| answers(python, &["--version"]));
    if is_complete {
        return Ok(python);
    }
    let create = || -> Command {
        let mut create = command("python3");
        create.args(["-m", "venv", "--clear"]).arg(directory);
        create
    };
    if run(&mut create()).is_err() {
        install(&PACKAGES)?;
        run(&mut create())?;
    }
    let mut pip = command(&python);
    pip.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
        "--only-binary=:all:",
        "--no-deps",
    ]);
    run(pip.arg("--requirement").arg(&list))
        .context("cannot install the engines to compare with from PyPI: is the network there?")?;
    std::fs::write(&stamp, wanted)?;
    Ok(python)
}
