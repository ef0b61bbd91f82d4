//! From a system to the tables of the rule engine in fixed point.

use mm_control::fuzzy::fixed::{Engine, Premise, Rule, Slot, Tables, Term, Trigger};
use mm_control::fuzzy::{Aggregation, And, Connective, MembershipFunction, Or};

use super::row::{self, Shape as SlotShape};
use super::steps::Scale;
use super::{CompileError, unsupported};
use crate::{Defuzzification, Kind, Shape, System, Variable};

/// Corners beyond this are not stored, in steps.
const FARTHEST: f64 = 268_435_456.0;
/// One in units of weights.
const ONE: f64 = 1_073_741_824.0;

/// A rule base in fixed point with everything it needs, as [`Tables`] borrow it.
#[derive(Debug, Clone, PartialEq)]
pub struct Q15 {
    /// Name of the system.
    pub name: String,
    /// Lower and upper end of each input.
    pub input_ranges: Vec<(f64, f64)>,
    /// Lower and upper end of each output.
    pub output_ranges: Vec<(f64, f64)>,
    /// The terms of each input.
    pub inputs: Vec<Vec<OwnedTrigger>>,
    /// The rules that no single term sets off.
    pub rest: Vec<OwnedRule>,
    /// The slots of each output.
    pub outputs: Vec<OutputRow>,
    /// Degree of AND.
    pub and: And,
    /// Degree of OR.
    pub or: Or,
    /// Whether it is its own mirror image.
    pub odd: bool,
}

/// The slots of an output.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutputRow {
    /// Exponent of the scale of their areas.
    pub scale: u32,
    /// The slots.
    pub slots: Vec<SlotShape>,
}

/// A term of an input and the rules listed under it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnedTrigger {
    /// Corners in steps.
    pub corners: [i32; 4],
    /// The rules.
    pub rules: Vec<OwnedRule>,
}

/// A rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OwnedRule {
    /// What it asks.
    pub premises: Vec<Premise>,
    /// Which slots it fires.
    pub slots: Vec<u16>,
    /// Factor on its strength, in units of 2^-30.
    pub weight: u32,
    /// How the premises are joined.
    pub connective: Connective,
}

impl System {
    /// The system with its breakpoints and weights as [`Q15`] stores them: rounded to 2^-15 of half their range, and to 2^-30.
    ///
    /// The rule engine in fixed point is within 2 units of the exact centroid of this system; what the rounding itself does
    /// is the difference between this system and the given one.
    #[must_use]
    pub fn as_stored(&self) -> Self {
        let mut stored = self.clone();
        for variable in stored.inputs.iter_mut().chain(&mut stored.outputs) {
            let scale = Scale::of(variable.range);
            let round = |x: f64| scale.value(scale.steps(x).round());
            for term in &mut variable.terms {
                if let Shape::Set(set) = &mut term.shape {
                    match set {
                        MembershipFunction::Triangle(p) => *p = p.map(round),
                        MembershipFunction::Trapezoid(p) => *p = p.map(round),
                        MembershipFunction::LinearS(p) | MembershipFunction::LinearZ(p) => *p = p.map(round),
                        _ => {}
                    }
                }
            }
        }
        for rule in &mut stored.rules {
            rule.weight = (rule.weight * ONE).round() / ONE;
        }
        stored
    }
}

