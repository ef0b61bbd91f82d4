//! A surface of one input as Rust, C and TOML.

use std::fmt::Write;

use mm_control::fuzzy::fixed::Section;
use serde::Deserialize;

use super::text::{Origin, c_ranges, facts_of_surface, number, numbers, quoted, range};
use super::{CompileError, CompiledSurface, Jump};

impl CompiledSurface {
    fn facts(&self) -> Vec<String> {
        let jumps = self.jumps.len();
        vec![
            format!(
                "Input range {}, output range {}, both in units of 2^-15 of their half from their middle.",
                range(self.input_range),
                range(self.output_range)
            ),
            facts_of_surface(self.bound, self.error, &number(self.error_at), "all 65536 inputs"),
            format!(
                "{} knots of {} bits, {} section(s), {jumps} jump(s), {} bytes.",
                self.knots.len(),
                self.bits,
                self.sections.len(),
                self.bytes()
            ),
        ]
    }

    /// A Rust file with a constant `Surface1`; `root` is the path of the crate, `mm_control` for all but that crate itself.
    #[must_use]
    pub fn to_rust(&self, origin: &Origin<'_>, root: &str) -> String {
        let section =
            |s: &Section| format!("Section {{ start: {}, knot: {}, shift: {} }}", s.start, s.knot, s.shift);
        let surface = self.surface();
        let others: String =
            surface.others.iter().map(|other| format!("        {},\n", section(other))).collect();
        let others = if others.is_empty() { "&[]".to_owned() } else { format!("&[\n{others}    ]") };
        format!(
            "{head}\nuse {root}::fuzzy::fixed::{{Section, Surface1}};\n\n\
             /// The fuzzy system \"{system}\" as a table of knots, within {bound:.4e} of it in output units.\n\
             ///\n/// Input range {input}, output range {output}.\n\
             #[rustfmt::skip]\n\
             pub const {name}: Surface1<'static> = Surface1 {{\n    first: {first},\n    others: {others},\n    \
             knots: &[\n{knots}    ],\n    odd: {odd},\n}};\n",
            head = origin.head("//", &self.name, &self.facts()),
            system = super::text::one_line(&self.name),
            bound = self.bound,
            input = doc_range(self.input_range),
            output = doc_range(self.output_range),
            name = origin.constant(),
            first = section(&surface.first),
            knots = numbers(&self.knots, "        "),
            odd = self.odd,
        )
    }

    /// A C99 header with the knots and an inline function, whole numbers only; the same bits as the evaluation in Rust.
    #[must_use]
    pub fn to_c(&self, origin: &Origin<'_>) -> String {
        let (prefix, guard) = (origin.prefix(), format!("{}_H", origin.constant()));
        let head: String = origin.head(" *", &self.name, &self.facts());
        let mut text = format!("/*\n{head} */\n#ifndef {guard}\n#define {guard}\n\n#include <stdint.h>\n\n");
        text.push_str(&c_ranges(&origin.constant(), &[self.input_range], self.output_range));
        let _infallible = write!(
            text,
            "static const int16_t {prefix}_knots[{}] = {{\n{}}};\n\n",
            self.knots.len(),
            numbers(&self.knots, "    ")
        );
        let first = self.surface().first;
        let (mut lookup, start, knot, shift);
        if self.sections.len() > 1 {
            let _infallible = writeln!(
                text,
                "static const struct {{ int32_t start; uint32_t knot; uint32_t shift; }} {prefix}_sections[{}] = {{",
                self.sections.len()
            );
            for s in &self.sections {
                let _infallible = writeln!(text, "    {{ {}, {}u, {}u }},", s.start, s.knot, s.shift);
            }
            text.push_str("};\n\n");
            lookup = format!(
                "    uint32_t low = 0u, high = {}u;\n    uint32_t start_knot, shift;\n    int32_t start;\n",
                self.sections.len()
            );
            let _infallible = write!(
                lookup,
                "    while (high - low > 1u) {{\n        const uint32_t middle = (low + high) / 2u;\n        \
                 if ({prefix}_sections[middle].start <= p) {{ low = middle; }} else {{ high = middle; }}\n    }}\n    \
                 start = {prefix}_sections[low].start;\n    start_knot = {prefix}_sections[low].knot;\n    \
                 shift = {prefix}_sections[low].shift;\n"
            );
            (start, knot, shift) = ("start".to_owned(), "start_knot".to_owned(), "shift".to_owned());
        } else {
            lookup = String::new();
            (start, knot, shift) = (
                format!("INT32_C({})", first.start),
                format!("{}u", first.knot),
                format!("{}u", first.shift),
            );
        }
        text.push_str(&self.c_function(&prefix, &lookup, [&start, &knot, &shift]));
        let _infallible = write!(text, "\n#endif /* {guard} */\n");
        text
    }

