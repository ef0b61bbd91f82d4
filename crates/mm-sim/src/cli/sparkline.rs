//! The error of a run over time, in one line of text.

/// Columns of the line.
const COLUMNS: usize = 48;

/// Steps of a block a decade: each is a factor of 3.2.
const STEPS_A_DECADE: f64 = 2.0;

/// Blocks from the lowest to the highest.
const BLOCKS: [char; 8] =
    ['\u{2581}', '\u{2582}', '\u{2583}', '\u{2584}', '\u{2585}', '\u{2586}', '\u{2587}', '\u{2588}'];

/// The largest value in each of equal parts of a run.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trace {
    duration: f64,
    largest: [Option<f64>; COLUMNS],
}

impl Trace {
    /// Nothing yet of a run of so many seconds.
    pub(super) const fn new(duration: f64) -> Self {
        Self { duration, largest: [None; COLUMNS] }
    }

    /// Takes a value at a time.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "a column; a cast saturates"
    )]
    pub(super) fn take(&mut self, t: f64, value: f64) {
        let column = ((t / self.duration * COLUMNS as f64) as usize).min(COLUMNS - 1);
        if let Some(largest) = self.largest.get_mut(column).filter(|_| value.is_finite()) {
            *largest = Some(largest.map_or(value, |old| old.max(value)));
        }
    }

    /// The line, up to the last value, on a logarithmic scale up to the largest; none without a value above zero.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "one of eight blocks"
    )]
    pub(super) fn line(&self) -> Option<String> {
        let top = self.largest.iter().flatten().fold(0.0, |top: f64, value| top.max(*value));
        let count = self.largest.iter().rposition(Option::is_some)? + 1;
        let block = |value: &Option<f64>| match value {
            Some(value) => {
                let step = (BLOCKS.len() as f64 - 1.0 + STEPS_A_DECADE * (value / top).log10()).floor();
                BLOCKS.get(step.max(0.0) as usize).copied().unwrap_or(' ')
            }
            None => ' ',
        };
        (top > 0.0).then(|| self.largest.iter().take(count).map(block).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_goes_up_to_the_largest_and_ends_with_the_run() {
        let mut trace = Trace::new(48.0);
        assert_eq!(trace.line(), None, "nothing to show");
        for (t, value) in [(0.0, 0.0), (1.0, 4.0), (1.9, 2.0), (2.5, 8.0), (5.0, f64::NAN), (4.0, 1.0)] {
            trace.take(t, value);
        }
        assert_eq!(
            trace.line().as_deref(),
            Some("\u{2581}\u{2587}\u{2588} \u{2586}"),
            "largest of each column"
        );
        trace.take(48.0, 8.0);
        assert_eq!(trace.line().map(|line| line.chars().count()), Some(48), "the end is in the last column");
    }
}