impl Q15 {
    /// Compiles a Mamdani system of piecewise-linear terms whose output terms form a row.
    ///
    /// # Errors
    /// [`CompileError::System`] for a system that no engine takes, [`CompileError::Unsupported`] for what this engine has no place for:
    /// Sugeno systems, curved terms, other defuzzifications than the centroid, aggregation by the probabilistic sum, negated
    /// conclusions; with the maximum, output terms that are not ascending or overlap beyond the next one, and
    /// scaled ones (implication by the product) that overlap; output terms with a side across an end of the range.
    pub fn compile(system: &System) -> Result<Self, CompileError> {
        refuse_other_kinds(system)?;
        system.with_engine(crate::Accuracy::Exact, |_| ())?;
        let input_corners = system
            .inputs
            .iter()
            .map(|variable| {
                corners_of(variable, "input").map(|terms| terms.into_iter().map(beyond_ends).collect())
            })
            .collect::<Result<Vec<Vec<[i32; 4]>>, _>>()?;
        let output_corners = system.outputs.iter().map(row::clipped_terms).collect::<Result<Vec<_>, _>>()?;
        let rules = firing_rules(system);
        if rules.is_empty() {
            return Err(unsupported("the rules", "none of them ever fires"));
        }
        let mut outputs = Vec::new();
        let mut slots_of_rules = vec![Vec::new(); rules.len()];
        let mut first = 0;
        for (position, (variable, corners)) in system.outputs.iter().zip(&output_corners).enumerate() {
            let concluded: Vec<usize> =
                rules.iter().map(|rule| usize::from(rule.outputs[position].unsigned_abs())).collect();
            let (output, slots) = row::row(system, variable, corners, &concluded)?;
            for (slot, own) in slots.into_iter().zip(&mut slots_of_rules) {
                let number = slot.map(|slot| u16::try_from(first + slot));
                own.extend(number.transpose().map_err(|_| unsupported("the rules", "there are too many"))?);
            }
            first += output.slots.len();
            outputs.push(output);
        }
        let odd = is_odd(&rules, &input_corners, &output_corners);
        let (inputs, rest) = listed(&rules, slots_of_rules, &input_corners)?;
        let ranges = |variables: &[Variable]| variables.iter().map(|variable| variable.range).collect();
        let compiled = Self {
            name: system.name.clone(),
            input_ranges: ranges(&system.inputs),
            output_ranges: ranges(&system.outputs),
            inputs,
            rest,
            outputs,
            and: system.and,
            or: system.or,
            odd,
        };
        compiled.with_tables(|tables| Engine::try_new(tables).map(|_| ()))?;
        Ok(compiled)
    }

    /// The tables, stored for the rest of the program, as a control law needs them.
    #[must_use]
    pub fn leak(&self) -> &'static Tables<'static> {
        let rules = |rules: &[OwnedRule]| -> &'static [Rule<'static>] {
            Vec::leak(
                rules
                    .iter()
                    .map(|rule| Rule {
                        premises: Vec::leak(rule.premises.clone()),
                        slots: Vec::leak(rule.slots.clone()),
                        weight: rule.weight,
                        connective: rule.connective,
                    })
                    .collect(),
            )
        };
        let triggers = |terms: &Vec<OwnedTrigger>| -> &'static [Trigger<'static>] {
            let owned = |trigger: &OwnedTrigger| Trigger {
                term: Term::new(trigger.corners),
                rules: rules(&trigger.rules),
            };
            Vec::leak(terms.iter().map(owned).collect())
        };
        Box::leak(Box::new(Tables {
            inputs: Vec::leak(self.inputs.iter().map(triggers).collect()),
            rest: rules(&self.rest),
            outputs: Vec::leak(self.outputs.iter().map(|row| &*Vec::leak(row.slots())).collect()),
            and: self.and,
            or: self.or,
            odd: self.odd,
        }))
    }

    /// Makes the tables and hands them to `work`; they live as long as that call.
    pub fn with_tables<R>(&self, work: impl FnOnce(&Tables<'_>) -> R) -> R {
        let rules: Vec<Vec<Vec<Rule<'_>>>> = self
            .inputs
            .iter()
            .map(|terms| {
                terms.iter().map(|trigger| trigger.rules.iter().map(OwnedRule::borrow).collect()).collect()
            })
            .collect();
        let inputs: Vec<Vec<Trigger<'_>>> = (self.inputs.iter().zip(&rules))
            .map(|(terms, rules)| {
                terms
                    .iter()
                    .zip(rules)
                    .map(|(term, rules)| Trigger { term: Term::new(term.corners), rules })
                    .collect()
            })
            .collect();
        let inputs: Vec<&[Trigger<'_>]> = inputs.iter().map(Vec::as_slice).collect();
        let outputs: Vec<Vec<Slot>> = self.outputs.iter().map(OutputRow::slots).collect();
        let outputs: Vec<&[Slot]> = outputs.iter().map(Vec::as_slice).collect();
        let rest: Vec<Rule<'_>> = self.rest.iter().map(OwnedRule::borrow).collect();
        work(&Tables {
            inputs: &inputs,
            outputs: &outputs,
            rest: &rest,
            and: self.and,
            or: self.or,
            odd: self.odd,
        })
    }
}

impl OwnedRule {
    fn borrow(&self) -> Rule<'_> {
        Rule {
            premises: &self.premises,
            slots: &self.slots,
            weight: self.weight,
            connective: self.connective,
        }
    }
}

