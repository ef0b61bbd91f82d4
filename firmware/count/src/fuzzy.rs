//! What is evaluated: the fuzzy system of the thesis in its forms, over its whole input range.

use core::fmt::Write;
use core::hint::black_box;

use mm_control::fuzzy::fixed::{self, Evaluate, THESIS_Q15, THESIS_SURFACE};
use mm_control::fuzzy::{Curve, FuzzyError, FuzzySystem, Surface, THESIS_F32};

use crate::{Clock, Counter};

/// Counts every form and writes a line for each.
///
/// # Errors
/// A [`FuzzyError`] of the tables.
pub fn run<C: Clock>(counter: &Counter<C>, out: &mut impl Write) -> Result<(), FuzzyError> {
    // Tables and engines come through a black box: nothing is specialized to what they hold.
    let curve = Curve::<f32>::try_new(black_box(&THESIS_F32))?;
    let count = counter.count(&curve, numbers(), |curve, x| curve.evaluate(x), f32::to_bits);
    // A line that cannot be written is missed on the other side.
    let _ = writeln!(out, "fuzzy-f32-exact {count}");
    let surface = Surface::<f32, 65>::from_engine(&curve)?;
    let count = counter.count(&surface, numbers(), |surface, x| surface.evaluate(x), f32::to_bits);
    let _ = writeln!(out, "fuzzy-f32-surface {count}");
    let curve = fixed::Curve::<8>::try_new(black_box(&THESIS_Q15))?;
    let count = counter.count(&curve, steps(), |curve, q| curve.evaluate(q), bits);
    let _ = writeln!(out, "fuzzy-q15 {count}");
    let count = counter.count(&THESIS_SURFACE, steps(), |surface, q| surface.evaluate(q), bits);
    let _ = writeln!(out, "fuzzy-surface {count}");
    Ok(())
}

/// -1.4 to 1.4 in 1,401 numbers 0.002 apart.
fn numbers() -> impl Iterator<Item = f32> + Clone {
    (-700_i16..=700).map(|i| f32::from(i) * 0.002)
}

/// The same range in units of 2^-15 of its half; the upper end is the last of the units.
fn steps() -> impl Iterator<Item = i16> + Clone {
    (-700_i32..=700).map(|i| i16::try_from(i * 32_768 / 700).unwrap_or(i16::MAX))
}

const fn bits(q: i16) -> u32 {
    q.cast_unsigned() as u32
}
