//! The fuzzy system of a scenario's law.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use mm_control::LawKind;
use mm_control::fuzzy::{FuzzyError, FuzzySystem, Sampling};
use mm_control::laws::FuzzyTerm;
use mm_fis::compile::{CompileError, CompiledSurface, Q15, Request};
use mm_fis::{Accuracy, System};

use crate::scenario::{FuzzyEngine, Loaded, ScenarioError};

/// Samples of an output set whose centroid has no closed form, for a table: their error, about 1/n^2 of the range, is below half a
/// unit of 16 bits.
const FINE: Sampling = Sampling::Ends(501);

/// The fuzzy system that the scenario asks for; none where the law keeps its own, or has none.
pub(super) fn term(loaded: &Loaded, kind: LawKind) -> Result<Option<FuzzyTerm<f64>>, ScenarioError> {
    let controller = &loaded.file.controller;
    let default = match kind {
        // A table of equal steps would make a slope of a jump, and miss 0 where the range is uneven.
        LawKind::Bfsmc if loaded.fis.is_none() => FuzzyEngine::Table,
        LawKind::Bfsmc | LawKind::BfsmcThesis if exact(loaded) => FuzzyEngine::Exact,
        LawKind::Bfsmc | LawKind::BfsmcThesis => FuzzyEngine::Surface,
        _ => return Ok(None),
    };
    if loaded.fis.is_none() && controller.fuzzy_engine.is_none() {
        return Ok(None);
    }
    let own = if kind == LawKind::Bfsmc { "smooth" } else { "thesis" };
    let system = match &loaded.fis {
        Some(system) => Cow::Borrowed(system),
        None => Cow::Owned(bundled(own).map_err(|error| {
            loaded.problem("controller.fuzzy_engine", error, "a bundled system that can be read")
        })?),
    };
    let engine = controller.fuzzy_engine.unwrap_or(default);
    let term = kept(&system, engine).map_err(|Refusal { message, expected }| {
        let key = if loaded.fis.is_some() { "controller.fis" } else { "controller.fuzzy_engine" };
        loaded.problem(key, message, expected)
    })?;
    if kind == LawKind::Bfsmc && !term.opposes() {
        let message = format!(
            "the system aids the motion, as `{}` evaluates it: it answers some input with an output of the same sign, or 0 not with 0",
            name(engine)
        );
        let expected = "for `bfsmc` an output against the sign of the input, over a range on both sides of 0";
        return Err(loaded.problem("controller.fis", message, expected));
    }
    Ok(Some(term))
}

/// Whether the system of the scenario, or the law's own, can be evaluated by its rules with the exact centroid.
fn exact(loaded: &Loaded) -> bool {
    loaded.fis.as_ref().is_none_or(|system| system.leaks(Accuracy::Exact))
}

/// Name of an engine in a scenario.
const fn name(engine: FuzzyEngine) -> &'static str {
    match engine {
        FuzzyEngine::Table => "table",
        FuzzyEngine::Exact => "exact",
        FuzzyEngine::Sampled => "sampled",
        FuzzyEngine::Q15 => "q15",
        FuzzyEngine::Surface => "surface",
    }
}

fn bundled(name: &str) -> Result<System, String> {
    let text = mm_fis::bundled_text(name).unwrap_or_default();
    mm_fis::read(name, text).map(|document| document.system).map_err(|error| error.to_string())
}

/// Why a system cannot be the law's.
struct Refusal {
    message: String,
    expected: &'static str,
}

impl From<FuzzyError> for Refusal {
    fn from(error: FuzzyError) -> Self {
        let expected = match error {
            FuzzyError::Curved(_) => "`table`, `surface` or `sampled` as `controller.fuzzy_engine`",
            FuzzyError::OutOfRange("kind") => {
                "a Mamdani system, or `table` or `surface` as `controller.fuzzy_engine`"
            }
            FuzzyError::TooMany(_) => {
                "at most 32 output terms (or rules, where sums or complements keep them apart), or `table` or `surface` as `controller.fuzzy_engine`"
            }
            _ => "a system of one input and one output that the engine can evaluate",
        };
        Self { message: format!("the fuzzy system is refused: {error}"), expected }
    }
}

impl From<CompileError> for Refusal {
    fn from(error: CompileError) -> Self {
        Self {
            message: error.to_string(),
            expected: "a system that can be compiled, or another `controller.fuzzy_engine`",
        }
    }
}

/// The term of a system and an engine, made once and kept: its tables live as long as the program.
fn kept(system: &System, engine: FuzzyEngine) -> Result<FuzzyTerm<f64>, Refusal> {
    static KEPT: Mutex<Option<HashMap<String, FuzzyTerm<f64>>>> = Mutex::new(None);
    if system.inputs.len() != 1 || system.outputs.len() != 1 {
        let (inputs, outputs) = (system.inputs.len(), system.outputs.len());
        let message = format!("the fuzzy system has {inputs} inputs and {outputs} outputs");
        return Err(Refusal {
            message,
            expected: "one input, s over its scale, and one output, the force over its gain",
        });
    }
    let key = format!("{engine:?} {system:?}");
    let mut guard = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = guard.get_or_insert_with(HashMap::new);
    if let Some(term) = kept.get(&key) {
        return Ok(*term);
    }
    let term = made(system, engine)?;
    kept.insert(key, term);
    Ok(term)
}

fn made(system: &System, engine: FuzzyEngine) -> Result<FuzzyTerm<f64>, Refusal> {
    let ranges = match (system.inputs.as_slice(), system.outputs.as_slice()) {
        ([input], [output]) => (input.range, output.range),
        _ => return Err(FuzzyError::Length("inputs").into()),
    };
    Ok(match engine {
        FuzzyEngine::Table => mapped(system, ranges.0, |map| FuzzyTerm::table(map))??,
        FuzzyEngine::Exact => FuzzyTerm::rules(system.leak(Accuracy::Exact)?)?,
        FuzzyEngine::Sampled => FuzzyTerm::rules(system.leak(Accuracy::Sampled(Sampling::default()))?)?,
        FuzzyEngine::Q15 => FuzzyTerm::q15(Q15::compile(system)?.leak(), ranges.0, ranges.1)?,
        FuzzyEngine::Surface => {
            let compile = |map: &Map<'_>| {
                CompiledSurface::compile(&system.name, &|x| map.evaluate(x), ranges, &Request::default())
            };
            let compiled = mapped(system, ranges.0, compile)??;
            FuzzyTerm::surface(compiled.leak(), compiled.input_range, compiled.output_range)?
        }
    })
}

/// Hands a system of one input and one output to `work` as a map, as exactly as it can be evaluated.
fn mapped<R>(
    system: &System,
    input_range: (f64, f64),
    work: impl Fn(&Map<'_>) -> R,
) -> Result<R, FuzzyError> {
    let with = |accuracy| system.with_function(accuracy, 0, |function| work(&Map { function, input_range }));
    match with(Accuracy::Exact) {
        Err(FuzzyError::Curved(_)) => with(Accuracy::Sampled(FINE)),
        other => other,
    }
}

/// A system as a function of one number.
struct Map<'a> {
    function: &'a (dyn Fn(&[f64]) -> f64 + Sync),
    input_range: (f64, f64),
}

impl FuzzySystem<f64> for Map<'_> {
    fn evaluate(&self, x: f64) -> f64 {
        (self.function)(&[x])
    }

    fn input_range(&self) -> (f64, f64) {
        self.input_range
    }
}
