//! The fuzzy system that `controller.fis` names.

use super::diagnostic::{Problem, Source};
use super::tree::{Node, Place};
use super::{Files, linked};

const KEY: &str = "controller.fis";

/// Reads the system: a file or, for a name without a directory that is none, a bundled one.
pub(super) fn file(
    root: &Node,
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Option<mm_fis::System> {
    let key = root.find(KEY)?;
    let name = key.as_str()?;
    let source = sources.len();
    let read =
        linked(key, name, (sources, files), ".fis").or_else(|message| match mm_fis::bundled_text(name) {
            Some(text) => Ok(Source::new(name, text)),
            None => Err(message),
        });
    match read {
        Ok(read) => sources.push(read),
        Err(message) => {
            let expected = "a `.fis` or `.fcl` file, or one of the bundled `thesis`, `smooth`";
            problems.push(Problem::new(KEY, message, key.place.clone()).expected(expected));
            return None;
        }
    }
    let text = sources.last().map_or("", |source| source.text.as_str());
    match mm_fis::read(name, text) {
        Ok(document) => Some(document.system),
        Err(error) => {
            problems.extend(error.problems().iter().map(|problem| {
                let place = Place { source, span: problem.span() };
                let found = Problem::new(KEY, problem.message(), place).nearest(problem.nearest());
                match problem.expected() {
                    Some(expected) => found.expected(expected),
                    None => found,
                }
            }));
            None
        }
    }
}
