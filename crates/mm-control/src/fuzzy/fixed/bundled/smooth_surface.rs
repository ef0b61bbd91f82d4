// Compiled from the fuzzy system "smooth"; generated, not to be edited.
// Input range [-1.0, 1.0], output range [-1.3333333333333333, 1.3333333333333333], both in units of 2^-15 of their half from their middle.
// Bound 1.3021e-3, largest error 4.0686e-4 at -0.60009765625, in output units, over all 65536 inputs.
// 66 knots of 16 bits, 1 section(s), 0 jump(s), 144 bytes.
// Made again by: MMSIM_BLESS=1 cargo test -p mm-fis --test fis compile_emit

use crate::fuzzy::fixed::{Section, Surface1};

/// The fuzzy system "smooth" as a table of knots, within 1.3021e-3 of it in output units.
///
/// Input range from -1.0 to 1.0, output range from -1.3333333333333333 to 1.3333333333333333.
#[rustfmt::skip]
pub const SMOOTH_SURFACE: Surface1<'static> = Surface1 {
    first: Section { start: 0, knot: 0, shift: 5 },
    others: &[],
    knots: &[
        0, -720, -1327, -1874, -2371, -2832, -3266, -3685, -4096, -4507, -4926, -5360, -5821, -6318, -6865, -7472,
        -8192, -8710, -9176, -9601, -9992, -10356, -10698, -11024, -11336, -11639, -11936, -12229, -12522, -12817, -13118, -13426,
        -13746, -14081, -14436, -14815, -15225, -15667, -16178, -16669, -17094, -17489, -17853, -18193, -18512, -18815, -19103, -19381,
        -19650, -19913, -20172, -20429, -20685, -20943, -21204, -21470, -21744, -22028, -22325, -22637, -22968, -23322, -23704, -24119,
        -24576, -24576,
    ],
    odd: true,
};
