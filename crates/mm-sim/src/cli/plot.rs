//! `mmsim plot`: figures of logs as SVG or PNG.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::report::{read, write};
use super::{Exit, complain, print};
use crate::figures::{Kind, Recording, Run, png};
use crate::report::names;

/// The name that stands for all kinds, each in a file of its own.
const ALL: &str = "all";

#[derive(Debug, Clone, Args)]
pub(super) struct PlotArgs {
    /// Logs, each a run to show beside the others.
    #[arg(value_name = "RUN.mcap", required = true)]
    logs: Vec<PathBuf>,
    /// File of the figure, its kind by the extension: .svg or .png.
    #[arg(short, long, value_name = "FILE", value_parser = picture)]
    output: PathBuf,
    /// What to show; `all` writes a file for each, its name after a hyphen.
    #[arg(long, value_name = "KIND", default_value = "overview", value_parser = kinds())]
    figure: String,
    /// Pixels of a PNG for each of the figure's own: 3 are 288 dots per inch.
    #[arg(long, value_name = "N", default_value = "3", value_parser = scale)]
    scale: f32,
    /// Title instead of the scenario's name.
    #[arg(long)]
    title: Option<String>,
}

/// The kinds of figure that can be asked for.
fn kinds() -> PossibleValuesParser {
    Kind::ALL.map(|(_, name)| name).into_iter().chain([ALL]).collect::<Vec<_>>().into()
}

fn picture(path: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(path);
    if is_png(&path) || extension(&path) == "svg" {
        Ok(path)
    } else {
        Err("expected a name that ends in .svg or .png".to_owned())
    }
}

fn scale(text: &str) -> Result<f32, String> {
    let value = text.parse().ok().filter(|value| (0.1..=20.0).contains(value));
    value.ok_or_else(|| "expected a number from 0.1 to 20".to_owned())
}

fn extension(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

fn is_png(path: &Path) -> bool {
    extension(path) == "png"
}

/// Reads the logs and draws what was asked for.
pub(super) fn plot(args: &PlotArgs) -> Exit {
    let logs = match read(&args.logs) {
        Ok(logs) => logs,
        Err(exit) => return exit,
    };
    let recordings: Vec<Recording> = logs.iter().map(Recording::of_log).collect();
    let names = names(&logs);
    let runs: Vec<Run<'_>> = names.iter().zip(&recordings).map(|(name, data)| Run { name, data }).collect();
    let scenario = logs.first().map_or("", |log| log.says("scenario"));
    let only = if let [name] = names.as_slice() { format!(" ({name})") } else { String::new() };
    let title = args.title.clone().unwrap_or_else(|| format!("{scenario}{only}"));
    let mut exit = Exit::Done;
    for (kind, name) in Kind::ALL {
        let path = match args.figure.as_str() {
            ALL => with_name(&args.output, name),
            wanted if wanted == name => args.output.clone(),
            _ => continue,
        };
        exit = exit.max(draw(kind, &title, &runs, (&path, args.scale)));
    }
    exit
}

/// The path with a name before its extension.
fn with_name(path: &Path, name: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{name}.{}", extension(path)))
}

fn draw(kind: Kind, title: &str, runs: &[Run<'_>], (path, scale): (&Path, f32)) -> Exit {
    let fail = |error: &dyn core::fmt::Display| {
        complain(&format_args!("error: {}: {error}", path.display()));
        Exit::Failed
    };
    let svg = match kind.page(title, runs).to_svg() {
        Ok(svg) => svg,
        Err(error) => return fail(&error),
    };
    let bytes = if is_png(path) {
        match png(&svg, scale) {
            Ok(bytes) => bytes,
            Err(error) => return fail(&error),
        }
    } else {
        svg.into_bytes()
    };
    match write(path, &bytes) {
        Ok(()) => print(&path.display().to_string()),
        Err(exit) => exit,
    }
}
