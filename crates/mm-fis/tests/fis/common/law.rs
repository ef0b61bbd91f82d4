//! What has to hold for any text at all: the fuzz targets and the replay of the corpus share it.
#![expect(clippy::panic, reason = "a helper of tests reports like a test")]

use mm_control::fuzzy::{FuzzyError, Sampling};
use mm_fis::{Accuracy, Document, Engine, Kind, Problem, ReadError, System, read_fis, write_fis};

/// Rules times terms up to which a system is evaluated.
const MAX_WORK: usize = 20_000;

/// Checks that a text is refused with places in it, or is read to a system that is written, read again and evaluated.
///
/// Returns whether it was read.
pub(crate) fn holds(text: &str, read: fn(&str) -> Result<Document, ReadError>) -> bool {
    match read(text) {
        Err(error) => {
            assert!(!error.problems().is_empty(), "a refusal has a reason");
            error.problems().iter().for_each(|problem| placed(text, problem));
            false
        }
        Ok(Document { system, notes }) => {
            notes.iter().for_each(|note| placed(text, note));
            round_trip(&system);
            evaluate(&system);
            true
        }
    }
}

fn placed(text: &str, problem: &Problem) {
    let found = text.get(problem.span());
    assert!(found.is_some_and(|found| !found.contains(['\n', '\r'])), "{problem}: {:?}", problem.span());
    assert!(problem.line() >= 1 && problem.column() >= 1, "{problem}");
    assert!(!problem.to_string().contains('\n'), "one line: {problem}");
}

fn round_trip(system: &System) {
    let written = write_fis(system);
    let again = read_fis(&written).map(|document| document.system);
    assert_eq!(again.as_ref(), Ok(system), "{written}");
    assert_eq!(again.as_ref().map(write_fis), Ok(written), "writing is idempotent");
}

fn evaluate(system: &System) {
    let terms: usize = system.inputs.iter().chain(&system.outputs).map(|variable| variable.terms.len()).sum();
    if system.rules.len().saturating_mul(terms.max(system.inputs.len() + system.outputs.len())) > MAX_WORK {
        return;
    }
    let sampled = Accuracy::Sampled(Sampling::Ends(21));
    let done = system.with_engine(sampled, |engine| infer(system, engine));
    assert_eq!(done, Ok(()), "what is read is evaluated: {}", write_fis(system));
    match system.with_engine(Accuracy::Exact, |engine| infer(system, engine)) {
        Ok(()) | Err(FuzzyError::Curved(_)) => {}
        Err(refused) => panic!("{refused}: {}", write_fis(system)),
    }
}

fn infer(system: &System, engine: &Engine<'_>) {
    let mut workspace = vec![0.0; engine.workspace_len()];
    let mut outputs = vec![0.0; system.outputs.len()];
    for part in [0.0, 0.3, 0.5, 1.0, -0.1, f64::NAN] {
        let inputs: Vec<f64> = system
            .inputs
            .iter()
            .map(|input| input.range.0 + part * (input.range.1 - input.range.0))
            .collect();
        let done = engine.infer(&inputs, &mut outputs, &mut workspace);
        assert!(done.is_ok(), "{done:?}");
        for (output, variable) in outputs.iter().zip(&system.outputs) {
            let (low, high) = variable.range;
            let inside = system.kind == Kind::Sugeno || (low..=high).contains(output);
            assert!(output.is_finite() && inside, "{output} at {inputs:?}: {}", write_fis(system));
        }
    }
}
