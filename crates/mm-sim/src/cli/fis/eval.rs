//! `mmsim fis eval`: inputs in, outputs out.

use std::io::{BufRead as _, BufWriter, Write};

use clap::{Args, ValueEnum};
use mm_control::fuzzy::{FuzzyError, Inference, Sampling};
use mm_fis::{Accuracy, Defuzzification, Kind, System};
use serde_json::{Value, json};

use super::super::{Exit, complain};
use super::engines::{self, EngineError, Evaluator, Fixed, TableArgs};
use super::file::{self, STDIN};
use super::{FileArg, Places};

/// Samples where an exact centroid is not to be had.
const FINE: u32 = 10_001;

/// Said where they are given in vain.
const SAMPLES_IDLE: &str = "warning: --points and --sampling matter only with `--engine sampled`";

/// What `eval` takes.
#[derive(Debug, Clone, Args)]
pub(in super::super) struct EvalArgs {
    #[command(flatten)]
    file: FileArg,
    /// How to infer.
    #[arg(long, value_enum, default_value_t = EngineKind::Exact)]
    engine: EngineKind,
    #[command(flatten)]
    table: TableArgs,
    /// Samples of an output set. Default: 101.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=100_000_000))]
    points: Option<u32>,
    /// Where they are. Default: ends.
    #[arg(long, value_enum)]
    sampling: Option<Places>,
    /// Print an array of objects {inputs, outputs, clamped, unfired}.
    #[arg(long)]
    json: bool,
    /// Inputs, those of one evaluation after those of the other; without any, a line an evaluation from standard input.
    #[arg(value_name = "X", allow_negative_numbers = true)]
    values: Vec<String>,
}

/// How to infer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum EngineKind {
    /// Centroids in closed form.
    Exact,
    /// Output sets by samples, as MATLAB and others do it.
    Sampled,
    /// The rules in 16-bit fixed point, as firmware evaluates them.
    Q15,
    /// A compiled table of one input or two, as firmware evaluates it.
    Surface,
}

impl EvalArgs {
    fn sampling(&self) -> Sampling {
        let points = self.points.unwrap_or(101);
        match self.sampling.unwrap_or(Places::Ends) {
            Places::Ends => Sampling::Ends(points),
            Places::Midpoints => Sampling::Midpoints(points),
        }
    }
}

/// Evaluates.
pub(super) fn eval(args: &EvalArgs) -> Exit {
    checked(args).unwrap_or_else(|exit| exit)
}

fn checked(args: &EvalArgs) -> Result<Exit, Exit> {
    let usage = |message: String| {
        complain(&format_args!("error: {message}"));
        Exit::Usage
    };
    let values = args.values.iter().map(|text| number(text.trim())).collect::<Result<Vec<_>, _>>();
    let values = values.map_err(usage)?;
    if args.file.file == STDIN && values.is_empty() {
        return Err(usage("the system comes from standard input: give the inputs as arguments".to_owned()));
    }
    let loaded = file::load(&args.file.file)?;
    let count = loaded.system.inputs.len();
    if !values.len().is_multiple_of(count.max(1)) {
        let names: Vec<_> = loaded.system.inputs.iter().map(|input| format!("`{}`", input.name)).collect();
        return Err(usage(format!(
            "found {} {}, expected {count} for each evaluation ({}) or a multiple of that",
            values.len(),
            if values.len() == 1 { "number" } else { "numbers" },
            names.join(", ")
        )));
    }
    run(args, &loaded.system, &values)
}

/// A number, `nan` and `inf` included: the engine defines what it makes of them.
fn number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("`{text}` is not a number"))
}

fn run(args: &EvalArgs, system: &System, values: &[f64]) -> Result<Exit, Exit> {
    warn(args);
    let work = |evaluate: &mut Evaluator<'_>| {
        let mut run = Run::new(args, system);
        let exit = run.all(evaluate, values);
        run.remark();
        exit
    };
    let float = |accuracy| Ok(system.with_engine(accuracy, |engine| work(&mut engines::float(engine)))?);
    let done = match args.engine {
        EngineKind::Exact | EngineKind::Sampled => match float(accuracy(args, system)) {
            Err(EngineError::System(FuzzyError::Curved(_))) => {
                complain(&format_args!(
                    "note: the output sets are curved, which have no exact centroid here: it is taken from {FINE} samples"
                ));
                float(Accuracy::Sampled(Sampling::Ends(FINE)))
            }
            other => other,
        },
        EngineKind::Q15 => engines::with_fixed(system, Fixed::Q15, &args.table, work),
        EngineKind::Surface => engines::with_fixed(system, Fixed::Surface, &args.table, work),
    };
    done.unwrap_or_else(|error| {
        complain(&format_args!("error: {}: {error}", args.file.file));
        Err(Exit::Usage)
    })
}

