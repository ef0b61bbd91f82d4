//! Whether a rule fires for every input.

use std::fmt::Write;

use mm_control::fuzzy::{Connective, MembershipFunction as Mf};

use crate::{Rule, Shape, System, Variable};

/// Degrees that are looked at: points times rules times inputs.
const MAX_WORK: usize = 5_000_000;

/// A place where no rule concludes anything of an output, as in `, as at x = 3`; `None` where one always does.
///
/// Between the points where a term starts, ends or is fully met, whether it holds at all does not change: the points and
/// the middles between them stand for all. Where there are too many of them it is taken that there is such a place,
/// which the answer, being empty, then does not name.
pub(crate) fn unfired(system: &System, output: usize) -> Option<String> {
    let grids: Vec<Vec<f64>> = system.inputs.iter().map(grid).collect();
    let rules: Vec<&Rule> = system
        .rules
        .iter()
        .filter(|rule| rule.weight > 0.0 && rule.outputs.get(output).is_some_and(|term| *term != 0))
        .collect();
    let points = grids.iter().try_fold(1_usize, |points, grid| points.checked_mul(grid.len()));
    let each = rules.len().max(1).saturating_mul(system.inputs.len());
    let work = points.and_then(|points| points.checked_mul(each));
    if work.is_none_or(|work| work > MAX_WORK) {
        return Some(String::new());
    }
    let mut at = vec![0; grids.len()];
    loop {
        let point: Vec<f64> = grids.iter().zip(&at).filter_map(|(grid, at)| grid.get(*at).copied()).collect();
        if !rules.iter().any(|rule| fires(system, rule, &point)) {
            return Some(named(system, &point));
        }
        // The next point: counting with one digit for each input.
        let mut carries = true;
        for (digit, grid) in at.iter_mut().zip(&grids) {
            *digit += 1;
            if *digit < grid.len() {
                carries = false;
                break;
            }
            *digit = 0;
        }
        if carries {
            return None;
        }
    }
}

fn named(system: &System, point: &[f64]) -> String {
    let mut text = String::from(", as at ");
    for (index, (input, x)) in system.inputs.iter().zip(point).enumerate() {
        let _ = write!(text, "{}{} = {x}", if index > 0 { ", " } else { "" }, input.name);
    }
    text
}

fn fires(system: &System, rule: &Rule, point: &[f64]) -> bool {
    let mut holding = rule.inputs.iter().zip(&system.inputs).zip(point).filter_map(|((index, input), x)| {
        let term = input.terms.get(usize::from(index.unsigned_abs()).checked_sub(1)?)?;
        let Shape::Set(set) = term.shape else { return Some(false) };
        let degree = set.degree(*x);
        Some(if *index < 0 { degree < 1.0 } else { degree > 0.0 })
    });
    match rule.connective {
        Connective::And => holding.all(|holds| holds),
        Connective::Or => holding.any(|holds| holds),
    }
}

/// The points of an input at which some term changes, and the middles between them.
fn grid(input: &Variable) -> Vec<f64> {
    let (low, high) = input.range;
    let mut edges = vec![low, high];
    for term in &input.terms {
        let Shape::Set(set) = term.shape else { continue };
        match set {
            // Below `exp(-745)` a degree is 0.
            Mf::Gaussian([s, c]) => edges.extend([c - 39.0 * s, c, c + 39.0 * s]),
            Mf::Gaussian2([s1, c1, s2, c2]) => edges.extend([c1 - 39.0 * s1, c1, c2, c2 + 39.0 * s2]),
            Mf::Bell([.., c]) => edges.push(c),
            Mf::Sigmoid([a, c]) => edges.extend([c - 710.0 / a, c, c + 40.0 / a]),
            Mf::SigmoidDifference([a1, c1, a2, c2]) | Mf::SigmoidProduct([a1, c1, a2, c2]) => {
                edges.extend([c1 - 710.0 / a1, c1, c1 + 40.0 / a1, c2 - 710.0 / a2, c2, c2 + 40.0 / a2]);
            }
            Mf::Triangle(_)
            | Mf::Trapezoid(_)
            | Mf::LinearS(_)
            | Mf::LinearZ(_)
            | Mf::S(_)
            | Mf::Z(_)
            | Mf::Pi(_) => {
                edges.extend_from_slice(set.parameters());
            }
        }
    }
    edges.retain(|edge| (low..=high).contains(edge));
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    let middles: Vec<f64> =
        edges.windows(2).filter_map(|pair| Some(0.5 * pair.first()? + 0.5 * pair.last()?)).collect();
    edges.extend(middles);
    edges
}
