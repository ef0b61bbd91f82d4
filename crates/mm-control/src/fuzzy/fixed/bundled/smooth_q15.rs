// Compiled from the fuzzy system "smooth"; generated, not to be edited.
// Input ranges [-1.0, 1.0]; output ranges [-1.3333333333333333, 1.3333333333333333].
// Corners in units of 2^-15 of half a range from its middle, weights of 2^-30.
// Within 2 units of the exact centroid of the system with its corners rounded so.
// Made again by: MMSIM_BLESS=1 cargo test -p mm-fis --test fis compile_emit

use crate::fuzzy::fixed::{Rule, Slot, Tables, Term, Trigger};
use crate::fuzzy::{And, Connective, Or};

/// The fuzzy system "smooth" in fixed point: its breakpoints in units of 2^-15 of half a range.
#[rustfmt::skip]
pub const SMOOTH_Q15: Tables<'static> = Tables {
    inputs: &[
        &[
            Trigger { term: Term::new([-32768, -32768, -32768, -19661]), rules: &[Rule { premises: &[], slots: &[6], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-32768, -19661, -19661, -8192]), rules: &[Rule { premises: &[], slots: &[5], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-19661, -8192, -8192, 0]), rules: &[Rule { premises: &[], slots: &[4], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([-8192, 0, 0, 8192]), rules: &[Rule { premises: &[], slots: &[3], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([0, 8192, 8192, 19661]), rules: &[Rule { premises: &[], slots: &[2], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([8192, 19661, 19661, 32768]), rules: &[Rule { premises: &[], slots: &[1], weight: 1073741824, connective: Connective::And }] },
            Trigger { term: Term::new([19661, 32768, 32768, 32768]), rules: &[Rule { premises: &[], slots: &[0], weight: 1073741824, connective: Connective::And }] },
        ],
    ],
    rest: &[],
    outputs: &[
        &[
            Slot::cut([-32768, -24576, -24576, -16384], None, 15),
            Slot::cut([-24576, -16384, -16384, -8192], Some([-32768, -24576, -24576, -16384]), 15),
            Slot::cut([-16384, -8192, -8192, 0], Some([-24576, -16384, -16384, -8192]), 15),
            Slot::cut([-8192, 0, 0, 8192], Some([-16384, -8192, -8192, 0]), 15),
            Slot::cut([0, 8192, 8192, 16384], Some([-8192, 0, 0, 8192]), 15),
            Slot::cut([8192, 16384, 16384, 24576], Some([0, 8192, 8192, 16384]), 15),
            Slot::cut([16384, 24576, 24576, 32768], Some([8192, 16384, 16384, 24576]), 15),
        ],
    ],
    and: And::Min,
    or: Or::Max,
    odd: true,
};
