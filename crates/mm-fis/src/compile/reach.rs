//! Which bounds can be met, where one cannot.

/// Halvings of the last doubling; each is a search of its own.
const REFINEMENTS: usize = 1;

/// The first of `bound`, 2 `bound`, 4 `bound` ... that `attempt` meets; `whole` is a bound beyond which trying makes no sense.
pub(super) fn doubled<T>(bound: f64, whole: f64, attempt: &dyn Fn(f64) -> Option<T>) -> Option<T> {
    let mut bound = bound;
    loop {
        match attempt(bound) {
            None if bound < whole => bound *= 2.0,
            found => return found,
        }
    }
}

/// A bound above `asked`, which is not met, that is: it has two decimal digits and was tried itself.
///
/// Found by doubling from `asked`, at least from `least`, then by halving the last step. `None` where even `whole` is not met.
pub(super) fn reachable(asked: f64, (least, whole): (f64, f64), is_met: &dyn Fn(f64) -> bool) -> Option<f64> {
    let (mut fails, mut meets) = (asked, rounded_up((2.0 * asked).max(least)));
    while !is_met(meets) {
        if meets >= whole {
            return None;
        }
        (fails, meets) = (meets, rounded_up(2.0 * meets));
    }
    for _ in 0..REFINEMENTS {
        let middle = rounded_up(0.5 * fails + 0.5 * meets);
        if middle <= fails || middle >= meets {
            break;
        }
        if is_met(middle) {
            meets = middle;
        } else {
            fails = middle;
        }
    }
    Some(meets)
}

/// The next number of two decimal digits.
fn rounded_up(value: f64) -> f64 {
    let near = |value: f64| format!("{value:.1e}").parse().unwrap_or(value);
    let nearest: f64 = near(value);
    // A twentieth is at least half of the second digit.
    if nearest < value { near(1.05 * value) } else { nearest }
}

#[cfg(test)]
mod tests {
    //! Law: the next number of two digits is not below and less than a tenth above; what is found has been tried, and nothing below half of it
    //! is met where everything above some bound is. No tolerance.
    use super::{doubled, reachable, rounded_up};

    #[test]
    fn bounds_of_two_digits() {
        for (value, up) in [(0.1234, 0.13), (9.91, 10.0), (0.039, 0.039), (1.01e-7, 1.1e-7), (100.0, 100.0)] {
            assert_eq!(rounded_up(value).to_string(), f64::to_string(&up), "{value}");
        }
    }

    #[test]
    fn the_bound_found_is_met() {
        for limit in [0.02, 0.3, 1.7, 40.0] {
            let found = reachable(0.01, (0.001, 50.0), &|bound| bound >= limit).expect("below the whole");
            assert!((limit..2.0 * limit).contains(&found), "{found} for {limit}");
            let found = doubled(0.01, 50.0, &|bound| (bound >= limit).then_some(bound)).expect("likewise");
            assert!((limit..2.0 * limit).contains(&found), "{found} for {limit}");
        }
        assert_eq!(reachable(0.01, (0.001, 50.0), &|_| false), None);
        assert_eq!(doubled(0.01, 50.0, &|_| None::<f64>), None);
    }
}
