//! What is wrong, or odd, with a fuzzy system that runs.
//!
//! ```text
//! System --terms, rules--> what the tables say                    exact
//!        --cells, gaps---> inputs for which nothing holds or fires exact for shapes with feet
//!        --scan, outputs-> jumps, turns, reach of the outputs     by evaluating, refined
//! ```

mod cells;
mod gaps;
mod outputs;
mod points;
mod probe;
mod rules;
mod scan;
mod terms;
mod words;

use std::cmp::Reverse;
use std::fmt;

use mm_control::fuzzy::FuzzyError;

use crate::System;

pub use outputs::{Course, along};

/// How serious a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Most likely not meant.
    Warning,
}

impl Severity {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
        }
    }
}

macro_rules! kinds {
    ($($(#[$doc:meta])+ $variant:ident = $name:literal, $severity:ident;)+) => {
        /// What was found.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum FindingKind {
            $($(#[$doc])+ $variant,)+
        }

        impl FindingKind {
            /// All of them, in the order in which they are reported.
            pub const ALL: &[Self] = &[$(Self::$variant),+];

            /// Its name, which does not change from version to version.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)+ }
            }

            /// How serious it is, as a rule.
            #[must_use]
            pub const fn severity(self) -> Severity {
                match self { $(Self::$variant => Severity::$severity,)+ }
            }
        }
    };
}

kinds! {
    /// No term of an input holds on these intervals; a note only where some rule fires for all inputs nevertheless.
    UncoveredInput = "uncovered-input", Warning;
    /// No rule fires for an output where the inputs are these.
    NoRuleFires = "no-rule-fires", Warning;
    /// A rule never fires, whatever the inputs.
    UnreachableRule = "unreachable-rule", Warning;
    /// A rule concludes nothing.
    RuleWithoutEffect = "rule-without-effect", Warning;
    /// Rules say the same twice.
    DuplicateRules = "duplicate-rules", Warning;
    /// Rules conclude different terms from the same condition.
    ContradictingRules = "contradicting-rules", Warning;
    /// A rule adds nothing to another one that concludes the same from less.
    DominatedRule = "dominated-rule", Note;
    /// No rule asks for an input.
    UnusedInput = "unused-input", Warning;
    /// No rule concludes anything about an output.
    UnusedOutput = "unused-output", Warning;
    /// No rule uses a term.
    UnusedTerm = "unused-term", Warning;
    /// A term is zero over the whole range of its variable.
    TermOutsideRange = "term-outside-range", Warning;
    /// The range cuts off a part of an output term, which moves its centroid inwards.
    ClippedTerm = "clipped-term", Warning;
    /// A term of an input reaches beyond its range.
    TermBeyondRange = "term-beyond-range", Note;
    /// The terms of a variable do not ascend.
    TermOrder = "term-order", Note;
    /// Two terms of a variable are the same set.
    EqualTerms = "equal-terms", Note;
    /// Two terms of a variable, or two variables, have one name.
    DuplicateName = "duplicate-name", Warning;
    /// An output jumps.
    Jump = "jump", Warning;
    /// An output both rises and falls along an input.
    NotMonotone = "not-monotone", Note;
    /// An output stays far from an end of its range.
    RangeNotReached = "range-not-reached", Note;
    /// An output leaves its range.
    RangeExceeded = "range-exceeded", Warning;
}

impl fmt::Display for FindingKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// One thing that was found.
///
/// The message says it all; the other fields say the same to a program, and are empty where they do not apply.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What it is.
    pub kind: FindingKind,
    /// How serious it is.
    pub severity: Severity,
    /// One sentence, without a full stop.
    pub message: String,
    /// The variables that it is about.
    pub variables: Vec<String>,
    /// The terms that it is about.
    pub terms: Vec<String>,
    /// The rules that it is about, counted from 1.
    pub rules: Vec<usize>,
    /// Intervals of the one input that it is about.
    pub intervals: Vec<(f64, f64)>,
    /// Boxes of inputs, an interval for each input.
    pub regions: Vec<Vec<(f64, f64)>>,
    /// Jumps.
    pub jumps: Vec<Jump>,
    /// Where an output rises and where it falls, in ascending order of the input.
    pub runs: Vec<Run>,
}

impl Finding {
    fn new(kind: FindingKind, message: String) -> Self {
        Self {
            kind,
            severity: kind.severity(),
            message,
            variables: Vec::new(),
            terms: Vec::new(),
            rules: Vec::new(),
            intervals: Vec::new(),
            regions: Vec::new(),
            jumps: Vec::new(),
            runs: Vec::new(),
        }
    }

    fn about(mut self, variables: &[&str]) -> Self {
        self.variables = variables.iter().map(|&name| name.to_owned()).collect();
        self
    }

    fn terms(mut self, terms: Vec<String>) -> Self {
        self.terms = terms;
        self
    }

    fn rules(mut self, rules: Vec<usize>) -> Self {
        self.rules = rules;
        self
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} [{}]", self.severity.name(), self.message, self.kind)
    }
}

