//! The rule base of the thesis, number by number.

use super::bundled::same;
use super::{
    Aggregation, And, Connective, Defuzzifier, Implication, MamdaniTables, MembershipFunction, Operators, Or,
    Rule, Variable,
};
use mm_model::Q32;

/// The tables in one precision, by the function that makes a number of it of a literal.
macro_rules! tables {
    ($n:path) => {{
        MamdaniTables {
            inputs: &[Variable {
                range: ($n(-1.4), $n(1.4)),
                terms: &[
                    MembershipFunction::Trapezoid([$n(-4.6), $n(-1.4), $n(-0.9667), $n(-0.7003)]),
                    MembershipFunction::Triangle([$n(-1.0), $n(-0.667), $n(-0.25)]),
                    MembershipFunction::Triangle([$n(-0.667), $n(-0.25), $n(0.0)]),
                    MembershipFunction::Triangle([$n(-0.25), $n(0.0), $n(0.0)]),
                    MembershipFunction::Triangle([$n(0.0), $n(0.0), $n(0.25)]),
                    MembershipFunction::Triangle([$n(0.0), $n(0.25), $n(0.667)]),
                    MembershipFunction::Triangle([$n(0.25), $n(0.667), $n(1.0)]),
                    MembershipFunction::Trapezoid([$n(0.7003), $n(0.9667), $n(1.4), $n(4.6)]),
                ],
            }],
            outputs: &[Variable {
                range: ($n(-1.0), $n(1.0)),
                terms: &[
                    MembershipFunction::Triangle([$n(-1.333), $n(-1.0), $n(-0.6666)]),
                    MembershipFunction::Triangle([$n(-1.0), $n(-0.6666), $n(-0.3334)]),
                    MembershipFunction::Triangle([$n(-0.6666), $n(-0.3334), $n(0.0)]),
                    MembershipFunction::Triangle([$n(-0.3334), $n(0.0), $n(0.3334)]),
                    MembershipFunction::Triangle([$n(0.0), $n(0.3334), $n(0.6666)]),
                    MembershipFunction::Triangle([$n(0.3334), $n(0.6666), $n(1.0)]),
                    MembershipFunction::Triangle([$n(0.6666), $n(1.0), $n(1.334)]),
                ],
            }],
            rules: &[
                Rule { inputs: &[1], outputs: &[5], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[2], outputs: &[6], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[3], outputs: &[7], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[4], outputs: &[7], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[5], outputs: &[1], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[6], outputs: &[1], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[7], outputs: &[2], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[8], outputs: &[3], weight: $n(1.0), connective: Connective::And },
            ],
            operators: Operators {
                and: And::Min,
                or: Or::Max,
                implication: Implication::Min,
                aggregation: Aggregation::Max,
            },
            defuzzifier: Defuzzifier::Centroid,
        }
    }};
}

/// The fuzzy switching term of the thesis: Appendix C as printed, with its rules.
///
/// | input term | breakpoints | THEN output term | breakpoints |
/// |---|---|---|---|
/// | NB | -4.6 -1.4 -0.9667 -0.7003 | PS | 0 0.3334 0.6666 |
/// | NM | -1 -0.667 -0.25 | PM | 0.3334 0.6666 1 |
/// | NS, ANZ | -0.667 -0.25 0; -0.25 0 0 | PB | 0.6666 1 1.334 |
/// | APZ, PS | 0 0 0.25; 0 0.25 0.667 | NB | -1.333 -1 -0.6666 |
/// | PM | 0.25 0.667 1 | NM | -1 -0.6666 -0.3334 |
/// | PB | 0.7003 0.9667 1.4 4.6 | NS | -0.6666 -0.3334 0 |
///
/// Convention: input range [-1.4, 1.4], output range [-1, 1]; a positive input gives a negative output. The input
/// is clamped to its range, so that the rules fire for every input. The output term AZ exists and no rule uses it.
///
/// The map is not a smooth one: it jumps from +0.8889 through 0 to -0.8889 at zero, where both ANZ and APZ hold
/// fully, it is not monotone, and at the ends of the range it is down to 1/3 in magnitude. [`SMOOTH`] has
/// none of this.
///
/// [`SMOOTH`]: super::SMOOTH
///
/// # Source
/// The thesis, section 4.5 and Appendix C (the file `FSMC.fis`).
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{Curve, FuzzySystem, THESIS_F32};
///
/// let curve = Curve::<f32>::try_new(&THESIS_F32)?;
/// assert!(curve.evaluate(0.5) < 0.0);
/// assert_eq!(curve.evaluate(9.0), curve.evaluate(1.4));
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
pub const THESIS: MamdaniTables<'static, f64> = tables!(same);

/// The same in single precision, each number of Appendix C rounded once.
pub const THESIS_F32: MamdaniTables<'static, f32> = tables!(same);

/// The same in fixed point.
pub const THESIS_Q32: MamdaniTables<'static, Q32> = tables!(Q32::from_f64);
