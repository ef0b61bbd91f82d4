//! Python's dictionaries as edits of a scenario, and JSON as Python's objects.

use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyString};

/// A value as TOML on one line: what the edits of a scenario are written in.
pub(crate) fn toml(value: &Bound<'_, PyAny>, name: &str) -> PyResult<String> {
    if let Ok(flag) = value.cast::<PyBool>() {
        return Ok(flag.is_true().to_string());
    }
    if let Ok(text) = value.cast::<PyString>() {
        // JSON's strings are TOML's.
        return Ok(serde_json::Value::from(text.to_str()?).to_string());
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.str()?.to_string());
    }
    if let Ok(number) = value.cast::<PyFloat>() {
        return Ok(format!("{:?}", number.value()).replace("NaN", "nan"));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let mut entries = Vec::new();
        for (key, value) in table {
            let key = key.extract::<String>()?;
            entries.push(format!("{} = {}", serde_json::Value::from(key.as_str()), toml(&value, &key)?));
        }
        return Ok(format!("{{{}}}", entries.join(", ")));
    }
    // Numbers of numpy, and paths.
    if let Ok(path) = value.call_method0("__fspath__") {
        return toml(&path, name);
    }
    if let Ok(plain) = value.call_method0("tolist") {
        return toml(&plain, name);
    }
    let Ok(items) = value.try_iter() else {
        let kind = value.get_type().name()?;
        return Err(PyTypeError::new_err(format!(
            "{name}: expected a number, bool, str, list or dict, got {kind}"
        )));
    };
    let items: Vec<String> = items.map(|item| toml(&item?, name)).collect::<PyResult<_>>()?;
    Ok(format!("[{}]", items.join(", ")))
}

/// A dictionary as edits `KEY=VALUE`, each key below `prefix`.
pub(crate) fn edits(table: Option<&Bound<'_, PyDict>>, prefix: &str) -> PyResult<Vec<String>> {
    let Some(table) = table else { return Ok(Vec::new()) };
    let mut edits = Vec::new();
    for (key, value) in table {
        let key = key
            .extract::<String>()
            .map_err(|_| PyTypeError::new_err(format!("keys of overrides are strings, got {key}")))?;
        if value.is_none() {
            continue;
        }
        edits.push(format!("{prefix}{key}={}", toml(&value, &key)?));
    }
    Ok(edits)
}

/// JSON as Python's own objects.
pub(crate) fn object<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// Anything that can be written as JSON as Python's own objects.
pub(crate) fn of<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    object(py, &text)
}