impl OutputRow {
    fn slots(&self) -> Vec<Slot> {
        let slot = |shape: &SlotShape| match *shape {
            SlotShape::Cut { corners, below } => Slot::cut(corners, below, self.scale),
            SlotShape::Scaled { corners } => Slot::scaled(corners, self.scale),
        };
        self.slots.iter().map(slot).collect()
    }
}

fn refuse_other_kinds(system: &System) -> Result<(), CompileError> {
    if system.kind == Kind::Sugeno {
        return Err(unsupported("a Sugeno system", "its rules conclude no fuzzy sets"));
    }
    if system.defuzzification != Defuzzification::Centroid {
        return Err(unsupported("the defuzzification", "only the centroid is computed in fixed point"));
    }
    if system.aggregation == Aggregation::Probor {
        return Err(unsupported("the aggregation", "the probabilistic sum makes the output set curved"));
    }
    for (number, rule) in (1..).zip(&system.rules) {
        if rule.outputs.iter().any(|&term| term < 0) {
            return Err(unsupported(format!("rule {number}"), "it concludes the complement of a term"));
        }
    }
    for (variables, role) in [(&system.inputs, "input"), (&system.outputs, "output")] {
        for variable in variables {
            corners_of(variable, role)?;
        }
    }
    Ok(())
}

/// The corners of all terms in steps, rounded.
pub(super) fn corners_of(variable: &Variable, role: &str) -> Result<Vec<[i32; 4]>, CompileError> {
    let scale = Scale::of(variable.range);
    let (lo, hi) = variable.range;
    let corners = |term: &crate::Term| {
        let refuse =
            |reason| unsupported(format!("the term `{}` of {role} `{}`", term.name, variable.name), reason);
        let Shape::Set(set) = &term.shape else { return Err(refuse("it is no fuzzy set")) };
        let corners = set.corners(lo, hi).ok_or_else(|| refuse("it is not piecewise linear"))?;
        let steps = corners.map(|corner| scale.steps(corner).round());
        let near = held_far_ends(steps);
        if near.iter().all(|steps| steps.abs() <= FARTHEST) {
            #[expect(clippy::cast_possible_truncation, reason = "compared just before")]
            Ok(near.map(|steps| steps as i32))
        } else {
            Err(refuse("it has a side that starts more than 8192 half ranges away"))
        }
    };
    variable.terms.iter().map(corners).collect()
}

