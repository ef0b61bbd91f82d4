//! Which gains of each law are tuned, and how far.

use core::fmt;

use mm_control::{Gains, LawKind};
use mm_model::{Force, Velocity};

/// A gain as a scenario gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Gain {
    /// One number.
    One(f64),
    /// A number for each channel: forward, yaw, joints 1 to 3.
    Each([f64; 5]),
}

impl fmt::Display for Gain {
    /// As TOML.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::One(value) => write!(f, "{value:?}"),
            Self::Each(values) => write!(f, "{values:?}"),
        }
    }
}

/// A key of `[controller.gains]` and where its default is.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// Its default, of the default gains of a law.
    pub default: fn(&Gains<f64, 3>) -> Gain,
}

/// Channels of a gain that one factor multiplies.
#[derive(Debug, Clone, Copy)]
pub struct Group {
    /// The gain.
    pub key: Key,
    /// Name of the channels; empty for a gain without channels.
    pub name: &'static str,
    /// The channels, from 0.
    pub channels: &'static [usize],
    /// Least and greatest factor on the default.
    pub bounds: [f64; 2],
}

const SWITCHING: Key = Key { name: "switching_gain", default: |g| force(&g.switching) };
const LAYER: Key = Key { name: "boundary_layer", default: |g| velocity(&g.boundary_layer) };
const FUZZY: Key = Key { name: "fuzzy_gain", default: |g| force(&g.fuzzy) };
const FUZZY_SCALE: Key = Key { name: "fuzzy_scale", default: |g| velocity(&g.fuzzy_scale) };
const OBSERVER: Key = Key { name: "observer_bandwidth_1_s", default: |g| Gain::One(g.observer_bandwidth) };
const DAMPING: Key = Key { name: "damping_gain_1_s", default: |g| velocity(&g.damping) };
const STIFFNESS: Key = Key { name: "stiffness_gain_1_s2", default: |g| velocity(&g.stiffness) };
const INTEGRAL: Key = Key { name: "integral_gain_1_s3", default: |g| velocity(&g.integral) };
const POSITION: Key = Key { name: "acceptable_position", default: |g| velocity(&g.acceptable_position) };
const VELOCITY: Key = Key { name: "acceptable_velocity", default: |g| velocity(&g.acceptable_velocity) };
const BODIES: Key = Key { name: "body_adaptation_gain_1_j", default: |g| Gain::One(g.body_adaptation) };
const LEARNING: Key = Key { name: "force_adaptation_gain_1_s2", default: |g| Gain::One(g.force_adaptation) };
const TWISTING: Key = Key { name: "twisting_gain", default: |g| force(&g.twisting) };
const TWISTING_RATE: Key = Key { name: "twisting_rate_gain", default: |g| force(&g.twisting_rate) };

/// From next to nothing to beyond the torque limits.
const FORCE: [f64; 2] = [1e-3, 3.0];
/// Two decades either way.
const WIDTH: [f64; 2] = [1e-2, 1e2];
/// From a slow observer to 0.8 per period, beyond which it rings.
const BANDWIDTH: [f64; 2] = [0.05, 4.0];

/// A linear gain: from a sluggish loop to poles of 1 per period and beyond, some of which are unstable.
const LINEAR: [f64; 2] = [0.05, 20.0];
/// The gains of squares and cubes of a pole.
const POWER: [f64; 2] = [1e-3, 1e3];

/// A gain and the bounds of its factors.
type Range = (Key, [f64; 2]);

/// The parts of a gain by channel that have a factor each.
const PARTS: [(&str, &[usize]); 3] = [("forward", &[0]), ("yaw", &[1]), ("joints", &[2, 3, 4])];

