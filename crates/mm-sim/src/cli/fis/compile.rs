//! `mmsim fis compile`: fixed-point tables for firmware.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use mm_fis::System;
use mm_fis::compile::{self, CompiledSurface, CompiledSurface2, Origin, Q15, Request, Table};

use super::super::{Exit, complain, print};
use super::engines::{self, Evaluator, Fixed, TableArgs};
use super::file::{self, Loaded, STDIN};
use super::{FileArg, counted};
use crate::{shell, whole};

/// Inputs at which a rule engine of one input is compared: all there are.
const ALL: u32 = 1 << 16;

/// What `compile` takes.
#[derive(Debug, Clone, Args)]
pub(in super::super) struct CompileArgs {
    #[command(flatten)]
    file: FileArg,
    /// What to compile to.
    #[arg(long, value_enum, default_value_t = Fixed::Surface)]
    to: Fixed,
    #[command(flatten)]
    table: TableArgs,
    /// Output of the system for a surface, by name or counted from 1; needed where there are several.
    #[arg(long, value_name = "OUTPUT")]
    which: Option<String>,
    /// File for the result, or - for standard output; its ending chooses the language: .rs, .h, .c or .toml. Default: -.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Language of the result. Default: by the file's ending, else Rust.
    #[arg(long, value_enum)]
    lang: Option<Language>,
    /// Name of the constant. Default: made from the name of the system's file.
    #[arg(long)]
    name: Option<String>,
    /// No report on standard error.
    #[arg(long, short)]
    quiet: bool,
}

/// A language that results are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Language {
    /// A constant over the types of `mm_control::fuzzy::fixed`.
    Rust,
    /// A C99 header with a table and an inline function; for surfaces.
    C,
    /// All numbers, for other programs.
    Toml,
}

/// What was compiled.
enum Compiled {
    Rules(Q15),
    Table(Table),
}

/// Compiles.
pub(super) fn compile(args: &CompileArgs) -> Exit {
    compiled(args).unwrap_or_else(|exit| exit)
}

fn refuse(message: &dyn std::fmt::Display) -> Exit {
    complain(&format_args!("error: {message}"));
    Exit::Usage
}

fn compiled(args: &CompileArgs) -> Result<Exit, Exit> {
    let language = language(args)?;
    let loaded = file::load(&args.file.file)?;
    let system = &loaded.system;
    let named = |error: &dyn std::fmt::Display| refuse(&format_args!("{}: {error}", loaded.name));
    let (compiled, report) = match args.to {
        Fixed::Q15 => {
            let mut idle = args.table.given();
            idle.extend(args.which.is_some().then_some("--which"));
            engines::warn_idle(&idle, "--to surface");
            let rules = Q15::compile(system).map_err(|error| named(&error))?;
            let report = if args.quiet { String::new() } else { report_of_rules(system, &args.table) };
            (Compiled::Rules(rules), report)
        }
        Fixed::Surface => {
            let output = which(args, system)?;
            let table =
                engines::table(system, output, &args.table.request()).map_err(|error| named(&error))?;
            let report = report_of_table(system, output, &table, args.table.bound.is_some());
            (Compiled::Table(table), report)
        }
    };
    let text = text(&compiled, language, args, &loaded)?;
    let exit = match args.output.as_ref().filter(|path| path.as_os_str() != STDIN) {
        None => print(text.trim_end()),
        Some(path) => {
            whole::write(path, |out| out.write_all(text.as_bytes())).map_err(|error| {
                complain(&format_args!("error: cannot write {}: {error}", path.display()));
                Exit::Failed
            })?;
            Exit::Done
        }
    };
    if !args.quiet {
        let place = args.output.as_ref().filter(|path| path.as_os_str() != STDIN);
        let begin = place.map_or_else(String::new, |path| format!("{}: ", path.display()));
        complain(&format_args!("{begin}{}", report.trim_end()));
    }
    Ok(exit)
}

/// The language asked for, or that of the file's ending.
fn language(args: &CompileArgs) -> Result<Language, Exit> {
    let Some(path) = args.output.as_ref().filter(|path| path.as_os_str() != STDIN) else {
        return Ok(args.lang.unwrap_or(Language::Rust));
    };
    let ending = path.extension().and_then(std::ffi::OsStr::to_str).unwrap_or("").to_lowercase();
    let by_ending = match ending.as_str() {
        "rs" => Some(Language::Rust),
        "h" | "c" | "hpp" => Some(Language::C),
        "toml" => Some(Language::Toml),
        _ => None,
    };
    match (args.lang, by_ending) {
        (Some(wanted), Some(other)) if wanted != other => Err(refuse(&format_args!(
            "--lang {} contradicts the ending of {}: expected {}",
            wanted.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned()),
            path.display(),
            match wanted {
                Language::Rust => ".rs",
                Language::C => ".h or .c",
                Language::Toml => ".toml",
            }
        ))),
        (wanted, found) => wanted.or(found).ok_or_else(|| {
            refuse(&format_args!(
                "no language is known by the ending of {}: expected .rs, .h, .c or .toml, or --lang",
                path.display()
            ))
        }),
    }
}

