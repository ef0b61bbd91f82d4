//! A monotone rule base: what the fuzzy switching term of the thesis is meant to do, without its jump.

use super::{MembershipFunction, Rule, RuleBase};

const THIRD: f64 = 1.0 / 3.0;
const TWO_THIRDS: f64 = 2.0 / 3.0;
const FOUR_THIRDS: f64 = 4.0 / 3.0;

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
/// use mm_control::fuzzy::{FuzzySystem, SMOOTH};
///
/// let engine = SMOOTH.engine()?;
/// assert_eq!(engine.evaluate(0.0), 0.0);
/// assert!((engine.evaluate(1.0) + 1.0).abs() < 1e-15);
/// assert!(engine.evaluate(0.2) < engine.evaluate(0.1));
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
pub const SMOOTH: RuleBase<f64, 7, 7, 7> = RuleBase {
    input_range: (-1.0, 1.0),
    input_terms: [
        MembershipFunction::from_triangle([-1.0, -1.0, -0.6]),
        MembershipFunction::from_triangle([-1.0, -0.6, -0.25]),
        MembershipFunction::from_triangle([-0.6, -0.25, 0.0]),
        MembershipFunction::from_triangle([-0.25, 0.0, 0.25]),
        MembershipFunction::from_triangle([0.0, 0.25, 0.6]),
        MembershipFunction::from_triangle([0.25, 0.6, 1.0]),
        MembershipFunction::from_triangle([0.6, 1.0, 1.0]),
    ],
    output_range: (-FOUR_THIRDS, FOUR_THIRDS),
    output_terms: [
        MembershipFunction::from_triangle([-FOUR_THIRDS, -1.0, -TWO_THIRDS]),
        MembershipFunction::from_triangle([-1.0, -TWO_THIRDS, -THIRD]),
        MembershipFunction::from_triangle([-TWO_THIRDS, -THIRD, 0.0]),
        MembershipFunction::from_triangle([-THIRD, 0.0, THIRD]),
        MembershipFunction::from_triangle([0.0, THIRD, TWO_THIRDS]),
        MembershipFunction::from_triangle([THIRD, TWO_THIRDS, 1.0]),
        MembershipFunction::from_triangle([TWO_THIRDS, 1.0, FOUR_THIRDS]),
    ],
    rules: [
        Rule { input: 0, output: 6, weight: 1.0 },
        Rule { input: 1, output: 5, weight: 1.0 },
        Rule { input: 2, output: 4, weight: 1.0 },
        Rule { input: 3, output: 3, weight: 1.0 },
        Rule { input: 4, output: 2, weight: 1.0 },
        Rule { input: 5, output: 1, weight: 1.0 },
        Rule { input: 6, output: 0, weight: 1.0 },
    ],
};
