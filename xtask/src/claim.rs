//! The claim of the thesis, judged: its fuzzy law against its baseline on `square-compare`, as printed and as mended, with equal switching
//! authority, over 30 disturbance phases and start offsets. Writes `docs/claim.csv`.

use std::fmt::Write;

use anyhow::{Context, Result, ensure};

use crate::mmsim::{Mmsim, Outcome};
use crate::parallel;
use crate::shell::{relative, root};
use crate::table::{Table, number};

/// Runs of each variant; every variant sees the same ones.
const SEEDS: u32 = 30;

/// Switching gains of bsmc: the best of the recorded grid (`docs/grid.csv`), N, then N m.
const K: [f64; 5] = [6.0, 0.3, 16.875, 22.5, 16.875];

/// Size of the fuzzy output just beside zero (`docs/errata.md`, Appendix C).
const JUMP: f64 = 8.0 / 9.0;

/// A law with its settings.
struct Variant {
    name: &'static str,
    controller: &'static str,
    /// Factors on K of the switching gain and of the fuzzy gain.
    factors: [f64; 2],
    more: &'static [&'static str],
}

const fn variant(name: &'static str, controller: &'static str, factors: [f64; 2]) -> Variant {
    Variant { name, controller, factors, more: &[] }
}

/// The baseline comes first.
const VARIANTS: [Variant; 9] = [
    variant("bsmc: sign, gain k", "bsmc", [1.0, 0.0]),
    variant("mended, k and k_f = k on top", "bfsmc-thesis", [1.0, 1.0]),
    variant(
        "mended, equal authority at s = 0: k + 8/9 k_f as bsmc, halves",
        "bfsmc-thesis",
        [0.5, 0.5 / JUMP],
    ),
    variant("mended, equal authority at s = 0: fuzzy term alone", "bfsmc-thesis", [0.0, 1.0 / JUMP]),
    Variant {
        name: "printed sign (error of 4.17), k and k_f = k",
        controller: "bfsmc-thesis",
        factors: [1.0, 1.0],
        more: &["controller.gains.misprints.sign=true"],
    },
    Variant {
        name: "printed channels (no input map), k and k_f = k",
        controller: "bfsmc-thesis",
        factors: [1.0, 1.0],
        more: &["controller.gains.misprints.channels=true"],
    },
    Variant {
        name: "printed channels, equal authority, halves",
        controller: "bfsmc-thesis",
        factors: [0.5, 0.5 / JUMP],
        more: &["controller.gains.misprints.channels=true"],
    },
    variant("for comparison: bsmc-sat, gain k", "bsmc-sat", [1.0, 0.0]),
    Variant {
        name: "for comparison: bfsmc of this project, tuned gains",
        controller: "bfsmc",
        factors: [1.0, 1.0],
        more: &[],
    },
];

/// One run of one variant.
struct Case {
    variant: usize,
    seed: u32,
}

const HEADER: &str = "variant,seed,phase_rad,offset_x_m,offset_y_m,offset_z_m,status,itae_sum_m_s2,rmse_norm_m,max_error_m,\
                      torque_tv_n_m_per_s";

/// Columns of a result, by their names in the summary.
const COLUMNS: [&str; 4] = [
    "metrics.itae_m_s2.sum",
    "metrics.rmse_m.norm",
    "metrics.max_error_m",
    "metrics.torque_tv_n_m_per_s.sum",
];

/// Runs all variants on all seeds, writes `docs/claim.csv` and prints the table.
pub(crate) fn run(mmsim: &Mmsim) -> Result<()> {
    let cases: Vec<Case> =
        (0..VARIANTS.len()).flat_map(|variant| (0..SEEDS).map(move |seed| Case { variant, seed })).collect();
    let outcomes: Vec<Outcome> =
        parallel::map(&cases, |case| mmsim.simulate("square-compare", &case.arguments()))
            .into_iter()
            .collect::<Result<_>>()?;
    let mut csv = format!("{HEADER}\n");
    for (case, outcome) in cases.iter().zip(&outcomes) {
        let code = outcome.code.context("a run was killed")?;
        // A run may diverge; bad input or a missing summary of a good run is a fault of this job.
        ensure!(code == 1 || outcome.is_good(), "{}\n{}", outcome.verdict(), outcome.messages);
        let (phase, offset) = draw(case.seed);
        let mut cells =
            vec![format!("\"{}\"", case.settings().name), case.seed.to_string(), phase.to_string()];
        cells.extend(offset.map(|x| x.to_string()));
        cells.push(if code == 0 { "ok" } else { "failed" }.to_owned());
        cells.extend(
            COLUMNS.map(|name| result(outcome, name).map_or_else(String::new, |value| value.to_string())),
        );
        writeln!(csv, "{}", cells.join(","))?;
    }
    let path = root().join("docs/claim.csv");
    std::fs::write(&path, csv)?;
    report(&cases, &outcomes);
    println!("{} runs in {}", cases.len(), relative(&path));
    Ok(())
}

/// A number of a run that went to its end.
fn result(outcome: &Outcome, name: &str) -> Option<f64> {
    outcome.number(name).filter(|_| outcome.is_good())
}