/// Sides that lie beyond the ends altogether, moved to where a number of 32 bits holds them.
fn held_far_ends([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    let (left, right) = (-FARTHEST, FARTHEST);
    let (a, b) = if b < -32768.0 { (a.max(left), b.max(left)) } else { (a, b) };
    let (c, d) = if c > 32768.0 { (c.min(right), d.min(right)) } else { (c, d) };
    [a, b.min(c), c.max(b), d]
}

/// Sides beyond the ends of an input's range made vertical there, where it has no effect within.
fn beyond_ends([a, b, c, d]: [i32; 4]) -> [i32; 4] {
    let (a, b) = if b <= -32768 && c >= -32768 { (-32768, -32768) } else { (a, b) };
    let (c, d) = if c >= 32768 && b <= 32768 { (32768, 32768) } else { (c, d) };
    [a, b, c, d]
}

/// The rules that can fire and conclude something.
fn firing_rules(system: &System) -> Vec<&crate::Rule> {
    let fires = |rule: &&crate::Rule| {
        let asks = rule.inputs.iter().any(|&term| term != 0) || rule.connective == Connective::And;
        asks && weight(rule) > 0 && rule.outputs.iter().any(|&term| term != 0)
    };
    system.rules.iter().filter(fires).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the engine has checked that it is in [0, 1]"
)]
fn weight(rule: &crate::Rule) -> u32 {
    (rule.weight * ONE).round() as u32
}

/// The terms of each input with the rules listed under them, and the other rules.
///
/// A rule joined by AND goes under the term with the narrowest reach of those it asks for: there it is met least often.
fn listed(
    rules: &[&crate::Rule],
    slots: Vec<Vec<u16>>,
    inputs: &[Vec<[i32; 4]>],
) -> Result<(Vec<Vec<OwnedTrigger>>, Vec<OwnedRule>), CompileError> {
    let term = |&corners: &[i32; 4]| OwnedTrigger { corners, rules: Vec::new() };
    let mut terms: Vec<Vec<OwnedTrigger>> =
        inputs.iter().map(|terms| terms.iter().map(term).collect()).collect();
    let mut rest = Vec::new();
    for (rule, slots) in rules.iter().zip(slots) {
        let mut premises = Vec::new();
        for (input, &index) in rule.inputs.iter().enumerate() {
            if let Some(term) = index.unsigned_abs().checked_sub(1) {
                let input =
                    u16::try_from(input).map_err(|_| unsupported("the system", "it has too many inputs"))?;
                premises.push(Premise { input, term, not: index < 0 });
            }
        }
        let reach = |premise: &Premise| {
            let [a, .., d] = inputs[usize::from(premise.input)][usize::from(premise.term)];
            d.abs_diff(a)
        };
        let plain = premises.iter().enumerate().filter(|(_, premise)| !premise.not);
        let narrowest = plain.min_by_key(|(_, premise)| reach(premise)).map(|(position, _)| position);
        let (weight, connective) = (weight(rule), rule.connective);
        match narrowest.filter(|_| connective == Connective::And) {
            Some(position) => {
                let own = premises.remove(position);
                let rule = OwnedRule { premises, slots, weight, connective };
                terms[usize::from(own.input)][usize::from(own.term)].rules.push(rule);
            }
            None => rest.push(OwnedRule { premises, slots, weight, connective }),
        }
    }
    Ok((terms, rest))
}

/// Whether the rules are their own mirror image.
fn is_odd(rules: &[&crate::Rule], inputs: &[Vec<[i32; 4]>], outputs: &[Vec<[i32; 4]>]) -> bool {
    let mirrored = |[a, b, c, d]: [i32; 4]| [-d, -c, -b, -a];
    let kept = |corners: [i32; 4]| corners;
    let described = |turn: &dyn Fn([i32; 4]) -> [i32; 4]| {
        let terms = |indices: &[i16], variables: &[Vec<[i32; 4]>]| -> Vec<Option<(bool, [i32; 4])>> {
            let term = |(&index, terms): (&i16, &Vec<[i32; 4]>)| {
                let position = usize::from(index.unsigned_abs()).checked_sub(1)?;
                Some((index < 0, turn(terms[position])))
            };
            indices.iter().zip(variables).map(term).collect()
        };
        let mut all: Vec<_> = rules
            .iter()
            .map(|rule| {
                let and = rule.connective == Connective::And;
                (terms(&rule.inputs, inputs), terms(&rule.outputs, outputs), weight(rule), and)
            })
            .collect();
        all.sort_unstable();
        all
    };
    described(&kept) == described(&mirrored)
}
