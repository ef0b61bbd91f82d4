//! A rule base in fixed point as Rust and TOML.

use std::fmt::Write;

use mm_control::fuzzy::fixed::{Engine, Premise};
use mm_control::fuzzy::{And, Connective, Or};
use serde::Deserialize;

use super::row::Shape as SlotShape;
use super::text::{Origin, one_line, quoted, range};
use super::{CompileError, OutputRow, OwnedRule, OwnedTrigger, Q15};

impl Q15 {
    fn facts(&self) -> Vec<String> {
        let ranges = |ranges: &[(f64, f64)]| ranges.iter().map(|&r| range(r)).collect::<Vec<_>>().join(", ");
        vec![
            format!(
                "Input ranges {}; output ranges {}.",
                ranges(&self.input_ranges),
                ranges(&self.output_ranges)
            ),
            "Corners in units of 2^-15 of half a range from its middle, weights of 2^-30.".to_owned(),
            "Within 2 units of the exact centroid of the system with its corners rounded so.".to_owned(),
        ]
    }

    /// A Rust file with a constant `Tables`; `root` is the path of the crate, `mm_control` for all but that crate itself.
    #[must_use]
    pub fn to_rust(&self, origin: &Origin<'_>, root: &str) -> String {
        let mut text = origin.head("//", &self.name, &self.facts());
        let _infallible = write!(
            text,
            "\nuse {root}::fuzzy::fixed::{{{imports}}};\nuse {root}::fuzzy::{{And, {connective}Or}};\n\n\
             /// The fuzzy system \"{system}\" in fixed point: its breakpoints in units of 2^-15 of half a range.\n\
             #[rustfmt::skip]\npub const {name}: Tables<'static> = Tables {{\n    inputs: &[\n",
            imports = self.imports(),
            connective = if self.rules().next().is_some() { "Connective, " } else { "" },
            system = one_line(&self.name),
            name = origin.constant(),
        );
        for terms in &self.inputs {
            text.push_str("        &[\n");
            for OwnedTrigger { corners, rules } in terms {
                let rules: Vec<String> = rules.iter().map(rust_rule).collect();
                let rules = match rules.as_slice() {
                    [] => "&[]".to_owned(),
                    [rule] => format!("&[{rule}]"),
                    rules => {
                        format!("&[\n                {},\n            ]", rules.join(",\n                "))
                    }
                };
                let _infallible =
                    writeln!(text, "            Trigger {{ term: Term::new({corners:?}), rules: {rules} }},");
            }
            text.push_str("        ],\n");
        }
        text.push_str("    ],\n    rest: &[");
        for rule in &self.rest {
            let _infallible = write!(text, "\n        {},", rust_rule(rule));
        }
        text.push_str(if self.rest.is_empty() {
            "],\n    outputs: &[\n"
        } else {
            "\n    ],\n    outputs: &[\n"
        });
        for OutputRow { scale, slots } in &self.outputs {
            text.push_str("        &[\n");
            for slot in slots {
                let _infallible = match slot {
                    SlotShape::Cut { corners, below } => {
                        writeln!(text, "            Slot::cut({corners:?}, {below:?}, {scale}),")
                    }
                    SlotShape::Scaled { corners } => {
                        writeln!(text, "            Slot::scaled({corners:?}, {scale}),")
                    }
                };
            }
            text.push_str("        ],\n");
        }
        let _infallible = write!(
            text,
            "    ],\n    and: And::{:?},\n    or: Or::{:?},\n    odd: {},\n}};\n",
            self.and, self.or, self.odd
        );
        text
    }

    fn rules(&self) -> impl Iterator<Item = &OwnedRule> {
        self.inputs.iter().flatten().flat_map(|trigger| &trigger.rules).chain(&self.rest)
    }

