//! The scenarios that the binary carries.

use super::nearest::{is_near, nearest};

macro_rules! bundle {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../../../scenarios/", $name, ".toml")))),+]
    };
}

static BUNDLED: &[(&str, &str)] = bundle![
    "verify-straight",
    "verify-circle",
    "verify-reverse-circle",
    "verify-joint2",
    "verify-joints23",
    "verify-moving-base",
    "sinusoid",
    "sinusoid-base-held",
    "spiral",
    "square",
    "square-smooth",
    "waypoints",
    "spiral-disturbed",
    "step-disturbed",
    "spiral-compare",
    "square-compare",
    "square-realistic",
    "payload-drop",
    "square-faults",
];

/// Returns the name and the text of every bundled scenario, in the order of the thesis.
#[must_use]
pub fn bundled() -> &'static [(&'static str, &'static str)] {
    BUNDLED
}

/// The text of the bundled scenario of a name, with or without `.toml`.
pub(super) fn find(spec: &str) -> Option<&'static str> {
    let name = spec.strip_suffix(".toml").unwrap_or(spec);
    BUNDLED.iter().find(|(bundled, _)| *bundled == name).map(|(_, text)| *text)
}

/// The bundled name that a name looks like.
pub(super) fn nearest_name(spec: &str) -> Option<&'static str> {
    let word = spec.strip_suffix(".toml").unwrap_or(spec);
    nearest(word, BUNDLED.iter().map(|(name, _)| *name)).filter(|name| is_near(word, name))
}
