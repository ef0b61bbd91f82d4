//! Files of a reproduction, and CSV.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::work::ReproduceError;
use crate::whole;

/// Writes a file beside its place and moves it there when it is complete.
pub(super) fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), ReproduceError> {
    whole::write(path, fill).map_err(|source| ReproduceError::File { path: path.to_owned(), source })
}

/// Writes a table.
pub(super) fn write_csv(
    path: &Path,
    header: &[&str],
    lines: impl Iterator<Item = Vec<String>>,
) -> Result<(), ReproduceError> {
    let header = header.iter().map(|&name| name.to_owned()).collect();
    write(path, |out| csv(out, std::iter::once(header).chain(lines)))
}

/// Writes lines of CSV.
fn csv(out: &mut impl Write, lines: impl IntoIterator<Item = Vec<String>>) -> io::Result<()> {
    for line in lines {
        let fields: Vec<String> = line.iter().map(|field| quoted(field)).collect();
        writeln!(out, "{}", fields.join(","))?;
    }
    Ok(())
}

/// A field, in quotes where it needs them (RFC 4180).
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
