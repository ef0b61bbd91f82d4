//! `mmsim fis`: fuzzy systems from files: evaluate, check, draw, compile.

mod check;
mod compile;
mod engines;
mod eval;
mod file;
mod plot;

use std::ffi::OsString;

use clap::{Args, Subcommand, ValueEnum};

use super::Exit;

/// What `fis` does.
#[derive(Debug, Subcommand)]
pub(super) enum FisCommand {
    /// Evaluate a fuzzy system: one line an evaluation, inputs then outputs.
    #[command(after_help = "Examples:\n  \
        mmsim fis eval thesis -1.4 0 0.5              three evaluations of a system of one input\n  \
        mmsim fis eval tip.fis 3 8                    one of a system of two inputs\n  \
        mmsim fis eval thesis --engine sampled -0.001 the centroid by 101 samples, as MATLAB has it\n  \
        seq -1 0.1 1 | mmsim fis eval thesis          a line an evaluation, from standard input")]
    Eval(eval::EvalArgs),
    /// Find what is wrong with a fuzzy system: gaps, dead rules and terms, jumps, turns.
    #[command(after_help = "Examples:\n  \
        mmsim fis check thesis\n  \
        mmsim fis check tip.fis --json\n  \
        mmsim fis check tip.fis --strict      exit code 1 where there is a warning")]
    Check(check::CheckArgs),
    /// Draw membership functions and what the outputs are over the inputs, as SVG.
    #[command(after_help = "Examples:\n  \
        mmsim fis plot thesis                       writes thesis.svg\n  \
        mmsim fis plot tip.fis -o pictures/tip.svg\n  \
        mmsim fis plot thesis --overlay surface     with the compiled surface on top\n  \
        mmsim fis plot three.fis --inputs 1,3       the second input stays in the middle of its range")]
    Plot(plot::PlotArgs),
    /// Compile a fuzzy system to fixed-point tables for firmware: Rust, C or TOML.
    #[command(after_help = "Examples:\n  \
        mmsim fis compile thesis --bits 16 -o table.rs\n  \
        mmsim fis compile thesis --bound 0.001 -o thesis.h      C99, no library needed\n  \
        mmsim fis compile thesis --to q15 --lang toml           the rules in fixed point, on standard output")]
    Compile(compile::CompileArgs),
}

/// The file of a fuzzy system.
#[derive(Debug, Clone, Args)]
struct FileArg {
    /// A .fis or .fcl file, the name of a bundled system (thesis, smooth), or - for standard input.
    #[arg(value_name = "FILE|NAME")]
    file: String,
}

/// Where an output set is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Places {
    /// From end to end of the range, both included, as MATLAB does.
    Ends,
    /// In the middles of equal parts of the range, as fuzzylite does.
    Midpoints,
}

/// Runs one of the sub-commands.
pub(super) fn fis(command: &FisCommand) -> Exit {
    match command {
        FisCommand::Eval(args) => eval::eval(args),
        FisCommand::Check(args) => check::check(args),
        FisCommand::Plot(args) => plot::plot(args),
        FisCommand::Compile(args) => compile::compile(args),
    }
}

/// `1 input`, `2 inputs`.
fn counted(count: usize, one: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") }
}

/// Options of numbers: what follows one is its value, whatever its sign.
const OF_NUMBERS: [&str; 5] = ["--bound", "--bits", "--input-bits", "--max-knots", "--points"];

/// Lets negative numbers pass as values: those after `fis eval` get a blank in front, which nothing takes for an option, and those after an
/// option are joined to it.
///
/// The parser of the command line knows `-1.4`, but neither `-.5` nor `-1e-3` nor `-inf`.
pub(super) fn shield_numbers(args: Vec<OsString>) -> Vec<OsString> {
    if args.get(1).is_none_or(|word| word != "fis") {
        return args;
    }
    let is_eval = args.get(2).is_some_and(|word| word == "eval");
    let mut shielded: Vec<OsString> = Vec::with_capacity(args.len());
    let mut is_past = false;
    for (at, word) in args.into_iter().enumerate() {
        is_past |= word == "--";
        let number = word.to_str().filter(|text| text.starts_with('-') && text.parse::<f64>().is_ok());
        let Some(text) = number.filter(|_| at >= 3 && !is_past) else {
            shielded.push(word);
            continue;
        };
        match shielded.last_mut().filter(|last| OF_NUMBERS.iter().any(|option| *last == option)) {
            Some(option) => option.push(format!("={text}")),
            None if is_eval => shielded.push(format!(" {text}").into()),
            None => shielded.push(word),
        }
    }
    shielded
}

#[cfg(test)]
mod tests {
    use super::shield_numbers;

    #[test]
    fn only_negative_numbers_of_eval_are_shielded() {
        let shielded = |line: &str| {
            let words = line.split(' ').map(Into::into).collect();
            let words = shield_numbers(words).into_iter().map(|word| word.into_string().expect("text"));
            words.collect::<Vec<_>>().join("|")
        };
        assert_eq!(
            shielded("mmsim fis eval f -1e-3 -.5 -inf -x 2 --json -- -1"),
            "mmsim|fis|eval|f| -1e-3| -.5| -inf|-x|2|--json|--|-1",
            "numbers before --"
        );
        assert_eq!(
            shielded("mmsim fis eval f --bound -.5 -1"),
            "mmsim|fis|eval|f|--bound=-.5| -1",
            "the value of an option"
        );
        assert_eq!(
            shielded("mmsim fis plot f --bits -1 -1"),
            "mmsim|fis|plot|f|--bits=-1|-1",
            "joined alone"
        );
        assert_eq!(shielded("mmsim run -1"), "mmsim|run|-1", "nowhere else");
    }
}