/// The output to compile, counted from 0.
fn which(args: &CompileArgs, system: &System) -> Result<usize, Exit> {
    let names = || {
        let names =
            system.outputs.iter().zip(1..).map(|(output, number)| format!("{number} `{}`", output.name));
        names.collect::<Vec<_>>().join(", ")
    };
    let Some(wanted) = &args.which else {
        return if system.outputs.len() == 1 {
            Ok(0)
        } else {
            Err(refuse(&format_args!("a surface has one output; choose with --which: {}", names())))
        };
    };
    let by_name = system.outputs.iter().position(|output| output.name == *wanted);
    let by_number = || wanted.parse::<usize>().ok()?.checked_sub(1).filter(|at| *at < system.outputs.len());
    by_name
        .or_else(by_number)
        .ok_or_else(|| refuse(&format_args!("there is no output `{wanted}`: expected one of {}", names())))
}

fn text(
    compiled: &Compiled,
    language: Language,
    args: &CompileArgs,
    loaded: &Loaded,
) -> Result<String, Exit> {
    let kind = if matches!(compiled, Compiled::Rules(_)) { "q15" } else { "surface" };
    let name = args.name.clone().unwrap_or_else(|| format!("{}_{kind}", loaded.stem));
    let command = command(args);
    let origin = Origin { name: &name, command: &command };
    const ROOT: &str = "mm_control";
    Ok(match (compiled, language) {
        (Compiled::Rules(rules), Language::Rust) => rules.to_rust(&origin, ROOT),
        (Compiled::Rules(rules), Language::Toml) => rules.to_toml(&origin),
        (Compiled::Rules(_), Language::C) => {
            return Err(refuse(&"the Q15 engine is written as Rust or TOML; for C, compile a surface"));
        }
        (Compiled::Table(table), language) => {
            let language = match language {
                Language::Rust => compile::Language::Rust,
                Language::C => compile::Language::C,
                Language::Toml => compile::Language::Toml,
            };
            table.written(language, &origin)
        }
    })
}

/// The command line that makes the same again; the folder of the result is nobody's business.
fn command(args: &CompileArgs) -> String {
    let Request { bits, bound, input_bits, max_knots } = args.table.request();
    let file_name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let input = file_name(Path::new(&args.file.file)).unwrap_or_else(|| args.file.file.clone());
    let mut words: Vec<String> = ["mmsim", "fis", "compile"].map(str::to_owned).into();
    words.push(input);
    if args.to == Fixed::Q15 {
        words.extend(["--to", "q15"].map(str::to_owned));
    } else {
        words.extend(["--bits".to_owned(), bits.to_string()]);
        words.extend(bound.into_iter().flat_map(|bound| ["--bound".to_owned(), bound.to_string()]));
        for (option, value, default) in [
            ("--input-bits", u64::from(input_bits), 10),
            ("--max-knots", u64::try_from(max_knots).unwrap_or(u64::MAX), 16_384),
        ] {
            if value != default {
                words.extend([option.to_owned(), value.to_string()]);
            }
        }
        words.extend(args.which.iter().flat_map(|which| ["--which".to_owned(), which.clone()]));
    }
    let language = args.lang.and_then(|lang| Some(lang.to_possible_value()?.get_name().to_owned()));
    words.extend(language.into_iter().flat_map(|lang| ["--lang".to_owned(), lang]));
    words.extend(args.name.iter().flat_map(|name| ["--name".to_owned(), name.clone()]));
    let output = args.output.as_deref().and_then(file_name);
    words.extend(output.into_iter().flat_map(|output| ["-o".to_owned(), output]));
    shell::command(words.iter().map(String::as_str))
}

