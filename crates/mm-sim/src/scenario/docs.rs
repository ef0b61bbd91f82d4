//! The reference page of the scenario format.

use std::fmt::Write as _;

use serde_json::Value as Json;

use super::check::describe;
use super::schema::{View, schema};
use super::types::SAME_KEYS;

/// What stands before the tables of the reference page.
const PREFACE: &str = "\
# Scenario files

A scenario is a TOML file. Quantities are in SI units and radians, and a key that carries one ends in its
unit. Whole numbers serve as floats; `nan` and `inf` are refused. An unknown key is an error. This page and
[scenario.schema.json](scenario.schema.json), for editors, are generated from the types in
`crates/mm-sim/src/scenario/types.rs`.

`--set KEY=VALUE` changes any key from the command line: KEY is dotted, a number in it counts the entries of
an array from zero (`robot.link.1.mass_kg=6.5`), missing tables are made, and VALUE is a TOML value or a bare
word.

`include = \"base.toml\"` continues another file, or one of the bundled scenarios by its name: tables are merged key by key, `[[robot.link]]`
entry by entry, a `[trajectory]` of another `kind` replaces the old one as a whole, and so does every other value and array. What a
file names is sought beside that file. `mmsim scenario new` writes a commented file to begin with, `mmsim scenario check FILE` says
what is wrong with one, and editors with the schema say it while one types.
";

/// Returns the reference page of the scenario format in Markdown, a table for each section.
#[must_use]
pub fn markdown() -> String {
    let schema = schema();
    let mut page = PREFACE.to_owned();
    section(&mut page, View::new(&schema), "Top level", "");
    page
}

struct Row {
    key: String,
    kind: String,
    unit: String,
    default: String,
    meaning: String,
}

fn section(page: &mut String, view: View<'_>, title: &str, path: &str) {
    let _ = write!(page, "\n## {title}\n\n{}\n", meaning(view));
    let mut rows = Vec::new();
    if let Some(first) = view.kinds().first() {
        let names: Vec<String> = view.kinds().iter().map(|kind| format!("`{}`", kind.name)).collect();
        rows.push(Row {
            key: first.tag.to_owned(),
            kind: names.join(", "),
            unit: String::new(),
            default: "required".to_owned(),
            meaning: "See below.".to_owned(),
        });
    }
    let mut inner = Vec::new();
    fields(view, path, &mut rows, &mut inner);
    table(page, &rows);
    for kind in view.kinds() {
        let mut rows = Vec::new();
        fields(kind.schema, path, &mut rows, &mut inner);
        rows.retain(|row| row.key != kind.tag);
        let _ = write!(page, "\n`{} = \"{}\"`: {}\n", kind.tag, kind.name, meaning(kind.schema));
        table(page, &rows);
    }
    for (title, path, view) in inner {
        section(page, view, &title, &path);
    }
}

/// Sorts the keys of a table into rows and sections of their own.
fn fields<'a>(view: View<'a>, path: &str, rows: &mut Vec<Row>, inner: &mut Vec<(String, String, View<'a>)>) {
    let required = view.required();
    for (key, property) in view.properties() {
        let path = if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
        let in_expect = path.starts_with("expect.");
        let items = property.items().filter(|items| items.is_table());
        if let Some(same) = property.text(SAME_KEYS) {
            rows.push(Row {
                key: key.to_owned(),
                kind: format!("the keys of `[{same}]`"),
                unit: String::new(),
                default: String::new(),
                meaning: format!("Gains of `{key}`."),
            });
            continue;
        }
        match items {
            Some(items) if !in_expect => inner.push((format!("`[[{path}]]`"), path, items)),
            None if property.is_table() && !in_expect => inner.push((format!("`[{path}]`"), path, property)),
            None if property.is_table() && !is_bounds(property) => {
                let mut parts = Vec::new();
                fields(property, &path, &mut parts, inner);
                let about = meaning(property);
                rows.extend(parts.into_iter().map(|part| Row {
                    key: format!("{key}.{}", part.key),
                    meaning: format!("{about} {}", part.meaning),
                    ..part
                }));
            }
            _ => rows.push(Row {
                key: key.to_owned(),
                kind: kind(property),
                unit: if in_expect { "" } else { unit(key) }.to_owned(),
                default: default(property, required.contains(&key)),
                meaning: meaning(property),
            }),
        }
    }
}

fn table(page: &mut String, rows: &[Row]) {
    if rows.is_empty() {
        return;
    }
    page.push_str("\n| key | value | unit | default | meaning |\n| --- | --- | --- | --- | --- |\n");
    for Row { key, kind, unit, default, meaning } in rows {
        let _ = writeln!(page, "| `{key}` | {kind} | {unit} | {default} | {meaning} |");
    }
}

fn is_bounds(view: View<'_>) -> bool {
    view.properties().iter().map(|(key, _)| *key).eq(["min", "max"])
        || view.properties().iter().map(|(key, _)| *key).eq(["max", "min"])
}

fn kind(view: View<'_>) -> String {
    match view.items() {
        _ if is_bounds(view) => "`{ min, max }`".to_owned(),
        Some(items) if is_bounds(items) => "array of `{ min, max }`".to_owned(),
        _ => describe(view),
    }
}

fn default(view: View<'_>, is_required: bool) -> String {
    match view.get("default") {
        _ if is_required => "required".to_owned(),
        Some(Json::String(text)) => format!("`\"{text}\"`"),
        Some(value @ (Json::Number(_) | Json::Bool(_) | Json::Array(_))) => format!("`{value}`"),
        _ => String::new(),
    }
}

/// The description on one line, with that of each word that the value may be.
fn meaning(view: View<'_>) -> String {
    let mut text = one_line(view.text("description").unwrap_or_default());
    let words = view.words_and_meanings();
    if words.len() > 1 {
        for (word, meaning) in words.iter().filter(|(_, meaning)| !meaning.is_empty()) {
            let _ = write!(text, " `{word}`: {}", one_line(meaning));
        }
    }
    text
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

/// The unit that a key ends in.
fn unit(key: &str) -> &'static str {
    const UNITS: [(&str, &str); 21] = [
        ("rate_limit_n_m_s", "N m/s"),
        ("_n_m_a", "N m/A"),
        ("_ohm", "ohm"),
        ("_h", "H"),
        ("_v", "V"),
        ("_a", "A"),
        ("_kg_m2", "kg m^2"),
        ("_n_m_s", "N m s"),
        ("_m_s2", "m/s^2"),
        ("_m_s3", "m/s^3"),
        ("_rad_s", "rad/s"),
        ("_1_s", "1/s"),
        ("_n_m", "N m"),
        ("_m_s", "m/s"),
        ("_rad", "rad"),
        ("_kg", "kg"),
        ("_hz", "Hz"),
        ("_n", "N"),
        ("_m", "m"),
        ("_s", "s"),
        ("", ""),
    ];
    UNITS.iter().find(|(suffix, _)| key.ends_with(suffix)).map_or("", |(_, unit)| unit)
}