    fn imports(&self) -> &'static str {
        if self.rules().any(|rule| !rule.premises.is_empty()) {
            "Premise, Rule, Slot, Tables, Term, Trigger"
        } else {
            "Rule, Slot, Tables, Term, Trigger"
        }
    }

    /// A TOML file that [`from_toml`](Self::from_toml) reads back.
    #[must_use]
    pub fn to_toml(&self, origin: &Origin<'_>) -> String {
        let mut text = origin.head("#", &self.name, &self.facts());
        let and = if self.and == And::Min { "min" } else { "prod" };
        let or = if self.or == Or::Max { "max" } else { "probor" };
        let _infallible = write!(
            text,
            "kind = \"q15\"\nsystem = {}\nand = \"{and}\"\nor = \"{or}\"\nodd = {}\nrest = [\n",
            quoted(&self.name),
            self.odd
        );
        for rule in &self.rest {
            let _infallible = writeln!(text, "    {},", toml_rule(rule));
        }
        text.push_str("]\n");
        for (terms, &ends) in self.inputs.iter().zip(&self.input_ranges) {
            let _infallible = write!(text, "\n[[inputs]]\nrange = {}\nterms = [\n", range(ends));
            for OwnedTrigger { corners, rules } in terms {
                let rules: Vec<String> = rules.iter().map(toml_rule).collect();
                let _infallible =
                    writeln!(text, "    {{ corners = {corners:?}, rules = [{}] }},", rules.join(", "));
            }
            text.push_str("]\n");
        }
        for (OutputRow { scale, slots }, &ends) in self.outputs.iter().zip(&self.output_ranges) {
            let _infallible =
                write!(text, "\n[[outputs]]\nrange = {}\nscale = {scale}\nslots = [\n", range(ends));
            for slot in slots {
                let _infallible = match slot {
                    SlotShape::Cut { corners, below: None } => writeln!(text, "    {{ cut = {corners:?} }},"),
                    SlotShape::Cut { corners, below: Some(below) } => {
                        writeln!(text, "    {{ cut = {corners:?}, below = {below:?} }},")
                    }
                    SlotShape::Scaled { corners } => writeln!(text, "    {{ scaled = {corners:?} }},"),
                };
            }
            text.push_str("]\n");
        }
        text
    }

    /// Reads what [`to_toml`](Self::to_toml) wrote.
    ///
    /// # Errors
    /// [`CompileError::Read`] with line and column for what is no such file; [`CompileError::System`] for tables that the engine refuses.
    pub fn from_toml(text: &str) -> Result<Self, CompileError> {
        let file: File = toml::from_str(text).map_err(|error| CompileError::Read(error.to_string()))?;
        let one_of = |name: &str, value: &str, values: [&str; 2]| {
            let position = values.iter().position(|known| *known == value);
            let [first, second] = values;
            let problem = format!("`{name}` is \"{value}\": expected \"{first}\" or \"{second}\"");
            position.ok_or(CompileError::Read(problem))
        };
        if file.kind != "q15" {
            return Err(CompileError::Read(format!("`kind` is \"{}\": expected \"q15\"", file.kind)));
        }
        let and = if one_of("and", &file.and, ["min", "prod"])? == 0 { And::Min } else { And::Prod };
        let or = if one_of("or", &file.or, ["max", "probor"])? == 0 { Or::Max } else { Or::Probor };
        let rule = |rule: &FileRule| -> Result<OwnedRule, CompileError> {
            let connective = if one_of("connective", &rule.connective, ["and", "or"])? == 0 {
                Connective::And
            } else {
                Connective::Or
            };
            let premise = |&(input, term, not): &(u16, u16, bool)| Premise { input, term, not };
            let premises = rule.premises.iter().map(premise).collect();
            Ok(OwnedRule { premises, slots: rule.slots.clone(), weight: rule.weight, connective })
        };
        let trigger = |term: &FileTerm| -> Result<OwnedTrigger, CompileError> {
            let rules = term.rules.iter().map(rule).collect::<Result<_, _>>()?;
            Ok(OwnedTrigger { corners: term.corners, rules })
        };
        let read = Self {
            name: file.system,
            input_ranges: file.inputs.iter().map(|input| input.range).collect(),
            output_ranges: file.outputs.iter().map(|output| output.range).collect(),
            inputs: (file.inputs.iter())
                .map(|input| input.terms.iter().map(trigger).collect())
                .collect::<Result<_, CompileError>>()?,
            rest: file.rest.iter().map(rule).collect::<Result<_, _>>()?,
            outputs: file.outputs.iter().map(row).collect::<Result<_, _>>()?,
            and,
            or,
            odd: file.odd,
        };
        read.with_tables(|tables| Engine::try_new(tables).map(|_| ()))?;
        Ok(read)
    }
}

fn row(output: &FileOutput) -> Result<OutputRow, CompileError> {
    let slot = |slot: &FileSlot| match (slot.cut, slot.scaled, slot.below) {
        (Some(corners), None, below) => Ok(SlotShape::Cut { corners, below }),
        (None, Some(corners), None) => Ok(SlotShape::Scaled { corners }),
        _ => Err(CompileError::Read("a slot has either `cut`, and perhaps `below`, or `scaled`".to_owned())),
    };
    Ok(OutputRow { scale: output.scale, slots: output.slots.iter().map(slot).collect::<Result<_, _>>()? })
}

fn rust_rule(rule: &OwnedRule) -> String {
    let premise = |p: &Premise| format!("Premise {{ input: {}, term: {}, not: {} }}", p.input, p.term, p.not);
    let premises: Vec<String> = rule.premises.iter().map(premise).collect();
    format!(
        "Rule {{ premises: &[{}], slots: &{:?}, weight: {}, connective: Connective::{:?} }}",
        premises.join(", "),
        rule.slots,
        rule.weight,
        rule.connective
    )
}

fn toml_rule(rule: &OwnedRule) -> String {
    let premise = |p: &Premise| format!("[{}, {}, {}]", p.input, p.term, p.not);
    let premises: Vec<String> = rule.premises.iter().map(premise).collect();
    let connective = if rule.connective == Connective::And { "and" } else { "or" };
    let (slots, weight) = (&rule.slots, rule.weight);
    let premises = premises.join(", ");
    format!(
        "{{ premises = [{premises}], slots = {slots:?}, weight = {weight}, connective = \"{connective}\" }}"
    )
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    kind: String,
    system: String,
    and: String,
    or: String,
    odd: bool,
    rest: Vec<FileRule>,
    inputs: Vec<FileInput>,
    outputs: Vec<FileOutput>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileInput {
    range: (f64, f64),
    terms: Vec<FileTerm>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileTerm {
    corners: [i32; 4],
    rules: Vec<FileRule>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRule {
    premises: Vec<(u16, u16, bool)>,
    slots: Vec<u16>,
    weight: u32,
    connective: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileOutput {
    range: (f64, f64),
    scale: u32,
    slots: Vec<FileSlot>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSlot {
    cut: Option<[i32; 4]>,
    below: Option<[i32; 4]>,
    scaled: Option<[i32; 4]>,
}
