//! What the program evaluates.

use core::fmt::Write;

use mm_control::fuzzy::fixed::{Curve, Evaluate, SMOOTH_Q15, SMOOTH_SURFACE, THESIS_Q15, THESIS_SURFACE};

/// Evaluates all systems and prints a line for each; whether their tables were accepted.
pub(crate) fn run(out: &mut impl Write) -> bool {
    let (Ok(thesis), Ok(smooth)) = (Curve::<8>::try_new(&THESIS_Q15), Curve::<8>::try_new(&SMOOTH_Q15))
    else {
        let _ = writeln!(out, "the tables are refused");
        return false;
    };
    show(out, "thesis rules", &thesis);
    show(out, "thesis surface", &THESIS_SURFACE);
    show(out, "smooth rules", &smooth);
    show(out, "smooth surface", &SMOOTH_SURFACE);
    true
}

/// Outputs at both ends, at zero and at the quarters of the range, and a checksum over every input there is.
fn show(out: &mut impl Write, name: &str, system: &impl Evaluate) {
    let some = [i16::MIN, -16_384, -1, 0, 1, 16_384, i16::MAX].map(|x| system.evaluate(x));
    let checksum = (i16::MIN..=i16::MAX).fold(0_u32, |sum, x| {
        // The outputs as the digits of a number with base 31, modulo 2^32.
        sum.wrapping_mul(31).wrapping_add(u32::from(system.evaluate(x).cast_unsigned()))
    });
    let _ = writeln!(out, "{name}: {some:?} checksum={checksum:08x}");
}
