//! What the outputs do over the inputs.

use mm_control::fuzzy::{FuzzyError, Sampling};

use super::cells::{is_tailed, set_of};
use super::points::points;
use super::probe::Probe;
use super::scan::{Place, Scan, places};
use super::words::{Short, list};
use super::{Finding, FindingKind as Kind, Jump, Reach, Run};
use crate::{Accuracy, Defuzzification, System, Variable};

/// Work that the scans may take, in units of about a nanosecond.
const WORK: usize = 40_000_000;
/// Most lines along an input, and most values of each other input.
const MOST_LINES: usize = 128;
const MOST_VALUES: usize = 33;
/// Fewest and most points of a kind besides the lines.
const FEWEST_POINTS: usize = 64;
const MOST_POINTS: usize = 4096;
/// Part of the range that has to be missing at an end for an output not to reach it.
const MISSING: f64 = 0.25;
/// Jumps that a finding lists.
const MOST_JUMPS: usize = 100;
/// Part of the range within which jumps are at one place.
const SAME_PLACE: f64 = 1e-9;

/// What the outputs do.
pub(super) struct Probed {
    pub(super) findings: Vec<Finding>,
    pub(super) outputs: Vec<Reach>,
    pub(super) is_sampled: bool,
}

/// How finely the outputs are known, and how densely the inputs are looked at.
#[derive(Debug, Clone, Copy)]
struct Grain {
    /// Smallest jump and smallest turn that count, in the output's range.
    jump: f64,
    turn: f64,
    /// Parts of a line.
    parts: u32,
    /// Lines along each input.
    lines: usize,
    /// Most points of a kind besides the lines.
    points: usize,
    is_sampled: bool,
}

/// Evaluates a system all over its inputs.
pub(super) fn probe(system: &System) -> Result<Probed, FuzzyError> {
    with_probe(system, |probe, known| analyse(system, probe, grain(system, known)))
}

/// How an output is known: exactly, or by samples, and what is too small to be seen in it, in its range.
#[derive(Debug, Clone, Copy)]
struct Known {
    samples: Option<u32>,
    jump: f64,
    turn: f64,
}

/// Hands an engine to `work`, the most exact that the system has.
fn with_probe<R>(system: &System, work: impl Fn(Probe<'_>, Known) -> R) -> Result<R, FuzzyError> {
    let is_sampled_anyway = matches!(
        system.defuzzification,
        Defuzzification::Bisector
            | Defuzzification::MeanOfMaximum
            | Defuzzification::SmallestOfMaximum
            | Defuzzification::LargestOfMaximum
    );
    let exact = Known { samples: None, jump: 1e-5, turn: 1e-6 };
    if !is_sampled_anyway {
        match system.with_engine(Accuracy::Exact, |engine| work(Probe::new(engine, system), exact)) {
            Err(FuzzyError::Curved(_)) => {}
            other => return other,
        }
    }
    let samples: u32 = if system.inputs.len() == 1 { 1001 } else { 201 };
    // Such an output is one of the samples, or the mean of some; a centroid is far better than they are dense.
    let steps = if is_sampled_anyway { 2.5 } else { 0.1 };
    let tolerance = steps / f64::from(samples);
    let known = Known { samples: Some(samples), jump: tolerance, turn: tolerance };
    let accuracy = Accuracy::Sampled(Sampling::Ends(samples));
    system.with_engine(accuracy, |engine| work(Probe::new(engine, system), known))
}

/// An output along one input.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Course {
    /// Input and output, in ascending order of the input: dense, and to both sides of every breakpoint.
    pub points: Vec<(f64, f64)>,
    /// The jumps, in ascending order.
    pub jumps: Vec<Jump>,
}

