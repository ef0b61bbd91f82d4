//! The file of points that `trajectory.file` names, CSV or TOML, put in the place of `trajectory.points_m`.

use std::path::Path;

use super::diagnostic::{Problem, ScenarioError, Source};
use super::tree::{Entry, Node, Place, Value};
use super::{Files, check, linked, parse, schema};

const KEY: &str = "trajectory.file";

/// The header of a CSV file.
const COLUMNS: [&str; 3] = ["x_m", "y_m", "z_m"];

/// Longest value that a message quotes.
const MAX_QUOTE: usize = 40;

/// Reads the points; each keeps its place in the file, so that later messages point there.
pub(super) fn file(
    root: &mut Node,
    sources: &mut Vec<Source>,
    files: &Files<'_>,
    problems: &mut Vec<Problem>,
) -> Result<(), ScenarioError> {
    let Some(key) = root.find(KEY) else { return Ok(()) };
    let Some(name) = key.as_str() else { return Ok(()) };
    let is_waypoints = root.find("trajectory.kind").and_then(Node::as_str) == Some("waypoints");
    if !is_waypoints || root.find("trajectory.points_m").is_some() {
        return Ok(()); // reported already
    }
    let extension = Path::new(name).extension().map(|extension| extension.to_ascii_lowercase());
    let format = match extension.as_deref().and_then(std::ffi::OsStr::to_str) {
        Some("csv") => "CSV",
        Some("toml") => "TOML",
        _ => {
            let message = format!("found \"{name}\", a file of unknown format");
            problems.push(Problem::new(KEY, message, key.place.clone()).expected("a `.csv` or `.toml` file"));
            return Ok(());
        }
    };
    let source = sources.len();
    match linked(key, name, (sources, files), format) {
        Ok(linked) => sources.push(linked),
        Err(message) => {
            problems.push(Problem::new(KEY, message, key.place.clone()).expected("a file of points"));
            return Ok(());
        }
    }
    let points = if format == "TOML" {
        let mut tree = parse(sources, source, &schema::WAYPOINTS)?;
        problems.extend(check::check(sources, &schema::WAYPOINTS, &tree));
        match &mut tree.value {
            Value::Table(entries) => entries.remove("points_m").map(|entry| entry.node),
            _ => None,
        }
    } else {
        let text = sources.last().map_or("", |source| source.text.as_str());
        csv(source, text).map_err(|found| problems.extend(found)).ok()
    };
    if let (Some(points), Value::Table(entries)) = (points, &mut root.value)
        && let Some(Value::Table(trajectory)) =
            entries.get_mut("trajectory").map(|entry| &mut entry.node.value)
    {
        let key = points.place.clone();
        trajectory.insert("points_m".to_owned(), Entry { key, node: points });
    }
    Ok(())
}

fn problem(message: String, place: Place, expected: &str) -> Problem {
    Problem::new(KEY, message, place).expected(expected)
}

/// What was found, for a message.
fn quoted(what: &str, shown: &str) -> String {
    match shown.chars().count() {
        0 => "found nothing".to_owned(),
        1..=MAX_QUOTE => format!("found {what}`{shown}`"),
        _ => "found a long text".to_owned(),
    }
}

/// The points of a CSV text: a header, then three numbers a line; blank lines count for nothing.
fn csv(source: usize, text: &str) -> Result<Node, Vec<Problem>> {
    let mut rows = lines(text).filter(|(_, line)| !line.trim().is_empty());
    let (start, line) = rows.next().unwrap_or((0, ""));
    let header = Place { source, span: start..start + line.len() };
    if !line.split(',').map(str::trim).eq(COLUMNS) {
        return Err(vec![problem(quoted("the header ", line.trim()), header, "the header `x_m,y_m,z_m`")]);
    }
    let mut problems = Vec::new();
    let mut points = Vec::new();
    for (start, line) in rows {
        match point(source, start, line) {
            Ok(point) => points.push(point),
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() && points.len() < 2 {
        let message = format!("found {} of at least 2 points", points.len());
        problems.push(problem(message, header.clone(), "2 lines of numbers or more"));
    }
    if problems.is_empty() { Ok(Node { value: Value::Array(points), place: header }) } else { Err(problems) }
}

/// The point of a line that starts at a byte of the text.
fn point(source: usize, start: usize, line: &str) -> Result<Node, Vec<Problem>> {
    let place = |from: usize, text: &str| {
        let first = from + text.len() - text.trim_start().len();
        Place { source, span: first..first + text.trim().len() }
    };
    let columns = line.split(',').count();
    if columns != COLUMNS.len() {
        let plural = if columns == 1 { "" } else { "s" };
        let message = format!("found {columns} column{plural}");
        return Err(vec![problem(message, place(start, line), "3 columns, `x_m,y_m,z_m`")]);
    }
    let mut coordinates = Vec::with_capacity(columns);
    let mut problems = Vec::new();
    let mut next = start;
    for field in line.split(',') {
        let place = place(next, field);
        next += field.len() + 1;
        match field.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => coordinates.push(Node { value: Value::Float(value), place }),
            _ => problems.push(problem(quoted("", field.trim()), place, "a finite number")),
        }
    }
    let value = Value::Array(coordinates);
    if problems.is_empty() { Ok(Node { value, place: place(start, line) }) } else { Err(problems) }
}

/// The lines of a text, each with the byte it starts at, without line ends and a byte order mark.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let body = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut next = text.len() - body.len();
    body.split_inclusive('\n').map(move |line| {
        let start = next;
        next += line.len();
        (start, line.trim_end_matches(['\r', '\n']))
    })
}
