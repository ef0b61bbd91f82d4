//! Terms given by points.

use mm_control::fuzzy::MembershipFunction as Mf;

use crate::fis::Number;
use crate::read::Report;

/// A point (x, degree).
pub(super) type Point<'a> = (Number<'a>, Number<'a>);

/// How far a point may lie off the straight side it is on: rounding of decimal fractions.
const STRAIGHT: f64 = 1e-12;

/// Makes a triangle, a trapezoid or a shoulder of points; other shapes the engine does not have.
///
/// Left of the first point and right of the last the degree stays as it is there.
#[expect(clippy::float_cmp, reason = "degrees of 0 and 1 are written as such")]
pub(super) fn shape(points: &[Point<'_>], report: &mut Report) -> Option<Mf<f64>> {
    let mut before: Option<f64> = None;
    for (x, y) in points {
        if before.is_some_and(|before| x.value < before) {
            report.add_expected(
                x.place,
                format!("a point at {} after one at {}", x.place.text, before.unwrap_or(0.0)),
                "ascending points",
            );
            return None;
        }
        if !(0.0..=1.0).contains(&y.value) {
            report.add_expected(y.place, format!("a degree of {}", y.place.text), "a number from 0 to 1");
            return None;
        }
        before = Some(x.value);
    }
    let top = |(_, y): &Point<'_>| y.value == 1.0;
    let (Some(first), Some(last)) = (points.iter().position(top), points.iter().rposition(top)) else {
        if let Some((_, y)) = points.iter().max_by(|a, b| a.1.value.total_cmp(&b.1.value)) {
            report.add_expected(
                y.place,
                format!("a term whose largest degree is {}", y.place.text),
                "a degree of 1",
            );
        }
        return None;
    };
    let (rising, rest) = points.split_at(first);
    let (level, falling) = rest.split_at_checked(last + 1 - first)?;
    if let Some((_, y)) = level.iter().find(|point| !top(point)) {
        report.add_expected(
            y.place,
            format!("a term with two peaks: {} between them", y.place.text),
            UNTAKEN,
        );
        return None;
    }
    let (left, right) = (level.first()?.0, level.last()?.0);
    let falling: Vec<_> = falling.iter().rev().copied().collect();
    let rising = side(rising, left, report)?;
    let falling = side(&falling, right, report)?;
    let (b, c) = (left.value, right.value);
    match (rising, falling) {
        (Some(a), Some(d)) if b == c => Some(Mf::Triangle([a, b, d])),
        (Some(a), Some(d)) => Some(Mf::Trapezoid([a, b, c, d])),
        (Some(a), None) => Some(Mf::LinearS([a, b])),
        (None, Some(d)) => Some(Mf::LinearZ([c, d])),
        (None, None) => {
            report.add_expected(left.place, "a term that is 1 everywhere", UNTAKEN);
            None
        }
    }
}

const UNTAKEN: &str = "a triangle, a trapezoid or a shoulder";

/// Where a side starts that ends at the peak, from the outside inwards: `None` without a side.
#[expect(clippy::option_option, reason = "refused, or no side, or a side")]
fn side(points: &[Point<'_>], peak: Number<'_>, report: &mut Report) -> Option<Option<f64>> {
    let Some((_, outermost)) = points.first() else { return Some(None) };
    if outermost.value > 0.0 {
        let message = format!("a term that stays at {} outside", outermost.place.text);
        report.add_expected(outermost.place, message, "a degree of 0 or 1 at the first and the last point");
        return None;
    }
    let foot = points.iter().rposition(|(_, y)| y.value <= 0.0)?;
    let start = points.get(foot)?.0.value;
    let width = peak.value - start;
    for (index, (x, y)) in points.iter().enumerate() {
        let straight = if index <= foot {
            0.0
        } else if width.abs() > 0.0 {
            (x.value - start) / width
        } else {
            // A vertical side holds every degree.
            y.value
        };
        if (y.value - straight).abs() > STRAIGHT {
            let message = format!("a bend at ({}, {})", x.place.text, y.place.text);
            report.add_expected(y.place, message, UNTAKEN);
            return None;
        }
    }
    Some(Some(start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Piece;

    fn read(points: &[(f64, f64)]) -> Option<Mf<f64>> {
        let number = |value| Number { value, place: Piece::new("", 0) };
        let points: Vec<_> = points.iter().map(|&(x, y)| (number(x), number(y))).collect();
        shape(&points, &mut Report::new())
    }

    #[test]
    fn points_become_the_shapes_they_draw() {
        for (points, shape) in [
            (&[(0.0, 0.0), (1.0, 1.0), (3.0, 0.0)][..], Some(Mf::Triangle([0.0, 1.0, 3.0]))),
            (&[(1.0, 0.0), (4.0, 1.0), (6.0, 1.0), (9.0, 0.0)], Some(Mf::Trapezoid([1.0, 4.0, 6.0, 9.0]))),
            (&[(0.0, 1.0), (4.0, 0.0)], Some(Mf::LinearZ([0.0, 4.0]))),
            (&[(-1.0, 0.0), (6.0, 0.0), (9.0, 1.0), (10.0, 1.0)], Some(Mf::LinearS([6.0, 9.0]))),
            (&[(0.0, 0.0), (0.1, 0.1), (0.3, 0.3), (1.0, 1.0)], Some(Mf::LinearS([0.0, 1.0]))),
            (&[(2.0, 0.0), (2.0, 1.0), (3.0, 1.0), (3.0, 0.0)], Some(Mf::Trapezoid([2.0, 2.0, 3.0, 3.0]))),
            (&[(0.0, 0.0), (0.5, 0.4), (1.0, 1.0)], None),
            (&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.5), (3.0, 1.0)], None),
            (&[(0.0, 0.5), (1.0, 1.0)], None),
            (&[(0.0, 0.0), (1.0, 0.9), (2.0, 0.0)], None),
            (&[(0.0, 1.0), (1.0, 1.0)], None),
            (&[(1.0, 0.0), (0.0, 1.0)], None),
            (&[(0.0, 0.0), (1.0, 1.5)], None),
            (&[], None),
        ] {
            assert_eq!(read(points), shape, "{points:?}");
        }
    }
}
