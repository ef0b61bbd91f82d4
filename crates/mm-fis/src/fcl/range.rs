//! The range of a variable, where the text gives none.

use mm_control::fuzzy::MembershipFunction as Mf;

use super::describe::Described;
use crate::read::Report;
use crate::{Kind, Shape};

/// Widths of a Gaussian, and of a sigmoid, beyond which its degree is below the last bit of 1.
const FAR: (f64, f64) = (9.0, 40.0);

/// The range of an input: as said, or where its terms end, beyond which none of them changes.
pub(super) fn of_input(variable: &Described<'_>, report: &mut Report) -> Option<(f64, f64)> {
    if let Some((range, _)) = variable.range {
        return Some(range);
    }
    ends(variable, |shape| if let Shape::Set(set) = shape { extent(set) } else { constant(shape) }, report)
}

/// The range of an output: as said, or where its terms end; curved ones never do.
///
/// That of singletons only says what the output is where no rule fires, its middle; so it lies about the default.
pub(super) fn of_output(variable: &Described<'_>, kind: Kind, report: &mut Report) -> Option<(f64, f64)> {
    if kind == Kind::Sugeno {
        return Some(about_default(variable));
    }
    if let Some((range, _)) = variable.range {
        return Some(range);
    }
    let straight = |shape: &Shape| match shape {
        Shape::Set(set @ (Mf::Triangle(_) | Mf::Trapezoid(_))) => extent(set),
        _ => None,
    };
    ends(variable, straight, report)
}

fn ends(
    variable: &Described<'_>,
    extent: impl Fn(&Shape) -> Option<(f64, f64)>,
    report: &mut Report,
) -> Option<(f64, f64)> {
    let mut range = (f64::INFINITY, f64::NEG_INFINITY);
    for defined in &variable.terms {
        let Some((low, high)) = defined.points.or_else(|| extent(&defined.term.shape)) else {
            let message = format!("{} has no RANGE, and this term no end", variable.name.shown());
            report.add_expected(defined.place, message, "`RANGE := (low .. high);` in its block");
            return None;
        };
        range = (range.0.min(low), range.1.max(high));
    }
    if range.0 < range.1 && (range.1 - range.0).is_finite() {
        return Some(range);
    }
    let message = format!("{} has no RANGE, and its terms no width", variable.name.shown());
    report.add_expected(variable.name, message, "`RANGE := (low .. high);` in its block");
    None
}

fn constant(shape: &Shape) -> Option<(f64, f64)> {
    if let Shape::Constant(value) = shape { Some((*value, *value)) } else { None }
}

/// Where a set ends or stops to change.
fn extent(set: &Mf<f64>) -> Option<(f64, f64)> {
    let (gauss, sigmoid) = FAR;
    let about = |centre: f64, width: f64| (centre - width.abs(), centre + width.abs());
    let both = |(a, b): (f64, f64), (c, d): (f64, f64)| (a.min(c), b.max(d));
    let (low, high) = match *set {
        Mf::Triangle([low, _, high]) | Mf::Trapezoid([low, _, _, high]) => (low, high),
        Mf::LinearS([a, b]) | Mf::LinearZ([a, b]) | Mf::S([a, b]) | Mf::Z([a, b]) => (a.min(b), a.max(b)),
        Mf::Pi([a, b, c, d]) => (a.min(b).min(c).min(d), a.max(b).max(c).max(d)),
        Mf::Gaussian([s, c]) => about(c, gauss * s),
        Mf::Gaussian2([s1, c1, s2, c2]) => both(about(c1, gauss * s1), about(c2, gauss * s2)),
        Mf::Sigmoid([a, c]) => about(c, sigmoid / a),
        Mf::SigmoidDifference([a1, c1, a2, c2]) | Mf::SigmoidProduct([a1, c1, a2, c2]) => {
            both(about(c1, sigmoid / a1), about(c2, sigmoid / a2))
        }
        // Falls as a power only.
        Mf::Bell(_) => return None,
    };
    (low.is_finite() && high.is_finite()).then_some((low, high))
}

/// A range whose middle is the default, where there is one and the numbers allow it.
fn about_default(variable: &Described<'_>) -> (f64, f64) {
    let said = variable.range.map(|(range, _)| range);
    let centre = match (variable.default, said) {
        (Some((Some(default), _)), _) => default,
        (_, Some(said)) => return said,
        (_, None) => {
            let values = || variable.terms.iter().filter_map(|term| constant(&term.term.shape));
            let low = values().fold(f64::INFINITY, |low, (value, _)| low.min(value));
            let high = values().fold(f64::NEG_INFINITY, |high, (value, _)| high.max(value));
            if low < high && (high - low).is_finite() {
                return (low, high);
            }
            if low.is_finite() { low } else { 0.0 }
        }
    };
    let reach = |value: f64| (value - centre).abs();
    let furthest = variable
        .terms
        .iter()
        .filter_map(|term| constant(&term.term.shape))
        .map(|(value, _)| reach(value))
        .chain(said.into_iter().flat_map(|(low, high)| [reach(low), reach(high)]))
        .fold(centre.abs() * f64::EPSILON, f64::max);
    let width = if furthest > 0.0 { furthest } else { 1.0 };
    let (low, high) = (centre - width, centre + width);
    if low < high && (high - low).is_finite() { (low, high) } else { said.unwrap_or((-1.0, 1.0)) }
}
