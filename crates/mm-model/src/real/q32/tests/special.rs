//! What lies outside the range, and how it is never left; see the parent for the laws.

use super::{Q32, Random, Real, extremes};

const SPECIAL: [Q32; 3] = [Q32::INFINITY, Q32::NEG_INFINITY, Q32::NAN];

fn operands() -> Vec<Q32> {
    let mut random = Random(5);
    let drawn = core::iter::repeat_with(|| random.number()).take(200);
    SPECIAL.into_iter().chain(extremes()).chain(drawn).collect()
}

/// An operand as a small `f64` of the same class: nothing overflows that way but what is infinite.
fn class(q: Q32) -> f64 {
    if q.is_finite() { q.sign().to_f64() } else { q.to_f64() }
}

fn same(a: Q32, b: f64) -> bool {
    if b.is_nan() { a.is_nan() } else { a.to_f64().to_bits() == (b + 0.0).to_bits() }
}

#[test]
fn a_result_of_the_special_is_special_as_in_floating_point() {
    for a in operands() {
        for b in operands().into_iter().filter(|b| !(a.is_finite() && b.is_finite())) {
            let (x, y) = (class(a), class(b));
            assert!(same(a + b, x + y), "{a} + {b} = {}", a + b);
            assert!(same(a - b, x - y), "{a} - {b} = {}", a - b);
            assert!(same(a * b, x * y), "{a} * {b} = {}", a * b);
            let ratio = if b.is_finite() { a.to_f64() / if y == 0.0 { 0.0 } else { y } } else { f64::NAN };
            assert!(same(a / b, ratio), "{a} / {b} = {}", a / b);
        }
        assert!(same(-a, -a.to_f64()) || a == Q32::MIN, "-{a}");
        assert!(same(a.abs(), a.to_f64().abs()) || a == Q32::MIN, "|{a}|");
    }
}

/// The law that a controller's checks rest on: of an operand that is not finite no operation makes a finite number.
#[test]
fn no_operation_comes_back_from_outside() {
    for special in SPECIAL {
        for other in operands() {
            let two = [special + other, other + special, special - other, other - special];
            let more = [special * other, other * special, special / other, other / special];
            let functions = [special.atan2(other), other.atan2(special)];
            for result in two.into_iter().chain(more).chain(functions) {
                assert!(!result.is_finite(), "{special} with {other} gave {result}");
            }
        }
        let (sin, cos) = special.sin_cos();
        let one = [sin, cos, special.acos(), special.floor(), special.abs(), special.wrap_to_pi(), -special];
        for result in one.into_iter().chain([special.sqrt(), special.split_index().1]) {
            assert!(!result.is_finite(), "of {special}: {result}");
        }
        assert!(!(special * Q32::ZERO).is_finite(), "{special} times zero");
        assert!(special * Q32::ZERO != Q32::ZERO, "{special} times zero");
    }
}

#[test]
fn zero_divides_into_infinity() {
    assert_eq!(Q32::ONE / Q32::ZERO, Q32::INFINITY);
    assert_eq!(-Q32::ONE / Q32::ZERO, Q32::NEG_INFINITY);
    assert!((Q32::ZERO / Q32::ZERO).is_nan(), "0 / 0");
}

#[test]
fn comparisons_are_those_of_floating_point() {
    for a in operands() {
        for b in operands() {
            let exact = |q: Q32| if q.is_finite() { (i128::from(q.raw), 0.0) } else { (0, q.to_f64()) };
            let ((x, u), (y, v)) = (exact(a), exact(b));
            let expected = match (a.is_finite(), b.is_finite()) {
                (true, true) => Some(x.cmp(&y)),
                _ => u.partial_cmp(&v),
            };
            assert_eq!(a.partial_cmp(&b), expected, "{a} against {b}");
            assert_eq!(a < b, expected.is_some_and(core::cmp::Ordering::is_lt), "{a} < {b}");
            assert_eq!(a <= b, expected.is_some_and(core::cmp::Ordering::is_le), "{a} <= {b}");
            assert_eq!(a > b, expected.is_some_and(core::cmp::Ordering::is_gt), "{a} > {b}");
            assert_eq!(a >= b, expected.is_some_and(core::cmp::Ordering::is_ge), "{a} >= {b}");
            assert_eq!(a == b, expected.is_some_and(core::cmp::Ordering::is_eq), "{a} == {b}");
        }
    }
}

/// `from_raw` and `from_u32` make no special word by accident.
#[test]
fn words_outside_the_range_are_infinite() {
    for raw in [1 << 60, 4 << 60, i64::MAX, -(1 << 60) - 1, -(6 << 60) + 5, -(7 << 60), i64::MIN] {
        let q = Q32::from_raw(raw);
        assert_eq!(q, if raw < 0 { Q32::NEG_INFINITY } else { Q32::INFINITY }, "{raw}");
    }
    for value in [1 << 28, 1 << 30, 1 << 31, u32::MAX] {
        assert_eq!(Q32::from_u32(value), Q32::INFINITY, "{value}");
    }
    assert_eq!(Q32::from_u32((1 << 28) - 1).to_raw(), ((1 << 28) - 1) << 32);
}
