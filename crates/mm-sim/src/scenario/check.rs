//! Checks a tree against a schema and gathers everything that does not fit.
//!
//! The schema keywords understood are those that the types of this module produce: a keyword beyond them
//! would be ignored here, which a round trip through the types then reports.

use serde_json::Value as Json;

use super::diagnostic::{Problem, Source};
use super::nearest::nearest;
use super::schema::{Kind, View};
use super::tree::{Node, Place, Table, Value};

/// What is said of a key that has to be there.
pub(super) const MISSING: &str = "missing key";

/// Longest value that a message quotes.
const MAX_QUOTE: usize = 40;

/// Returns all that does not fit the schema.
pub(super) fn check(sources: &[Source], schema: &Json, root: &Node) -> Vec<Problem> {
    let view = View::new(schema);
    let mut known = Vec::new();
    list_keys(view, "", &mut known);
    let mut checker = Checker { sources, known, problems: Vec::new() };
    checker.value(view, root, "");
    checker.problems
}

struct Checker<'a> {
    sources: &'a [Source],
    /// Every key of the format, as its name and its dotted path.
    known: Vec<(String, String)>,
    problems: Vec<Problem>,
}

impl Checker<'_> {
    fn value(&mut self, view: View<'_>, node: &Node, key: &str) {
        let words = view.words();
        if !words.is_empty() {
            return self.word(&words, node, key);
        }
        let alternatives = view.alternatives();
        if !alternatives.is_empty() {
            return match alternatives.iter().find(|alternative| has_type(**alternative, node)) {
                Some(fitting) => self.value(*fitting, node, key),
                None => self.mismatch(view, node, key),
            };
        }
        if !has_type(view, node) {
            return self.mismatch(view, node, key);
        }
        match &node.value {
            Value::Table(table) => self.table(view, node, table, key),
            Value::Array(items) => self.array(view, node, items, key),
            Value::Integer(_) | Value::Float(_) => self.number(view, node, key),
            Value::String(text) => {
                let least = view.get("minLength").and_then(Json::as_u64).unwrap_or(0);
                let most = view.get("maxLength").and_then(Json::as_u64).unwrap_or(u64::MAX);
                let length = text.chars().count() as u64;
                if length < least || length > most {
                    self.problems.push(
                        Problem::new(key, format!("found {length} characters"), node.place.clone())
                            .expected(format!("a string of {least} to {most} characters")),
                    );
                }
            }
            Value::Boolean(_) | Value::Datetime => {}
        }
    }

    fn word(&mut self, words: &[&str], node: &Node, key: &str) {
        if node.as_str().is_some_and(|text| words.contains(&text)) {
            return;
        }
        let near = node.as_str().and_then(|text| nearest(text, words.iter().copied()));
        self.problems.push(
            Problem::new(key, self.found(node), node.place.clone()).expected(one_of(words)).nearest(near),
        );
    }

    fn mismatch(&mut self, view: View<'_>, node: &Node, key: &str) {
        self.problems.push(Problem::new(key, self.found(node), node.place.clone()).expected(describe(view)));
    }

    fn number(&mut self, view: View<'_>, node: &Node, key: &str) {
        let Some(value) = node.as_number() else {
            let message = format!("{}, not a finite number", self.found(node));
            self.problems.push(Problem::new(key, message, node.place.clone()).expected(describe(view)));
            return;
        };
        let bound = |keyword| view.get(keyword).and_then(Json::as_f64);
        let fits = bound("minimum").is_none_or(|least| value >= least)
            && bound("maximum").is_none_or(|most| value <= most)
            && bound("exclusiveMinimum").is_none_or(|below| value > below)
            && bound("exclusiveMaximum").is_none_or(|above| value < above);
        let too_large = matches!(node.value, Value::Integer(value) if view.text("type") == Some("integer")
            && u64::try_from(value).is_err());
        if !fits || too_large {
            self.mismatch(view, node, key);
        }
    }

    fn array(&mut self, view: View<'_>, node: &Node, items: &[Node], key: &str) {
        let bound = |keyword| view.get(keyword).and_then(Json::as_u64);
        let count = items.len() as u64;
        if bound("minItems").is_some_and(|least| count < least)
            || bound("maxItems").is_some_and(|most| count > most)
        {
            let entries = if count == 1 { "entry" } else { "entries" };
            self.problems.push(
                Problem::new(key, format!("found {count} {entries}"), node.place.clone())
                    .expected(describe(view)),
            );
        }
        if let Some(item_view) = view.items() {
            for (index, item) in items.iter().enumerate() {
                self.value(item_view, item, &join(key, &index.to_string()));
            }
        }
    }

    fn table(&mut self, view: View<'_>, node: &Node, table: &Table, key: &str) {
        let kinds = view.kinds();
        let mut properties = view.properties();
        let mut required = view.required();
        let mut chosen = None;
        if let Some(first) = kinds.first() {
            chosen = self.kind(&kinds, node, table, key);
            match chosen {
                Some(kind) => {
                    properties.extend(kind.schema.properties());
                    required.extend(kind.schema.required());
                }
                // The kind itself is already reported: its keys get the benefit of the doubt.
                None => properties.extend(kinds.iter().flat_map(|kind| kind.schema.properties())),
            }
            required.retain(|name| *name != first.tag);
        }
        for (name, entry) in table {
            let path = join(key, name);
            if kinds.first().is_some_and(|kind| kind.tag == name) {
                continue;
            }
            match properties.iter().find(|(property, _)| property == name) {
                Some((_, property)) => self.value(*property, &entry.node, &path),
                None => self.unknown(&properties, &kinds, chosen, (name, &path), &entry.key),
            }
        }
        for name in required.into_iter().filter(|name| !table.contains_key(*name)) {
            let property = properties.iter().find(|(property, _)| *property == name);
            self.missing(property.map(|(_, view)| *view), &node.place, &join(key, name));
        }
    }

    /// Finds the kind that a table's tag names, and reports a tag that names none.
    fn kind<'k>(&mut self, kinds: &[Kind<'k>], node: &Node, table: &Table, key: &str) -> Option<Kind<'k>> {
        let names: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
        let tag = kinds.first()?.tag;
        let Some(entry) = table.get(tag) else {
            self.problems
                .push(Problem::new(&join(key, tag), MISSING, node.place.clone()).expected(one_of(&names)));
            return None;
        };
        self.word(&names, &entry.node, &join(key, tag));
        let name = entry.node.as_str()?;
        kinds.iter().find(|kind| kind.name == name).copied()
    }

    fn unknown(
        &mut self,
        properties: &[(&str, View<'_>)],
        kinds: &[Kind<'_>],
        chosen: Option<Kind<'_>>,
        (name, path): (&str, &str),
        place: &Place,
    ) {
        let takers: Vec<&str> = kinds
            .iter()
            .filter(|kind| kind.schema.properties().iter().any(|(property, _)| *property == name))
            .map(|kind| kind.name)
            .collect();
        let names = properties.iter().map(|(property, _)| *property);
        let problem = match chosen {
            Some(chosen) if !takers.is_empty() => {
                let message = format!("not a key of {} = \"{}\"", chosen.tag, chosen.name);
                Problem::new(path, message, place.clone()).expected(format!(
                    "only with {} {}",
                    chosen.tag,
                    one_of(&takers)
                ))
            }
            _ => {
                let stem = format!("{name}_");
                let here = names.clone().find(|property| property.starts_with(&stem));
                let elsewhere =
                    self.known.iter().find(|(known, _)| known == name).map(|(_, path)| path.as_str());
                Problem::new(path, "unknown key", place.clone())
                    .expected(one_of(&names.clone().collect::<Vec<_>>()))
                    .nearest(here.or(elsewhere).or_else(|| nearest(name, names)))
            }
        };
        self.problems.push(problem);
    }

    /// Reports a required key, or those within a required table.
    fn missing(&mut self, view: Option<View<'_>>, place: &Place, key: &str) {
        match view {
            Some(view) if view.is_table() => {
                let empty = Node { value: Value::Table(Table::new()), place: place.clone() };
                self.value(view, &empty, key);
            }
            _ => {
                let mut problem = Problem::new(key, MISSING, place.clone());
                if let Some(view) = view {
                    problem = problem.expected(describe(view));
                }
                self.problems.push(problem);
            }
        }
    }

    fn found(&self, node: &Node) -> String {
        let span = node.place.span.clone();
        let quote = self.sources.get(node.place.source).and_then(|source| source.text.get(span));
        match (&node.value, quote) {
            (Value::Table(_) | Value::Array(_), _) | (_, None | Some("")) => {
                format!("found {}", node.type_name())
            }
            (_, Some(quote)) if quote.len() > MAX_QUOTE || quote.contains('\n') => {
                format!("found {}", node.type_name())
            }
            (Value::Integer(_) | Value::Float(_), Some(quote)) => format!("found {quote}"),
            (_, Some(quote)) => format!("found {}, {quote}", node.type_name()),
        }
    }
}

fn list_keys(view: View<'_>, path: &str, known: &mut Vec<(String, String)>) {
    let of_kinds = view.kinds().into_iter().flat_map(|kind| kind.schema.properties());
    for (name, property) in view.properties().into_iter().chain(of_kinds) {
        let path = join(path, name);
        if !path.starts_with("expect.") {
            known.push((name.to_owned(), path.clone()));
        }
        list_keys(property.items().unwrap_or(property), &path, known);
    }
}

fn join(key: &str, name: &str) -> String {
    if key.is_empty() { name.to_owned() } else { format!("{key}.{name}") }
}

fn one_of(words: &[&str]) -> String {
    let listed = words.iter().map(|word| format!("`{word}`")).collect::<Vec<_>>().join(", ");
    if words.len() == 1 { listed } else { format!("one of {listed}") }
}

fn has_type(view: View<'_>, node: &Node) -> bool {
    match (view.text("type"), &node.value) {
        (Some("object"), Value::Table(_))
        | (Some("array"), Value::Array(_))
        | (Some("string"), Value::String(_))
        | (Some("boolean"), Value::Boolean(_))
        | (Some("integer"), Value::Integer(_))
        | (Some("number"), Value::Integer(_) | Value::Float(_)) => true,
        (None, _) => view.kinds().is_empty() || node.as_table().is_some(),
        _ => false,
    }
}

/// What a schema asks for, in words: `a number above 0`.
pub(super) fn describe(view: View<'_>) -> String {
    let words = view.words();
    if !words.is_empty() {
        return one_of(&words);
    }
    let alternatives = view.alternatives();
    if !alternatives.is_empty() {
        return alternatives.into_iter().map(describe).collect::<Vec<_>>().join(" or ");
    }
    match view.text("type") {
        Some("array") => {
            let items = view.items().map_or_else(|| "values".to_owned(), |items| plural(items));
            let bound = |keyword| view.get(keyword).and_then(Json::as_u64);
            match (bound("minItems"), bound("maxItems")) {
                (Some(least), Some(most)) if least == most => format!("an array of {least} {items}"),
                (Some(1), None) => format!("a non-empty array of {items}"),
                (Some(least), None) => format!("an array of at least {least} {items}"),
                (_, Some(most)) => format!("an array of at most {most} {items}"),
                (None, None) => format!("an array of {items}"),
            }
        }
        Some("integer") => format!("a whole number{}", range(view)),
        Some("number") => format!("a number{}", range(view)),
        Some("boolean") => "true or false".to_owned(),
        Some("string") => "a string".to_owned(),
        _ => "a table".to_owned(),
    }
}

fn plural(view: View<'_>) -> String {
    match view.text("type") {
        Some("number") => format!("numbers{}", range(view)),
        Some("integer") => format!("whole numbers{}", range(view)),
        Some("string") => "strings".to_owned(),
        Some("object") => "tables, `[[...]]`".to_owned(),
        Some("array") => describe(view).replacen("an array", "arrays", 1),
        _ => "values".to_owned(),
    }
}

/// The range of a number in words, with a leading blank; empty without one.
fn range(view: View<'_>) -> String {
    let bounds = [
        ("exclusiveMinimum", "above"),
        ("minimum", "of at least"),
        ("exclusiveMaximum", "below"),
        ("maximum", "of at most"),
    ];
    let words: Vec<String> = bounds
        .iter()
        .filter_map(|(keyword, words)| Some(format!(" {words} {}", view.get(keyword)?)))
        .collect();
    words.join(" and")
}
