//! The rows of the table: what is measured, and the number that the thesis states, where it states one.

use super::measure::{Axis, Measure};

/// A row to fill.
#[derive(Debug, Clone, Copy)]
pub(super) struct Claim {
    pub(super) experiment: &'static str,
    pub(super) controller: &'static str,
    pub(super) quantity: &'static str,
    pub(super) unit: &'static str,
    pub(super) measure: Measure,
    /// The thesis's number; none where it has a figure or a sentence only.
    pub(super) thesis: Option<f64>,
    pub(super) note: Option<&'static str>,
}

const V_OVER_OMEGA: &str = "v/omega of the velocities that the thesis gives; its circle is a figure";
const CALLED_SPIRAL: &str = "v/omega; the thesis calls the motion a spiral";
const FROM_TIME: &str = "0.5 m/s for 2 s, as the thesis says";
const GROWS: &str =
    "the thesis says that the semicircle grows with the motion of the base, and gives no number";
const SMOOTH: &str = "the thesis shows figures and says that the error converges, and gives no number";
const REJECTED: &str = "the thesis shows figures of the rejected disturbance, and gives no number";
const GAINS: &str = "ITAE falls as 1/(K c), and the thesis gives no gains: not comparable";
const OTHER_LAW: &str =
    "our default law, not the printed one; ITAE falls as 1/(K c), and the thesis gives no gains";
const SUMMED: &str = "sum of the entries of Table 5.2; no gains are given: not comparable";
const CLAIM: &str = "the thesis's claim for its law, here for the law as printed";
const CLAIM_OTHER: &str = "the thesis's claim for its law, here for our default law, which is another one";
const CLAIM_SUM: &str =
    "the thesis's claim for its law (its abstract says 31.6), here for the law as printed";
const NO_NUMBER: &str = "the thesis compares by figures only";
const CHATTER: &str = "the thesis does not report it";

/// A row without a number of the thesis.
const fn row(
    experiment: &'static str,
    controller: &'static str,
    (quantity, unit): (&'static str, &'static str),
    measure: Measure,
) -> Claim {
    Claim { experiment, controller, quantity, unit, measure, thesis: None, note: None }
}

impl Claim {
    const fn says(self, thesis: f64) -> Self {
        Self { thesis: Some(thesis), ..self }
    }

    const fn note(self, note: &'static str) -> Self {
        Self { note: Some(note), ..self }
    }
}

/// All rows, in the order of the thesis.
pub(super) fn claims() -> Vec<Claim> {
    let mut all = verification();
    for (experiment, note) in [
        ("sinusoid", SMOOTH),
        ("sinusoid-base-held", SMOOTH),
        ("spiral", SMOOTH),
        ("square", SMOOTH),
        ("spiral-disturbed", REJECTED),
        ("step-disturbed", REJECTED),
    ] {
        all.extend(tracking(experiment, "bfsmc").map(|claim| claim.note(note)));
    }
    let from = |experiment, quantity, t| {
        row(experiment, "bfsmc", (quantity, "mm"), Measure::LargestFrom(t)).note(REJECTED)
    };
    all.push(from("spiral-disturbed", "largest error from 20 s on", 20.0));
    all.push(from("step-disturbed", "largest error from 5 s on", 5.0));
    all.extend(compared("spiral-compare", "largest error from 10 s on", 10.0));
    all.extend(compared("square-compare", "largest error from 10 s on", 10.0));
    all.extend(table_5_2());
    // Rows of one experiment stand together.
    all.sort_by_key(|claim| super::EXPERIMENTS.iter().position(|e| e.name == claim.experiment));
    all
}

/// Section 3.7.
fn verification() -> Vec<Claim> {
    let imposed = |experiment, quantity, measure| row(experiment, "none", quantity, measure);
    let mut all = vec![
        imposed("verify-straight", ("mean speed of the base", "m/s"), Measure::MeanSpeed).says(0.1),
        imposed("verify-straight", ("largest |y| of the base", "m"), Measure::Sideways).says(0.0),
        imposed("verify-circle", ("radius of the circle", "m"), Measure::BaseRadius)
            .says(0.5)
            .note(V_OVER_OMEGA),
        imposed("verify-reverse-circle", ("radius of the circle", "m"), Measure::BaseRadius)
            .says(0.5)
            .note(CALLED_SPIRAL),
        imposed("verify-joint2", ("radius of the tip's arc", "m"), Measure::TipRadius),
        imposed("verify-resting-base", ("span of the semicircle", "m"), Measure::TipSpan).note(GROWS),
        imposed("verify-moving-base", ("span of the semicircle", "m"), Measure::TipSpan).note(GROWS),
        imposed("verify-moving-base", ("way of the base", "m"), Measure::BaseTravel)
            .says(1.0)
            .note(FROM_TIME),
    ];
    for experiment in [
        "verify-straight",
        "verify-circle",
        "verify-reverse-circle",
        "verify-joint2",
        "verify-joints23",
        "verify-resting-base",
        "verify-moving-base",
    ] {
        all.push(imposed(experiment, ("largest distance from closed form", "mm"), Measure::Largest));
    }
    all
}

