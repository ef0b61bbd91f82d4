//! `mmsim fis plot`: a picture of a fuzzy system.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use mm_control::fuzzy::{FuzzyError, MembershipFunction};
use mm_fis::check::{Course, along};
use mm_fis::{Shape, System, Variable};

use super::super::{Exit, complain, print};
use super::FileArg;
use super::engines::{self, EngineError, Fixed, TableArgs};
use super::file::{self, Loaded};
use crate::figures::fuzzy::{Break, FuzzyPage, Map, Overlay, Response, Sets, Term};
use crate::whole;

/// Points of a membership function, besides those at its breakpoints.
const POINTS: u32 = 400;
/// Distance to the side of a breakpoint, in the range.
const SIDE: f64 = 1e-9;
/// Samples of an output set in a cell of a map, where an exact centroid is not to be had.
const SAMPLES: u32 = 401;

/// Points of a curve as a fixed-point engine has it, and the part of the range from which a step between two of them is a jump.
const CELLS_OF_OVERLAY: u32 = 8192;
const LARGEST_STEP: f64 = 0.02;

/// What `plot` takes.
#[derive(Debug, Clone, Args)]
pub(in super::super) struct PlotArgs {
    #[command(flatten)]
    file: FileArg,
    /// File for the picture, or - for standard output. Default: NAME.svg here.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Inputs to vary, by name or counted from 1: one for curves, two for maps; the others stay in the middle. Default: the first two.
    #[arg(long, value_name = "INPUT[,INPUT]", value_delimiter = ',')]
    inputs: Vec<String>,
    /// Draw curves as a fixed-point engine has them as well.
    #[arg(long, value_enum, value_name = "ENGINE")]
    overlay: Option<Fixed>,
    #[command(flatten)]
    table: TableArgs,
}

/// Draws.
pub(super) fn plot(args: &PlotArgs) -> Exit {
    drawn(args).unwrap_or_else(|exit| exit)
}

fn drawn(args: &PlotArgs) -> Result<Exit, Exit> {
    check_ending(args.output.as_deref())?;
    if args.overlay != Some(Fixed::Surface) {
        engines::warn_idle(&args.table.given(), "--overlay surface");
    }
    let loaded = file::load(&args.file.file)?;
    let axes = axes(args, &loaded.system)?;
    let refuse = |error: &dyn std::fmt::Display| {
        complain(&format_args!("error: {}: {error}", loaded.name));
        Exit::Usage
    };
    let mut page = page(&loaded, &axes).map_err(|error| refuse(&error))?;
    match (args.overlay, axes.as_slice()) {
        (None, _) => {}
        (Some(engine), [axis]) => {
            lay_over(&mut page, &loaded.system, *axis, (engine, &args.table))
                .map_err(|error| refuse(&error))?;
        }
        (Some(_), _) => return Err(refuse(&"--overlay is for curves: choose one input with --inputs")),
    }
    let svg = page.to_svg().map_err(|error| {
        complain(&format_args!("error: {error}"));
        Exit::Failed
    })?;
    let path = args.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.svg", loaded.stem)));
    if path.as_os_str() == file::STDIN {
        return Ok(print(svg.trim_end()));
    }
    whole::write(&path, |out| out.write_all(svg.as_bytes())).map_err(|error| {
        complain(&format_args!("error: cannot write {}: {error}", path.display()));
        Exit::Failed
    })?;
    Ok(print(&format!("picture in {}", path.display())))
}

/// Refuses the ending of another kind of picture.
fn check_ending(path: Option<&Path>) -> Result<(), Exit> {
    let Some(path) = path else { return Ok(()) };
    match path.extension() {
        Some(ending) if !ending.eq_ignore_ascii_case("svg") => {
            complain(&format_args!(
                "error: pictures are written as SVG, not as {}: expected a name that ends in .svg, or -",
                path.display()
            ));
            Err(Exit::Usage)
        }
        _ => Ok(()),
    }
}

/// The inputs to vary, counted from 0: one or two.
fn axes(args: &PlotArgs, system: &System) -> Result<Vec<usize>, Exit> {
    let count = system.inputs.len();
    let refuse = |message: String| {
        complain(&format_args!("error: {message}"));
        Exit::Usage
    };
    if args.inputs.is_empty() {
        return Ok((0..count.min(2)).collect());
    }
    let axis = |wanted: &String| {
        let by_name = system.inputs.iter().position(|input| input.name == *wanted);
        let by_number = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|axis| *axis < count);
        by_name.or_else(by_number).ok_or_else(|| {
            let names =
                system.inputs.iter().zip(1..).map(|(input, number)| format!("{number} `{}`", input.name));
            let names = names.collect::<Vec<_>>().join(", ");
            refuse(format!("there is no input `{wanted}`: expected one of {names} in --inputs"))
        })
    };
    let axes = args.inputs.iter().map(axis).collect::<Result<Vec<_>, _>>()?;
    if axes.len() > 2 || axes.first() == axes.get(1) {
        return Err(refuse("expected one input or two different ones in --inputs".to_owned()));
    }
    Ok(axes)
}

