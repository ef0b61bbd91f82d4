//! The gains of the law that runs: those for all laws, those of a file, those for this law.

use std::path::Path;

use super::diagnostic::{Problem, Source};
use super::tree::{Entry, Node, Table, Value};
use super::types::ControllerKind;
use super::{SET_NAME, ScenarioError, check, included, schema};

/// Lays over `controller.gains` what `controller.gains_file` and `controller.gains_for` say of the law that runs.
///
/// What is meant for one law comes before what is meant for all, what the scenario says before what a file says; but what an
/// argument gives, be it a gain or the file, comes before all that it does not give. Every value keeps its place.
pub(super) fn resolve(
    root: &mut Node,
    sources: &mut Vec<Source>,
    folder: &Path,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let law = law(root);
    let key = "controller.gains_file";
    let file = included(root, (key, "a file of gains"), sources, folder, problems)?;
    let from_argument = |node: &Node| sources.get(node.place.source).is_some_and(|s| s.name == SET_NAME);
    let mut layers = Vec::new();
    if let Some(file) = file {
        problems.extend(check::check(sources, &schema::GAINS, &file));
        let is_chosen = root.find(key).is_some_and(from_argument);
        layers.extend(file.find(&law).and_then(Node::as_table).map(|table| (table.clone(), is_chosen)));
    }
    let own = root.find(&format!("controller.gains_for.{law}")).and_then(Node::as_table);
    layers.extend(own.map(|table| (table.clone(), false)));
    if layers.is_empty() {
        return Ok(());
    }
    let below = root.find("controller.gains").and_then(Node::as_table).cloned().unwrap_or_default();
    let mut ranked: Vec<(String, Entry, bool)> = Vec::new();
    for (table, is_chosen) in std::iter::once((below, false)).chain(layers) {
        for (name, entry) in table {
            let is_argument = is_chosen || from_argument(&entry.node);
            match ranked.iter_mut().find(|(known, ..)| *known == name) {
                Some((_, _, stays)) if *stays && !is_argument => {}
                Some(known) => *known = (name, entry, is_argument),
                None => ranked.push((name, entry, is_argument)),
            }
        }
    }
    put(root, ranked.into_iter().map(|(name, entry, _)| (name, entry)).collect());
    Ok(())
}

/// Name of the law that runs.
fn law(root: &Node) -> String {
    let default = || crate::experiment::controller_name(ControllerKind::default()).to_owned();
    root.find("controller.kind").and_then(Node::as_str).map_or_else(default, str::to_owned)
}

/// Makes a table the gains of the scenario.
fn put(root: &mut Node, gains: Table) {
    let Value::Table(entries) = &mut root.value else { return };
    let Some(controller) = entries.get_mut("controller") else { return };
    let place = controller.node.place.clone();
    let Value::Table(keys) = &mut controller.node.value else { return };
    let table = Value::Table(gains);
    match keys.get_mut("gains") {
        Some(entry) => entry.node.value = table,
        None => {
            let node = Node { value: table, place: place.clone() };
            keys.insert("gains".to_owned(), Entry { key: place, node });
        }
    }
}
