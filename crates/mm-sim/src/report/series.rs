//! A signal with fewer points for the same picture, as text.
//!
//! A run is cut into windows; within each the points that lie on a line through their neighbours are dropped, to a fraction of what
//! the signal does in that window, so that who zooms in on one still sees its curve. Where that does not help, a signal chatters, and
//! its window keeps the lowest and highest points of some intervals.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use crate::figures::reduce;

/// Windows of a run.
const WINDOWS: usize = 50;
/// A window's width and height as a picture, px: its curve is kept to 0.12 px.
const WINDOW_PX: (f64, f64) = (300.0, 60.0);
/// Intervals of a window that chatters.
const INTERVALS: f64 = 16.0;
/// Points of a window above which it chatters; the first one, where a run starts, may have more.
const MOST: usize = 60;
const MOST_AT_START: usize = 400;
/// What is no more than rounding, in the largest value of the signal.
const ROUNDING: f64 = 1e-7;
/// Errors below are at this one where the logarithm is shown, m.
const FLOOR_M: f64 = 1e-7;

/// Indices of the points to keep of a signal; of one that is shown by its logarithm, by that.
fn kept(time: &[f64], values: &[f64], is_logarithmic: bool) -> Vec<usize> {
    let shown = |value: f64| if is_logarithmic { libm::log10(value.max(FLOOR_M)) } else { value };
    let points: Vec<(usize, f64, f64)> = time
        .iter()
        .zip(values)
        .enumerate()
        .map(|(i, (t, value))| (i, *t, shown(*value)))
        .filter(|(_, t, value)| t.is_finite() && value.is_finite())
        .collect();
    let largest = points.iter().map(|(_, _, value)| value.abs()).fold(0.0, f64::max);
    let size = points.len().div_ceil(WINDOWS).max(1);
    let mut all = Vec::new();
    for begin in (0..points.len()).step_by(size) {
        // A window ends where the next one begins, so that the curve is one.
        let window = points.get(begin..(begin + size + 1).min(points.len())).unwrap_or_default();
        let most = if begin == 0 { MOST_AT_START } else { MOST };
        let chosen = thinned(window, ROUNDING * largest, most);
        all.extend(chosen.into_iter().filter_map(|i| window.get(i)).map(|(index, _, _)| *index));
    }
    all.dedup();
    all
}

/// Numbers of the points to keep of a window.
fn thinned(window: &[(usize, f64, f64)], rounding: f64, most: usize) -> Vec<usize> {
    let (Some(first), Some(last)) = (window.first(), window.last()) else { return Vec::new() };
    let low = window.iter().map(|point| point.2).fold(f64::INFINITY, f64::min);
    let high = window.iter().map(|point| point.2).fold(f64::NEG_INFINITY, f64::max);
    let height = (high - low).max(rounding).max(f64::MIN_POSITIVE);
    let span = (last.1 - first.1).max(f64::MIN_POSITIVE);
    let drawn = |width: f64| -> Vec<(f64, f64)> {
        let pixel = |(_, t, value): &(usize, f64, f64)| {
            (width * (t - first.1) / span, WINDOW_PX.1 * (value - low) / height)
        };
        window.iter().map(pixel).collect()
    };
    let exact = reduce::path(&drawn(WINDOW_PX.0));
    if exact.len() <= most { exact } else { reduce::function(&drawn(INTERVALS)) }
}

/// A signal for the page: its times, then its values, little-endian `f32` in base64; none if it is zero throughout.
pub(super) fn encoded(time: &[f64], values: &[f64], is_logarithmic: bool) -> Option<String> {
    // What a map to forces and back leaves of nothing is rounding.
    if !values.iter().any(|value| value.abs() > 1e-12) {
        return None;
    }
    let kept = kept(time, values, is_logarithmic);
    let pick = |column: &[f64]| -> Vec<f64> { kept.iter().filter_map(|&i| column.get(i).copied()).collect() };
    let all = pick(time).into_iter().chain(pick(values));
    Some(base64_of(all))
}

/// Numbers as little-endian `f32` in base64.
pub(super) fn base64_of(values: impl IntoIterator<Item = f64>) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "seven digits are enough for a picture")]
    let bytes: Vec<u8> = values.into_iter().flat_map(|value| (value as f32).to_le_bytes()).collect();
    STANDARD.encode(bytes)
}

#[cfg(test)]
mod tests {
    use super::{encoded, kept};

    fn times(count: u32, step: f64) -> Vec<f64> {
        (0..count).map(|i| step * f64::from(i)).collect()
    }

    #[test]
    fn a_smooth_signal_is_kept_to_a_hair_in_every_window() {
        let t = times(98_000, 1e-3);
        let values: Vec<f64> = t.iter().map(|t| libm::exp(-t) + 1e-3 * libm::sin(2.0 * t)).collect();
        let kept = kept(&t, &values, false);
        assert!(kept.len() < 1500, "{} of 98000 points", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, 97_999), "both ends stay");
        for pair in kept.windows(2).skip_while(|pair| t[pair[0]] < 20.0) {
            for i in pair[0]..pair[1] {
                let part = (t[i] - t[pair[0]]) / (t[pair[1]] - t[pair[0]]);
                let line = values[pair[0]] + part * (values[pair[1]] - values[pair[0]]);
                // The signal spans 2e-3 in a window of 1.96 s: 0.12 px of 60.
                let off = (line - values[i]).abs();
                assert!(off < 2e-3 * 0.12 / 60.0 * 1.5, "{off} off at {} s, of which 1e-3 is all", t[i]);
            }
        }
    }

    #[test]
    fn chatter_keeps_its_height_and_a_spike_stays() {
        let t = times(98_000, 1e-3);
        let mut values: Vec<f64> = (0..98_000_u32).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 }).collect();
        values[54_321] = 9.0;
        let kept = kept(&t, &values, false);
        assert!(kept.len() < 4000, "{} of 98000 points", kept.len());
        assert!(kept.contains(&54_321), "the spike");
        for second in 0..98 {
            let inside = kept.iter().filter(|i| **i / 1000 == second).map(|i| values[*i]);
            let (low, high) = inside.fold((0.0, 0.0), |(low, high), v| (f64::min(low, v), f64::max(high, v)));
            assert!(low <= -1.0 && high >= 1.0, "second {second} spans {low} to {high}");
        }
    }

    #[test]
    fn a_small_error_after_a_large_one_keeps_its_logarithm() {
        let t = times(9_800, 1e-2);
        let values: Vec<f64> = t.iter().map(|t| 0.2 * libm::exp(-6.0 * t)).collect();
        let kept = kept(&t, &values, true);
        let inside = kept.iter().filter(|i| (1.0..1.9).contains(&t[**i])).count();
        assert!(inside <= 3, "the logarithm is a straight line: {inside} points");
        let last = kept.iter().map(|i| values[*i]).find(|v| *v < 1e-6);
        assert!(last.is_some(), "the end of the decay is there");
    }

    #[test]
    fn nothing_is_none_and_what_is_not_finite_is_left_out() {
        let t = times(4, 1.0);
        assert!(encoded(&t, &[0.0, 1e-17, 0.0, 0.0], false).is_none(), "rounding");
        assert!(encoded(&t, &[], false).is_none(), "not recorded");
        assert_eq!(kept(&t, &[1.0, f64::NAN, 2.0, 5.0], false), [0, 2, 3], "without the undefined one");
    }
}