/// An output along one input, the others held at the values of `base`: points in ascending order, and the jumps.
///
/// An exact centroid is taken where there is one. An output or an input that does not exist has no points.
///
/// # Errors
/// As [`System::with_engine`].
pub fn along(system: &System, output: usize, axis: usize, base: &[f64]) -> Result<Course, FuzzyError> {
    let (Some(input), Some(variable)) = (system.inputs.get(axis), system.outputs.get(output)) else {
        return Ok(Course::default());
    };
    let width = variable.range.1 - variable.range.0;
    with_probe(system, |mut probe, known| {
        let places = places(input, if known.samples.is_some() { 500 } else { 2000 });
        let scan = Scan::new(&mut probe, base, (axis, input.range), &places);
        let points = scan.curve(output).into_iter().map(|(place, value)| (place.x(), value)).collect();
        Course { points, jumps: scan.jumps(&mut probe, output, known.jump * width) }
    })
}

fn grain(system: &System, Known { samples, jump, turn }: Known) -> Grain {
    if system.inputs.len() == 1 {
        let parts = if samples.is_some() { 500 } else { 2000 };
        return Grain { jump, turn, parts, lines: 1, points: 0, is_sampled: samples.is_some() };
    }
    let parts: u32 = if samples.is_some() { 48 } else { 96 };
    let count = |variables: &[Variable]| variables.iter().map(|variable| variable.terms.len()).sum::<usize>();
    let is_curved = |term: &&crate::Term| set_of(term).is_some_and(is_tailed);
    let curved = system.inputs.iter().flat_map(|input| &input.terms).filter(is_curved).count();
    let inputs = system.inputs.len();
    let sampling = samples.map_or(0, |samples| samples as usize).saturating_mul(20 * system.outputs.len());
    let one = (3 * inputs + 2 * system.outputs.len()).saturating_mul(system.rules.len())
        + 20 * (count(&system.inputs) + count(&system.outputs))
        + 200 * curved
        + sampling;
    let line =
        one.saturating_mul(parts as usize + 12 * system.inputs.first().map_or(0, |input| input.terms.len()));
    let lines = (WORK / line.saturating_mul(inputs).max(1)).clamp(1, MOST_LINES);
    let points = (WORK / one.max(1)).clamp(FEWEST_POINTS, MOST_POINTS);
    Grain { jump, turn, parts, lines, points, is_sampled: samples.is_some() }
}

fn analyse(system: &System, mut probe: Probe<'_>, grain: Grain) -> Probed {
    let mut lines: Vec<Vec<Line>> = vec![Vec::new(); system.outputs.len()];
    let mut outputs: Vec<Reach> = system
        .outputs
        .iter()
        .map(|output| Reach {
            output: output.name.clone(),
            range: output.range,
            reached: (f64::INFINITY, f64::NEG_INFINITY),
            is_partial: system.inputs.len() > 1,
        })
        .collect();
    for (axis, input) in system.inputs.iter().enumerate() {
        let places: Vec<Place> = places(input, grain.parts);
        for base in bases(system, axis, grain.lines) {
            let scan = Scan::new(&mut probe, &base, (axis, input.range), &places);
            for (number, (output, (lines, reach))) in
                system.outputs.iter().zip(lines.iter_mut().zip(&mut outputs)).enumerate()
            {
                let width = output.range.1 - output.range.0;
                let jumps = scan.jumps(&mut probe, number, grain.jump * width);
                let runs = scan.runs(&mut probe, number, (grain.turn * width, width));
                let values = scan.curve(number).into_iter().map(|(_, value)| value);
                let turns = runs.iter().flat_map(|run| [run.from_value, run.to_value]);
                values.chain(turns).for_each(|value| reach.see(value));
                lines.push(Line { axis, base: base.clone(), jumps, runs });
            }
        }
    }
    if grain.points > 0 {
        for inputs in points(system, grain.points) {
            outputs.iter_mut().zip(probe.at(&inputs)).for_each(|(reach, value)| reach.see(value));
        }
    }
    let mut findings = Vec::new();
    for (output, lines) in system.outputs.iter().zip(&lines) {
        for axis in 0..system.inputs.len() {
            let own: Vec<&Line> = lines.iter().filter(|line| line.axis == axis).collect();
            findings.extend(jumps(system, output, axis, &own));
            findings.extend(turns(system, output, axis, &own));
        }
    }
    for (number, output) in outputs.iter().enumerate() {
        let is_used = |rule: &crate::Rule| rule.outputs.get(number).is_some_and(|&index| index != 0);
        findings.extend(reach(output).filter(|_| system.rules.iter().any(is_used)));
    }
    Probed { findings, outputs, is_sampled: grain.is_sampled }
}

