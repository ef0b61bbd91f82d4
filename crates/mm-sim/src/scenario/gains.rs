//! The gains of the law that runs: those for all laws, those of a file, those for this law.

use super::diagnostic::{Problem, Source};
use super::tree::{Entry, Node, Table, Value};
use super::types::ControllerKind;
use super::{Files, SET_NAME, ScenarioError, check, included, schema};

/// Lays over `controller.gains` what `controller.gains_file` and `controller.gains_for` say of the law that runs.
///
/// What is meant for one law comes before what is meant for all, what the scenario says before what a file says; but what an
/// argument gives, be it a gain or the file, comes before all that it does not give. Of arguments that both mean one law, a gain
/// and a file, the later one counts. Every value keeps its place.
pub(super) fn resolve(
    root: &mut Node,
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let law = law(root);
    let key = "controller.gains_file";
    let file = included(root, (key, "a file of gains", &schema::GAINS), sources, files, problems)?;
    let from_argument = |node: &Node| sources.get(node.place.source).is_some_and(|s| s.name == SET_NAME);
    let mut layers = Vec::new();
    if let Some(file) = file {
        problems.extend(check::check(sources, &schema::GAINS, &file));
        let chosen = root.find(key).filter(|node| from_argument(node)).map(|node| node.place.source);
        layers.extend(file.find(&law).and_then(Node::as_table).map(|table| (table.clone(), chosen)));
    }
    let own = root.find(&format!("controller.gains_for.{law}")).and_then(Node::as_table);
    layers.extend(own.map(|table| (table.clone(), None)));
    if layers.is_empty() {
        return Ok(());
    }
    let below = root.find("controller.gains").and_then(Node::as_table).cloned().unwrap_or_default();
    // Beside each value the argument that gave it; one for all laws is put before any for this law.
    let mut ranked: Vec<(String, Entry, Option<usize>)> = Vec::new();
    for (layer, (table, chosen)) in std::iter::once((below, None)).chain(layers).enumerate() {
        for (name, entry) in table {
            let own = from_argument(&entry.node).then_some(entry.node.place.source);
            let argument = chosen.or(own).map(|source| if layer == 0 { 0 } else { source });
            match ranked.iter_mut().find(|(known, ..)| *known == name) {
                // None is less than any argument.
                Some((.., given)) if *given > argument => {}
                Some(known) => *known = (name, entry, argument),
                None => ranked.push((name, entry, argument)),
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
