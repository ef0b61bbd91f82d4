//! From text to sections, and to keys with values.

use std::collections::HashSet;

use crate::read::{Piece, Report};

/// What a section describes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Topic {
    System,
    Input(usize),
    Output(usize),
    Rules,
}

/// A section: its header and its lines that are neither blank nor comments.
#[derive(Debug)]
pub(super) struct Section<'a> {
    pub(super) topic: Topic,
    /// `[Input1]`
    pub(super) header: Piece<'a>,
    pub(super) lines: Vec<Piece<'a>>,
}

/// A line `key = value`; the value may have a comment behind it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry<'a> {
    pub(super) key: Piece<'a>,
    pub(super) value: Piece<'a>,
}

const TOPICS: [&str; 4] = ["System", "Input1", "Output1", "Rules"];

/// Splits a text into its sections.
pub(super) fn sections<'a>(text: &'a str, report: &mut Report) -> Vec<Section<'a>> {
    let mut sections: Vec<Section<'a>> = Vec::new();
    let mut known: HashSet<Topic> = HashSet::new();
    // Lines of a section that was refused; none of them is worth a message of its own.
    let mut skipping = false;
    for line in lines(text) {
        let line = line.trim();
        if line.is_empty() || starts_comment(line.text) {
            continue;
        }
        if line.text.starts_with('[') {
            let Some((header, topic)) = topic(line, report) else {
                skipping = true;
                continue;
            };
            skipping = !known.insert(topic);
            if skipping {
                report.add(header, format!("{} is there twice", header.shown()));
            } else {
                sections.push(Section { topic, header, lines: Vec::new() });
            }
        } else if let (Some(section), false) = (sections.last_mut(), skipping) {
            section.lines.push(line);
        } else if !skipping {
            report.add_expected(line, "text before the first section", "`[System]`");
            skipping = true;
        }
    }
    sections
}

/// The lines of a text, which LF, CR LF or CR may end, without a byte order mark.
fn lines(text: &str) -> impl Iterator<Item = Piece<'_>> {
    let bare = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut start = text.len() - bare.len();
    bare.split(['\n', '\r']).map(move |line| {
        let piece = Piece::new(line, start);
        start += line.len() + 1;
        piece
    })
}

/// Whether a comment begins here.
pub(super) fn starts_comment(text: &str) -> bool {
    text.starts_with(['%', '#']) || text.starts_with("//")
}

/// A line up to its comment, for lines in which nothing is quoted.
pub(super) fn without_comment(line: Piece<'_>) -> Piece<'_> {
    let ends = [line.text.find(['%', '#']), line.text.find("//")];
    let end = ends.into_iter().flatten().min().unwrap_or(line.text.len());
    line.split_at(end).0.trim_end()
}

fn topic<'a>(line: Piece<'a>, report: &mut Report) -> Option<(Piece<'a>, Topic)> {
    let header = without_comment(line);
    let Some(name) = header.text.strip_prefix('[').and_then(|name| name.strip_suffix(']')) else {
        report.add_expected(header, format!("section {}", header.shown()), "a header such as `[Input1]`");
        return None;
    };
    let word: String = name.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect();
    let number = |prefix: &str| word.strip_prefix(prefix)?.parse::<usize>().ok().filter(|&number| number > 0);
    let topic = match word.as_str() {
        "system" => Some(Topic::System),
        "rules" => Some(Topic::Rules),
        _ => number("input").map(Topic::Input).or_else(|| number("output").map(Topic::Output)),
    };
    if topic.is_none() {
        let inside = header.split_at(1).1;
        let inside = inside.split_at(inside.text.len() - 1).0.trim();
        report.add_unknown(inside, "unknown section", &TOPICS);
    }
    topic.map(|topic| (header, topic))
}

/// Splits a line at its `=`.
pub(super) fn entry<'a>(line: Piece<'a>, report: &mut Report) -> Option<Entry<'a>> {
    let Some(at) = line.text.find('=').filter(|&at| without_comment(line).text.len() > at) else {
        report.add_expected(line, format!("found {}", without_comment(line).shown()), "`key=value`");
        return None;
    };
    let (key, rest) = line.split_at(at);
    Some(Entry { key: key.trim(), value: rest.split_at(1).1.trim() })
}