fn tracking(experiment: &'static str, controller: &'static str) -> [Claim; 5] {
    [
        row(experiment, controller, ("ITAE, sum", "m s^2"), Measure::Itae(Axis::Sum)),
        row(experiment, controller, ("RMS error", "mm"), Measure::Rms),
        row(experiment, controller, ("largest error", "mm"), Measure::Largest),
        row(experiment, controller, ("within 10 mm from", "s"), Measure::Settled),
        row(experiment, controller, ("torque variation", "N m/s"), Measure::Variation).note(CHATTER),
    ]
}

/// Sections 5.7 and 5.8, as far as the thesis has no numbers.
fn compared(experiment: &'static str, from: &'static str, t: f64) -> Vec<Claim> {
    let mut all = Vec::new();
    for law in ["bsmc", "bfsmc-thesis", "bfsmc"] {
        if experiment == "spiral-compare" {
            all.push(row(experiment, law, ("ITAE, sum", "m s^2"), Measure::Itae(Axis::Sum)).note(NO_NUMBER));
        }
        all.push(row(experiment, law, (from, "mm"), Measure::LargestFrom(t)).note(NO_NUMBER));
        all.push(row(experiment, law, ("torque variation", "N m/s"), Measure::Variation).note(CHATTER));
    }
    if experiment == "spiral-compare" {
        for law in ["bfsmc-thesis", "bfsmc"] {
            let measure = Measure::ItaeBelow("bsmc", Axis::Sum);
            all.push(row(experiment, law, ("ITAE below bsmc, sum", "%"), measure).note(NO_NUMBER));
        }
    }
    all
}

/// Table 5.2: ITAE of BSMC, of BFSMC, and the improvement in percent; the sums are the text's.
pub(crate) const TABLE_5_2: [(Axis, f64, f64, f64); 4] = [
    (Axis::X, 3.91, 2.06, 47.31),
    (Axis::Y, 4.637, 4.265, 8.02),
    (Axis::Z, 2.431, 1.232, 49.32),
    (Axis::Sum, 10.978, 7.557, 31.16),
];

fn table_5_2() -> Vec<Claim> {
    let itae = |axis| match axis {
        Axis::X => "ITAE x",
        Axis::Y => "ITAE y",
        Axis::Z => "ITAE z",
        Axis::Sum => "ITAE, sum",
    };
    let below = |axis| match axis {
        Axis::X => "ITAE below bsmc, x",
        Axis::Y => "ITAE below bsmc, y",
        Axis::Z => "ITAE below bsmc, z",
        Axis::Sum => "ITAE below bsmc, sum",
    };
    let mut all = Vec::new();
    for (law, note) in [("bsmc", GAINS), ("bfsmc-thesis", GAINS), ("bfsmc", OTHER_LAW)] {
        for (axis, bsmc, bfsmc, _) in TABLE_5_2 {
            let note = if axis == Axis::Sum && law != "bfsmc" { SUMMED } else { note };
            let thesis = if law == "bsmc" { bsmc } else { bfsmc };
            let quantity = (itae(axis), "m s^2");
            all.push(row("square-compare", law, quantity, Measure::Itae(axis)).says(thesis).note(note));
        }
    }
    for (law, note, note_sum) in [("bfsmc-thesis", CLAIM, CLAIM_SUM), ("bfsmc", CLAIM_OTHER, CLAIM_OTHER)] {
        for (axis, _, _, percent) in TABLE_5_2 {
            let note = if axis == Axis::Sum { note_sum } else { note };
            let measure = Measure::ItaeBelow("bsmc", axis);
            all.push(row("square-compare", law, (below(axis), "%"), measure).says(percent).note(note));
        }
    }
    all
}
