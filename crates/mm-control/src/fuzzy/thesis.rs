//! The rule base of the thesis, number by number.

use super::{MembershipFunction, Rule, RuleBase};

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
/// use mm_control::fuzzy::{FuzzySystem, THESIS};
///
/// let rules = THESIS.cast::<f32>();
/// let engine = rules.engine()?;
/// assert!(engine.evaluate(0.5) < 0.0);
/// assert_eq!(engine.evaluate(9.0), engine.evaluate(1.4));
/// # Ok::<(), mm_control::fuzzy::FuzzyError>(())
/// ```
pub const THESIS: RuleBase<f64, 8, 7, 8> = RuleBase {
    input_range: (-1.4, 1.4),
    input_terms: [
        MembershipFunction::from_breakpoints([-4.6, -1.4, -0.9667, -0.7003]),
        MembershipFunction::from_triangle([-1.0, -0.667, -0.25]),
        MembershipFunction::from_triangle([-0.667, -0.25, 0.0]),
        MembershipFunction::from_triangle([-0.25, 0.0, 0.0]),
        MembershipFunction::from_triangle([0.0, 0.0, 0.25]),
        MembershipFunction::from_triangle([0.0, 0.25, 0.667]),
        MembershipFunction::from_triangle([0.25, 0.667, 1.0]),
        MembershipFunction::from_breakpoints([0.7003, 0.9667, 1.4, 4.6]),
    ],
    output_range: (-1.0, 1.0),
    output_terms: [
        MembershipFunction::from_triangle([-1.333, -1.0, -0.6666]),
        MembershipFunction::from_triangle([-1.0, -0.6666, -0.3334]),
        MembershipFunction::from_triangle([-0.6666, -0.3334, 0.0]),
        MembershipFunction::from_triangle([-0.3334, 0.0, 0.3334]),
        MembershipFunction::from_triangle([0.0, 0.3334, 0.6666]),
        MembershipFunction::from_triangle([0.3334, 0.6666, 1.0]),
        MembershipFunction::from_triangle([0.6666, 1.0, 1.334]),
    ],
    rules: [
        Rule { input: 0, output: 4, weight: 1.0 },
        Rule { input: 1, output: 5, weight: 1.0 },
        Rule { input: 2, output: 6, weight: 1.0 },
        Rule { input: 3, output: 6, weight: 1.0 },
        Rule { input: 4, output: 0, weight: 1.0 },
        Rule { input: 5, output: 0, weight: 1.0 },
        Rule { input: 6, output: 1, weight: 1.0 },
        Rule { input: 7, output: 2, weight: 1.0 },
    ],
};
