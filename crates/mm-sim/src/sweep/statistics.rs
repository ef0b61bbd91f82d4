//! Quantiles of the samples and the confidence bound of a share.

use serde::Serialize;
use statrs::function::beta::inv_beta_reg;

/// The least of the values that at least so many percent of them do not exceed (nearest rank); none of no values.
///
/// Infinity stands for what was too bad to have a value.
#[must_use]
pub fn quantile(values: &[f64], percent: usize) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (percent * sorted.len()).div_ceil(100).max(1);
    sorted.get(rank - 1).copied()
}

/// A probability as estimated, between its bounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Interval {
    /// Share of the samples.
    pub share: f64,
    /// Lower bound.
    pub low: f64,
    /// Upper bound.
    pub high: f64,
}

/// Probability that a share not inside the bounds goes unnoticed, half of it on either side.
const MISSED: f64 = 0.05;

/// The two-sided 95 % bounds of Clopper and Pearson on the probability of what happened `count` times in `samples`.
///
/// Equation: low = B(0.025; k, n - k + 1), high = B(0.975; k + 1, n - k) with the quantile B of the beta distribution; 0 for
/// k = 0 and 1 for k = n. Rounded to six significant digits: the last bits of the library's quantile depend on the machine.
///
/// # Source
/// C. J. Clopper, E. S. Pearson, The use of confidence or fiducial limits illustrated in the case of the binomial, Biometrika 26,
/// 1934.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^53")]
pub fn clopper_pearson(count: u64, samples: u64) -> Interval {
    if samples == 0 {
        return Interval { share: 0.0, low: 0.0, high: 1.0 };
    }
    let (k, n) = (count.min(samples) as f64, samples as f64);
    let quantile = |a, b, share| rounded(inv_beta_reg(a, b, share));
    let low = if count == 0 { 0.0 } else { quantile(k, n - k + 1.0, 0.5 * MISSED) };
    let high = if count >= samples { 1.0 } else { quantile(k + 1.0, n - k, 1.0 - 0.5 * MISSED) };
    Interval { share: k / n, low, high }
}

/// The number nearest to one that six significant digits write.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P(X <= k) of n trials of probability p, term by term.
    fn binomial_cdf(k: u32, n: u32, p: f64) -> f64 {
        let (mut sum, mut binomial) = (0.0, 1.0);
        for i in 0..=k {
            sum += binomial * libm::pow(p, f64::from(i)) * libm::pow(1.0 - p, f64::from(n - i));
            binomial *= f64::from(n - i) / f64::from(i + 1);
        }
        sum
    }

    /// The probability at which `f`, falling in it, takes a value: bisection.
    fn where_it_is(value: f64, f: impl Fn(f64) -> f64) -> f64 {
        let (mut lo, mut hi) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (lo + hi);
            if f(middle) > value { lo = middle } else { hi = middle }
        }
        lo
    }

    /// Published: the rule of three's exact form, 1 - 0.025^(1/n) for no event; 1 to 9 of 10 from standard tables of the binomial.
    /// Tolerance: half a unit of the last printed digit.
    #[test]
    fn bounds_are_the_published_ones() {
        for (k, n, low, high) in [
            (0, 30, 0.0, 0.1157),
            (0, 10, 0.0, 0.3085),
            (1, 10, 0.0025, 0.4450),
            (2, 10, 0.0252, 0.5561),
            (5, 10, 0.1871, 0.8129),
            (10, 10, 0.6915, 1.0),
            (0, 1000, 0.0, 0.0037),
        ] {
            let bounds = clopper_pearson(k, n);
            assert!((bounds.low - low).abs() < 5.1e-5, "{k} of {n}: {bounds:?}");
            assert!((bounds.high - high).abs() < 5.1e-5, "{k} of {n}: {bounds:?}");
        }
    }

    /// The definition: at the upper bound as few events have 2.5 %, at the lower as many. Tolerance: half a unit of the sixth digit,
    /// and what the library's quantile is off by.
    #[test]
    fn bounds_are_those_of_the_binomial() {
        for (k, n) in [(0, 7), (1, 7), (3, 30), (29, 30), (12, 200), (3, 500)] {
            let bounds = clopper_pearson(k.into(), n.into());
            let high = where_it_is(0.025, |p| binomial_cdf(k, n, p));
            assert!(
                (bounds.high - high).abs() < 5.001e-6 * high + 1e-9,
                "{k} of {n}: {} for {high}",
                bounds.high
            );
            if k > 0 {
                let low = where_it_is(0.975, |p| binomial_cdf(k - 1, n, p));
                assert!(
                    (bounds.low - low).abs() < 5.001e-6 * low + 1e-9,
                    "{k} of {n}: {} for {low}",
                    bounds.low
                );
            }
            assert!(bounds.low <= bounds.share && bounds.share <= bounds.high, "{bounds:?}");
        }
        assert_eq!(clopper_pearson(0, 0), Interval { share: 0.0, low: 0.0, high: 1.0 }, "nothing known");
    }

    /// Twin: of all values the least one that enough others do not exceed, by counting.
    #[test]
    fn quantiles_are_those_of_counting() {
        for count in 0..45_usize {
            let values: Vec<f64> =
                (0..count).map(|i| crate::random::noise_at(9, i as f64).floor() + (i % 7) as f64).collect();
            for percent in [1, 50, 95, 99, 100] {
                let enough = |x: &&f64| values.iter().filter(|y| *y <= *x).count() * 100 >= percent * count;
                let wanted = values.iter().filter(enough).copied().reduce(f64::min);
                assert_eq!(quantile(&values, percent), wanted, "{percent} % of {values:?}");
            }
        }
        assert_eq!(quantile(&[1.0, f64::INFINITY, 0.0], 95), Some(f64::INFINITY), "one without a value");
    }
}