/// Warns of options that the engine does not heed.
fn warn(args: &EvalArgs) {
    if args.engine != EngineKind::Surface {
        engines::warn_idle(&args.table.given(), "--engine surface");
    }
    let is_set = args.points.is_some() || args.sampling.is_some();
    if is_set && matches!(args.engine, EngineKind::Q15 | EngineKind::Surface) {
        complain(&SAMPLES_IDLE);
    }
}

/// How the outputs are to be found, and what about it the user may not expect.
fn accuracy(args: &EvalArgs, system: &System) -> Accuracy {
    let is_set = args.points.is_some() || args.sampling.is_some();
    let has_samples = system.kind == Kind::Mamdani && system.defuzzification != Defuzzification::Centroid;
    match args.engine {
        EngineKind::Sampled => {
            if system.kind == Kind::Sugeno {
                complain(&"note: a Sugeno system has no output sets to sample: its outputs are exact");
            }
            Accuracy::Sampled(args.sampling())
        }
        _ if has_samples => Accuracy::Sampled(args.sampling()),
        _ => {
            if is_set {
                complain(&SAMPLES_IDLE);
            }
            Accuracy::Exact
        }
    }
}

/// One kind of thing that evaluations met.
#[derive(Debug, Default)]
struct Met {
    first: Option<String>,
    count: usize,
}

impl Met {
    fn add(&mut self, words: impl FnOnce() -> String) {
        self.count = self.count.saturating_add(1);
        if self.first.is_none() {
            self.first = Some(words());
        }
    }

    fn remark(&self) {
        if let Some(first) = &self.first {
            let more = match self.count.saturating_sub(1) {
                0 => String::new(),
                1 => " (and 1 more evaluation)".to_owned(),
                more => format!(" (and {more} more evaluations)"),
            };
            complain(&format_args!("warning: {first}{more}"));
        }
    }
}

/// Evaluations on their way to standard output.
struct Run<'a> {
    system: &'a System,
    out: BufWriter<std::io::StdoutLock<'static>>,
    is_json: bool,
    done: usize,
    clamped: Met,
    nan: Met,
    unfired: Met,
}

impl<'a> Run<'a> {
    fn new(args: &EvalArgs, system: &'a System) -> Self {
        Self {
            system,
            out: BufWriter::new(std::io::stdout().lock()),
            is_json: args.json,
            done: 0,
            clamped: Met::default(),
            nan: Met::default(),
            unfired: Met::default(),
        }
    }

    /// Evaluates the values or, without any, standard input.
    fn all(&mut self, evaluate: &mut Evaluator<'_>, values: &[f64]) -> Result<Exit, Exit> {
        let count = self.system.inputs.len().max(1);
        let mut each = |run: &mut Self, values: &[f64], line: Option<usize>| {
            values.chunks_exact(count).try_for_each(|inputs| run.one(evaluate, inputs, line))
        };
        if self.is_json {
            self.write("[")?;
        }
        let read = if values.is_empty() { self.lines(&mut each) } else { each(self, values, None) };
        if self.is_json {
            self.write(if self.done > 0 { "\n]\n" } else { "]\n" })?;
        }
        let flushed = self.out.flush();
        flushed.map_err(|error| failed(&error))?;
        read.map(|()| Exit::Done)
    }

    /// Evaluates the lines of standard input as they come.
    fn lines(
        &mut self,
        each: &mut impl FnMut(&mut Self, &[f64], Option<usize>) -> Result<(), Exit>,
    ) -> Result<(), Exit> {
        let count = self.system.inputs.len();
        let mut input = std::io::stdin().lock();
        let (mut bytes, mut values) = (Vec::new(), Vec::new());
        for line in 1.. {
            bytes.clear();
            let refuse = |message: String| {
                complain(&format_args!("error: standard input, line {line}: {message}"));
                Exit::Usage
            };
            let read = input.read_until(b'\n', &mut bytes).map_err(|error| {
                complain(&format_args!("error: cannot read standard input: {error}"));
                Exit::Failed
            })?;
            if read == 0 {
                break;
            }
            let text = String::from_utf8_lossy(&bytes);
            let text = if line == 1 { text.trim_start_matches('\u{feff}') } else { &text };
            values.clear();
            for word in text.split([' ', '\t', ',', ';', '\r', '\n']).filter(|word| !word.is_empty()) {
                values.push(number(word).map_err(refuse)?);
            }
            if !values.len().is_multiple_of(count.max(1)) {
                let found = values.len();
                let message = format!("found {found} numbers, expected {count} or a multiple of that");
                return Err(refuse(message.replace("found 1 numbers", "found 1 number")));
            }
            each(self, &values, Some(line))?;
            // Whoever waits at the other end of a pipe gets what is known.
            self.out.flush().map_err(|error| failed(&error))?;
        }
        Ok(())
    }

