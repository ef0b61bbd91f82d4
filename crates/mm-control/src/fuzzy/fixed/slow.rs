//! The same inference where all that fires is small: strengths keep their ratio on a common exponent.

use super::engine::Tables;
use super::firing::{Sample, fire};
use super::grade::{Grade, Small};
use super::slot::{Moments, Slot};

/// Area and moment of a row, whose first slot has the number `first`; its `strengths` are overwritten.
///
/// Cost: everything is computed again from the inputs, about ten times that of the fast way; it is taken where less than a sixteenth of
/// the largest term's area fires, or nothing at all.
#[cold]
#[inline(never)]
pub(super) fn moments(
    tables: &Tables<'_>,
    sample: Sample<'_>,
    (row, first): (&[Slot], usize),
    strengths: &mut [u32],
) -> Moments {
    strengths.fill(0);
    fire::<Small>(tables, sample, first, strengths);
    let firing = row.iter().zip(&*strengths).filter(|(slot, _)| slot.area() > 0);
    let top = firing.map(|(_, &strength)| Small(strength).exponent()).max().unwrap_or(0);
    let row = || row.iter().zip(&*strengths).map(|(slot, &strength)| (slot, Small(strength)));
    // Below 2^30 times the sum of the areas of the row, which is at most 2^33.
    let area: u64 = row().map(|(slot, own)| slot.whole_area(own.relative_to(top), own.q30())).sum();
    // Leaves 30 bits of area, so that the sums fit as those of the fast way do.
    let shift = 34_u32.saturating_sub(area.leading_zeros());
    let mut sum = Moments::default();
    let mut below = Small::ZERO;
    for (slot, own) in row() {
        if own != Small::ZERO {
            slot.add(&mut sum, own.relative_to(top), own.q30(), shift);
            let shared = own.min(below).min(Small::new(slot.crossing().into(), 30));
            if shared != Small::ZERO {
                slot.subtract_shared(&mut sum, shared.relative_to(top), shared.q30(), shift);
            }
        }
        below = own;
    }
    sum
}
