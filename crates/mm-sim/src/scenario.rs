//! Scenario files: reading, checking and describing them.
//!
//! A scenario is a TOML file that says what to simulate. [`load`] reads one, lays `--set KEY=VALUE` edits
//! over it, checks everything at once and returns plain data, [`ScenarioFile`], in which optional keys are
//! still optional: building the checked robot, reference and controller from it is the caller's, who reports
//! what it finds with [`Loaded::problem`], so that every message points at a place in the file.
//!
//! The types are the one source of the format: [`schema()`] and [`markdown`] are generated from them, and the
//! checker walks the same schema.

mod bundled;
mod check;
mod diagnostic;
mod docs;
mod nearest;
mod rules;
mod schema;
mod tree;
mod types;

use std::path::{Path, PathBuf};

use diagnostic::Source;
use tree::{Node, Table, Value};

pub use bundled::bundled;
pub use diagnostic::{Problem, ScenarioError};
pub use docs::markdown;
pub use schema::schema;
pub use types::{
    Actuators, AxesAndNorm, AxesAndSum, Bounds, Controller, ControllerKind, Disturbance, DisturbanceTarget,
    Estimator, EstimatorKind, Expect, Friction, Gains, Initial, Integrator, Link, Motion, Motor, Motors,
    Outer, Peaks, PerAxis, PerChannel, Plant, PoseSource, Preset, Robot, RobotFields, ScenarioFile, Segment,
    Sensors, Shape, Simulation, TipStart, Totals, Trajectory,
};

/// The name that an argument of the command line has in messages.
const SET_NAME: &str = "--set";

/// A scenario that was read and checked, with the texts it came from.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scenario.
    pub file: ScenarioFile,
    sources: Vec<Source>,
    root: Node,
    is_modified: bool,
}

impl Loaded {
    /// Returns the name of the scenario.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.file.name
    }

    /// Returns the text of the scenario file, without the edits laid over it.
    #[must_use]
    pub fn text(&self) -> &str {
        self.sources.first().map_or("", |source| &source.text)
    }

    /// Returns the scenario file as it was given.
    #[must_use]
    pub fn source_name(&self) -> &str {
        self.sources.first().map_or("", |source| &source.name)
    }

    /// Whether any edit was laid over the file.
    #[must_use]
    pub const fn is_modified(&self) -> bool {
        self.is_modified
    }

    /// Returns the error that something is wrong at a dotted key, for example `robot.link.1.mass_kg`.
    ///
    /// A key that the scenario does not give is reported at the nearest table around it.
    #[must_use]
    pub fn problem(
        &self,
        key: &str,
        message: impl Into<String>,
        expected: impl Into<String>,
    ) -> ScenarioError {
        let problem = Problem::new(key, message, self.root.place_of(key)).expected(expected);
        ScenarioError::new(&self.sources, vec![problem])
    }
}

/// Reads a scenario: an existing file or, for a name without a directory, a bundled scenario with or without
/// `.toml`; then lays the edits, each `KEY=VALUE`, over it.
///
/// # Errors
///
/// Everything that is wrong with the scenario and the edits, each with its place.
pub fn load(spec: &str, sets: &[String]) -> Result<Loaded, ScenarioError> {
    let path = Path::new(spec);
    if path.exists() && !path.is_dir() {
        let text = read(path, "scenario", spec)?;
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        return assemble(spec, &text, &folder, sets);
    }
    let is_bare = path.file_name().is_some_and(|name| name == spec);
    if is_bare && let Some(text) = bundled::find(spec) {
        return assemble(spec, text, Path::new(""), sets);
    }
    let what = match (path.is_dir(), is_bare) {
        (true, _) => "it is a folder",
        (false, true) => "no such file and no bundled scenario of that name",
        (false, false) => "no such file",
    };
    let stem = path.file_stem().and_then(std::ffi::OsStr::to_str).unwrap_or(spec);
    let problem = Problem::without_place(format!("cannot read scenario `{spec}`: {what}"))
        .expected("a file or one of the bundled scenarios: `mmsim scenario list`")
        .nearest(bundled::nearest_name(stem));
    Err(ScenarioError::new(&[], vec![problem]))
}

