//! The schema and the reference page in `docs` are those that the types generate.
//!
//! `MMSIM_BLESS=1 cargo test -p mm-sim --test sim scenario_reference` writes them anew.

#![expect(clippy::unwrap_used, reason = "a helper of tests reports like a test")]

use std::path::PathBuf;

use mm_sim::scenario;

fn check(file: &str, fresh: &str) {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(file);
    if std::env::var_os("MMSIM_BLESS").is_some() {
        std::fs::write(&path, fresh).unwrap();
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == fresh, "docs/{file} is stale: run this test with MMSIM_BLESS=1");
}

#[test]
fn schema_is_fresh() {
    let mut text = serde_json::to_string_pretty(&scenario::schema()).unwrap();
    text.push('\n');
    check("scenario.schema.json", &text);
}

#[test]
fn reference_page_is_fresh() {
    check("scenario.md", &scenario::markdown());
}
