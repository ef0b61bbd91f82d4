//! Compares the fuzzy engine with engines from PyPI: `tests/fuzzy_peers`, run in a virtual environment of its own.

use std::path::PathBuf;

use anyhow::Result;

use crate::python::environment;
use crate::shell::{cargo, command, root, run, target_directory, watch};

/// Where the tests and the list of their packages are, from the root of the workspace.
const TESTS: &str = "tests/fuzzy_peers";

/// The environment with the other engines; its Python.
pub(crate) fn prepare() -> Result<PathBuf> {
    environment(&target_directory()?.join("fuzzy-peers"), &root().join(TESTS).join("requirements.txt"))
}

/// Builds our side, makes the environment if the list of packages has changed, and runs the tests; `see` gets each line they print.
pub(crate) fn check(see: impl FnMut(&str)) -> Result<()> {
    let target = target_directory()?;
    // Of the whole workspace, so that features and with them all objects are those of the test steps.
    let build = ["build", "--workspace", "--locked", "--example", "evaluate", "--profile", "testrelease"];
    run(&mut cargo(&build))?;
    let python = prepare()?;
    let mut tests = command(python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", TESTS]);
    tests.env("FUZZY_EVALUATE", target.join("testrelease/examples/evaluate"));
    tests.env("PYTHONDONTWRITEBYTECODE", "1");
    watch(&mut tests, see)
}
