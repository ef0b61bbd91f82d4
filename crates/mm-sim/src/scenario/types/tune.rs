//! `[tune]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{NonNegative, Positive};

/// Budget and cost of `mmsim tune`, a particle swarm (4.45), (4.46).
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Tune {
    /// Particles of the swarm, at least 1.
    #[schemars(range(min = 1, max = 10000))]
    pub particles: u32,
    /// How often each particle is evaluated, at least once: the budget is particles times iterations runs.
    #[schemars(range(min = 1, max = 1_000_000))]
    pub iterations: u32,
    /// Seed of the swarm; `--seed` comes before it.
    pub seed: u64,
    /// Inertia weight w of (4.45).
    #[schemars(with = "NonNegative")]
    pub inertia_weight: f64,
    /// Cognitive coefficient c1 of (4.45), the pull towards a particle's own best.
    #[schemars(with = "NonNegative")]
    pub cognitive: f64,
    /// Social coefficient c2 of (4.45), the pull towards the best of the swarm.
    #[schemars(with = "NonNegative")]
    pub social: f64,
    /// Least and greatest factor on the default gains. Default: those of each group of gains.
    #[schemars(with = "Option<[Positive; 2]>")]
    pub bounds: Option<[f64; 2]>,
    /// Weight of the torque variation, m s^3/(N m).
    #[schemars(with = "NonNegative")]
    pub torque_variation_weight: f64,
    /// Weight of the effort, m s/(N^2 m^2).
    #[schemars(with = "NonNegative")]
    pub effort_weight: f64,
    /// Other versions of the scenario that the gains have to do for too, each a list of edits `KEY=VALUE`: the cost is that of the
    /// worst version.
    pub also: Vec<Vec<String>>,
}

impl Default for Tune {
    fn default() -> Self {
        Self {
            particles: 20,
            iterations: 30,
            seed: 0,
            inertia_weight: 0.7298,
            cognitive: 1.49618,
            social: 1.49618,
            bounds: None,
            torque_variation_weight: 1e-4,
            effort_weight: 1e-9,
            also: Vec::new(),
        }
    }
}
