//! The known word that a misspelt one most likely means.

/// Longest word that is compared; a longer one is no misspelling of anything known, and the bound keeps the cost down.
const MAX_WORD: usize = 40;

/// The known word at the least edit distance from `word`, case ignored, the first of equals; none where nothing is near.
pub(crate) fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let word = word.to_lowercase();
    let length = word.chars().count();
    if length == 0 || length > MAX_WORD {
        return None;
    }
    let distance = |known: &str| {
        let known = known.to_lowercase();
        if known.starts_with(&word) || (!known.is_empty() && word.starts_with(&known)) {
            // `tri` of `trimf`: a word cut short.
            return 1;
        }
        strsim::osa_distance(&word, &known)
    };
    known
        .into_iter()
        .map(|known| (distance(known), known))
        .min_by_key(|(distance, _)| *distance)
        .filter(|(distance, known)| *distance <= 1 + length.max(known.chars().count()) / 3)
        .map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn slips_are_recognized_and_other_words_are_not() {
        let known = ["trimf", "trapmf", "gaussmf", "gauss2mf"];
        for (word, near) in [
            ("trinf", Some("trimf")),
            ("TRIMF", Some("trimf")),
            ("trap", Some("trapmf")),
            ("gausmf", Some("gaussmf")),
            ("customised", None),
            ("", None),
        ] {
            assert_eq!(nearest(word, known), near, "{word}");
        }
        assert_eq!(nearest(&"x".repeat(100_000), known), None, "too long to be a slip");
    }
}
