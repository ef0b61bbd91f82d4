//! The keys of a section.

use std::collections::{HashMap, HashSet};

use super::lines::{Entry, Section, entry};
use super::names::{count, look_up};
use super::scan::{Scanner, ends, number};
use crate::read::{Piece, Report};

/// The keys of a section that are known, by their names in lower case, and its numbered ones.
#[derive(Debug)]
pub(super) struct Keys<'a> {
    named: HashMap<String, Entry<'a>>,
    /// `MF1`, `MF2`, ... by their numbers.
    pub(super) numbered: Vec<(usize, Entry<'a>)>,
}

impl<'a> Keys<'a> {
    /// Sorts the lines of a section by their keys; unknown and repeated ones are reported.
    pub(super) fn new(section: &Section<'a>, known: &[&str], numbered: &str, report: &mut Report) -> Self {
        let mut keys = Self { named: HashMap::new(), numbered: Vec::new() };
        let mut numbers: HashSet<usize> = HashSet::new();
        let prefix = numbered.to_lowercase();
        for line in &section.lines {
            let Some(entry) = entry(*line, report) else { continue };
            let key = entry.key.text.to_lowercase();
            let number = key.strip_prefix(&prefix).filter(|_| !prefix.is_empty()).and_then(whole);
            let fresh = if let Some(number) = number {
                let fresh = numbers.insert(number);
                if fresh {
                    keys.numbered.push((number, entry));
                }
                fresh
            } else if known.iter().any(|known| known.eq_ignore_ascii_case(&key)) {
                keys.named.insert(key, entry).is_none()
            } else {
                let mut listed = known.to_vec();
                let first = format!("{numbered}1");
                if !numbered.is_empty() {
                    listed.push(&first);
                }
                report.add_unknown(entry.key, &format!("unknown key in {}:", section.header.text), &listed);
                continue;
            };
            if !fresh {
                report.add(entry.key, format!("{} is there twice", entry.key.shown()));
            }
        }
        keys.numbered.sort_by_key(|(number, _)| *number);
        keys
    }

    pub(super) fn get(&self, key: &str) -> Option<Entry<'a>> {
        self.named.get(&key.to_lowercase()).copied()
    }

    /// The text of a key: in quotes or bare.
    pub(super) fn text(&self, key: &str, report: &mut Report) -> Option<(String, Piece<'a>)> {
        let mut scanner = Scanner::new(self.get(key)?.value);
        let word = scanner.word(ends, report)?;
        scanner.finish(report)?;
        Some(word)
    }

    /// What the name that a key gives means; `default` where the key is not there.
    pub(super) fn name<T: Copy>(
        &self,
        key: &str,
        what: &str,
        names: &[(&'static str, bool, T)],
        default: T,
        report: &mut Report,
    ) -> Option<T> {
        if self.get(key).is_none() {
            return Some(default);
        }
        let (text, place) = self.text(key, report)?;
        look_up((&text, place), what, names, report)
    }

    /// Checks a count against what is there.
    pub(super) fn counts(&self, key: &str, there: usize, what: &str, report: &mut Report) {
        let Some(entry) = self.get(key) else { return };
        let mut scanner = Scanner::new(entry.value);
        let Some((text, place)) = scanner.word(ends, report) else { return };
        if scanner.finish(report).is_none() {
            return;
        }
        let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
        if !digits {
            report.add_found(place, "a whole number");
        } else if whole(&text) != Some(there) {
            let be = if there == 1 { "is" } else { "are" };
            let there = count(there, what);
            report.add(place, format!("{} is {}, but there {be} {there}", entry.key.text, place.text));
        }
    }

    /// A single number.
    pub(super) fn number(&self, key: &str, report: &mut Report) -> Option<super::scan::Number<'a>> {
        let mut scanner = Scanner::new(self.get(key)?.value);
        let (_, word) = scanner.word(ends, report)?;
        scanner.finish(report)?;
        number(word, report)
    }
}

/// A whole number without a sign.
fn whole(text: &str) -> Option<usize> {
    let digits = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    text.parse().ok().filter(|_| digits)
}