/// Reads a scenario from its text; `name` stands for the file in messages.
///
/// # Errors
///
/// As [`load`].
pub fn from_text(name: &str, text: &str, sets: &[String]) -> Result<Loaded, ScenarioError> {
    assemble(name, text, Path::new(""), sets)
}

/// The text of a file; what is wrong with it otherwise, with the place of the first byte that is no text.
fn read_text(path: &Path) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| {
        let good = error.as_bytes().get(..error.utf8_error().valid_up_to()).unwrap_or_default();
        let line = good.iter().filter(|&&byte| byte == b'\n').count() + 1;
        let column = good.iter().rev().take_while(|&&byte| byte != b'\n').count() + 1;
        format!("line {line}, column {column} (in bytes): not UTF-8; expected a TOML text")
    })
}

fn read(path: &Path, what: &str, name: &str) -> Result<String, ScenarioError> {
    read_text(path).map_err(|error| {
        let problem = Problem::without_place(format!("cannot read {what} `{name}`: {error}"));
        ScenarioError::new(&[], vec![problem])
    })
}

/// Parses, edits, checks and converts.
fn assemble(name: &str, text: &str, folder: &Path, sets: &[String]) -> Result<Loaded, ScenarioError> {
    let mut sources = vec![Source { name: name.to_owned(), text: text.to_owned() }];
    let mut root = parse(&sources, 0)?;
    let mut problems = Vec::new();
    for argument in sets {
        let source = sources.len();
        sources.push(Source { name: SET_NAME.to_owned(), text: argument.clone() });
        if let Err(problem) = tree::set(&mut root, source, argument) {
            problems.push(*problem);
        }
    }
    problems.extend(check::check(&sources, &schema::SCENARIO, &root));
    problems.extend(rules::check(&root));
    robot_file(&mut root, &mut sources, folder, &mut problems)?;
    if !problems.is_empty() {
        return Err(ScenarioError::new(&sources, problems));
    }
    let file = serde_json::from_value(root.to_json()).map_err(|error| {
        let problem = Problem::new("", error.to_string(), root.place.clone());
        ScenarioError::new(&sources, vec![problem])
    })?;
    Ok(Loaded { file, sources, root, is_modified: !sets.is_empty() })
}

fn parse(sources: &[Source], index: usize) -> Result<Node, ScenarioError> {
    let text = sources.get(index).map_or("", |source| &source.text);
    tree::parse(index, text).map_err(|errors| {
        let problem = |(message, span)| {
            Problem::new("", format!("not TOML: {message}"), tree::Place { source: index, span })
                .expected("valid TOML")
        };
        ScenarioError::new(sources, errors.into_iter().map(problem).collect())
    })
}

/// Reads the file that `robot.file` names and lays the scenario's own fields over it.
fn robot_file(
    root: &mut Node,
    sources: &mut Vec<Source>,
    folder: &Path,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let Some(file) = root.find("robot.file") else { return Ok(()) };
    let Some(name) = file.as_str() else { return Ok(()) };
    let is_in_scenario = file.place.source == 0;
    let path = if is_in_scenario { folder.join(name) } else { PathBuf::from(name) };
    let shown = path.display().to_string();
    let text = match read_text(&path) {
        Ok(text) => text,
        Err(error) => {
            let message = format!("cannot read `{shown}`: {error}");
            problems.push(Problem::new("robot.file", message, file.place.clone()).expected("a robot file"));
            return Ok(());
        }
    };
    let source = sources.len();
    sources.push(Source { name: shown, text });
    let mut below = parse(sources, source)?;
    let found = check::check(sources, &schema::ROBOT, &below);
    problems.extend(found);
    problems.extend(rules::check_robot(&below));
    let (Value::Table(fields), Value::Table(entries)) = (&mut below.value, &mut root.value) else {
        return Ok(());
    };
    if let Some(Value::Table(robot)) = entries.get_mut("robot").map(|entry| &mut entry.node.value) {
        let own: Table = std::mem::take(robot);
        tree::overlay(fields, own);
        *robot = std::mem::take(fields);
    }
    Ok(())
}
