//! Virtual environments with packages from PyPI.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result};

use crate::shell::{answers, command, install, run};

/// Debian's packages for a virtual environment.
const PACKAGES: [&str; 2] = ["python3", "python3-venv"];

/// Held while an environment is made: who asks for one that is being made ahead waits for it.
static MAKING: Mutex<()> = Mutex::new(());

/// The Python of a virtual environment with the packages of a list; a copy of the list in it says that it is complete.
pub(crate) fn environment(directory: &Path, list: &Path) -> Result<PathBuf> {
    let _making = MAKING.lock().unwrap_or_else(PoisonError::into_inner);
    let python = directory.join("bin/python");
    let wanted = std::fs::read_to_string(list).with_context(|| format!("cannot read {}", list.display()))?;
    let stamp = directory.join("requirements.txt");
    let is_complete = std::fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted)
        && python.to_str().is_some_and(|python| answers(python, &["--version"]));
    if is_complete {
        return Ok(python);
    }
    create(directory)?;
    let mut pip = pip(&python);
    run(pip.args(["--no-deps", "--requirement"]).arg(list))
        .context("cannot install packages from PyPI: is the network there?")?;
    std::fs::write(&stamp, wanted)?;
    Ok(python)
}

/// An empty virtual environment; its Python.
pub(crate) fn create(directory: &Path) -> Result<PathBuf> {
    let create = || -> Command {
        let mut create = command("python3");
        create.args(["-m", "venv", "--clear"]).arg(directory);
        create
    };
    if run(&mut create()).is_err() {
        install(&PACKAGES)?;
        run(&mut create())?;
    }
    Ok(directory.join("bin/python"))
}

/// An installation of packages that are built already.
pub(crate) fn pip(python: &Path) -> Command {
    let mut pip = command(python);
    pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--only-binary=:all:"]);
    pip
}
