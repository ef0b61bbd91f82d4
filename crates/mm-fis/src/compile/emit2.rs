//! A surface of two inputs as Rust, C and TOML.

use std::fmt::Write;

use serde::Deserialize;

use super::text::{Origin, c_ranges, facts_of_surface, number, numbers, one_line, quoted, range};
use super::{CompileError, CompiledSurface2};

impl CompiledSurface2 {
    fn facts(&self) -> Vec<String> {
        let [first, second] = self.input_ranges.map(range);
        let at = format!("({}, {})", number(self.error_at[0]), number(self.error_at[1]));
        let inputs = format!("all inputs rounded to {} bits", self.input_bits);
        vec![
            format!(
                "Input ranges {first}, {second}, output range {}, in units of 2^-15 of their half from their middle.",
                range(self.output_range)
            ),
            facts_of_surface(self.bound, self.error, &at, &inputs),
            format!("{} knots of {} bits, {} bytes.", self.knots.len(), self.bits, self.bytes()),
        ]
    }

    /// A Rust file with a constant `Surface2`; `root` is the path of the crate, `mm_control` for all but that crate itself.
    #[must_use]
    pub fn to_rust(&self, origin: &Origin<'_>, root: &str) -> String {
        format!(
            "{head}\nuse {root}::fuzzy::fixed::Surface2;\n\n\
             /// The fuzzy system \"{system}\" as a table of knots, within {bound:.4e} of it in output units.\n\
             #[rustfmt::skip]\npub const {name}: Surface2<'static> = Surface2 {{\n    bits: {bits},\n    shifts: {shifts:?},\n    \
             columns: {columns},\n    knots: &[\n{knots}    ],\n    odd: {odd},\n}};\n",
            head = origin.head("//", &self.name, &self.facts()),
            system = one_line(&self.name),
            bound = self.bound,
            name = origin.constant(),
            bits = self.input_bits,
            shifts = self.shifts,
            columns = self.surface().columns,
            knots = numbers(&self.knots, "        "),
            odd = self.odd,
        )
    }

    /// A C99 header with the knots and an inline function, whole numbers only; the same bits as the evaluation in Rust.
    #[must_use]
    pub fn to_c(&self, origin: &Origin<'_>) -> String {
        let (prefix, guard) = (origin.prefix(), format!("{}_H", origin.constant()));
        let [s1, s2] = self.shifts;
        let (bits, columns, shift) = (self.input_bits, self.surface().columns, s1 + s2);
        let (unit, half) = (16 - bits, 1 << (bits - 1));
        let last = [(1_u32 << (bits - u32::from(self.odd) - s1)) - 1, (1_u32 << (bits - s2)) - 1];
        let (turn, back) = if self.odd {
            let turn = format!(
                "    if (p == {half} && r == {half}) {{ return 0; }}\n    turned = p < {half} || (p == {half} && r < {half});\n    \
                 if (turned) {{ p = {full} - p; r = {full} - r; }}\n    p -= {half};\n",
                full = 2 * half
            );
            (turn, "    if (turned) { y = -y; }\n    if (y > 32767) { y = 32767; }\n")
        } else {
            (String::new(), "")
        };
        let declared = if self.odd { "    int turned;\n" } else { "" };
        format!(
            "/*\n{head} */\n#ifndef {guard}\n#define {guard}\n\n#include <stdint.h>\n\n{ranges}\
             static const int16_t {prefix}_knots[{count}] = {{\n{knots}}};\n\n\
             /* Output for the inputs q1, q2; each is rounded to {bits} bits first. */\n\
             static inline int16_t {prefix}_evaluate(int16_t q1, int16_t q2)\n{{\n    \
             int32_t p = (int32_t)((uint32_t)((int32_t)q1 + INT32_C({rounding})) >> {unit});\n    \
             int32_t r = (int32_t)((uint32_t)((int32_t)q2 + INT32_C({rounding})) >> {unit});\n    \
             int32_t i, j, y;\n    int64_t f, g, upper, lower, sum;\n    const int16_t *k;\n{declared}{turn}    \
             i = p >> {s1};\n    if (i > INT32_C({last_row})) {{ i = INT32_C({last_row}); }}\n    \
             j = r >> {s2};\n    if (j > INT32_C({last_column})) {{ j = INT32_C({last_column}); }}\n    \
             f = p - i * (INT32_C(1) << {s1});\n    g = r - j * (INT32_C(1) << {s2});\n    \
             k = &{prefix}_knots[i * INT32_C({columns}) + j];\n    \
             upper = k[0] * (INT64_C(1) << {s2}) + ((int64_t)k[1] - k[0]) * g;\n    \
             lower = k[{columns}] * (INT64_C(1) << {s2}) + ((int64_t)k[{columns} + 1] - k[{columns}]) * g;\n    \
             sum = upper * (INT64_C(1) << {s1}) + (lower - upper) * f + ((INT64_C(1) << {shift}) >> 1);\n    \
             /* floor(sum / 2^{shift}), without shifting a negative number */\n    \
             y = (int32_t)((uint64_t)(sum + (INT64_C(32768) << {shift})) >> {shift}) - 32768;\n{back}    return (int16_t)y;\n}}\n\n\
             #endif /* {guard} */\n",
            head = origin.head(" *", &self.name, &self.facts()),
            ranges = c_ranges(&origin.constant(), &self.input_ranges, self.output_range),
            count = self.knots.len(),
            knots = numbers(&self.knots, "    "),
            rounding = 32768 + ((1 << unit) >> 1),
            last_row = last[0],
            last_column = last[1],
        )
    }