impl Case {
    fn settings(&self) -> &'static Variant {
        &VARIANTS[self.variant]
    }

    fn arguments(&self) -> Vec<String> {
        let Variant { controller, factors, more, .. } = self.settings();
        let gains = |factor: f64| K.map(|k| format!("{:?}", factor * k)).join(",");
        let (phase, [x, y, z]) = draw(self.seed);
        let mut sets = vec![
            format!("disturbance.0.phase_rad={phase:?}"),
            format!("initial.offset_m=[{x:?},{y:?},{z:?}]"),
        ];
        if *controller != "bfsmc" {
            sets.push(format!("controller.gains_for.{controller}.switching_gain=[{}]", gains(factors[0])));
            sets.push(format!("controller.gains_for.{controller}.fuzzy_gain=[{}]", gains(factors[1])));
            sets.push(format!("controller.gains_for.{controller}.fuzzy_scale=[1.0,1.0,1.0,1.0,1.0]"));
        }
        sets.extend(more.iter().map(|set| (*set).to_owned()));
        let mut arguments = vec!["--controller".to_owned(), (*controller).to_owned()];
        for set in sets {
            arguments.extend(["--set".to_owned(), set]);
        }
        arguments
    }
}

/// Phase of the disturbance, anywhere in the circle, and offset of the tip, up to 2 cm along each axis; seed 0 is the scenario itself.
fn draw(seed: u32) -> (f64, [f64; 3]) {
    if seed == 0 {
        return (0.0, [0.0; 3]);
    }
    let mut state = u64::from(seed);
    let mut next = || {
        // SplitMix64.
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        f64::from(u32::try_from((z ^ (z >> 31)) >> 32).unwrap_or(0)) / 4_294_967_296.0
    };
    let phase = core::f64::consts::TAU * next();
    (phase, [0; 3].map(|_| 0.02 * (2.0 * next() - 1.0)))
}

/// Prints median and range of each variant, and in how many of the runs it was better than the baseline.
fn report(cases: &[Case], outcomes: &[Outcome]) {
    let of = |variant: usize, name: &str| -> Vec<Option<f64>> {
        let pairs = cases.iter().zip(outcomes);
        pairs.filter(|(case, _)| case.variant == variant).map(|(_, outcome)| result(outcome, name)).collect()
    };
    let mut table = Table::new(&[
        "variant",
        "ITAE sum, m s2: median",
        "least to largest",
        "torque TV, N m/s: median",
        "largest error, mm",
        "failed",
        "ITAE below bsmc",
        "TV below bsmc",
    ]);
    let [itae, _, error, variation] = COLUMNS;
    for (i, variant) in VARIANTS.iter().enumerate() {
        let (sums, variations) = (of(i, itae), of(i, variation));
        let better = |name| {
            let pairs = of(i, name).into_iter().zip(of(0, name));
            let wins = pairs.filter(|(a, b)| matches!((a, b), (Some(a), Some(b)) if a < b)).count();
            format!("{wins} of {SEEDS}")
        };
        let (low, middle, high) = spread(&sums);
        let (_, usual, _) = spread(&variations);
        let (_, _, worst) = spread(&of(i, error));
        table.add(vec![
            variant.name.to_owned(),
            number(middle),
            format!("{} to {}", number(low), number(high)),
            number(usual),
            number(worst.map(|e| 1e3 * e)),
            sums.iter().filter(|sum| sum.is_none()).count().to_string(),
            if i == 0 { String::new() } else { better(itae) },
            if i == 0 { String::new() } else { better(variation) },
        ]);
    }
    table.print();
}

/// Least, median and largest of the values that there are.
fn spread(values: &[Option<f64>]) -> (Option<f64>, Option<f64>, Option<f64>) {
    let mut sorted: Vec<f64> = values.iter().flatten().copied().collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median = match (sorted.get(middle.wrapping_sub(1)), sorted.get(middle)) {
        (Some(a), Some(b)) if sorted.len().is_multiple_of(2) => Some(0.5 * (a + b)),
        (_, middle) => middle.copied(),
    };
    (sorted.first().copied(), median, sorted.last().copied())
}

#[cfg(test)]
mod tests {
    use super::{SEEDS, draw, spread};

    #[test]
    fn the_median_counts_what_there_is() {
        assert_eq!(spread(&[Some(3.0), None, Some(1.0)]), (Some(1.0), Some(2.0), Some(3.0)), "two values");
        assert_eq!(spread(&[Some(5.0)]), (Some(5.0), Some(5.0), Some(5.0)), "one value");
        assert_eq!(spread(&[None]), (None, None, None), "no value");
    }

    #[test]
    fn draws_differ_and_stay_in_range() {
        let all: Vec<_> = (0..SEEDS).map(draw).collect();
        for (i, (phase, offset)) in all.iter().enumerate() {
            assert!((0.0..core::f64::consts::TAU).contains(phase), "phase {phase}");
            assert!(offset.iter().all(|x| x.abs() <= 0.02), "offset {offset:?}");
            assert!(!all[..i].contains(&(*phase, *offset)), "draw {i} is there twice");
        }
    }
}
