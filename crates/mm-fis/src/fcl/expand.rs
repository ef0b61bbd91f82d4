//! From a condition with brackets to rules that join their inputs in one way each.

use mm_control::fuzzy::{And, Connective, Or};

use super::condition::{Condition, Join, joined};
use crate::read::{Piece, Report};

/// Rules that one may become.
const MAX_RULES: usize = 1000;

/// What a condition may be taken apart by.
#[derive(Debug, Clone, Copy)]
pub(super) struct Algebra {
    pub(super) and: And,
    pub(super) or: Or,
    /// Whether the largest of several rules is the same as one rule with OR: the accumulation is MAX, of sets.
    pub(super) largest: bool,
}

/// One input: which, its term, and where it says so.
type Literal<'a> = (usize, i16, Piece<'a>);

/// The inputs of a rule, one term each, and how they are joined.
pub(super) struct Antecedent {
    pub(super) inputs: Vec<i16>,
    pub(super) connective: Connective,
}

impl Algebra {
    /// The rules that together fire as strongly as `condition`, exactly.
    pub(super) fn rules(
        self,
        condition: &Condition<'_>,
        inputs: usize,
        report: &mut Report,
    ) -> Option<Vec<Antecedent>> {
        let condition = self.without_not(condition, false, report)?;
        if let Some((connective, literals)) = flat(&condition)
            && distinct(&literals)
        {
            return Some(vec![antecedent(connective, &literals, inputs)]);
        }
        let place = match &condition {
            Condition::Is { place, .. } | Condition::Joined { place, .. } | Condition::Not { place, .. } => {
                *place
            }
        };
        let alternatives = self.alternatives(&condition, report)?;
        if alternatives.len() > 1 && !(self.largest && self.or == Or::Max) {
            report.add_expected(
                place,
                "a condition that takes several rules, whose largest is its degree only with OR : MAX, ACCU : MAX and sets",
                "AND alone or OR alone, each input once",
            );
            return None;
        }
        let single = |literals: &Vec<Literal<'_>>| antecedent(Connective::And, literals, inputs);
        Some(alternatives.iter().map(single).collect())
    }

    /// The condition with NOT at its inputs alone.
    fn without_not<'a>(
        self,
        condition: &Condition<'a>,
        negated: bool,
        report: &mut Report,
    ) -> Option<Condition<'a>> {
        match condition {
            Condition::Is { input, term, place } => {
                let term = if negated { -term } else { *term };
                Some(Condition::Is { input: *input, term, place: *place })
            }
            Condition::Not { inside, .. } => self.without_not(inside, !negated, report),
            Condition::Joined { join, parts, place } => {
                let pair = matches!((self.and, self.or), (And::Min, Or::Max) | (And::Prod, Or::Probor));
                if negated && !pair {
                    let message = "NOT before brackets, with operators that are no pair";
                    report.add_expected(*place, message, "AND : MIN with OR : MAX, or PROD with ASUM");
                    return None;
                }
                let parts = parts
                    .iter()
                    .map(|part| self.without_not(part, negated, report))
                    .collect::<Option<Vec<_>>>()?;
                let join = match (join, negated) {
                    (Join::And, false) | (Join::Or, true) => Join::And,
                    _ => Join::Or,
                };
                Some(joined(join, parts, *place))
            }
        }
    }

    /// The alternatives of a condition: each a list of inputs that have to hold together.
    fn alternatives<'a>(
        self,
        condition: &Condition<'a>,
        report: &mut Report,
    ) -> Option<Vec<Vec<Literal<'a>>>> {
        let (join, parts, place) = match condition {
            Condition::Is { input, term, place } => return Some(vec![vec![(*input, *term, *place)]]),
            Condition::Not { inside, .. } => return self.alternatives(inside, report),
            Condition::Joined { join, parts, place } => (*join, parts, *place),
        };
        let parts = parts.iter().map(|part| self.alternatives(part, report)).collect::<Option<Vec<_>>>()?;
        if join == Join::Or {
            let all: Vec<_> = parts.into_iter().flatten().collect();
            return self.bounded(all, place, report);
        }
        let mut products: Vec<Vec<Literal<'a>>> = vec![Vec::new()];
        for part in parts {
            let mut next = Vec::new();
            for before in &products {
                for after in &part {
                    next.push(self.both(before, after, report)?);
                }
                if next.len() > MAX_RULES {
                    break;
                }
            }
            products = self.bounded(next, place, report)?;
        }
        Some(products)
    }

    fn bounded<'a>(
        self,
        alternatives: Vec<Vec<Literal<'a>>>,
        place: Piece<'a>,
        report: &mut Report,
    ) -> Option<Vec<Vec<Literal<'a>>>> {
        if alternatives.len() <= MAX_RULES {
            return Some(alternatives);
        }
        report.add(place, format!("a condition that takes more than {MAX_RULES} rules"));
        None
    }

    /// Two lists that have to hold together; an input can be asked for one term only.
    fn both<'a>(
        self,
        before: &[Literal<'a>],
        after: &[Literal<'a>],
        report: &mut Report,
    ) -> Option<Vec<Literal<'a>>> {
        let mut both = before.to_vec();
        for literal in after {
            let same = before.iter().find(|known| known.0 == literal.0);
            match same {
                None => both.push(*literal),
                // The smaller of a degree and itself is that degree.
                Some(known) if known.1 == literal.1 && self.and == And::Min => {}
                Some(_) => {
                    let message = format!("{}: one input with two terms in one AND", literal.2.shown());
                    report.add_expected(literal.2, message, "each input once");
                    return None;
                }
            }
        }
        Some(both)
    }
}

/// The inputs of a condition that is one AND or one OR.
fn flat<'a>(condition: &Condition<'a>) -> Option<(Connective, Vec<Literal<'a>>)> {
    match condition {
        Condition::Is { input, term, place } => Some((Connective::And, vec![(*input, *term, *place)])),
        Condition::Not { .. } => None,
        Condition::Joined { join, parts, .. } => {
            let connective = if *join == Join::And { Connective::And } else { Connective::Or };
            let mut literals = Vec::new();
            for part in parts {
                let (inner, inside) = flat(part)?;
                if inside.len() > 1 && inner != connective {
                    return None;
                }
                literals.extend(inside);
            }
            Some((connective, literals))
        }
    }
}

fn distinct(literals: &[Literal<'_>]) -> bool {
    let mut inputs: Vec<_> = literals.iter().map(|literal| literal.0).collect();
    inputs.sort_unstable();
    inputs.windows(2).all(|pair| pair.first() != pair.last())
}

fn antecedent(connective: Connective, literals: &[Literal<'_>], inputs: usize) -> Antecedent {
    let term = |input| literals.iter().find(|literal| literal.0 == input).map_or(0, |literal| literal.1);
    Antecedent { inputs: (0..inputs).map(term).collect(), connective }
}
