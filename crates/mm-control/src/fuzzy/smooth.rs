//! A monotone rule base: what the fuzzy switching term of the thesis is meant to do, without its jump.

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
                range: ($n(-1.0), $n(1.0)),
                terms: &[
                    MembershipFunction::Triangle([$n(-1.0), $n(-1.0), $n(-0.6)]),
                    MembershipFunction::Triangle([$n(-1.0), $n(-0.6), $n(-0.25)]),
                    MembershipFunction::Triangle([$n(-0.6), $n(-0.25), $n(0.0)]),
                    MembershipFunction::Triangle([$n(-0.25), $n(0.0), $n(0.25)]),
                    MembershipFunction::Triangle([$n(0.0), $n(0.25), $n(0.6)]),
                    MembershipFunction::Triangle([$n(0.25), $n(0.6), $n(1.0)]),
                    MembershipFunction::Triangle([$n(0.6), $n(1.0), $n(1.0)]),
                ],
            }],
            outputs: &[Variable {
                range: ($n(-4.0 / 3.0), $n(4.0 / 3.0)),
                terms: &[
                    MembershipFunction::Triangle([$n(-4.0 / 3.0), $n(-1.0), $n(-2.0 / 3.0)]),
                    MembershipFunction::Triangle([$n(-1.0), $n(-2.0 / 3.0), $n(-1.0 / 3.0)]),
                    MembershipFunction::Triangle([$n(-2.0 / 3.0), $n(-1.0 / 3.0), $n(0.0)]),
                    MembershipFunction::Triangle([$n(-1.0 / 3.0), $n(0.0), $n(1.0 / 3.0)]),
                    MembershipFunction::Triangle([$n(0.0), $n(1.0 / 3.0), $n(2.0 / 3.0)]),
                    MembershipFunction::Triangle([$n(1.0 / 3.0), $n(2.0 / 3.0), $n(1.0)]),
                    MembershipFunction::Triangle([$n(2.0 / 3.0), $n(1.0), $n(4.0 / 3.0)]),
                ],
            }],
            rules: &[
                Rule { inputs: &[1], outputs: &[7], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[2], outputs: &[6], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[3], outputs: &[5], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[4], outputs: &[4], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[5], outputs: &[3], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[6], outputs: &[2], weight: $n(1.0), connective: Connective::And },
                Rule { inputs: &[7], outputs: &[1], weight: $n(1.0), connective: Connective::And },
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

/// The default rule base of the smooth fuzzy control law: seven terms a side, strictly falling from +1 to -1.
///
/// | input term | peak | THEN output term | peak |
/// |---|---|---|---|
/// | NB, NM, NS | -1, -0.6, -0.25 | PB, PM, PS | 1, 2/3, 1/3 |
/// | ZE | 0 | ZE | 0 |
/// | PS, PM, PB | 0.25, 0.6, 1 | NS, NM, NB | -1/3, -2/3, -1 |
///
/// Input terms are triangles from neighbour to neighbour, so their degrees sum to 1 over the range [-1, 1].
/// Output terms are triangles of equal width over [-4/3, 4/3]: the outermost ones are whole, so that their
/// centroid, and with it the output at the ends of the input range, is 1 in magnitude.
///
/// Convention: a positive input gives a negative output; 0 gives exactly 0; the map is odd, strictly falling over
/// the range, with slopes from -2, at 0, to -2/3, and stays at its largest magnitude, 1, from |x| = 1 on.
///
/// Why it is monotone: between two peaks exactly two neighbouring output terms fire, with `w` and `1 - w`. Raising
/// `w` adds area only on the far side of the term left behind, and cutting a symmetric term lower does not
/// move its centroid.
///
/// # Source
/// The signs of the rules of section 4.5 of the thesis, with magnitudes that grow with the input.
///
/// # Examples
/// ```
/// use mm_control::fuzzy::{Curve, FuzzySystem, SMOOTH};
///
/// let curve = Curve::<f64>::try_new(&SMOOTH)?;
/// assert_eq!(curve.evaluate(0.0), 0.0);
/// assert!((curve.evaluate(1.0) + 1.0).abs() < 1e-15);
/// assert!(curve.evaluate(0.2) < curve.evaluate(0.1));
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
pub const SMOOTH: MamdaniTables<'static, f64> = tables!(same);

/// The same in single precision.
pub const SMOOTH_F32: MamdaniTables<'static, f32> = tables!(same);

/// The same in fixed point.
pub const SMOOTH_Q32: MamdaniTables<'static, Q32> = tables!(Q32::from_f64);
