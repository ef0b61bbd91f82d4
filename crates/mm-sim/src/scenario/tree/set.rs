//! `--set KEY=VALUE`: edits of the tree from the command line.

use super::{Entry, Node, Place, Table, Value, parse_value};
use crate::scenario::diagnostic::Problem;

/// Deepest key that an argument may name, that of the TOML parser.
const MAX_DEPTH: usize = 80;

/// Entries up to which an array of tables is made longer for an argument.
const MAX_NEW_ENTRIES: usize = 16;

/// Keys of which a scenario takes one of two: an argument for one displaces the other from the file.
pub(super) const RIVALS: [(&str, &str, &str); 3] =
    [("robot", "preset", "file"), ("initial", "base_pose", "tip"), ("trajectory", "points_m", "file")];

/// Sets the value that the argument `KEY=VALUE`, the text `source`, names.
///
/// KEY is dotted; missing tables are made and a number counts the entries of an array from zero. VALUE is a
/// TOML value or, when it does not parse as one, a bare string.
///
/// # Errors
///
/// The reason why the tree cannot be edited so.
pub(in crate::scenario) fn set(root: &mut Node, source: usize, argument: &str) -> Result<(), Box<Problem>> {
    let whole = Place { source, span: 0..argument.len() };
    let Some((key, value)) = argument.split_once('=') else {
        return Err(Problem::new(argument, "not of the form KEY=VALUE", whole)
            .expected("for example simulation.duration_s=10")
            .boxed());
    };
    let segments: Vec<&str> = key.split('.').map(str::trim).collect();
    let key_place = Place { source, span: 0..key.len() };
    if segments.iter().any(|segment| segment.is_empty()) || segments.len() > MAX_DEPTH {
        return Err(Problem::new(key, "not a dotted key", key_place)
            .expected("for example simulation.duration_s")
            .boxed());
    }
    let offset = argument.len() - value.trim_start().len();
    let value = value.trim();
    let node = parse_value(source, offset, value).unwrap_or_else(|| Node {
        value: Value::String(value.to_owned()),
        place: Place { source, span: offset..offset + value.len() },
    });
    displace_rival(root, source, &segments);
    insert(root, &segments, 0, node, &key_place)
}

fn displace_rival(root: &mut Node, source: usize, segments: &[&str]) {
    let [table, key] = segments else { return };
    let Value::Table(root) = &mut root.value else { return };
    let Some(Value::Table(entries)) = root.get_mut(*table).map(|entry| &mut entry.node.value) else { return };
    for (rival_table, one, other) in RIVALS {
        let rival = match *key {
            _ if rival_table != *table => continue,
            key if key == one => other,
            key if key == other => one,
            _ => continue,
        };
        // Only what the file says gives way: two arguments against each other stay an error.
        if entries.get(rival).is_some_and(|entry| entry.key.source == 0 && source != 0) {
            entries.remove(rival);
        }
    }
}

fn insert(
    node: &mut Node,
    segments: &[&str],
    depth: usize,
    new: Node,
    key: &Place,
) -> Result<(), Box<Problem>> {
    let Some(segment) = segments.get(depth) else {
        *node = new;
        return Ok(());
    };
    let so_far = segments[..depth].join(".");
    let found = node.type_name();
    match &mut node.value {
        Value::Table(table) => {
            let next_is_index = segments.get(depth + 1).is_some_and(|next| next.parse::<usize>().is_ok());
            let is_last = segments.len() == depth + 2;
            let make_array = next_is_index && (!is_last || super::is_table(&new));
            let entry = table.entry((*segment).to_owned()).or_insert_with(|| Entry {
                key: key.clone(),
                node: Node {
                    value: if make_array { Value::Array(Vec::new()) } else { Value::Table(Table::new()) },
                    place: key.clone(),
                },
            });
            if segments.len() == depth + 1 {
                entry.key = key.clone();
            }
            insert(&mut entry.node, segments, depth + 1, new, key)
        }
        Value::Array(items) => {
            let Ok(index) = segment.parse::<usize>() else {
                return Err(Problem::new(
                    &so_far,
                    format!("found an array, no key `{segment}`"),
                    key.clone(),
                )
                .expected(format!("the number of an entry, from 0 to {}", items.len().saturating_sub(1)))
                .boxed());
            };
            let of_tables =
                (segments.len() > depth + 1 || super::is_table(&new)) && items.iter().all(super::is_table);
            if of_tables && index < MAX_NEW_ENTRIES {
                while items.len() <= index {
                    items.push(Node { value: Value::Table(Table::new()), place: key.clone() });
                }
            }
            let count = items.len();
            let Some(item) = items.get_mut(index) else {
                return Err(Problem::new(&segments.join("."), format!("no entry {index}"), key.clone())
                    .expected(format!("an entry of the {count} that `{so_far}` has, counted from 0"))
                    .boxed());
            };
            insert(item, segments, depth + 1, new, key)
        }
        _ => Err(Problem::new(&so_far, format!("found {found}, which has no key `{segment}`"), key.clone())
            .expected("a table")
            .boxed()),
    }
}
