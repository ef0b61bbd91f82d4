//! Tuned gains as the TOML file that `controller.gains_file` reads.

use std::fmt::Write as _;

use super::{Outcome, Tuned, tunables};
use crate::VERSION;
use crate::scenario::Loaded;

/// The file of tuned gains: how it was made, then a table for each law with what it costs, or why there is none.
///
/// `command` is the command line that made it, `loaded` the scenario before a law was chosen.
#[must_use]
pub fn to_toml(command: &str, loaded: &Loaded, seed: u64, all: &[Outcome]) -> String {
    let tune = &loaded.file.tune;
    // A line break in a file name must not end the comment.
    let command: String = command.chars().map(|c| if c.is_control() { '?' } else { c }).collect();
    let mut out = format!(
        "# Gains for `controller.gains_file`, made by mmsim {VERSION}:\n#   {command}\n\
         # Scenario {}, digest {}.\n\
         # Particle swarm of {} particles x {} iterations = {} runs a law, seed {seed}, w = {}, c1 = {}, c2 = {}.\n\
         # Cost: ITAE sum + {:?} x torque variation sum + {:?} x effort.\n",
        loaded.name().escape_debug(),
        loaded.digest(),
        tune.particles,
        tune.iterations,
        u64::from(tune.particles) * u64::from(tune.iterations),
        tune.inertia_weight,
        tune.cognitive,
        tune.social,
        tune.torque_variation_weight,
        tune.effort_weight,
    );
    if !tune.also.is_empty() {
        let versions: Vec<String> = tune.also.iter().map(|version| version.join(" ")).collect();
        let _ = writeln!(
            out,
            "# The cost is that of the worst of the scenario, whose metrics follow, and of its versions with {}.",
            versions.join("; ").escape_debug()
        );
    }
    for (kind, outcome) in all {
        match outcome {
            Ok(tuned) => law(&mut out, tuned),
            Err(error) => {
                let _ = writeln!(out, "\n# No gains for {}: {error}.", kind.name());
            }
        }
    }
    out
}

/// The table of one law.
fn law(out: &mut String, tuned: &Tuned) {
    let _ = writeln!(
        out,
        "\n# Cost {}, with the default gains {}, with those as given {}.",
        tuned.trial.cost, tuned.default_cost, tuned.given_cost
    );
    if let Some((m, digest)) = &tuned.trial.result {
        let _ = write!(
            out,
            "# ITAE sum {} m s^2, torque variation sum {} N m/s, effort {} N^2 m^2 s,\n\
             # RMS error {} m, largest error {} m, saturated fraction {}, trajectory digest {digest}.\n",
            m.itae_m_s2.sum,
            m.torque_tv_n_m_per_s.sum,
            m.effort_n2_m2_s,
            m.rmse_m.norm,
            m.max_error_m,
            m.saturated_fraction,
        );
    }
    let factors = tunables(tuned.law).into_iter().zip(&tuned.factors).map(|(group, factor)| {
        let of = if group.name.is_empty() { String::new() } else { format!(" {}", group.name) };
        format!("{}{of} {factor:.3e}", group.key.name)
    });
    let _ = writeln!(out, "# Factors on the default gains: {}.", factors.collect::<Vec<_>>().join(", "));
    let _ = writeln!(out, "[{}]", tuned.law.name());
    for (key, gain) in &tuned.gains {
        let _ = writeln!(out, "{key} = {gain}");
    }
    if !tuned.kept.is_empty() {
        let _ = writeln!(out, "# Not tuned, as given by the scenario's own file of gains:");
    }
    for (key, gain) in &tuned.kept {
        let _ = writeln!(out, "{key} = {gain}");
    }
}
