//! The JSON Schema of scenario and robot files.

use std::sync::LazyLock;

use schemars::JsonSchema;
use serde_json::{Map, Value};

use super::types::{GainsFor, RobotFields, ScenarioFile, WaypointFile};

/// The schema of a scenario file.
pub(super) static SCENARIO: LazyLock<Value> = LazyLock::new(generate::<ScenarioFile>);

/// The schema of a robot file.
pub(super) static ROBOT: LazyLock<Value> = LazyLock::new(generate::<RobotFields>);

/// The schema of a file of points.
pub(super) static WAYPOINTS: LazyLock<Value> = LazyLock::new(generate::<WaypointFile>);
/// The schema of a file of gains.
pub(super) static GAINS: LazyLock<Value> = LazyLock::new(generate::<GainsFor>);

/// Returns the JSON Schema (draft 2020-12) of a scenario file, for editors and for the checker.
#[must_use]
pub fn schema() -> Value {
    SCENARIO.clone()
}

fn generate<T: JsonSchema>() -> Value {
    let mut schema = schemars::schema_for!(T).to_value();
    drop_null(&mut schema);
    schema
}

/// Takes out what JSON needs for an optional key and TOML, without a null, does not have.
fn drop_null(schema: &mut Value) {
    match schema {
        Value::Array(items) => items.iter_mut().for_each(drop_null),
        Value::Object(object) => {
            object.values_mut().for_each(drop_null);
            if object.get("default").is_some_and(Value::is_null) {
                object.shift_remove("default");
            }
            drop_null_type(object);
            drop_null_branch(object);
        }
        _ => {}
    }
}

fn drop_null_type(object: &mut Map<String, Value>) {
    let Some(Value::Array(types)) = object.get_mut("type") else { return };
    types.retain(|name| name != "null");
    if let [only] = types.as_slice() {
        let only = only.clone();
        object.insert("type".to_owned(), only);
    }
}

fn drop_null_branch(object: &mut Map<String, Value>) {
    let Some(Value::Array(branches)) = object.get_mut("anyOf") else { return };
    branches.retain(|branch| branch.get("type").is_none_or(|name| name != "null"));
    if let [Value::Object(only)] = branches.as_slice() {
        let only = only.clone();
        object.shift_remove("anyOf");
        for (key, value) in only {
            object.entry(key).or_insert(value);
        }
    }
}

/// A schema together with the definitions that its references name.
#[derive(Debug, Clone, Copy)]
pub(super) struct View<'a> {
    root: &'a Value,
    at: &'a Value,
}

impl<'a> View<'a> {
    pub(super) const fn new(root: &'a Value) -> Self {
        Self { root, at: root }
    }

    const fn with(self, at: &'a Value) -> Self {
        Self { root: self.root, at }
    }

    /// The value of a schema keyword, here or where the schema refers to.
    pub(super) fn get(self, keyword: &str) -> Option<&'a Value> {
        self.at.get(keyword).or_else(|| self.target()?.get(keyword))
    }

    /// The text of a schema keyword.
    pub(super) fn text(self, keyword: &str) -> Option<&'a str> {
        self.get(keyword)?.as_str()
    }

    fn target(self) -> Option<&'a Value> {
        let reference = self.at.get("$ref")?.as_str()?;
        self.root.pointer(reference.strip_prefix('#')?)
    }

    fn list(self, keyword: &str) -> impl Iterator<Item = Self> {
        self.get(keyword).and_then(Value::as_array).into_iter().flatten().map(move |at| self.with(at))
    }

    /// The schemas of which a value needs to meet one.
    pub(super) fn alternatives(self) -> Vec<Self> {
        self.list("anyOf").collect()
    }

    /// The schema of an array's entries.
    pub(super) fn items(self) -> Option<Self> {
        self.get("items").map(|at| self.with(at))
    }

    /// The words that a value may be, if they are all it may be.
    pub(super) fn words(self) -> Vec<&'a str> {
        self.words_and_meanings().into_iter().map(|(word, _)| word).collect()
    }

    /// The words that a value may be, each with what it means.
    pub(super) fn words_and_meanings(self) -> Vec<(&'a str, &'a str)> {
        let plain = |view: Self| {
            view.at.get("enum").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str)
        };
        let target = self.target().map(|at| self.with(at)).into_iter().flat_map(plain);
        let branches = self.list("oneOf").flat_map(|branch| {
            let meaning = branch.text("description").unwrap_or_default();
            branch
                .text("const")
                .map(|word| (word, meaning))
                .into_iter()
                .chain(plain(branch).map(|word| (word, "")))
        });
        plain(self).chain(target).map(|word| (word, "")).chain(branches).collect()
    }

    /// The key and its schema for each key of a table, without those of a kind.
    pub(super) fn properties(self) -> Vec<(&'a str, Self)> {
        let map = self.get("properties").and_then(Value::as_object);
        map.into_iter().flatten().map(|(key, at)| (key.as_str(), self.with(at))).collect()
    }

    /// The keys that a table must have.
    pub(super) fn required(self) -> Vec<&'a str> {
        self.get("required")
            .and_then(Value::as_array)
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .collect()
    }

    /// The kinds of a table that has a key, the tag, to tell them apart.
    pub(super) fn kinds(self) -> Vec<Kind<'a>> {
        let kind = |branch: Self| {
            let (tag, name) = branch
                .properties()
                .into_iter()
                .find_map(|(key, property)| Some((key, property.text("const")?)))?;
            Some(Kind { tag, name, schema: branch })
        };
        self.list("oneOf").filter_map(kind).collect()
    }

    /// Whether the schema describes a table.
    pub(super) fn is_table(self) -> bool {
        self.text("type") == Some("object")
    }
}

/// One kind of a table, told by the value of its tag.
#[derive(Debug, Clone, Copy)]
pub(super) struct Kind<'a> {
    pub(super) tag: &'a str,
    pub(super) name: &'a str,
    pub(super) schema: View<'a>,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The checker refuses unknown keys by itself; an editor does so only when the schema says it.
    #[test]
    fn every_table_is_closed() {
        fn walk(path: &str, schema: &Value, in_kind: bool) {
            if let Value::Object(object) = schema {
                let is_table = object.get("type").is_some_and(|name| name == "object");
                let closed = ["additionalProperties", "unevaluatedProperties"]
                    .iter()
                    .any(|keyword| object.get(*keyword) == Some(&Value::Bool(false)));
                assert!(!is_table || closed || in_kind, "{path} takes any key");
                for (key, value) in object {
                    walk(&format!("{path}/{key}"), value, key == "oneOf");
                }
            } else if let Value::Array(items) = schema {
                items.iter().for_each(|item| walk(path, item, in_kind));
            }
        }
        walk("", &SCENARIO, false);
        walk("", &ROBOT, false);
        walk("", &WAYPOINTS, false);
        walk("", &GAINS, false);
    }
}