/// What one output does along one line.
#[derive(Debug, Clone)]
struct Line {
    axis: usize,
    base: Vec<f64>,
    jumps: Vec<Jump>,
    runs: Vec<Run>,
}

impl Line {
    /// The largest rise, or fall, on the line.
    fn most(&self, rises: bool) -> f64 {
        let sizes = self.runs.iter().filter(|run| run.rises() == rises);
        sizes.map(|run| (run.to_value - run.from_value).abs()).fold(0.0, f64::max)
    }
}

/// Where the lines along an axis are: values of the other inputs, evenly over their ranges.
fn bases(system: &System, axis: usize, lines: usize) -> Vec<Vec<f64>> {
    let others = system.inputs.len().saturating_sub(1);
    let values = (1..=MOST_VALUES).rev().find(|values| {
        u32::try_from(others).ok().and_then(|power| values.checked_pow(power)).is_some_and(|all| all <= lines)
    });
    let values = if others == 0 { 1 } else { values.unwrap_or(1) };
    let mut all = vec![Vec::new()];
    for (number, input) in system.inputs.iter().enumerate() {
        let (lo, hi) = input.range;
        let choices: Vec<f64> = if number == axis || values == 1 {
            vec![0.5 * lo + 0.5 * hi]
        } else {
            #[expect(clippy::cast_precision_loss, reason = "at most 33 values")]
            let part = |k: usize| k as f64 / (values - 1) as f64;
            (0..values).map(|k| lo + part(k) * (hi - lo)).collect()
        };
        all = all
            .iter()
            .flat_map(|begun: &Vec<f64>| choices.iter().map(|value| [begun.as_slice(), &[*value]].concat()))
            .collect();
    }
    all
}

/// The other inputs in words: ` where \`food\` is 3`.
fn elsewhere(system: &System, axis: usize, inputs: &[f64]) -> String {
    let others = system.inputs.iter().zip(inputs).enumerate().filter(|(number, _)| *number != axis);
    let parts: Vec<String> =
        others.map(|(_, (input, value))| format!("`{}` is {}", input.name, Short(*value))).collect();
    if parts.is_empty() { String::new() } else { format!(" where {}", list(&parts, 8)) }
}

fn jumps(system: &System, output: &Variable, axis: usize, lines: &[&Line]) -> Option<Finding> {
    let input = system.inputs.get(axis)?;
    let width = input.range.1 - input.range.0;
    let at = |jump: &Jump| jump.inputs.get(axis).copied().unwrap_or(0.0);
    let mut all: Vec<&Jump> = lines.iter().flat_map(|line| &line.jumps).collect();
    all.sort_by(|a, b| at(a).total_cmp(&at(b)).then(b.size().total_cmp(&a.size())));
    let mut largest: Vec<Jump> = Vec::new();
    for jump in all {
        match largest.last_mut().filter(|last| at(jump) - at(last) <= SAME_PLACE * width) {
            Some(last) if jump.size() > last.size() => *last = jump.clone(),
            Some(_) => {}
            None => largest.push(jump.clone()),
        }
    }
    let most = largest.iter().max_by(|a, b| a.size().total_cmp(&b.size()))?;
    let message = if largest.len() <= 4 {
        let places: Vec<String> = largest.iter().map(|jump| in_words(system, axis, jump, at(jump))).collect();
        format!("output `{}` jumps at `{}` = {}", output.name, input.name, list(&places, 4))
    } else {
        let jump = in_words(system, axis, most, at(most));
        format!(
            "output `{}` jumps at {} places along `{}`, the most at {jump}",
            output.name,
            largest.len(),
            input.name
        )
    };
    let mut finding = Finding::new(Kind::Jump, message).about(&[&input.name, &output.name]);
    largest.truncate(MOST_JUMPS);
    finding.jumps = largest;
    Some(finding)
}

