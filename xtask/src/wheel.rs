//! The Python package: wheel and source distribution, and its tests in an environment of their own.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, ensure};

use crate::python::{create, environment, pip};
use crate::shell::{command, output, relative, root, run as run_command, target_directory, watch};

/// What the job was asked for.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Options {
    /// Runs the tests with the wheel.
    pub(crate) test: bool,
    /// A wheel that is quickly linked, and no source distribution.
    pub(crate) quick: bool,
}

/// Folder of the tests, with the list of what they take.
const TESTS: &str = "crates/mm-py/tests";

/// Makes the wheel, and what else is asked for.
pub(crate) fn run(options: Options) -> Result<ExitCode> {
    check(options, |_| ())?;
    Ok(ExitCode::SUCCESS)
}

/// The environment that builds and tests the package; its Python.
pub(crate) fn prepare() -> Result<PathBuf> {
    environment(&target_directory()?.join("python"), &root().join(TESTS).join("requirements.txt"))
}

/// The same; `see` gets each line that the tests print.
pub(crate) fn check(options: Options, see: impl FnMut(&str)) -> Result<()> {
    let target = target_directory()?;
    let python = prepare()?;
    let wheels = target.join("wheels");
    if wheels.exists() {
        std::fs::remove_dir_all(&wheels)?;
    }
    let mut maturin = command(python.with_file_name("maturin"));
    maturin.args(["build", "--quiet", "--locked", "--profile"]);
    maturin.arg(if options.quick { "testrelease" } else { "release" }).arg("--out").arg(&wheels);
    run_command(&mut maturin)?;
    if !options.quick {
        // Its lock file holds what the package takes of the workspace's, which is less: it is made anew.
        let mut sdist = command(python.with_file_name("maturin"));
        run_command(sdist.args(["sdist", "--out"]).arg(&wheels))?;
        from_source(&python, &wheels)?;
    }
    for file in std::fs::read_dir(&wheels)? {
        let file = file?;
        println!("{}: {} bytes", relative(&file.path()), file.metadata()?.len());
    }
    let wheel = only(&wheels, "whl")?;
    fresh(&target.join("wheel-alone"), &wheel)?;
    if options.test {
        let mut install = pip(&python);
        run_command(install.args(["--no-deps", "--force-reinstall"]).arg(&wheel))?;
        let mut tests = command(&python);
        tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", TESTS]);
        watch(tests.env("PYTHONDONTWRITEBYTECODE", "1"), see)?;
        let mut mypy = command(&python);
        mypy.args(["-m", "mypy", "--strict", "--cache-dir", "/dev/null", "crates/mm-py/python/mmsim"]);
        run_command(&mut mypy)?;
    }
    Ok(())
}

/// Builds a wheel from the source distribution, elsewhere, as pip does for a machine that no wheel is for.
fn from_source(python: &Path, wheels: &Path) -> Result<()> {
    let built = target_directory()?.join("wheels-from-source");
    // The build calls maturin by its name.
    let programs = python.parent().context("a Python without a folder")?.to_owned();
    let others = std::env::var_os("PATH").unwrap_or_default();
    let paths = std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&others)))?;
    let mut pip = command(python);
    pip.args([
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--disable-pip-version-check",
        "--no-deps",
        "--no-build-isolation",
    ]);
    run_command(pip.env("PATH", paths).arg("--wheel-dir").arg(&built).arg(only(wheels, "gz")?))
}

/// The wheel in an environment with nothing but what it asks for: the command runs, and the example of its README.
fn fresh(directory: &Path, wheel: &Path) -> Result<()> {
    let python = create(directory)?;
    run_command(pip(&python).arg(wheel))?;
    let packages = output(command(&python).args(["-m", "pip", "list", "--format=freeze"]))?;
    let others: Vec<&str> = packages
        .lines()
        .filter_map(|line| line.split("==").next())
        .filter(|name| !["pip", "setuptools", "numpy", "mmsim"].contains(name))
        .collect();
    ensure!(others.is_empty(), "the wheel brings {}", others.join(", "));
    let mut mmsim = command(python.with_file_name("mmsim"));
    mmsim.args(["--scenario", "square.toml", "--set", "simulation.duration_s=2.0", "--no-log"]);
    println!("{}", output(&mut mmsim)?);
    let readme = std::fs::read_to_string(root().join("crates/mm-py/README.md"))?;
    let example = readme.split("```").nth(1).and_then(|block| block.strip_prefix("python\n"));
    let example = example.context("no example in the README")?;
    println!("{}", output(command(&python).args(["-c", example]))?);
    Ok(())
}

/// The only file with an ending.
fn only(folder: &Path, ending: &str) -> Result<PathBuf> {
    let files = std::fs::read_dir(folder)?.map(|entry| entry.map(|entry| entry.path()));
    let files = files.collect::<std::io::Result<Vec<_>>>()?;
    let mut found = files.into_iter().filter(|path| path.extension().is_some_and(|other| other == ending));
    let first = found.next().with_context(|| format!("no .{ending} in {}", folder.display()))?;
    ensure!(found.next().is_none(), "several .{ending} in {}", folder.display());
    Ok(first)
}
