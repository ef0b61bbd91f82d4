//! Evaluates a `.fis` file at points: one line of numbers for each point comes in, one with the outputs goes out.
//!
//! ```sh
//! echo 0.25 | cargo run -p mm-fis --example evaluate -- crates/mm-fis/tests/systems/thesis.fis exact
//! ```
//!
//! The accuracy is `exact`, `ends:101` (samples from end to end of an output's range) or `midpoints:100` (in the middles of
//! equal parts). Numbers are separated by commas; outputs have 17 digits, so that none is lost.

use std::error::Error;
use std::fmt::Write as _;
use std::io::{BufRead, Write as _};

use mm_control::fuzzy::Sampling;
use mm_fis::{Accuracy, Engine, read_fis};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [path, accuracy] = arguments.as_slice() else {
        return Err("two arguments: a .fis file, and exact, ends:N or midpoints:N".into());
    };
    let text = std::fs::read_to_string(path).map_err(|error| format!("{path}: {error}"))?;
    let system = read_fis(&text)?.system;
    let outputs = system.outputs.len();
    system.with_engine(accuracy_of(accuracy)?, |engine| evaluate(engine, outputs))?
}

fn accuracy_of(name: &str) -> Result<Accuracy, Box<dyn Error>> {
    Ok(match name.split_once(':') {
        None if name == "exact" => Accuracy::Exact,
        Some(("ends", count)) => Accuracy::Sampled(Sampling::Ends(count.parse()?)),
        Some(("midpoints", count)) => Accuracy::Sampled(Sampling::Midpoints(count.parse()?)),
        _ => return Err(format!("`{name}` is no accuracy: exact, ends:N or midpoints:N").into()),
    })
}

/// Copies standard input, point by point, to outputs on standard output.
fn evaluate(engine: &Engine<'_>, outputs: usize) -> Result<(), Box<dyn Error>> {
    let mut workspace = vec![0.0; engine.workspace_len()];
    let mut values = vec![0.0; outputs];
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    for (line, number) in std::io::stdin().lock().lines().zip(1_u64..) {
        let line = line?;
        let point: Result<Vec<f64>, _> = line.split(',').map(|word| word.trim().parse()).collect();
        let point = point.map_err(|error| format!("line {number}: {error}"))?;
        let _ = engine
            .infer(&point, &mut values, &mut workspace)
            .map_err(|error| format!("line {number}: {error}"))?;
        let mut row = String::new();
        for value in &values {
            let comma = if row.is_empty() { "" } else { "," };
            write!(row, "{comma}{value:.16e}")?;
        }
        writeln!(out, "{row}")?;
    }
    Ok(out.flush()?)
}