fn in_words(system: &System, axis: usize, jump: &Jump, at: f64) -> String {
    format!(
        "{} (from {} through {} to {}{})",
        Short(at),
        Short(jump.left),
        Short(jump.value),
        Short(jump.right),
        elsewhere(system, axis, &jump.inputs)
    )
}

fn turns(system: &System, output: &Variable, axis: usize, lines: &[&Line]) -> Option<Finding> {
    let input = system.inputs.get(axis)?;
    let by = |rises: bool| {
        lines
            .iter()
            .max_by(|a, b| a.most(rises).total_cmp(&b.most(rises)))
            .filter(|line| line.most(rises) > 0.0)
    };
    let (rising, falling) = (by(true)?, by(false)?);
    let both = |line: &&&Line| f64::min(line.most(true), line.most(false));
    let worst = lines.iter().max_by(|a, b| both(a).total_cmp(&both(b))).filter(|line| both(line) > 0.0);
    let along = if system.inputs.len() == 1 { String::new() } else { format!(" along `{}`", input.name) };
    let (course, runs) = match worst {
        Some(line) => {
            (course(&line.runs, input.range) + &elsewhere(system, axis, &line.base), line.runs.clone())
        }
        None => {
            let rises = elsewhere(system, axis, &rising.base);
            (format!("it rises{rises}, and falls{}", elsewhere(system, axis, &falling.base)), Vec::new())
        }
    };
    let message = format!("output `{}` is not monotone{along}: {course}", output.name);
    let mut finding = Finding::new(Kind::NotMonotone, message).about(&[&input.name, &output.name]);
    finding.runs = runs;
    Some(finding)
}

/// The course of an output over a range: where it begins, each turn, and where it ends.
fn course(runs: &[Run], (lo, hi): (f64, f64)) -> String {
    let (Some(first), Some(last)) = (runs.first(), runs.last()) else { return String::new() };
    let begin = if first.from > lo {
        format!("from {} to {}", Short(lo), Short(first.from))
    } else {
        format!("at {}", Short(lo))
    };
    let mut parts = vec![format!("{} {begin}", Short(first.from_value))];
    for run in runs {
        let verb = if run.rises() { "rises" } else { "falls" };
        parts.push(format!("{verb} to {} at {}", Short(run.to_value), Short(run.to)));
    }
    let stays = if last.to < hi { format!(", where it stays up to {}", Short(hi)) } else { String::new() };
    format!("it is {}{stays}", list(&parts, 16))
}

/// An output that stays away from its range's ends, or leaves it.
fn reach(reach: &Reach) -> Option<Finding> {
    let ((lo, hi), (least, most)) = (reach.range, reach.reached);
    let width = hi - lo;
    let finding =
        |kind: Kind, what: &str| Finding::new(kind, format!("{what}: {reach}")).about(&[&reach.output]);
    if least < lo - SAME_PLACE * width || most > hi + SAME_PLACE * width {
        return Some(finding(Kind::RangeExceeded, "a range is exceeded"));
    }
    (least > lo + MISSING * width || most < hi - MISSING * width).then(|| {
        let what = if reach.is_partial {
            "no value near an end of a range was seen"
        } else {
            "an end of a range is never near"
        };
        finding(Kind::RangeNotReached, what)
    })
}