    /// Evaluates and writes once.
    fn one(&mut self, evaluate: &mut Evaluator<'_>, inputs: &[f64], line: Option<usize>) -> Result<(), Exit> {
        let mut outputs = vec![0.0; self.system.outputs.len()];
        let met = evaluate(inputs, &mut outputs);
        // A negative zero is zero to a reader.
        outputs.iter_mut().for_each(|output| *output += 0.0);
        self.done = self.done.saturating_add(1);
        self.take_note(met, inputs, &outputs, line);
        let text = if self.is_json {
            let object = json!({
                "inputs": numbers(inputs), "outputs": numbers(&outputs), "clamped": met.clamped, "unfired": met.unfired,
            });
            format!("{}{object}", if self.done == 1 { "\n" } else { ",\n" })
        } else {
            let words: Vec<String> = inputs.iter().chain(&outputs).map(|value| shown(*value)).collect();
            format!("{}\n", words.join(" "))
        };
        self.write(&text)
    }

    fn take_note(&mut self, met: Inference, inputs: &[f64], outputs: &[f64], line: Option<usize>) {
        let place = match line {
            Some(line) => format!("evaluation {} (line {line})", self.done),
            None => format!("evaluation {}", self.done),
        };
        let system = self.system;
        if met.clamped {
            self.clamped.add(|| format!("{place}: {}", clamped(system, inputs)));
        }
        if met.nan {
            self.nan.add(|| format!("{place}: {}", nan(system, inputs)));
        } else if met.unfired {
            self.unfired.add(|| format!("{place}: {}", unfired(system, outputs)));
        }
    }

    fn remark(&self) {
        for met in [&self.clamped, &self.nan, &self.unfired] {
            met.remark();
        }
    }

    fn write(&mut self, text: &str) -> Result<(), Exit> {
        self.out.write_all(text.as_bytes()).map_err(|error| failed(&error))
    }
}

/// A reader that has gone away is no failure, a full disk is.
fn failed(error: &std::io::Error) -> Exit {
    if error.kind() == std::io::ErrorKind::BrokenPipe {
        return Exit::Done;
    }
    complain(&format_args!("error: cannot write the result: {error}"));
    Exit::Failed
}

/// The shortest digits that read back to the same bits; with an exponent instead of many zeros.
fn shown(value: f64) -> String {
    let size = value.abs();
    let is_plain = size <= 0.0 || !size.is_finite() || (1e-7..1e16).contains(&size);
    if is_plain { value.to_string() } else { format!("{value:e}") }
}

/// Numbers as JSON, which has neither NaN nor infinite ones.
fn numbers(values: &[f64]) -> Vec<Value> {
    values.iter().map(|&value| value.into()).collect()
}

fn clamped(system: &System, inputs: &[f64]) -> String {
    let outside =
        system.inputs.iter().zip(inputs).find(|(input, x)| **x < input.range.0 || **x > input.range.1);
    outside.map_or_else(String::new, |(input, x)| {
        let (lo, hi) = input.range;
        let end = if *x < lo { lo } else { hi };
        let x = shown(*x);
        format!("input `{}` = {x} is outside its range, [{lo}, {hi}]; it is taken as {end}", input.name)
    })
}

fn nan(system: &System, inputs: &[f64]) -> String {
    let name =
        system.inputs.iter().zip(inputs).find(|(_, x)| x.is_nan()).map_or("", |(input, _)| &input.name);
    format!("input `{name}` is not a number; each output is the middle of its range")
}

fn unfired(system: &System, outputs: &[f64]) -> String {
    let middle = |(lo, hi): (f64, f64)| 0.5 * lo + 0.5 * hi;
    let at_rest =
        |output: &mm_fis::Variable, y: f64| (y - middle(output.range)).abs() <= 0.0 || y.abs() <= 0.0;
    let pairs = system.outputs.iter().zip(outputs).filter(|(output, y)| at_rest(output, **y));
    let words: Vec<String> = pairs.map(|(output, y)| format!("output `{}` is {y}", output.name)).collect();
    format!("no rule fires, or what fires has no area: {}", words.join(", "))
}
