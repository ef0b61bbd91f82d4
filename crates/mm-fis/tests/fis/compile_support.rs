//! Systems for the tests of the compiler: the two that are shipped, and random ones with a fixed seed.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "numbers small by construction"
)]

use mm_control::fuzzy::{
    Aggregation, And, Connective, Defuzzifier, Implication, MamdaniTables, MembershipFunction as Mf, Or,
    SMOOTH, THESIS,
};
use mm_fis::{Defuzzification, Kind, Rule, Shape, System, Term, Variable};

/// A generator of numbers, xorshift64*.
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn word(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    /// Uniform in [lo, hi).
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * ((self.word() >> 11) as f64 / 9_007_199_254_740_992.0)
    }

    /// Below `n`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.word() >> 33) as usize % n
    }

    pub(crate) fn chance(&mut self, p: f64) -> bool {
        self.between(0.0, 1.0) < p
    }
}

/// A system from tables, with made-up names.
pub(crate) fn system(name: &str, tables: &MamdaniTables<'_, f64>) -> System {
    assert_eq!(tables.defuzzifier, Defuzzifier::Centroid, "the only one that is translated here");
    let variables = |role: &str, variables: &[mm_control::fuzzy::Variable<'_, f64>]| {
        let variable = |(number, variable): (usize, &mm_control::fuzzy::Variable<'_, f64>)| Variable {
            name: format!("{role}{number}"),
            range: variable.range,
            terms: variable
                .terms
                .iter()
                .enumerate()
                .map(|(number, &set)| Term { name: format!("t{number}"), shape: Shape::Set(set) })
                .collect(),
        };
        (1..).zip(variables).map(variable).collect()
    };
    System {
        name: name.to_owned(),
        kind: Kind::Mamdani,
        and: tables.operators.and,
        or: tables.operators.or,
        implication: tables.operators.implication,
        aggregation: tables.operators.aggregation,
        defuzzification: Defuzzification::Centroid,
        inputs: variables("in", tables.inputs),
        outputs: variables("out", tables.outputs),
        rules: tables
            .rules
            .iter()
            .map(|rule| Rule {
                inputs: rule.inputs.to_vec(),
                outputs: rule.outputs.to_vec(),
                weight: rule.weight,
                connective: rule.connective,
            })
            .collect(),
    }
}

pub(crate) fn thesis() -> System {
    system("thesis", &THESIS)
}

pub(crate) fn smooth() -> System {
    system("smooth", &SMOOTH)
}

fn term(number: usize, set: Mf<f64>) -> Term {
    Term { name: format!("t{number}"), shape: Shape::Set(set) }
}

/// An input with terms from shoulder to shoulder, wide, narrow or with gaps between.
fn input(random: &mut Random, name: String) -> Variable {
    let (middle, half) = (random.between(-5.0, 5.0), random.between(0.1, 20.0));
    let range = (middle - half, middle + half);
    let count = 2 + random.below(5);
    let spread = random.between(0.4, 1.3);
    let terms = (0..count).map(|k| {
        let pitch = 2.0 * half / (count - 1) as f64;
        let peak = range.0 + pitch * k as f64;
        let (l, r) = (spread * pitch * random.between(0.7, 1.0), spread * pitch * random.between(0.7, 1.0));
        term(
            k,
            match random.below(5) {
                _ if k == 0 && random.chance(0.5) => Mf::LinearZ([peak, peak + r]),
                _ if k + 1 == count && random.chance(0.5) => Mf::LinearS([peak - l, peak]),
                0 => Mf::Trapezoid([peak - l, peak - 0.3 * l, peak + 0.4 * r, peak + r]),
                1 => Mf::Triangle([peak, peak, peak + r]),
                2 => Mf::Trapezoid([peak - l, peak - 0.5 * l, peak + 0.5 * r, peak + 0.5 * r]),
                _ => Mf::Triangle([peak - l, peak, peak + r]),
            },
        )
    });
    let terms = terms.collect();
    Variable { name, range, terms }
}

/// An output whose terms form a row of neighbours, some of them apart, some very narrow.
fn output(random: &mut Random, name: String, apart: bool) -> Variable {
    let (middle, half) = (random.between(-5.0, 5.0), random.between(0.1, 20.0));
    let count = 2 + random.below(5);
    let pitch = 2.0 * half / (count + 1) as f64;
    let overlap = if apart { 0.0 } else { random.between(0.0, 0.499) };
    let terms = (0..count).map(|k| {
        let centre = middle - half + pitch * (k + 1) as f64;
        let reach = pitch * (0.5 + overlap);
        let narrow = if random.chance(0.2) { random.between(0.02, 0.2) } else { 1.0 };
        let (a, d) = (centre - reach * narrow, centre + reach * narrow);
        term(
            k,
            match random.below(4) {
                0 => Mf::Trapezoid([a, 0.6 * a + 0.4 * centre, 0.3 * d + 0.7 * centre, d]),
                1 if narrow < 1.0 => Mf::Triangle([a, a, d]),
                _ => Mf::Triangle([a, 0.5 * a + 0.5 * d, d]),
            },
        )
    });
    let terms = terms.collect();
    Variable { name, range: (middle - half, middle + half), terms }
}

/// A random system that the Q15 engine takes, of one kind of operators for each seed.
pub(crate) fn random(seed: u64, inputs: usize, outputs: usize) -> System {
    let random = &mut Random::new(seed);
    let sum = seed % 3 == 1;
    let implication = if seed % 4 == 1 || seed % 6 == 5 { Implication::Prod } else { Implication::Min };
    let apart = !sum && implication == Implication::Prod;
    let inputs: Vec<Variable> = (1..=inputs).map(|k| input(random, format!("x{k}"))).collect();
    let outputs: Vec<Variable> = (1..=outputs).map(|k| output(random, format!("y{k}"), apart)).collect();
    let cells: usize = inputs.iter().map(|input| input.terms.len()).product();
    let rules = (0..cells.min(24)).map(|cell| {
        let mut rest = cell;
        let mut indices: Vec<i16> = inputs
            .iter()
            .map(|input| {
                let index = rest % input.terms.len();
                rest /= input.terms.len();
                (index + 1) as i16
            })
            .collect();
        if random.chance(0.2) {
            let turned = random.below(indices.len());
            indices[turned] = -indices[turned];
        }
        if indices.len() > 1 && random.chance(0.2) {
            let dropped = random.below(indices.len());
            indices[dropped] = 0;
        }
        let conclude = |output: &Variable| (random.below(output.terms.len()) + 1) as i16;
        let outputs = outputs.iter().map(conclude).collect();
        let weight = if random.chance(0.3) { random.between(0.001, 1.0) } else { 1.0 };
        let connective = if random.chance(0.25) { Connective::Or } else { Connective::And };
        Rule { inputs: indices, outputs, weight, connective }
    });
    let rules = rules.collect();
    System {
        name: format!("random{seed}"),
        kind: Kind::Mamdani,
        and: if seed.is_multiple_of(2) { And::Min } else { And::Prod },
        or: if seed % 5 < 2 { Or::Probor } else { Or::Max },
        implication,
        aggregation: if sum { Aggregation::Sum } else { Aggregation::Max },
        defuzzification: Defuzzification::Centroid,
        inputs,
        outputs,
        rules,
    }
}