/// A name that a file of pictures can hold.
fn clean(name: &str) -> String {
    name.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

fn page(Loaded { name, system, .. }: &Loaded, axes: &[usize]) -> Result<FuzzyPage, FuzzyError> {
    let title = if system.name.is_empty() { name } else { &system.name };
    let inputs = system.inputs.iter().map(|input| sets(input, "input", &[]));
    let names: Vec<String> = system.inputs.iter().map(|input| clean(&input.name)).collect();
    let outputs = system.outputs.iter().map(|output| sets(output, "output", &names));
    let mut page = FuzzyPage {
        title: format!("Fuzzy system {}", clean(title)),
        sets: inputs.chain(outputs).collect(),
        responses: Vec::new(),
        maps: Vec::new(),
    };
    match *axes {
        [axis] => {
            for output in 0..system.outputs.len() {
                page.responses.extend(response(system, axis, output)?);
            }
        }
        [across, up] => page.maps = maps(system, (across, up))?,
        _ => {}
    }
    Ok(page)
}

fn sets(variable: &Variable, role: &str, inputs: &[String]) -> Sets {
    let term = |term: &mm_fis::Term| {
        let name = clean(&term.name);
        match &term.shape {
            Shape::Set(set) => {
                let points = degrees(set, variable.range);
                Term::Set(name, highest(&points), points)
            }
            Shape::Constant(value) => Term::Number(name, *value),
            Shape::Linear(factors) => Term::Words(format!("{name} = {}", linear(factors, inputs))),
        }
    };
    Sets {
        title: format!("{role}: {}", clean(&variable.name)),
        range: variable.range,
        terms: variable.terms.iter().map(term).collect(),
    }
}

/// `2 x - 3 y + 1`.
fn linear(factors: &[f64], inputs: &[String]) -> String {
    let mut words = String::new();
    for (number, factor) in factors.iter().enumerate() {
        let sign = if factor.is_sign_negative() { '-' } else { '+' };
        if words.is_empty() {
            words.extend((sign == '-').then_some("-"));
        } else {
            words.push_str(&format!(" {sign} "));
        }
        words.push_str(&factor.abs().to_string());
        words.extend(inputs.get(number).map(|name| format!(" {name}")));
    }
    words
}

/// The degrees over a range, with both sides of each breakpoint.
fn degrees(set: &MembershipFunction<f64>, (lo, hi): (f64, f64)) -> Vec<[f64; 2]> {
    let mut places: Vec<f64> =
        (0..=POINTS).map(|k| lo + (hi - lo) * (f64::from(k) / f64::from(POINTS))).collect();
    for &at in set.parameters() {
        places.extend([at - SIDE * (hi - lo), at, at + SIDE * (hi - lo)]);
    }
    places.retain(|x| *x >= lo && *x <= hi);
    places.sort_by(f64::total_cmp);
    let points: Vec<[f64; 2]> = places.into_iter().map(|x| [x, set.degree(x)]).collect();
    // What lies on a line between its neighbours is no corner.
    let is_level = |a: f64, b: f64| (a - b).abs() <= 1e-12;
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for (at, point) in points.iter().enumerate() {
        let is_inner = kept.last().is_some_and(|last| is_level(last[1], point[1]))
            && points.get(at + 1).is_some_and(|next| is_level(next[1], point[1]));
        if !is_inner {
            kept.push(*point);
        }
    }
    kept
}

/// The middle of where the degree is largest.
fn highest(points: &[[f64; 2]]) -> f64 {
    let most = points.iter().map(|[_, degree]| *degree).fold(0.0, f64::max);
    let mut top = points.iter().filter(|[_, degree]| *degree >= most - 1e-9).map(|[x, _]| *x);
    let first = top.next().unwrap_or(0.0);
    0.5 * first + 0.5 * top.next_back().unwrap_or(first)
}

/// The middle of every input.
fn middles(system: &System) -> Vec<f64> {
    system.inputs.iter().map(|input| 0.5 * input.range.0 + 0.5 * input.range.1).collect()
}

/// Where the inputs that stay are: ` (food = 5)`.
fn held(system: &System, varied: &[usize]) -> String {
    let rest = system.inputs.iter().zip(middles(system)).enumerate().filter(|(at, _)| !varied.contains(at));
    let words: Vec<String> = rest.map(|(_, (input, at))| format!("{} = {at}", clean(&input.name))).collect();
    if words.is_empty() { String::new() } else { format!(" ({})", words.join(", ")) }
}

fn response(system: &System, axis: usize, output: usize) -> Result<Option<Response>, FuzzyError> {
    let (Some(input), Some(variable)) = (system.inputs.get(axis), system.outputs.get(output)) else {
        return Ok(None);
    };
    let Course { points, jumps } = along(system, output, axis, &middles(system))?;
    let breaks = jumps.iter().map(|jump| Break {
        at: jump.inputs.get(axis).copied().unwrap_or(0.0),
        values: [jump.left, jump.value, jump.right],
    });
    let (x, y) = (clean(&input.name), clean(&variable.name));
    Ok(Some(Response {
        title: format!("{y} over {x}{}", held(system, &[axis])),
        x: (x, input.range),
        y,
        points: points.into_iter().map(|(x, y)| [x, y]).collect(),
        breaks: breaks.collect(),
        overlay: None,
    }))
}

/// Draws every curve a second time, as a fixed-point engine has it.
fn lay_over(
    page: &mut FuzzyPage,
    system: &System,
    axis: usize,
    (engine, table): (Fixed, &TableArgs),
) -> Result<(), EngineError> {
    let Some(input) = system.inputs.get(axis) else { return Ok(()) };
    let (lo, hi) = input.range;
    let name = if engine == Fixed::Q15 { "fixed-point rules" } else { "compiled surface" };
    let mut overlays = vec![Overlay { name: name.to_owned(), parts: vec![Vec::new()] }; system.outputs.len()];
    engines::with_fixed(system, engine, table, |evaluate| {
        let (mut inputs, mut outputs) = (middles(system), vec![0.0; system.outputs.len()]);
        for k in 0..=CELLS_OF_OVERLAY {
            let x = lo + (hi - lo) * (f64::from(k) / f64::from(CELLS_OF_OVERLAY));
            if let Some(slot) = inputs.get_mut(axis) {
                *slot = x;
            }
            let _met = evaluate(&inputs, &mut outputs);
            for ((overlay, y), output) in overlays.iter_mut().zip(&outputs).zip(&system.outputs) {
                let largest_step = LARGEST_STEP * (output.range.1 - output.range.0);
                let last = overlay.parts.last().and_then(|part| part.last());
                if last.is_some_and(|[_, before]| (y - before).abs() > largest_step) {
                    overlay.parts.push(Vec::new());
                }
                overlay.parts.last_mut().into_iter().for_each(|part| part.push([x, *y]));
            }
        }
    })?;
    for (response, overlay) in page.responses.iter_mut().zip(overlays) {
        response.overlay = Some(overlay);
    }
    Ok(())
}

fn maps(system: &System, (across, up): (usize, usize)) -> Result<Vec<Map>, FuzzyError> {
    let (Some(x), Some(y)) = (system.inputs.get(across), system.inputs.get(up)) else {
        return Ok(Vec::new());
    };
    let mut maps: Vec<Map> = system
        .outputs
        .iter()
        .map(|output| Map {
            title: format!(
                "{} over {} and {}{}",
                clean(&output.name),
                clean(&x.name),
                clean(&y.name),
                held(system, &[across, up])
            ),
            x: (clean(&x.name), x.range),
            y: (clean(&y.name), y.range),
            z: clean(&output.name),
            rows: Vec::new(),
        })
        .collect();
    let mut inputs = middles(system);
    let middle = |(lo, hi): (f64, f64), cell: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a hundred cells")]
        let part = (cell as f64 + 0.5) / Map::CELLS as f64;
        lo + part * (hi - lo)
    };
    let fill = |engine: &mm_fis::Engine<'_>| {
        let mut workspace = vec![0.0; engine.workspace_len()];
        let mut outputs = vec![0.0; system.outputs.len()];
        for row in 0..Map::CELLS {
            maps.iter_mut().for_each(|map| map.rows.push(Vec::with_capacity(Map::CELLS)));
            for cell in 0..Map::CELLS {
                for (axis, value) in [(across, middle(x.range, cell)), (up, middle(y.range, row))] {
                    if let Some(slot) = inputs.get_mut(axis) {
                        *slot = value;
                    }
                }
                let _met = engine.infer(&inputs, &mut outputs, &mut workspace)?;
                for (map, value) in maps.iter_mut().zip(&outputs) {
                    map.rows.last_mut().into_iter().for_each(|row| row.push(*value));
                }
            }
        }
        Ok(maps)
    };
    system.with_engine(system.best_accuracy(SAMPLES), fill)?
}