    /// A TOML file that [`from_toml`](Self::from_toml) reads back.
    #[must_use]
    pub fn to_toml(&self, origin: &Origin<'_>) -> String {
        let mut text = origin.head("#", &self.name, &self.facts());
        let [first, second] = self.input_ranges.map(range);
        let _infallible = write!(
            text,
            "kind = \"surface2\"\nsystem = {}\ninput_ranges = [{first}, {second}]\noutput_range = {}\ninput_bits = {}\nbits = {}\n\
             shifts = {:?}\nodd = {}\nbound = {}\nerror = {}\nerror_at = [{}, {}]\nknots = [\n{}]\n",
            quoted(&self.name),
            range(self.output_range),
            self.input_bits,
            self.bits,
            self.shifts,
            self.odd,
            number(self.bound),
            number(self.error),
            number(self.error_at[0]),
            number(self.error_at[1]),
            numbers(&self.knots, "    ")
        );
        text
    }

    /// Reads what [`to_toml`](Self::to_toml) wrote.
    ///
    /// # Errors
    /// [`CompileError::Read`] with line and column for what is no such file, and for another number of knots than it needs.
    pub fn from_toml(text: &str) -> Result<Self, CompileError> {
        let file: File = toml::from_str(text).map_err(|error| CompileError::Read(error.to_string()))?;
        if file.kind != "surface2" {
            return Err(CompileError::Read(format!("`kind` is \"{}\": expected \"surface2\"", file.kind)));
        }
        let read = Self {
            name: file.system,
            input_ranges: file.input_ranges,
            output_range: file.output_range,
            input_bits: file.input_bits,
            bits: file.bits,
            shifts: file.shifts,
            odd: file.odd,
            knots: file.knots,
            bound: file.bound,
            error: file.error,
            error_at: file.error_at,
        };
        if read.surface().check() {
            Ok(read)
        } else {
            Err(CompileError::Read(
                "`knots` has not the number of entries that bits and shifts ask for".to_owned(),
            ))
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    kind: String,
    system: String,
    input_ranges: [(f64, f64); 2],
    output_range: (f64, f64),
    input_bits: u32,
    bits: u32,
    shifts: [u32; 2],
    odd: bool,
    bound: f64,
    error: f64,
    error_at: [f64; 2],
    knots: Vec<i16>,
}