    fn c_function(&self, prefix: &str, lookup: &str, [start, knot, shift]: [&str; 3]) -> String {
        let (position, before, turn) = if self.odd {
            let before = format!("    if (p < {start}) {{ return 0; }}\n");
            (
                "q < 0 ? -(int32_t)q : q",
                before,
                "    if (q < 0) { y = -y; }\n    if (y > 32767) { y = 32767; }\n",
            )
        } else {
            ("q", String::new(), "")
        };
        format!(
            "/* Output for the input q; the product and sum below stay within 32 bits: 2^16 * 2^14 + 2^30. */\n\
             static inline int16_t {prefix}_evaluate(int16_t q)\n{{\n    const int32_t p = {position};\n    \
             uint32_t past, index;\n    int32_t near_knot, rise, y;\n{lookup}{before}    \
             past = (uint32_t)(p - {start}) << {shift};\n    index = {knot} + (past >> 14);\n    \
             near_knot = {prefix}_knots[index];\n    \
             rise = ({prefix}_knots[index + 1u] - near_knot) * (int32_t)(past & 0x3fffu) + INT32_C(0x2000);\n    \
             /* floor(rise / 2^14), without shifting a negative number */\n    \
             y = near_knot + (int32_t)((uint32_t)(rise + INT32_C(0x40000000)) >> 14) - INT32_C(0x10000);\n{turn}    \
             return (int16_t)y;\n}}\n"
        )
    }

    /// A TOML file that [`from_toml`](Self::from_toml) reads back.
    #[must_use]
    pub fn to_toml(&self, origin: &Origin<'_>) -> String {
        let mut text = origin.head("#", &self.name, &self.facts());
        let _infallible = write!(
            text,
            "kind = \"surface1\"\nsystem = {}\ninput_range = {}\noutput_range = {}\nodd = {}\nbits = {}\nbound = {}\nerror = {}\n\
             error_at = {}\n",
            quoted(&self.name),
            range(self.input_range),
            range(self.output_range),
            self.odd,
            self.bits,
            number(self.bound),
            number(self.error),
            number(self.error_at)
        );
        text.push_str("jumps = [\n");
        for Jump { at, below, from, to } in &self.jumps {
            let (at, from, to) = (number(*at), number(*from), number(*to));
            let _infallible =
                writeln!(text, "    {{ at = {at}, below = {below}, from = {from}, to = {to} }},");
        }
        text.push_str("]\nsections = [\n");
        for Section { start, knot, shift } in &self.sections {
            let _infallible = writeln!(text, "    {{ start = {start}, knot = {knot}, shift = {shift} }},");
        }
        let _infallible = write!(text, "]\nknots = [\n{}]\n", numbers(&self.knots, "    "));
        text
    }

    /// Reads what [`to_toml`](Self::to_toml) wrote.
    ///
    /// # Errors
    /// [`CompileError::Read`] with line and column for what is no such file, and for sections that do not fit their knots.
    pub fn from_toml(text: &str) -> Result<Self, CompileError> {
        let file: File = toml::from_str(text).map_err(|error| CompileError::Read(error.to_string()))?;
        if file.kind != "surface1" {
            return Err(CompileError::Read(format!("`kind` is \"{}\": expected \"surface1\"", file.kind)));
        }
        let section = |s: &FileSection| Section { start: s.start, knot: s.knot, shift: s.shift };
        let jump = |j: &FileJump| Jump { at: j.at, below: j.below, from: j.from, to: j.to };
        let read = Self {
            name: file.system,
            input_range: file.input_range,
            output_range: file.output_range,
            odd: file.odd,
            sections: file.sections.iter().map(section).collect(),
            knots: file.knots,
            bits: file.bits,
            bound: file.bound,
            error: file.error,
            error_at: file.error_at,
            jumps: file.jumps.iter().map(jump).collect(),
        };
        if read.surface().check() {
            Ok(read)
        } else {
            Err(CompileError::Read("the sections do not ascend, or do not find their knots".to_owned()))
        }
    }
}

/// A range in a doc comment, where brackets would be a link.
fn doc_range((lo, hi): (f64, f64)) -> String {
    format!("from {} to {}", number(lo), number(hi))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    kind: String,
    system: String,
    input_range: (f64, f64),
    output_range: (f64, f64),
    odd: bool,
    bits: u32,
    bound: f64,
    error: f64,
    error_at: f64,
    jumps: Vec<FileJump>,
    sections: Vec<FileSection>,
    knots: Vec<i16>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileJump {
    at: f64,
    below: i32,
    from: f64,
    to: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileSection {
    start: i32,
    knot: u32,
    shift: u32,
}
