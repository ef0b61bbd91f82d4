//! The files that a scenario names: found, read, and the robot's laid under the scenario's own fields.

use std::path::{Path, PathBuf};

use super::diagnostic::{Problem, ScenarioError, Source};
use super::tree::{self, Node, Table, Value};
use super::{check, parse, rules, schema};

/// Where the files are that a scenario names.
pub(super) struct Files<'a> {
    /// Folder of the scenario file.
    pub(super) folder: &'a Path,
    /// Texts that were read before.
    pub(super) known: &'a [Source],
    /// Last of the texts, the file and its edits, that were there when they were read.
    pub(super) settled: usize,
}

impl<'a> Files<'a> {
    /// Files of which none was read before.
    pub(super) const fn of(folder: &'a Path) -> Self {
        Self { folder, known: &[], settled: 0 }
    }
}

/// Reads a file that a key names: from the folder of the file that names it or, named by an argument, from the working directory.
pub(super) fn linked(
    key: &Node,
    name: &str,
    (sources, files): (&[Source], &Files<'_>),
    format: &str,
) -> Result<Source, String> {
    let folder = sources.get(key.place.source).and_then(|source| source.folder.as_deref());
    let path = folder.map_or_else(|| PathBuf::from(name), |folder| folder.join(name));
    let shown = path.display().to_string();
    // The texts of the file and its edits come first, those of files that they name after them.
    let read_before = files.known.iter().skip(files.settled + 1).find(|source| source.name == shown);
    if let Some(source) = read_before.filter(|_| key.place.source <= files.settled || folder.is_some()) {
        return Ok(Source::new(shown, source.text.as_str()));
    }
    match read_text(&path, format) {
        Ok(text) => Ok(Source::new(shown, text)),
        Err(error) => Err(format!("cannot read `{shown}`: {error}")),
    }
}

/// Parses the TOML file that a key names, if there is one.
pub(super) fn included(
    root: &Node,
    (key, what, schema): (&str, &str, &serde_json::Value),
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Result<Option<Node>, ScenarioError> {
    let Some(file) = root.find(key) else { return Ok(None) };
    let Some(name) = file.as_str() else { return Ok(None) };
    let source = sources.len();
    match linked(file, name, (sources, files), "TOML") {
        Ok(linked) => sources.push(linked),
        Err(message) => {
            problems.push(Problem::new(key, message, file.place.clone()).expected(what));
            return Ok(None);
        }
    }
    parse(sources, source, schema).map(Some)
}

/// Reads the file that `robot.file` names and lays the scenario's own fields over it.
pub(super) fn robot(
    root: &mut Node,
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let file = ("robot.file", "a robot file", &*schema::ROBOT);
    let Some(mut below) = included(root, file, sources, files, problems)? else { return Ok(()) };
    let found = check::check(sources, &schema::ROBOT, &below);
    problems.extend(found);
    problems.extend(rules::check_robot(&below));
    let (Value::Table(fields), Value::Table(entries)) = (&mut below.value, &mut root.value) else {
        return Ok(());
    };
    if let Some(Value::Table(robot)) = entries.get_mut("robot").map(|entry| &mut entry.node.value) {
        let own: Table = std::mem::take(robot);
        tree::lay_over("robot", fields, own);
        *robot = std::mem::take(fields);
    }
    Ok(())
}

/// The text of a file of a format; what is wrong with it otherwise, with the place of the first byte that is no text.
fn read_text(path: &Path, format: &str) -> Result<String, String> {
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| {
        let good = error.as_bytes().get(..error.utf8_error().valid_up_to()).unwrap_or_default();
        let line = good.iter().filter(|&&byte| byte == b'\n').count() + 1;
        let column = good.iter().rev().take_while(|&&byte| byte != b'\n').count() + 1;
        format!("line {line}, column {column} (in bytes): not UTF-8; expected a {format} text")
    })
}
