//! Files that are there whole or not at all, and CSV.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::work::ReproduceError;

/// Writes a file beside its place and moves it there when it is complete.
pub(super) fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), ReproduceError> {
    whole(path, fill).map_err(|source| ReproduceError::File { path: path.to_owned(), source })
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

fn whole(path: &Path, fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>) -> io::Result<()> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = path.with_file_name(format!(".{name}.part"));
    let written = File::create(&beside).and_then(|file| {
        let mut out = BufWriter::new(file);
        fill(&mut out)?;
        out.flush()
    });
    let moved = written.and_then(|()| std::fs::rename(&beside, path));
    if moved.is_err() {
        // What is left of it is of no use; that it cannot be removed adds nothing to the error.
        let _ = std::fs::remove_file(&beside);
    }
    moved
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