fn report_of_table(system: &System, output: usize, table: &Table, is_asked: bool) -> String {
    let name = |variables: &[mm_fis::Variable], at: usize| {
        variables.get(at).map_or_else(String::new, |variable| variable.name.clone())
    };
    let mut out = format!("surface of output `{}`, ", name(&system.outputs, output));
    let _ = match table {
        Table::One(table) => {
            let CompiledSurface { knots, bits, sections, jumps, bound, error, error_at, .. } = table;
            let _ = writeln!(
                out,
                "{} knots of {bits} bits in {} {}, {} bytes{}",
                knots.len(),
                sections.len(),
                if sections.len() == 1 { "section" } else { "sections" },
                table.bytes(),
                if table.odd { ", exactly odd" } else { "" }
            );
            for jump in jumps {
                let _ = writeln!(
                    out,
                    "jump at `{}` = {}: from {} to {}",
                    name(&system.inputs, 0),
                    rounded(jump.at, table.input_range),
                    jump.from,
                    jump.to
                );
            }
            writeln!(
                out,
                "largest error {error:.3e} at `{}` = {error_at}, bound {bound:.3e}, over all 65,536 inputs",
                name(&system.inputs, 0)
            )
        }
        Table::Two(table) => {
            let CompiledSurface2 { knots, bits, input_bits, bound, error, error_at: [x, y], .. } = table;
            let _ = writeln!(
                out,
                "{} knots of {bits} bits, inputs of {input_bits} bits, {} bytes{}",
                knots.len(),
                table.bytes(),
                if table.odd { ", exactly odd" } else { "" }
            );
            writeln!(
                out,
                "largest error {error:.3e} at `{}` = {x}, `{}` = {y}, bound {bound:.3e}{}, over all inputs of {input_bits} bits",
                name(&system.inputs, 0),
                name(&system.inputs, 1),
                if is_asked { String::new() } else { found(*bound, table.output_range) }
            )
        }
    };
    if Table::is_sampled(system) {
        out.push_str("the output sets are curved: the errors are those from sampled centroids\n");
    }
    out
}

/// How a bound that was found and not asked for lies to the range.
fn found(bound: f64, (lo, hi): (f64, f64)) -> String {
    let halvings = (0.5 * (hi - lo) / bound).log2().round();
    format!(" (2^{} of half the output's range)", 0.0 - halvings)
}

/// A place in a range without the digits that halving the interval around it left behind.
fn rounded(at: f64, (lo, hi): (f64, f64)) -> f64 {
    let unit = (hi - lo) / 1_048_576.0 / 1024.0;
    let rounded = format!("{:.9}", (at / unit).round() * unit).parse().unwrap_or(at);
    if (rounded - at).abs() <= unit { rounded + 0.0 } else { at }
}

/// Rules and terms, and the error against the exact engine: as the file says, and with the breakpoints as stored.
fn report_of_rules(system: &System, table: &TableArgs) -> String {
    let mut out = format!(
        "rules in fixed point: {}, {}, {}\n",
        counted(system.inputs.len(), "input"),
        counted(system.outputs.len(), "output"),
        counted(system.rules.len(), "rule")
    );
    let stored = system.as_stored();
    let errors = engines::with_fixed(system, Fixed::Q15, table, |fixed| {
        let against = |other: &System, fixed: &mut Evaluator<'_>| {
            other.with_engine(mm_fis::Accuracy::Exact, |engine| {
                worst(system, fixed, &mut engines::float(engine))
            })
        };
        Ok::<_, mm_control::fuzzy::FuzzyError>((against(&stored, fixed)?, against(system, fixed)?))
    });
    let Ok(Ok((engine, whole))) = errors else { return out };
    for (number, output) in system.outputs.iter().enumerate() {
        let of = |errors: &[f64]| errors.get(number).copied().unwrap_or(0.0);
        let unit = 0.5 * (output.range.1 - output.range.0) / 32768.0;
        let _ = writeln!(
            out,
            "output `{}`: largest error {:.3e} ({:.2} units of the last place) with its breakpoints as stored, \
             {:.3e} ({:.2}) with those of the file, over {}",
            output.name,
            of(&engine),
            of(&engine) / unit,
            of(&whole),
            of(&whole) / unit,
            if system.inputs.len() == 1 { "all 65,536 inputs" } else { "65,536 points" }
        );
    }
    out
}

/// The largest difference of each output between two engines: over all inputs of one number, or over scattered points of several.
fn worst(system: &System, one: &mut Evaluator<'_>, other: &mut Evaluator<'_>) -> Vec<f64> {
    let count = system.outputs.len();
    let (mut left, mut right, mut errors) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    // A step of its own for each input, odd, so that each takes on all its values.
    const STEPS: [u32; 4] = [1, 25_717, 40_503, 13_849];
    for k in 0..ALL {
        let number = |(at, input): (usize, &mm_fis::Variable)| {
            let step = STEPS
                .get(at % STEPS.len())
                .copied()
                .unwrap_or(1)
                .wrapping_add(2 * u32::try_from(at / 4).unwrap_or(0));
            let (lo, hi) = input.range;
            let (middle, half) = (0.5 * lo + 0.5 * hi, 0.5 * hi - 0.5 * lo);
            middle + half * ((f64::from(k.wrapping_mul(step) % ALL) - 32768.0) / 32768.0)
        };
        let inputs: Vec<f64> = system.inputs.iter().enumerate().map(number).collect();
        let _ = (one(&inputs, &mut left), other(&inputs, &mut right));
        for (error, (a, b)) in errors.iter_mut().zip(left.iter().zip(&right)) {
            *error = f64::max(*error, (a - b).abs());
        }
    }
    errors
}
