//! One table laid over another: a file over what it includes, a scenario's `[robot]` over its robot file.

use super::set::RIVALS;
use super::{Node, Table, Value, is_table};

/// Array of tables of which each entry changes the fields that it gives; any other array counts as a whole.
const BY_ENTRY: &str = "robot.link";

/// Table whose keys depend on its `kind`: one of another kind replaces it.
const OF_KINDS: &str = "trajectory";

/// Lays `above` over `below`, the tables at a dotted path: tables key by key, everything else as a whole.
pub(in crate::scenario) fn lay_over(path: &str, below: &mut Table, above: Table) {
    let kind = |table: &Table| table.get("kind").and_then(|kind| kind.node.as_str()).map(str::to_owned);
    if path == OF_KINDS && kind(&above).is_some_and(|new| kind(below).is_some_and(|old| old != new)) {
        *below = above;
        return;
    }
    for (_, one, other) in RIVALS.into_iter().filter(|(table, ..)| *table == path) {
        for (given, rival) in [(one, other), (other, one)] {
            if above.contains_key(given) && !above.contains_key(rival) {
                below.remove(rival);
            }
        }
    }
    for (key, entry) in above {
        let Some(old) = below.get_mut(&key) else {
            below.insert(key, entry);
            continue;
        };
        let path = if path.is_empty() { key } else { format!("{path}.{key}") };
        lay_node(&path, &mut old.node, entry.node);
        old.key = entry.key;
    }
}

fn lay_node(path: &str, below: &mut Node, above: Node) {
    below.place = above.place;
    match (&mut below.value, above.value) {
        (Value::Table(old), Value::Table(new)) => lay_over(path, old, new),
        (Value::Array(old), Value::Array(mut new)) if path == BY_ENTRY && new.iter().all(is_table) => {
            let rest = new.split_off(new.len().min(old.len()));
            for (old, new) in old.iter_mut().zip(new) {
                lay_node("robot.link.entry", old, new);
            }
            old.extend(rest);
        }
        (old, new) => *old = new,
    }
}
