//! The known word that a misspelt one most likely means.

/// Returns the candidate at the least edit distance from `word`, the first of equals; none without
/// candidates.
///
/// Case is ignored, and a candidate that continues the word, as `duration_s` does `duration`, counts as
/// one edit away: a forgotten unit is the most common slip.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    candidates.into_iter().min_by_key(|candidate| {
        let lower = candidate.to_lowercase();
        if !word.is_empty() && lower.starts_with(&format!("{word}_")) { 1 } else { distance(&word, &lower) }
    })
}

/// Whether a word is so near to another that it may well be a misspelling of it.
pub(crate) fn is_near(word: &str, other: &str) -> bool {
    distance(&word.to_lowercase(), &other.to_lowercase()) <= 1 + other.chars().count() / 4
}

/// Counts the insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`
/// (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    // Longer words are no misspelling of anything known; the bound keeps the cost down.
    let a: Vec<char> = a.chars().take(64).collect();
    let b: Vec<char> = b.chars().take(64).collect();
    let mut before: Vec<usize> = vec![0; b.len() + 1];
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let replaced = last[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = replaced.min(last[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut last, row);
    }
    last[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_counts_edits_and_swaps() {
        for (a, b, edits) in
            [("", "", 0), ("", "abc", 3), ("kind", "knid", 1), ("mass", "mass_kg", 3), ("a", "b", 1)]
        {
            assert_eq!(distance(a, b), edits, "from {a:?} to {b:?}");
            assert_eq!(distance(b, a), edits, "from {b:?} to {a:?}");
        }
    }

    #[test]
    fn a_forgotten_unit_is_the_nearest() {
        assert_eq!(nearest("mass", ["com_m", "mass_kg", "max"]), Some("mass_kg"), "unit forgotten");
        assert_eq!(nearest("Duration_S", ["seed", "duration_s"]), Some("duration_s"), "case");
        assert_eq!(nearest("x", []), None, "nothing known");
        assert!(is_near("sqare", "square") && !is_near("tmp", "spiral"), "a slip and another word");
    }
}
