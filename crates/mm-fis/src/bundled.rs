//! The systems that come with this crate.

/// Names and texts of the bundled systems: `thesis`, Appendix C of the thesis, and `smooth`, a monotone one without a jump.
#[must_use]
pub const fn bundled() -> &'static [(&'static str, &'static str)] {
    &[
        ("thesis", include_str!("../../../scenarios/fis/thesis.fis")),
        ("smooth", include_str!("../../../scenarios/fis/smooth.fis")),
    ]
}

/// The text of the bundled system of a name, with or without `.fis`.
#[must_use]
pub fn bundled_text(name: &str) -> Option<&'static str> {
    let name = name.strip_suffix(".fis").unwrap_or(name);
    bundled().iter().find(|(bundled, _)| *bundled == name).map(|(_, text)| *text)
}
