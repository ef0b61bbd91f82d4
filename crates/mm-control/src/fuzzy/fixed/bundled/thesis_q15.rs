// Compiled from the fuzzy system "thesis"; generated, not to be edited.
// Input ranges [-1.4, 1.4]; output ranges [-1.0, 1.0].
// Corners in units of 2^-15 of half a range from its middle, weights of 2^-30.
// Within 2 units of the exact centroid of the system with its corners rounded so.
// Made again by: MMSIM_BLESS=1 cargo test -p mm-fis --test fis compile_emit

use crate::fuzzy::fixed::{Rule, Slot, Tables, Term, Trigger};
use crate::fuzzy::{And, Connective, Or};

/// The fuzzy system "thesis" in fixed point: its breakpoints in units of 2^-15 of half a range.
#[rustfmt::skip]
pub const THESIS_Q15: Tables<'static> = Tables {
    inputs: &[
        &[
            Trigger { term: Term::new([-32768, -32768, -22626, -16391]), rules: &[Rule { premises: &[], slots: &[3], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-23406, -15612, -15612, -5851]), rules: &[Rule { premises: &[], slots: &[4], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-15612, -5851, -5851, 0]), rules: &[Rule { premises: &[], slots: &[5], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-5851, 0, 0, 0]), rules: &[Rule { premises: &[], slots: &[5], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([0, 0, 0, 5851]), rules: &[Rule { premises: &[], slots: &[0], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([0, 5851, 5851, 15612]), rules: &[Rule { premises: &[], slots: &[0], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([5851, 15612, 15612, 23406]), rules: &[Rule { premises: &[], slots: &[1], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([16391, 22626, 32768, 32768]), rules: &[Rule { premises: &[], slots: &[2], weight: 1073741824, connective: Connective::And }] },
        ],
    ],
    rest: &[],
    outputs: &[
        &[
            Slot::cut([-32768, -32768, -32768, -21843], None, 14),
            Slot::cut([-32768, -21843, -21843, -10925], Some([-32768, -32768, -32768, -21843]), 14),
            Slot::cut([-21843, -10925, -10925, 0], Some([-32768, -21843, -21843, -10925]), 14),
            Slot::cut([0, 10925, 10925, 21843], None, 14),
            Slot::cut([10925, 21843, 21843, 32768], Some([0, 10925, 10925, 21843]), 14),
            Slot::cut([21843, 32768, 32768, 32768], Some([10925, 21843, 21843, 32768]), 14),
        ],
    ],
    and: And::Min,
    or: Or::Max,
    odd: true,
};
