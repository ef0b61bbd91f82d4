//! Places all over the inputs of a system of several, at which its outputs are looked at besides the lines.

use super::cells::{breakpoints, set_of};
use crate::System;

/// Most corners, and most combinations of breakpoints.
const MOST: usize = 4096;
/// Seed of the scattered points.
const SEED: u64 = 0x6d6d_5f66_6973;

/// The corners of the inputs' ranges, the combinations of their breakpoints unless these are too many, and scattered points;
/// up to `most` of each. The same for the same system.
pub(super) fn points(system: &System, most: usize) -> Vec<Vec<f64>> {
    let most = most.min(MOST);
    let mut random = Random(SEED);
    let mut all = corners(system, most, &mut random);
    all.extend(lattice(system, most));
    for _ in 0..most {
        let part = |(lo, hi): (f64, f64), random: &mut Random| lo + random.part() * (hi - lo);
        all.push(system.inputs.iter().map(|input| part(input.range, &mut random)).collect());
    }
    all
}

/// All corners or, where these are too many, the two outermost and random ones.
fn corners(system: &System, most: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let count = system.inputs.len();
    let is_all = u32::try_from(count).ok().and_then(|count| 1_usize.checked_shl(count));
    let ends = |upper: &dyn Fn(usize) -> bool| {
        let end = |(number, input): (usize, &crate::Variable)| {
            if upper(number) { input.range.1 } else { input.range.0 }
        };
        system.inputs.iter().enumerate().map(end).collect::<Vec<f64>>()
    };
    match is_all.filter(|all| *all <= most) {
        Some(all) => (0..all).map(|bits| ends(&|number| bits >> number & 1 == 1)).collect(),
        None => {
            let mut found = vec![ends(&|_| false), ends(&|_| true)];
            for _ in found.len()..most {
                let upper: Vec<bool> = (0..count).map(|_| random.part() >= 0.5).collect();
                found.push(ends(&|number| upper.get(number).copied().unwrap_or(false)));
            }
            found
        }
    }
}

/// All combinations of the inputs' breakpoints and ends; none where they are too many.
fn lattice(system: &System, most: usize) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = vec![Vec::new()];
    for input in &system.inputs {
        let (lo, hi) = input.range;
        let mut places: Vec<f64> = input.terms.iter().filter_map(set_of).flat_map(breakpoints).collect();
        places.extend([lo, hi]);
        places.retain(|x| *x >= lo && *x <= hi);
        places.sort_by(f64::total_cmp);
        places.dedup_by(|next, kept| *next <= *kept);
        if all.len().saturating_mul(places.len()) > most {
            return Vec::new();
        }
        all = all
            .iter()
            .flat_map(|begun| places.iter().map(|place| [begun.as_slice(), &[*place]].concat()))
            .collect();
    }
    all
}

/// `SplitMix64`: the same numbers everywhere.
struct Random(u64);

impl Random {
    /// The next number in [0, 1).
    fn part(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.0;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
        // The upper 32 bits: a double holds them exactly.
        f64::from(u32::try_from(bits >> 32).unwrap_or(0)) / 4_294_967_296.0
    }
}
