//! The engines that a system can be evaluated with: in floating point, in fixed point, and from a compiled table.

use clap::{Args, ValueEnum};
use mm_control::fuzzy::fixed;
use mm_control::fuzzy::{FuzzyError, Inference};
use mm_fis::compile::{CompileError, Q15, Request, Table, TableError, quantized, value_of};
use mm_fis::{Engine, System};

use super::super::complain;

/// What a compiled table is to be.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct TableArgs {
    /// Bits of a knot of a compiled surface, 8 to 16. Default: 16.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=16))]
    pub(super) bits: Option<u32>,
    /// Largest error of a compiled surface, in output units. Default: 2^-10 of half the output's range for one input, 2^-8 for two, there
    /// doubled until it is met.
    #[arg(long, value_name = "ERROR", value_parser = bound, allow_negative_numbers = true)]
    pub(super) bound: Option<f64>,
    /// Bits to which each of two inputs of a compiled surface is rounded, 8 to 12. Default: 10.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(8..=12))]
    pub(super) input_bits: Option<u32>,
    /// Most knots of a compiled surface. Default: 16384.
    #[arg(long, value_name = "N")]
    pub(super) max_knots: Option<usize>,
}

fn bound(text: &str) -> Result<f64, String> {
    let bound = text.parse::<f64>().ok().filter(|bound| *bound > 0.0 && bound.is_finite());
    bound.ok_or_else(|| "expected a number above 0".to_owned())
}

impl TableArgs {
    /// The same for the compiler.
    pub(super) fn request(&self) -> Request {
        Request {
            bound: self.bound,
            bits: self.bits.unwrap_or(16),
            input_bits: self.input_bits.unwrap_or(10),
            max_knots: self.max_knots.unwrap_or(16_384),
        }
    }

    /// The options that were given.
    pub(super) fn given(&self) -> Vec<&'static str> {
        let all = [
            ("--bits", self.bits.is_some()),
            ("--bound", self.bound.is_some()),
            ("--input-bits", self.input_bits.is_some()),
            ("--max-knots", self.max_knots.is_some()),
        ];
        all.into_iter().filter(|(_, is_given)| *is_given).map(|(option, _)| option).collect()
    }
}

/// Warns of options that were given to no effect.
pub(super) fn warn_idle(options: &[&str], needed: &str) {
    if !options.is_empty() {
        let verb = if options.len() == 1 { "matters" } else { "matter" };
        complain(&format_args!("warning: {} {verb} only with `{needed}`", options.join(" and ")));
    }
}

/// A fixed-point engine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Fixed {
    /// The rules in fixed point.
    Q15,
    /// A compiled table.
    Surface,
}

/// Why there is no such engine for a system.
#[derive(Debug, thiserror::Error)]
pub(super) enum EngineError {
    /// The system is refused.
    #[error(transparent)]
    System(#[from] FuzzyError),
    /// It cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// It cannot be compiled to a table; what to ask for instead.
    #[error("{0}{1}")]
    Table(CompileError, String),
    /// A table has one input or two.
    #[error("a compiled surface has one input or two, this system has {0}")]
    Inputs(usize),
}

/// What to ask for instead, where a bound or a number of knots is out of reach.
fn hint(error: &CompileError, inputs: usize, request: &Request) -> String {
    match error {
        CompileError::Bound { reachable, .. } => {
            let mut others = vec!["more knots (--max-knots)"];
            if request.bits < 16 {
                others.push("finer ones (--bits)");
            }
            if inputs > 1 && request.input_bits > 8 {
                others.push("coarser inputs (--input-bits)");
            }
            format!("; ask for less (--bound {reachable:e}), or allow {}", others.join(" or "))
        }
        CompileError::Knots { least, .. } => format!("; allow more (--max-knots {least})"),
        _ => String::new(),
    }
}

/// Something that evaluates all outputs, and says what it met.
pub(super) type Evaluator<'a> = dyn FnMut(&[f64], &mut [f64]) -> Inference + 'a;

/// An evaluator of a floating-point engine.
pub(super) fn float<'a>(engine: &'a Engine<'a>) -> impl FnMut(&[f64], &mut [f64]) -> Inference + 'a {
    let mut workspace = vec![0.0; engine.workspace_len()];
    // The lengths are those of the system, so that nothing is refused.
    move |inputs, outputs| engine.infer(inputs, outputs, &mut workspace).unwrap_or_default()
}

/// Compiles an output of a system; says what to ask for instead where that cannot be met.
pub(super) fn table(system: &System, output: usize, request: &Request) -> Result<Table, EngineError> {
    Table::compile(system, output, request).map_err(|error| match error {
        TableError::System(error) => EngineError::System(error),
        TableError::Inputs(count) => EngineError::Inputs(count),
        TableError::Compile(error) => {
            let hint = hint(&error, system.inputs.len(), request);
            EngineError::Table(error, hint)
        }
    })
}

/// Hands an evaluator in fixed point to `work`; what it meets is what a floating-point engine meets.
pub(super) fn with_fixed<R>(
    system: &System,
    kind: Fixed,
    table: &TableArgs,
    work: impl FnOnce(&mut Evaluator<'_>) -> R,
) -> Result<R, EngineError> {
    match kind {
        Fixed::Q15 => with_q15(system, &Q15::compile(system)?, work),
        Fixed::Surface => {
            let tables = (0..system.outputs.len())
                .map(|output| self::table(system, output, &table.request()))
                .collect::<Result<Vec<_>, _>>()?;
            with_tables(system, &tables, work)
        }
    }
}

/// Evaluates in fixed point between what a floating-point engine says to the inputs.
fn with_float<R>(
    system: &System,
    mut evaluate: impl FnMut(&[i16], &mut [f64]),
    work: impl FnOnce(&mut Evaluator<'_>) -> R,
) -> Result<R, EngineError> {
    let ranges: Vec<(f64, f64)> = system.inputs.iter().map(|input| input.range).collect();
    Ok(system.with_engine(system.best_accuracy(101), |engine| {
        let mut float = float(engine);
        work(&mut |inputs, outputs| {
            let met = float(inputs, outputs);
            if !met.nan {
                let fixed: Vec<i16> =
                    ranges.iter().zip(inputs).map(|(range, x)| quantized(*range, *x)).collect();
                evaluate(&fixed, outputs);
            }
            met
        })
    })?)
}

fn with_q15<R>(
    system: &System,
    rules: &Q15,
    work: impl FnOnce(&mut Evaluator<'_>) -> R,
) -> Result<R, EngineError> {
    rules.with_tables(|tables| {
        let engine = fixed::Engine::try_new(tables)?;
        let mut workspace = vec![0; engine.workspace_len()];
        let mut found = vec![0; rules.output_ranges.len()];
        let evaluate = |inputs: &[i16], outputs: &mut [f64]| {
            // The lengths are those of the system, so that nothing is refused.
            let _met = engine.infer(inputs, &mut found, &mut workspace);
            for (output, (range, q)) in outputs.iter_mut().zip(rules.output_ranges.iter().zip(&found)) {
                *output = value_of(*range, *q);
            }
        };
        with_float(system, evaluate, work)
    })
}

fn with_tables<R>(
    system: &System,
    tables: &[Table],
    work: impl FnOnce(&mut Evaluator<'_>) -> R,
) -> Result<R, EngineError> {
    let evaluate = |inputs: &[i16], outputs: &mut [f64]| {
        for (output, table) in outputs.iter_mut().zip(tables) {
            *output = table.evaluate(inputs);
        }
    };
    with_float(system, evaluate, work)
}
