//! The files that a scenario includes, laid under its own keys.

use std::path::{Path, PathBuf};

use super::diagnostic::{Problem, ScenarioError, Source};
use super::tree::{Node, Table, Value, lay_over};
use super::{Files, bundled, linked, parse, schema};

const KEY: &str = "include";

/// What the key takes.
const EXPECTED: &str = "a file, or an array of files";

/// Lays what a scenario includes, and what that includes, under its own keys; every value keeps its place.
pub(super) fn resolve(
    root: &mut Node,
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let chain = sources.first().map(|source| real(&source.name)).into_iter().collect();
    Inclusion { sources, files, problems, chain }.below(root)
}

/// An argument comes too late to include anything.
pub(super) fn refuse_edit(root: &Node, problems: &mut Vec<Problem>) {
    if let Some(node) = root.find(KEY) {
        problems.push(
            Problem::new(KEY, "given by an argument", node.place.clone()).expected("it in a file alone"),
        );
    }
}

struct Inclusion<'a> {
    sources: &'a mut Vec<Source>,
    files: &'a Files<'a>,
    problems: &'a mut Vec<Problem>,
    /// The files that are being read, each named by the one before.
    chain: Vec<PathBuf>,
}

impl Inclusion<'_> {
    /// Lays what a file includes under its keys.
    fn below(&mut self, root: &mut Node) -> Result<(), ScenarioError> {
        let Value::Table(own) = &mut root.value else { return Ok(()) };
        let Some(entry) = own.remove(KEY) else { return Ok(()) };
        let names = match &entry.node.value {
            Value::Array(items) => items.as_slice(),
            _ => std::slice::from_ref(&entry.node),
        };
        let mut below = Table::new();
        for node in names {
            let Some(name) = node.as_str() else {
                let message = format!("found {}", node.type_name());
                self.problems.push(Problem::new(KEY, message, node.place.clone()).expected(EXPECTED));
                continue;
            };
            if let Some(table) = self.one(node, name)? {
                lay_over("", &mut below, table);
            }
        }
        lay_over("", &mut below, std::mem::take(own));
        *own = below;
        Ok(())
    }

    /// The keys of one file; none where it cannot be included.
    fn one(&mut self, node: &Node, name: &str) -> Result<Option<Table>, ScenarioError> {
        let read = linked(node, name, (self.sources, self.files), "TOML");
        let text = match read.or_else(|message| bundled_source(name).ok_or(message)) {
            Ok(text) => text,
            Err(message) => {
                let nearest = bundled::nearest_name(name);
                let problem = Problem::new(KEY, message, node.place.clone()).nearest(nearest);
                self.problems.push(problem.expected("a file, or the name of a bundled scenario"));
                return Ok(None);
            }
        };
        let path = real(&text.name);
        if self.chain.contains(&path) {
            let message = format!("found `{name}`, which this file is part of");
            let expected = "files that do not include themselves, nor each other";
            self.problems.push(Problem::new(KEY, message, node.place.clone()).expected(expected));
            return Ok(None);
        }
        let folder = Path::new(&text.name).parent().map(Path::to_path_buf).unwrap_or_default();
        let source = self.sources.len();
        self.sources.push(text.within(&folder));
        let mut tree = parse(self.sources, source, &schema::SCENARIO)?;
        self.chain.push(path);
        self.below(&mut tree)?;
        self.chain.pop();
        Ok(match tree.value {
            Value::Table(table) => Some(table),
            _ => None,
        })
    }
}

fn bundled_source(name: &str) -> Option<Source> {
    bundled::find(name).map(|text| Source::new(name, text))
}

/// A path by which a file is known again.
fn real(name: &str) -> PathBuf {
    std::fs::canonicalize(name).unwrap_or_else(|_| PathBuf::from(name))
}
