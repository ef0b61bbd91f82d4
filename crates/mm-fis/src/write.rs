//! Writes `.fis` files.

use std::fmt::{self, Write};

use mm_control::fuzzy::{Aggregation, And, Connective, Implication, MembershipFunction as Mf, Or};

use crate::{Defuzzification, Kind, Rule, Shape, System, Term, Variable};

/// Writes a system as a `.fis` file of version 2.0, as MATLAB reads it.
///
/// Numbers are the shortest that read back to the same bits, so that [`read_fis`](crate::read_fis) gives an equal system; writing
/// that one gives the same text. A quote within a name is doubled; a line break within a name, which no file can hold,
/// becomes a blank.
///
/// # Examples
/// ```
/// let text = "[System]\nType='sugeno'\n[Input1]\nName='x'\nRange=[0 1]\nMF1='low':'trimf',[0 0 1]\n\
///             [Output1]\nName='y'\nRange=[0 1]\nMF1='few':'constant',[.5]\n[Rules]\n1, 1 (1) : 1";
/// let system = mm_fis::read_fis(text)?.system;
/// let written = mm_fis::write_fis(&system);
/// assert!(written.contains("MF1='few':'constant',[0.5]\n"));
/// assert_eq!(mm_fis::read_fis(&written)?.system, system);
/// # Ok::<(), mm_fis::ReadError>(())
/// ```
#[must_use]
pub fn write_fis(system: &System) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_system(&mut text, system);
    text
}

fn write_system(out: &mut String, system: &System) -> fmt::Result {
    let kind = match system.kind {
        Kind::Mamdani => "mamdani",
        Kind::Sugeno => "sugeno",
    };
    writeln!(out, "[System]\nName={}\nType='{kind}'\nVersion=2.0", quoted(&system.name))?;
    writeln!(out, "NumInputs={}\nNumOutputs={}", system.inputs.len(), system.outputs.len())?;
    writeln!(out, "NumRules={}", system.rules.len())?;
    let and = match system.and {
        And::Min => "min",
        And::Prod => "prod",
    };
    let or = match system.or {
        Or::Max => "max",
        Or::Probor => "probor",
    };
    let implication = match system.implication {
        Implication::Min => "min",
        Implication::Prod => "prod",
    };
    let aggregation = match system.aggregation {
        Aggregation::Max => "max",
        Aggregation::Sum => "sum",
        Aggregation::Probor => "probor",
    };
    writeln!(out, "AndMethod='{and}'\nOrMethod='{or}'\nImpMethod='{implication}'")?;
    writeln!(out, "AggMethod='{aggregation}'\nDefuzzMethod='{}'", defuzzification(system.defuzzification))?;
    for (what, variables) in [("Input", &system.inputs), ("Output", &system.outputs)] {
        for (variable, number) in variables.iter().zip(1..) {
            writeln!(out, "\n[{what}{number}]")?;
            write_variable(out, variable)?;
        }
    }
    writeln!(out, "\n[Rules]")?;
    system.rules.iter().try_for_each(|rule| write_rule(out, rule))
}

const fn defuzzification(defuzzification: Defuzzification) -> &'static str {
    match defuzzification {
        Defuzzification::Centroid => "centroid",
        Defuzzification::Bisector => "bisector",
        Defuzzification::MeanOfMaximum => "mom",
        Defuzzification::SmallestOfMaximum => "som",
        Defuzzification::LargestOfMaximum => "lom",
        Defuzzification::WeightedAverage => "wtaver",
        Defuzzification::WeightedSum => "wtsum",
    }
}

fn write_variable(out: &mut String, variable: &Variable) -> fmt::Result {
    let (low, high) = variable.range;
    writeln!(out, "Name={}\nRange={}", quoted(&variable.name), Vector(&[low, high]))?;
    writeln!(out, "NumMFs={}", variable.terms.len())?;
    for (Term { name, shape }, number) in variable.terms.iter().zip(1..) {
        let (form, numbers) = match shape {
            Shape::Set(set) => (set_name(set), set.parameters()),
            Shape::Constant(value) => ("constant", std::slice::from_ref(value)),
            Shape::Linear(factors) => ("linear", factors.as_slice()),
        };
        writeln!(out, "MF{number}={}:'{form}',{}", quoted(name), Vector(numbers))?;
    }
    Ok(())
}

const fn set_name(set: &Mf<f64>) -> &'static str {
    match set {
        Mf::Triangle(_) => "trimf",
        Mf::Trapezoid(_) => "trapmf",
        Mf::LinearS(_) => "linsmf",
        Mf::LinearZ(_) => "linzmf",
        Mf::Gaussian(_) => "gaussmf",
        Mf::Gaussian2(_) => "gauss2mf",
        Mf::Bell(_) => "gbellmf",
        Mf::Sigmoid(_) => "sigmf",
        Mf::SigmoidDifference(_) => "dsigmf",
        Mf::SigmoidProduct(_) => "psigmf",
        Mf::S(_) => "smf",
        Mf::Z(_) => "zmf",
        Mf::Pi(_) => "pimf",
    }
}

fn write_rule(out: &mut String, rule: &Rule) -> fmt::Result {
    let connective = match rule.connective {
        Connective::And => 1,
        Connective::Or => 2,
    };
    let list = |indices: &[i16]| indices.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ");
    let (inputs, outputs) = (list(&rule.inputs), list(&rule.outputs));
    writeln!(out, "{inputs}, {outputs} ({}) : {connective}", Number(rule.weight))
}

/// A name in quotes.
fn quoted(name: &str) -> String {
    format!("'{}'", name.replace('\'', "''").replace(['\n', '\r'], " "))
}

/// A number in the shortest digits that give the same bits.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.abs();
        // Debug writes 1e300 where Display writes 301 digits, and 1.0 where it writes 1.
        if magnitude > 0.0 && !(1e-5..1e16).contains(&magnitude) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

/// Numbers in brackets.
struct Vector<'a>(&'a [f64]);

impl fmt::Display for Vector<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("[")?;
        for (index, number) in self.0.iter().enumerate() {
            write!(f, "{}{}", if index > 0 { " " } else { "" }, Number(*number))?;
        }
        f.write_str("]")
    }
}
