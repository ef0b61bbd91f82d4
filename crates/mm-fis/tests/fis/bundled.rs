//! Law: the bundled `.fis` files and the consts of `mm_control::fuzzy` are the same rule bases, number by number, so that a
//! scenario may name either.
//!
//! Reference: the consts. Tolerance: none.

use mm_control::fuzzy::{MamdaniTables, SMOOTH, THESIS};
use mm_fis::{Accuracy, read_fis, write_fis};

fn check(file: &str, text: &str, expected: &MamdaniTables<'_, f64>) {
    let document = read_fis(text).map_err(|error| error.to_string());
    let Ok(document) = document else {
        unreachable!("{file}: {document:?}");
    };
    assert!(document.notes.is_empty(), "{file}: nothing to note");
    let tables = document.system.leak(Accuracy::Exact);
    assert_eq!(tables.as_deref(), Ok(expected), "{file}");
    // Below the comment that says what it is, the file is as the writer writes it.
    let body = text.find("[System]").and_then(|start| text.get(start..));
    assert_eq!(body, Some(write_fis(&document.system).as_str()), "{file} is canonical");
}

#[test]
fn files_and_consts_are_the_same() {
    check("thesis.fis", include_str!("../../../../scenarios/fis/thesis.fis"), &THESIS);
    check("smooth.fis", include_str!("../../../../scenarios/fis/smooth.fis"), &SMOOTH);
}
