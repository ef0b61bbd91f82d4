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
mod files;
mod fuzzy;
mod gains;
mod include;
pub(crate) mod nearest;
mod robot_toml;
mod rules;
mod schema;
mod snapshot;
mod starter;
mod tree;
mod types;
mod waypoints;

use std::path::{Path, PathBuf};

use diagnostic::Source;
use files::{Files, included, linked};
use tree::{Node, Value};

pub use bundled::bundled;
pub use diagnostic::{Problem, ScenarioError};
pub use docs::markdown;
pub use robot_toml::{robot_file_toml, robot_toml};
pub use schema::schema;
pub use snapshot::Snapshot;
pub use starter::starter;
pub use types::{
    Actuators, AxesAndNorm, AxesAndSum, Bounds, Controller, ControllerKind, Disturbance, DisturbanceTarget,
    Estimator, EstimatorKind, Expect, Fault, FaultKind, FaultTarget, Friction, FuzzyEngine, Gains, GainsFor,
    Include, Initial, Integrator, Link, Misprints, Motion, Motor, Motors, Outer, Peaks, PerAxis, PerChannel,
    Plant, PlantScale, PoseSource, Preset, Robot, RobotFields, ScenarioFile, Segment, Sensors, Shape,
    Simulation, Supervisor, Sweep, TipStart, Totals, Trajectory, Tune, WaypointPath,
};

/// The name that an argument of the command line has in messages.
const SET_NAME: &str = "--set";

/// A scenario that was read and checked, with the texts it came from.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// The scenario.
    pub file: ScenarioFile,
    /// The fuzzy system that `controller.fis` names.
    pub fis: Option<mm_fis::System>,
    sources: Vec<Source>,
    root: Node,
    folder: PathBuf,
    sets: Vec<String>,
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

    /// Returns the gains that came from the file that `controller.gains_file` names, by key, as TOML.
    pub(crate) fn gains_of_file(&self) -> Vec<(&str, String)> {
        let is_file = |node: &Node| {
            let of = self.sources.get(node.place.source);
            of.is_some_and(|source| !source.is_own())
        };
        let gains = self.root.find("controller.gains").and_then(Node::as_table);
        gains
            .into_iter()
            .flatten()
            .filter(|(_, entry)| is_file(&entry.node))
            .map(|(key, entry)| (key.as_str(), inline(&entry.node)))
            .collect()
    }

    /// Returns the files that the scenario names, such as a robot or waypoints: each as it was found, and its text.
    pub fn files(&self) -> impl Iterator<Item = (&str, &str)> {
        let named = self.sources.iter().skip(1).filter(|source| source.name != SET_NAME);
        named.map(|source| (source.name.as_str(), source.text.as_str()))
    }

    /// Returns the scenario file as it was given.
    #[must_use]
    pub fn source_name(&self) -> &str {
        self.sources.first().map_or("", |source| &source.name)
    }

    /// Whether any edit was laid over the file.
    #[must_use]
    pub const fn is_modified(&self) -> bool {
        !self.sets.is_empty()
    }

    /// Returns a digest, XXH3-128 in hexadecimal digits, of every text that the scenario is made of: its file, the edits, the
    /// files that it names.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut hash = xxhash_rust::xxh3::Xxh3::new();
        for Source { text, .. } in &self.sources {
            hash.update(&(text.len() as u64).to_le_bytes());
            hash.update(text.as_bytes());
        }
        format!("{:032x}", hash.digest128())
    }

    /// Returns the same scenario with more edits laid over it, as if they had been given to [`load`] after the others.
    ///
    /// Files that the scenario names are not read again, whatever has become of them; those that the edits name are.
    ///
    /// # Errors
    ///
    /// As [`load`].
    pub fn edited(&self, more: &[String]) -> Result<Self, ScenarioError> {
        let sets = [self.sets.as_slice(), more].concat();
        let files = Files { folder: &self.folder, known: &self.sources, settled: self.sets.len() };
        assemble((self.source_name(), self.text()), &files, &sets)
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
        let text = read(path, spec)?;
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_path_buf);
        return assemble((spec, &text), &Files::of(&folder), sets);
    }
    let is_bare = path.file_name().is_some_and(|name| name == spec);
    if is_bare && let Some(text) = bundled::find(spec) {
        return assemble((spec, text), &Files::of(Path::new("")), sets);
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
    assemble((name, text), &Files::of(Path::new("")), sets)
}