/// The groups of gains that are tuned for a law; none for a law without a line here.
///
/// The outer loop is the same for all laws of a comparison, and never tuned.
#[must_use]
pub fn tunables(law: LawKind) -> Vec<Group> {
    // Gains by channel, then those that are one number.
    let (by_channel, single): (&[Range], &[Range]) = match law {
        LawKind::Bsmc => (&[(SWITCHING, FORCE)], &[]),
        LawKind::BsmcSat => (&[(SWITCHING, FORCE), (LAYER, WIDTH)], &[]),
        LawKind::BfsmcThesis => (&[(SWITCHING, FORCE), (FUZZY, FORCE), (FUZZY_SCALE, WIDTH)], &[]),
        // The surface's force stays: what it can oppose to s is not for a swarm to give away on one scenario.
        LawKind::Bfsmc => (&[(FUZZY_SCALE, WIDTH)], &[(OBSERVER, BANDWIDTH)]),
        LawKind::Ctc => (&[(DAMPING, LINEAR), (STIFFNESS, POWER)], &[]),
        LawKind::Pid => (&[(DAMPING, LINEAR), (STIFFNESS, POWER), (INTEGRAL, POWER)], &[]),
        LawKind::Lqr => (&[(POSITION, WIDTH), (VELOCITY, WIDTH)], &[]),
        LawKind::SmcDecentralized => (&[(SWITCHING, FORCE), (LAYER, WIDTH)], &[]),
        LawKind::BacksteppingAdaptive => (&[(DAMPING, LINEAR)], &[(BODIES, POWER), (LEARNING, POWER)]),
        LawKind::SuperTwisting => (&[(TWISTING, WIDTH), (TWISTING_RATE, WIDTH)], &[]),
        _ => (&[], &[]),
    };
    let parts = by_channel
        .iter()
        .flat_map(|&(key, bounds)| PARTS.map(|(name, channels)| Group { key, name, channels, bounds }));
    let whole = single.iter().map(|&(key, bounds)| Group { key, name: "", channels: &[], bounds });
    parts.chain(whole).collect()
}

/// The channels of a force as a gain.
fn force(values: &Force<f64, 3>) -> Gain {
    let [j1, j2, j3] = values.joints;
    Gain::Each([values.forward, values.yaw, j1, j2, j3])
}

/// The channels of a velocity as a gain.
fn velocity(values: &Velocity<f64, 3>) -> Gain {
    let [j1, j2, j3] = values.joints;
    Gain::Each([values.forward, values.yaw_rate, j1, j2, j3])
}

/// The gains, by key, that factors on the default gains of a law make, each rounded to four digits.
#[must_use]
pub fn scaled(law: LawKind, default: &Gains<f64, 3>, factors: &[f64]) -> Vec<(&'static str, Gain)> {
    let mut gains: Vec<(&'static str, Gain)> = Vec::new();
    for (group, factor) in tunables(law).iter().zip(factors) {
        let name = group.key.name;
        if !gains.iter().any(|(known, _)| *known == name) {
            gains.push((name, (group.key.default)(default)));
        }
        let Some((_, gain)) = gains.iter_mut().find(|(known, _)| *known == name) else { continue };
        match gain {
            Gain::One(value) => *value *= factor,
            Gain::Each(values) => {
                for (_, value) in values.iter_mut().enumerate().filter(|(i, _)| group.channels.contains(i)) {
                    *value *= factor;
                }
            }
        }
    }
    for (_, gain) in &mut gains {
        match gain {
            Gain::One(value) => *value = rounded(*value),
            Gain::Each(values) => *values = values.map(rounded),
        }
    }
    gains
}

/// The number nearest to one that four significant digits write.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A law without groups could not be tuned, and a channel in two groups of one gain would be tuned twice.
    #[test]
    fn every_law_has_groups_that_do_not_overlap() {
        for law in LawKind::ALL {
            let groups = tunables(law);
            assert!(!groups.is_empty(), "{} has no gains to tune", law.name());
            let mut seen = Vec::new();
            for group in &groups {
                let [lo, hi] = group.bounds;
                assert!(0.0 < lo && lo < hi, "bounds of {group:?}");
                let channels = if group.channels.is_empty() { &[5] } else { group.channels };
                for channel in channels {
                    let place = (group.key.name, channel);
                    assert!(!seen.contains(&place), "{}: {place:?} twice", law.name());
                    seen.push(place);
                }
            }
        }
    }

    #[test]
    fn numbers_are_written_as_toml_and_rounded_to_four_digits() {
        assert_eq!(Gain::One(150.0).to_string(), "150.0", "a float");
        assert_eq!(
            Gain::Each([1e-9, 0.5, 2.0, 3.0, 4e20]).to_string(),
            "[1e-9, 0.5, 2.0, 3.0, 4e20]",
            "an array"
        );
        for (value, wanted) in
            [(123_456.0, 123_500.0), (0.000_123_44, 0.000_123_4), (0.0, 0.0), (9.9999, 10.0)]
        {
            assert_eq!(Gain::One(rounded(value)), Gain::One(wanted), "{value}");
        }
    }
}
