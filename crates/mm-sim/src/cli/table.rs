//! Tables for people.

use std::fmt::Write as _;

use crate::metrics::PerAxisSum;
pub(super) use crate::number::short;
use crate::simulation::Ending;
use crate::summary::{Summary, ended};

/// ITAE of Table 5.2 of the thesis: x, y, z, sum, for its BSMC and BFSMC.
const TABLE_5_2: [(&str, [f64; 4]); 2] =
    [("thesis, its BSMC", [3.91, 4.637, 2.431, 10.978]), ("thesis, its BFSMC", [2.06, 4.265, 1.232, 7.557])];

/// The table of one run; `error` is its error over time, if it was watched.
pub(super) fn single(s: &Summary, error: Option<&str>) -> String {
    let m = &s.metrics;
    let mut out = format!(
        "{} with {}: {} of {} s simulated in {} s, {} times real time\n\n",
        s.scenario,
        s.controller,
        short(s.simulated_s),
        short(s.duration_s),
        short(s.wall_s),
        short(s.real_time_factor)
    );
    let mut axes = |name: &str, unit: &str, values: [f64; 4]| {
        let [x, y, z, all] = values.map(short);
        let _ = writeln!(out, "{name:22} {x:>11} {y:>11} {z:>11} {all:>11}  {unit}");
    };
    let sum = |v: PerAxisSum| [v.x, v.y, v.z, v.sum];
    axes("ITAE  x, y, z, sum", "m s^2", sum(m.itae_m_s2));
    axes("IAE", "m s", sum(m.iae_m_s));
    axes("ISE", "m^2 s", sum(m.ise_m2_s));
    axes(
        "RMS error  x, y, z, |e|",
        "mm",
        [m.rmse_m.x, m.rmse_m.y, m.rmse_m.z, m.rmse_m.norm].map(|e| e * 1e3),
    );
    if let Some(line) = error {
        let _ = writeln!(out, "{:22} {line}  each step a factor of 3.2", "error over time");
    }
    out.push('\n');
    let tv = &m.torque_tv_n_m_per_s;
    let peak = &m.peak_torque_n_m;
    let mut torques = |name: &str, unit: &str, right: f64, left: f64, joints: [f64; 3]| {
        let [j1, j2, j3] = joints.map(short);
        let (right, left) = (short(right), short(left));
        let _ = writeln!(out, "{name:22} {right:>9} {left:>9} {j1:>9} {j2:>9} {j3:>9}  {unit}");
    };
    torques("torque variation", "N m/s  right, left, joints", tv.right, tv.left, tv.joints);
    torques("peak torque", "N m", peak.right, peak.left, peak.joints);
    out.push('\n');
    let settled = m.settling_time_s.map_or("never".to_owned(), |t| format!("{} s", short(t)));
    let reaching = match m.reaching_condition_met {
        Some(true) => "met",
        Some(false) => "not met",
        None => "does not apply",
    };
    for (name, value) in [
        ("torque variation, sum", format!("{} N m/s", short(tv.sum))),
        ("largest error", format!("{} mm", short(m.max_error_m * 1e3))),
        ("within 10 mm from", settled),
        ("energy", format!("{} J", short(m.energy_j))),
        ("saturated", format!("{} % of the periods", short(m.saturated_fraction * 100.0))),
        ("largest speed", format!("{} m/s", short(m.max_speed_m_s))),
        ("least manipulability", short(m.min_manipulability)),
        ("joint limits crossed", format!("{} times", m.joint_limit_crossings)),
        ("reaching condition", reaching.to_owned()),
        ("digest", s.digest.clone()),
        ("log", s.log.clone().unwrap_or_else(|| "none".to_owned())),
    ] {
        let _ = writeln!(out, "{name:22} {value}");
    }
    out.trim_end().to_owned()
}

/// The table of a comparison.
///
/// The thesis's numbers stand beside whole runs of its experiment alone: `edited` says that a scenario is another one.
pub(super) fn comparison(runs: &[Summary], improvement: Option<PerAxisSum>, edited: bool) -> String {
    let Some(first) = runs.first() else { return "no run finished".to_owned() };
    let finished = ended(&Ending::Finished);
    let is_of_thesis =
        first.scenario == "square-compare" && !edited && runs.iter().all(|run| run.ended == finished);
    let mut out = format!("{}: {} s\n\n", first.scenario, short(first.duration_s));
    let _ = writeln!(
        out,
        "{:20} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}",
        "", "ITAE x", "ITAE y", "ITAE z", "ITAE sum", "max error", "variation", "saturated"
    );
    let _ = writeln!(
        out,
        "{:20} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}",
        "", "m s^2", "m s^2", "m s^2", "m s^2", "mm", "N m/s", "%"
    );
    for run in runs {
        let m = &run.metrics;
        let itae = &m.itae_m_s2;
        let cells = [
            itae.x,
            itae.y,
            itae.z,
            itae.sum,
            m.max_error_m * 1e3,
            m.torque_tv_n_m_per_s.sum,
            m.saturated_fraction * 100.0,
        ];
        let _ = write!(out, "{:20}", run.controller);
        for cell in cells.map(short) {
            let _ = write!(out, " {cell:>11}");
        }
        if run.ended != finished {
            // Its integrals cover less time than those of the others.
            let _ = write!(out, "  ({} at {:.3} s)", run.ended, run.simulated_s);
        }
        out.push('\n');
    }
    if is_of_thesis {
        for (name, values) in TABLE_5_2 {
            let [x, y, z, sum] = values.map(short);
            let _ = writeln!(out, "{name:20} {x:>11} {y:>11} {z:>11} {sum:>11}  (Table 5.2, other gains)");
        }
    }
    if let Some(by) = improvement {
        let [x, y, z, sum] = [by.x, by.y, by.z, by.sum]
            .map(|p| if p.is_finite() { format!("{p:.2} %") } else { "-".to_owned() });
        let _ = writeln!(out, "{:20} {x:>11} {y:>11} {z:>11} {sum:>11}", "bfsmc below bsmc by");
        if is_of_thesis {
            let _ = writeln!(
                out,
                "{:20} {:>11} {:>11} {:>11} {:>11}",
                "in the thesis", "47.31 %", "8.02 %", "49.32 %", "31.16 %"
            );
        }
    }
    out.trim_end().to_owned()
}
