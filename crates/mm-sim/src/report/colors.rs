//! A colour for every run, on light and on dark paper: those of the figures for their laws, of Okabe and Ito for the others.

use serde::Serialize;

/// A colour on light and on dark paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub(crate) struct Color {
    light: &'static str,
    dark: &'static str,
}

const fn color(light: &'static str, dark: &'static str) -> Color {
    Color { light, dark }
}

const BLUE: Color = color("#0072b2", "#4aa8e0");
const ORANGE: Color = color("#d98c00", "#f0b33c");
const VERMILION: Color = color("#c8501c", "#ff7f4d");
const PURPLE: Color = color("#b0578d", "#e39cc6");

/// All of them, in the order in which they are given away.
const PALETTE: [Color; 10] = [
    BLUE,
    VERMILION,
    color("#00835f", "#2fc798"),
    ORANGE,
    PURPLE,
    color("#3aa0d8", "#9ad4f5"),
    color("#6b5bd2", "#a99bff"),
    color("#7a6a00", "#e6d94a"),
    color("#8c4a2f", "#c9957d"),
    color("#5c6770", "#b3bec8"),
];

/// The colour that the figures give a law.
fn of_law(law: &str) -> Option<Color> {
    match law {
        "bsmc" => Some(ORANGE),
        "bsmc-sat" => Some(PURPLE),
        "bfsmc-thesis" => Some(VERMILION),
        "bfsmc" | "none" => Some(BLUE),
        _ => None,
    }
}

/// A colour for each run: its law's if that is still free, else the next one that no law of the others has.
pub(super) fn of_runs(laws: &[&str]) -> Vec<Color> {
    let mut taken: Vec<Color> = Vec::new();
    let mut colors = vec![None; laws.len()];
    for (slot, law) in colors.iter_mut().zip(laws) {
        *slot = of_law(law).filter(|color| !taken.contains(color));
        taken.extend(*slot);
    }
    let mut free =
        PALETTE.into_iter().filter(|color| !taken.contains(color)).chain(PALETTE.into_iter().cycle());
    colors.into_iter().filter_map(|slot| slot.or_else(|| free.next())).collect()
}

#[cfg(test)]
mod tests {
    use super::{BLUE, ORANGE, of_runs};
    use std::collections::BTreeSet;

    #[test]
    fn laws_have_their_colours_and_no_two_runs_the_same() {
        let colors = of_runs(&["pid", "bsmc", "bfsmc", "bfsmc", "lqr"]);
        assert_eq!((colors[1], colors[2]), (ORANGE, BLUE), "as in the figures");
        let different: BTreeSet<&str> = colors.iter().map(|color| color.light).collect();
        assert_eq!(different.len(), 5, "five runs, five colours");
        assert_eq!(of_runs(&["pid"; 25]).len(), 25, "however many there are");
    }
}