/// A jump of an output along an input.
#[derive(Debug, Clone, PartialEq)]
pub struct Jump {
    /// Inputs at the jump.
    pub inputs: Vec<f64>,
    /// Value just below.
    pub left: f64,
    /// Value there.
    pub value: f64,
    /// Value just above.
    pub right: f64,
}

impl Jump {
    /// Largest difference between the three values.
    #[must_use]
    pub fn size(&self) -> f64 {
        let (left, value, right) = (self.left, self.value, self.right);
        (left - right).abs().max((left - value).abs()).max((value - right).abs())
    }
}

/// A stretch of an input along which an output does not turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// The output there.
    pub from_value: f64,
    /// The output there.
    pub to_value: f64,
}

impl Run {
    /// Whether the output rises along it.
    #[must_use]
    pub fn rises(&self) -> bool {
        self.to_value > self.from_value
    }
}

/// What an output takes on.
#[derive(Debug, Clone, PartialEq)]
pub struct Reach {
    /// The output.
    pub output: String,
    /// Range that the system declares.
    pub range: (f64, f64),
    /// Smallest and largest value that was seen.
    pub reached: (f64, f64),
    /// Whether there are several inputs, so that it may take on more than was seen.
    pub is_partial: bool,
}

impl Reach {
    fn see(&mut self, value: f64) {
        self.reached = (self.reached.0.min(value), self.reached.1.max(value));
    }
}

impl fmt::Display for Reach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { output, range, reached, is_partial } = self;
        let seen = if *is_partial { " at least" } else { "" };
        let [lo, hi, least, most] = [range.0, range.1, reached.0, reached.1].map(words::Short);
        write!(f, "output `{output}` takes on{seen} [{least}, {most}], its range is [{lo}, {hi}]")
    }
}

/// What [`check`] found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// What is wrong or odd, warnings first, then in the order of [`FindingKind::ALL`].
    pub findings: Vec<Finding>,
    /// What each output takes on.
    pub outputs: Vec<Reach>,
    /// Whether the outputs were sampled, as an exact centroid is not to be had.
    pub is_sampled: bool,
    /// What could not be looked at.
    pub skipped: Vec<String>,
}

impl Report {
    /// Number of findings of a severity.
    #[must_use]
    pub fn count(&self, severity: Severity) -> usize {
        self.findings.iter().filter(|finding| finding.severity == severity).count()
    }
}

/// Looks for what is wrong, or odd, with a system that runs.
///
/// Terms, rules and gaps are found from the breakpoints, exactly; a term without feet (`gaussmf`, `gbellmf`, `sigmf` and their kin) counts
/// as holding from a degree of 0.001 on, and its complement up to 0.999. Jumps, turns and reach come from evaluating
/// along the input, or with several inputs along lines in the direction of each, at all breakpoints, to both sides of them
/// and in between; places are then refined to rounding. What beside a breakpoint does not last up to 1e-5 of the range is rounding, as of a
/// complement near 0. The reach with several inputs is what was seen, also at corners, combinations of breakpoints and scattered points.
///
/// Cost: up to some 20,000 evaluations.
///
/// # Errors
/// As [`System::with_engine`]: a system that does not run is not checked.
///
/// # Examples
/// ```
/// use mm_fis::check::{FindingKind, check};
///
/// let text = "[System]\nType='mamdani'\n[Input1]\nName='x'\nRange=[0 2]\nMF1='low':'trimf',[0 0 1]\n\
///             [Output1]\nName='y'\nRange=[0 2]\nMF1='few':'trimf',[0 1 2]\n[Rules]\n1, 1 (1) : 1";
/// let report = check(&mm_fis::read_fis(text)?.system)?;
/// assert_eq!(report.findings[0].kind, FindingKind::UncoveredInput);
/// assert_eq!(report.findings[0].intervals, [(1.0, 2.0)]);
/// assert_eq!(report.findings[1].kind, FindingKind::NoRuleFires);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check(system: &System) -> Result<Report, FuzzyError> {
    let probed = outputs::probe(system)?;
    let axes: Vec<Vec<cells::Cell>> = system.inputs.iter().map(cells::cells).collect();
    let mut skipped = Vec::new();
    let mut findings = terms::find(system, &axes);
    findings.extend(rules::find(system, &axes, &mut skipped));
    findings.extend(probed.findings);
    let is_unfired = findings.iter().any(|finding| finding.kind == FindingKind::NoRuleFires);
    for finding in
        findings.iter_mut().filter(|finding| finding.kind == FindingKind::UncoveredInput && !is_unfired)
    {
        finding.severity = Severity::Note;
    }
    let place = |kind| FindingKind::ALL.iter().position(|other| *other == kind);
    findings.sort_by_key(|finding| (Reverse(finding.severity), place(finding.kind)));
    Ok(Report { findings, outputs: probed.outputs, is_sampled: probed.is_sampled, skipped })
}
