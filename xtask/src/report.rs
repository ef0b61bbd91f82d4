//! Opens reports in a browser without a window: `tests/report`, run in a virtual environment of its own, with Debian's Chromium.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::mmsim::Mmsim;
use crate::python::environment;
use crate::shell::{command, root, target_directory, watch};
use crate::tools::{CHROMIUM, require};

/// Where the tests and the list of their packages are, from the root of the workspace.
const TESTS: &str = "tests/report";

/// A scenario whose name and text would be elements, if they were not text.
const HOSTILE: &str = "# </script></pre><script>alert(3)</script>\n\
    name = '<script>alert(1)<!--<img src=x onerror=alert(2)>'\n\
    [simulation]\nduration_s = 0.5\n[trajectory]\nkind = \"square\"\n";

/// The environment of the tests; its Python.
pub(crate) fn prepare() -> Result<PathBuf> {
    environment(&target_directory()?.join("report-python"), &root().join(TESTS).join("requirements.txt"))
}

/// Makes the reports and tries them; `see` gets each line that the tests print.
pub(crate) fn check(mmsim: &Mmsim, see: impl FnMut(&str)) -> Result<()> {
    require(&[CHROMIUM])?;
    let target = target_directory()?;
    let folder = target.join("report");
    make(mmsim, &folder)?;
    let python = prepare()?;
    let mut tests = command(python);
    tests.args(["-m", "pytest", "-q", "-p", "no:cacheprovider", TESTS]);
    tests.env("REPORT_FOLDER", &folder).env("PYTHONDONTWRITEBYTECODE", "1");
    watch(&mut tests, see)
}

/// The reports that the tests open: of two laws, of a hostile log, of a reproduction.
fn make(mmsim: &Mmsim, folder: &Path) -> Result<()> {
    let _ = std::fs::remove_dir_all(folder);
    std::fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    std::fs::write(folder.join("hostile.toml"), HOSTILE)?;
    let path = |name: &str| folder.join(name).display().to_string();
    let [compared, hostile, reproduction] = ["compared", "hostile", "reproduction"].map(path);
    let laws = "bsmc,bfsmc";
    mmsim.succeed(&[
        "compare",
        "--scenario",
        "square-compare",
        "--controllers",
        laws,
        "--quiet",
        "--out",
        &compared,
    ])?;
    let logs =
        laws.split(',').map(|law| path(&format!("compared/square-compare.{law}.mcap"))).collect::<Vec<_>>();
    let report: Vec<&str> = std::iter::once("report").chain(logs.iter().map(String::as_str)).collect();
    mmsim.succeed(&report)?;
    mmsim.succeed(&["--scenario", &path("hostile.toml"), "--quiet", "--out", &hostile])?;
    let logs = std::fs::read_dir(folder.join("hostile"))?;
    for log in logs {
        mmsim.succeed(&["report", &log?.path().display().to_string()])?;
    }
    mmsim.succeed(&["reproduce", "--quiet", "--out", &reproduction])
}
