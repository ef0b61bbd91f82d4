//! The figures of the catalogue, into files.

use std::io::Write as _;
use std::path::Path;

use super::catalogue::Figure;
use super::files::write;
use super::report::FigureFile;
use super::work::ReproduceError;
use crate::figures::{Kind, Run};

/// Draws a figure of some runs, whose data are in the given files, into the folder; gives its text too.
pub(super) fn draw(
    figure: &'static Figure,
    runs: &[Run<'_>],
    data: Vec<String>,
    out: &Path,
) -> Result<(FigureFile, String), ReproduceError> {
    let page = figure.kind.page(title(figure, runs), runs);
    let svg = page.to_svg().map_err(|source| ReproduceError::Figure { number: figure.number, source })?;
    let path = format!("figures/figure-{}.svg", figure.number);
    write(&out.join(&path), |file| file.write_all(svg.as_bytes()))?;
    Ok((FigureFile { figure: figure.number, caption: figure.caption, svg: path, data }, svg))
}

fn title(figure: &Figure, runs: &[Run<'_>]) -> String {
    let law = match runs {
        [only] if only.name != "none" && figure.kind != Kind::Disturbance => format!(" ({})", only.name),
        _ => String::new(),
    };
    if figure.number.starts_with(|c: char| c.is_ascii_digit()) {
        format!("Figure {}: {}{law}", figure.number, figure.caption)
    } else {
        format!("{}{law}", figure.caption)
    }
}
