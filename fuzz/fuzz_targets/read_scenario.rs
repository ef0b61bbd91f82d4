//! Any text at all: it is refused with a place for every problem, or read and built.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mm_sim::experiment::Experiment;
use mm_sim::scenario;

fuzz_target!(|text: &str| {
    let built = scenario::from_text("fuzzed.toml", text, &[]).and_then(|loaded| Experiment::build(&loaded));
    let Err(error) = built else { return };
    assert!(!error.problems().is_empty(), "refused without a reason");
    for problem in error.problems() {
        assert!(error.location(problem).is_some(), "no place: {}", problem.message());
    }
    assert!(error.to_string().contains(" --> "), "a place is shown");
});
