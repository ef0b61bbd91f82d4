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
    let Totals { area, .. } = Totals::of(row, strengths, top, 0);
    // 30 bits of area, so that the sums fit as those of the fast way do.
    let shift = 34_u32.saturating_sub(area.leading_zeros());
    Totals::of(row, strengths, top, shift).moments
}

struct Totals {
    area: u64,
    moments: Moments,
}

impl Totals {
    fn of(row: &[Slot], strengths: &[u32], top: u32, shift: u32) -> Self {
        let mut total = Self { area: 0, moments: Moments::default() };
        let mut below = Small::ZERO;
        for (slot, &strength) in row.iter().zip(strengths) {
            let own = Small(strength);
            if !own.is_zero() {
                let (linear, height) = (own.relative_to(top), own.q30());
                // 2^30 times the sum of all areas, 2^33, at most.
                total.area = total.area.wrapping_add(slot.whole_area(linear, height));
                slot.add(&mut total.moments, linear, height, shift);
                let shared = own.min(below).min(Small::new(slot.crossing().into(), 30));
                if !shared.is_zero() {
                    let (linear, height) = (shared.relative_to(top), shared.q30());
                    slot.subtract_shared(&mut total.moments, linear, height, shift);
                }
            }
            below = own;
        }
        total
    }
}
