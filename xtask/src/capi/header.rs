//! `mm_control.h`, written by cbindgen from the sources of `crates/mm-capi`.

use std::fs;

use anyhow::{Context, Result, anyhow, ensure};

use crate::shell::{relative, root};

/// Structs that exist in both precisions.
const TWINS: [&str; 19] = [
    "Robot",
    "Link",
    "Friction",
    "Outer",
    "Gains",
    "Estimator",
    "Supervisor",
    "Params",
    "Configuration",
    "Velocity",
    "Force",
    "Torque",
    "Reference",
    "Input",
    "Measurement",
    "Timing",
    "Output",
    "Command",
    "Signals",
];

/// Where the header is, from the root.
pub(super) const DIRECTORY: &str = "crates/mm-capi/include";

/// Compares the header with the sources, or writes it where `bless` says so.
pub(super) fn check(bless: bool) -> Result<()> {
    let path = root().join(DIRECTORY).join("mm_control.h");
    let text = generated()?;
    if bless {
        return fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()));
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    let differs = kept.lines().zip(text.lines()).position(|(kept, new)| kept != new);
    let line = differs.unwrap_or_else(|| kept.lines().count().min(text.lines().count())) + 1;
    ensure!(
        kept == text,
        "{}:{line}: not what the sources of mm-capi make; `cargo xtask capi --bless` writes it anew",
        relative(&path)
    );
    Ok(())
}

/// The header of the sources.
fn generated() -> Result<String> {
    let package = root().join("crates/mm-capi");
    let config = package.join("cbindgen.toml");
    let mut config =
        cbindgen::Config::from_file(config).map_err(|error| anyhow!("cbindgen.toml: {error}"))?;
    for name in TWINS {
        let lower = name.to_lowercase();
        config.export.rename.insert(format!("{name}_f64"), format!("mm_{lower}"));
        config.export.rename.insert(format!("{name}_f32"), format!("mmf_{lower}"));
    }
    let builder = cbindgen::Builder::new().with_config(config).with_src(package.join("src/lib.rs"));
    let mut bytes = Vec::new();
    builder.generate().context("cbindgen")?.write(&mut bytes);
    let mut text = String::from_utf8(bytes)?.replace("\n\n\n", "\n\n").trim_start().to_owned();
    for name in ["status", "law", "fuzzy_engine", "estimator_kind", "mode"] {
        let alias = format!("typedef int32_t mm_{name};");
        text = text.replace(&alias, &format!("{alias} /**< A number of enum mm_{name}. */"));
    }
    ensure!(
        !text.contains("_f64") && !text.contains("_f32"),
        "a struct without a name for C: add it to TWINS"
    );
    Ok(text)
}