/// The text of the scenario file.
fn read(path: &Path, name: &str) -> Result<String, ScenarioError> {
    let bytes = std::fs::read(path).map_err(|error| {
        let problem = Problem::without_place(format!("cannot read scenario `{name}`: {error}"));
        ScenarioError::new(&[], vec![problem])
    })?;
    String::from_utf8(bytes).map_err(|error| {
        // What is no character is shown as one of three bytes.
        let start = error.utf8_error().valid_up_to();
        let place = tree::Place { source: 0, span: start..start + char::REPLACEMENT_CHARACTER.len_utf8() };
        let source = Source::new(name, String::from_utf8_lossy(error.as_bytes()));
        ScenarioError::new(&[source], vec![Problem::new("", "not UTF-8", place).expected("a TOML text")])
    })
}

/// Parses, edits, checks and converts.
fn assemble((name, text): (&str, &str), files: &Files<'_>, sets: &[String]) -> Result<Loaded, ScenarioError> {
    let mut sources = vec![Source::new(name, text).within(files.folder)];
    let mut root = parse(&sources, 0, &schema::SCENARIO)?;
    let mut problems = Vec::new();
    sources.extend(sets.iter().map(|argument| Source::new(SET_NAME, argument)));
    include::resolve(&mut root, &mut sources, files, &mut problems)?;
    for (index, argument) in sets.iter().enumerate() {
        if let Err(problem) = tree::set(&mut root, index + 1, argument) {
            problems.push(*problem);
        }
    }
    include::refuse_edit(&root, &mut problems);
    problems.extend(check::check(&sources, &schema::SCENARIO, &root));
    problems.extend(rules::check(&root));
    files::robot(&mut root, &mut sources, files, &mut problems)?;
    waypoints::file(&mut root, &mut sources, files, &mut problems)?;
    gains::resolve(&mut root, &mut sources, files, &mut problems)?;
    let fis = fuzzy::file(&root, &mut sources, files, &mut problems);
    if !problems.is_empty() {
        return Err(ScenarioError::new(&sources, problems));
    }
    let file = serde_json::from_value(root.to_json()).map_err(|error| {
        let problem = Problem::new("", error.to_string(), root.place.clone());
        ScenarioError::new(&sources, vec![problem])
    })?;
    Ok(Loaded { file, fis, sources, root, folder: files.folder.to_path_buf(), sets: sets.to_vec() })
}

/// Parses one of the texts; where it is no TOML, what stands before is checked as well, but for keys that may follow.
fn parse(sources: &[Source], index: usize, schema: &serde_json::Value) -> Result<Node, ScenarioError> {
    let text = sources.get(index).map_or("", |source| &source.text);
    let (root, mut errors) = tree::parse(index, text);
    // Of a line that went wrong, the first error says why.
    errors.sort_by_key(|(_, span)| span.start);
    let mut next_line = 0;
    errors.retain(|(_, span)| {
        let is_first = span.start >= next_line;
        if is_first {
            let end = text.as_bytes().iter().skip(span.start).position(|&byte| byte == b'\n');
            next_line = end.map_or(usize::MAX, |end| span.start + end + 1);
        }
        is_first
    });
    let Some(first) = errors.first().map(|(_, span)| span.start) else { return Ok(root) };
    let line_start = text.as_bytes().iter().take(first).rposition(|&byte| byte == b'\n').unwrap_or(0);
    let mut problems = check::check(sources, schema, &root);
    problems.retain(|problem| problem.is_before(index, line_start) && problem.message() != check::MISSING);
    problems.extend(errors.into_iter().map(|(message, span)| {
        Problem::new("", format!("not TOML: {message}"), tree::Place { source: index, span })
            .expected("valid TOML")
    }));
    Err(ScenarioError::new(sources, problems))
}

/// A gain as TOML on one line.
fn inline(node: &Node) -> String {
    let Value::Table(table) = &node.value else {
        // Numbers, flags and lists of them are the same in JSON and TOML.
        return node.to_json().to_string();
    };
    let entries: Vec<_> =
        table.iter().map(|(key, entry)| format!("{key} = {}", inline(&entry.node))).collect();
    format!("{{{}}}", entries.join(", "))
}
