//! The file of a fuzzy system: found, read, and its problems shown.

use std::io::Read as _;
use std::path::Path;

use mm_fis::{Document, Problem, System};

use super::super::{Exit, complain};
use crate::scenario::nearest::{is_near, nearest};
use crate::snippet::Message;

/// Problems that are shown; a file with more of them is not meant as a fuzzy system.
const MAX_SHOWN: usize = 30;

/// The name that stands for standard input.
pub(super) const STDIN: &str = "-";

/// A system and the name of its text.
pub(super) struct Loaded {
    /// The file as given.
    pub(super) name: String,
    /// Short name for files made from it: without folder and ending.
    pub(super) stem: String,
    pub(super) system: System,
}

/// Reads a system: an existing file, else a bundled one by name, or standard input; complains of what is wrong.
pub(super) fn load(spec: &str) -> Result<Loaded, Exit> {
    let (name, text) = text_of(spec)?;
    match mm_fis::read(&name, &text) {
        Ok(Document { system, notes }) => {
            for note in notes.iter().take(MAX_SHOWN) {
                complain(&message(note, (&name, &text), true));
            }
            let stem = Path::new(spec).file_stem().and_then(std::ffi::OsStr::to_str);
            let stem = stem.filter(|_| spec != STDIN).unwrap_or("fis").to_owned();
            Ok(Loaded { name, stem, system })
        }
        Err(error) => {
            let shown = error.problems().iter().take(MAX_SHOWN);
            let paragraphs: Vec<String> =
                shown.map(|problem| message(problem, (&name, &text), false).to_string()).collect();
            complain(&paragraphs.join("\n\n"));
            let more = error.problems().len().saturating_sub(MAX_SHOWN).saturating_add(error.left_off());
            if more > 0 {
                complain(&format_args!("\nand {more} more"));
            }
            Err(Exit::Usage)
        }
    }
}

fn message<'a>(problem: &'a Problem, (name, text): (&'a str, &'a str), is_warning: bool) -> Message<'a> {
    Message {
        is_warning,
        title: problem.message().to_owned(),
        expected: problem.expected(),
        nearest: problem.nearest(),
        place: Some((name, text, problem.span())),
        remark: None,
    }
}

/// Name and text of what was asked for.
fn text_of(spec: &str) -> Result<(String, String), Exit> {
    if spec == STDIN {
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().read_to_end(&mut bytes);
        read.map_err(|error| refuse(&format!("cannot read standard input: {error}"), None, None))?;
        let name = "standard input";
        return Ok((name.to_owned(), decoded(name, bytes)));
    }
    let path = Path::new(spec);
    if path.exists() && !path.is_dir() {
        let bytes = std::fs::read(path);
        let bytes = bytes.map_err(|error| refuse(&format!("cannot read `{spec}`: {error}"), None, None))?;
        return Ok((spec.to_owned(), decoded(spec, bytes)));
    }
    let is_bare = path.file_name().is_some_and(|name| name == spec);
    let wanted = spec.strip_suffix(".fis").unwrap_or(spec);
    if is_bare && let Some(text) = mm_fis::bundled_text(spec) {
        return Ok((spec.to_owned(), text.to_owned()));
    }
    let what = match (path.is_dir(), is_bare) {
        (true, _) => "it is a folder",
        (false, true) => "no such file and no bundled system of that name",
        (false, false) => "no such file",
    };
    let names = mm_fis::bundled().iter().map(|(name, _)| *name);
    let near = nearest(wanted, names).filter(|name| is_near(wanted, name));
    let expected = "a .fis or .fcl file, `-` or one of the bundled systems: `thesis`, `smooth`";
    Err(refuse(&format!("cannot read `{spec}`: {what}"), Some(expected), near))
}

fn refuse(title: &str, expected: Option<&str>, nearest: Option<&str>) -> Exit {
    complain(&Message { title: title.to_owned(), expected, nearest, ..Message::default() });
    Exit::Usage
}

/// The text of bytes: UTF-8 or, as older tools write names, Latin-1.
fn decoded(name: &str, bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).unwrap_or_else(|error| {
        complain(&format_args!("warning: {name} is not UTF-8; it is read as Latin-1"));
        error.as_bytes().iter().map(|&byte| char::from(byte)).collect()
    })
}
