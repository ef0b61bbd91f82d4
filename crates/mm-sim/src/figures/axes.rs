//! Ranges and ticks of axes.

/// Span below which a signal counts as constant: rounding, not motion.
const FLAT: f64 = 1e-9;

/// Smallest and largest finite value.
pub(super) fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.filter(|value| value.is_finite()).fold(None, |range, value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}

/// A range to draw: a constant gets room around it, anything else a margin of `margin` of its span.
pub(super) fn padded(range: Option<(f64, f64)>, margin: f64) -> (f64, f64) {
    let (low, high) = range.unwrap_or((0.0, 1.0));
    if high - low < FLAT {
        let middle = 0.5 * (low + high);
        let middle = if middle.abs() < FLAT { 0.0 } else { middle };
        let room = f64::max(0.1 * middle.abs(), 0.1);
        return (middle - room, middle + room);
    }
    let room = margin * (high - low);
    (low - room, high + room)
}

/// Round values within a range, about `count` of them, as numbers and as text.
pub(super) fn ticks((low, high): (f64, f64), count: f64) -> Vec<(f64, String)> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let rough = span / count;
    let power = libm::log10(rough).floor();
    let unit = power_of_ten(power);
    let factor = [1.0, 2.0, 5.0, 10.0].into_iter().find(|factor| factor * unit >= rough).unwrap_or(10.0);
    let step = factor * unit;
    let exponent = if factor > 5.0 { power + 1.0 } else { power };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to 0 to 12")]
    let decimals = (-exponent).clamp(0.0, 12.0) as usize;
    let slack = 1e-6 * step;
    let mut all = Vec::new();
    let mut number = ((low - slack) / step).ceil();
    while number * step <= high + slack {
        // + 0.0 turns a negative zero round.
        let value = number * step + 0.0;
        all.push((value, format!("{value:.decimals$}")));
        number += 1.0;
    }
    all
}

/// Powers of ten within a range of decimal logarithms, every `n`-th so that there are at most `most`.
pub(super) fn decades((low, high): (f64, f64), most: f64) -> Vec<(f64, String)> {
    let every = ((high - low) / most).ceil().max(1.0);
    let mut all = Vec::new();
    let mut power = (low / every).ceil() * every;
    while power <= high + 1e-9 {
        let text = if (-2.0..=3.0).contains(&power) {
            format!("{}", power_of_ten(power))
        } else {
            format!("1e{power:.0}")
        };
        all.push((power + 0.0, text));
        power += every;
    }
    all
}

/// Ten to a whole power, exactly where that is possible.
fn power_of_ten(power: f64) -> f64 {
    let text = format!("1e{power:.0}");
    text.parse().unwrap_or(1.0)
}

#[cfg(test)]
mod tests {
    use super::{decades, extent, padded, ticks};

    fn texts(ticks: Vec<(f64, String)>) -> Vec<String> {
        ticks.into_iter().map(|(_, text)| text).collect()
    }

    #[test]
    fn ticks_are_round_and_within_the_range() {
        assert_eq!(texts(ticks((0.0, 60.0), 6.0)), ["0", "10", "20", "30", "40", "50", "60"]);
        assert_eq!(texts(ticks((-0.31, 0.32), 4.0)), ["-0.2", "0.0", "0.2"]);
        assert_eq!(texts(ticks((0.0, 9.1e-5), 3.0)), ["0.00000", "0.00005"]);
        assert!(ticks((1.0, 1.0), 4.0).is_empty(), "no range, no tick");
        for (low, high) in [(-3.7, 12.9), (0.1, 0.100_7), (-1e4, 2.0), (97.9, 98.0)] {
            let all = ticks((low, high), 5.0);
            assert!((2..=7).contains(&all.len()), "{} ticks from {low} to {high}", all.len());
            for (value, text) in all {
                assert!(value >= low - 1e-6 && value <= high + 1e-6, "{text} is within");
                let read: f64 = text.parse().expect("a tick is a number");
                assert!((read - value).abs() < 1e-9 * (1.0 + value.abs()), "{text} says {value}");
            }
        }
    }

    #[test]
    fn decades_are_thinned() {
        assert_eq!(texts(decades((-2.0, 1.0), 6.0)), ["0.01", "0.1", "1", "10"]);
        assert_eq!(texts(decades((-6.0, 2.0), 4.0)), ["1e-6", "1e-4", "0.01", "1", "100"]);
    }

    #[test]
    fn constants_get_room_and_rounding_counts_as_constant() {
        assert_eq!(padded(extent([1e-17, -3e-16].into_iter()), 0.05), (-0.1, 0.1));
        assert_eq!(padded(extent([f64::NAN, 2.0, 4.0].into_iter()), 0.05), (1.9, 4.1));
        assert_eq!(padded(None, 0.05), (-0.05, 1.05));
    }
}
