//! A recorded grid of bsmc's switching gains on `square-compare`: how the result depends on them, and which are best.

use std::fmt::Write;

use anyhow::{Context, Result, ensure};

use crate::mmsim::{Mmsim, Outcome};
use crate::parallel;
use crate::shell::{relative, root};
use crate::table::{Table, number};

/// Switching gains of bsmc for the robot of the thesis, 15 % of its force limits: N, then N m.
const DEFAULT: [f64; 5] = [300.0, 30.0, 22.5, 30.0, 22.5];

/// Factors on the gains of forward speed, yaw and all joints, in all combinations.
const FACTORS: [f64; 6] = [0.1, 0.25, 0.5, 0.75, 1.0, 1.5];

/// One point of the grid.
struct Point {
    /// Factors on forward, yaw, joints.
    factors: [f64; 3],
    gains: [f64; 5],
}

const HEADER: &str = "forward_n,yaw_n_m,joint1_n_m,joint2_n_m,joint3_n_m,status,itae_x_m_s2,itae_y_m_s2,itae_z_m_s2,\
                      itae_sum_m_s2,max_error_m,torque_tv_n_m_per_s";

/// Columns of a result, by their names in the summary.
const COLUMNS: [&str; 6] = [
    "metrics.itae_m_s2.x",
    "metrics.itae_m_s2.y",
    "metrics.itae_m_s2.z",
    "metrics.itae_m_s2.sum",
    "metrics.max_error_m",
    "metrics.torque_tv_n_m_per_s.sum",
];

/// Runs the grid and writes `docs/grid.csv`.
pub(crate) fn run(mmsim: &Mmsim) -> Result<()> {
    let points = points();
    let outcomes: Vec<Outcome> =
        parallel::map(&points, |point| mmsim.simulate("square-compare", &point.arguments()))
            .into_iter()
            .collect::<Result<_>>()?;
    let mut csv = format!("{HEADER}\n");
    for (point, outcome) in points.iter().zip(&outcomes) {
        let code = outcome.code.context("a run was killed")?;
        // A run may diverge; bad input or a missing summary of a good run is a fault of this job.
        ensure!(code == 1 || outcome.is_good(), "{}\n{}", outcome.verdict(), outcome.messages);
        let cells = point.gains.iter().map(ToString::to_string);
        let status = std::iter::once(if code == 0 { "ok" } else { "failed" }.to_owned());
        let results = COLUMNS.iter().map(|name| {
            let value = outcome.number(name).filter(|_| code == 0);
            value.map_or_else(String::new, |value| value.to_string())
        });
        writeln!(csv, "{}", cells.chain(status).chain(results).collect::<Vec<_>>().join(","))?;
    }
    let path = root().join("docs/grid.csv");
    std::fs::write(&path, csv)?;
    report(&points, &outcomes);
    println!("{} combinations in {}", points.len(), relative(&path));
    Ok(())
}

fn points() -> Vec<Point> {
    let [forward, yaw, joint1, joint2, joint3] = DEFAULT;
    let mut points = Vec::new();
    for a in FACTORS {
        for b in FACTORS {
            for c in FACTORS {
                points.push(Point {
                    factors: [a, b, c],
                    gains: [a * forward, b * yaw, c * joint1, c * joint2, c * joint3],
                });
            }
        }
    }
    points
}

impl Point {
    fn arguments(&self) -> Vec<String> {
        let gains = self.gains.map(|gain| format!("{gain:?}")).join(",");
        ["--controller", "bsmc", "--set", &format!("controller.gains.switching_gain=[{gains}]")]
            .map(ToOwned::to_owned)
            .to_vec()
    }
}

/// Prints the five best by the sum of the ITAE, and the defaults.
fn report(points: &[Point], outcomes: &[Outcome]) {
    let itae = |outcome: &Outcome| {
        let sum = outcome.number("metrics.itae_m_s2.sum").filter(|_| outcome.is_good());
        sum.unwrap_or(f64::INFINITY)
    };
    let mut ranked: Vec<_> = points.iter().zip(outcomes).enumerate().collect();
    ranked.sort_by(|(_, (_, a)), (_, (_, b))| itae(a).total_cmp(&itae(b)));
    let mut table = Table::new(&[
        "factors on forward, yaw, joints",
        "rank",
        "ITAE sum, m s2",
        "max error, m",
        "torque TV, N m/s",
    ]);
    for (rank, (_, (point, outcome))) in ranked.iter().enumerate() {
        let is_default = point.factors.iter().all(|factor| factor.total_cmp(&1.0).is_eq());
        if rank < 5 || is_default {
            let [a, b, c] = point.factors;
            let note = if is_default { " (default)" } else { "" };
            table.add(vec![
                format!("{a}, {b}, {c}{note}"),
                (rank + 1).to_string(),
                number(outcome.number("metrics.itae_m_s2.sum")),
                number(outcome.number("metrics.max_error_m")),
                number(outcome.number("metrics.torque_tv_n_m_per_s.sum")),
            ]);
        }
    }
    table.print();
}
