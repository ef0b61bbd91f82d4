//! What a comparison with a target gives.

use std::fmt::Write as _;

use mm_link::{Counters, Ready};
use serde::Serialize;

use super::client::Frames;
use super::inject::Injected;
use super::twin::{Difference, Tally};
use crate::summary::Summary;

/// Name and version of the format.
pub(super) const SCHEMA: &str = "mmsim.pil/1";

/// The `--json` object.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    pub(super) schema: &'static str,
    pub(super) target: String,
    /// What the target says that it is.
    pub(super) firmware: Firmware,
    pub(super) precision: &'static str,
    pub(super) ticks: u64,
    pub(super) equal_ticks: u64,
    pub(super) first_difference: Option<Difference>,
    /// Updates for which the supervisor held or stopped the robot.
    pub(super) supervised_periods: u64,
    pub(super) frames: Frames,
    /// Frames and updates as the target counted them; none where it did not say.
    pub(super) target_frames: Option<Counters>,
    pub(super) injected: Option<Injected>,
    pub(super) cost: Option<Cost>,
    /// Why the link failed, where it did.
    pub(super) link_error: Option<String>,
    pub(super) digest: String,
    pub(super) summary: Summary,
}

/// The program on the target.
#[derive(Debug, Serialize)]
pub(super) struct Firmware {
    pub(super) target: String,
    pub(super) version: String,
    pub(super) flash_bytes: Option<u64>,
    /// Static RAM, without the stack.
    pub(super) ram_bytes: Option<u64>,
}

/// What an update costs.
#[derive(Debug, Serialize)]
pub(super) struct Cost {
    /// `instructions` or `timer ticks`.
    pub(super) unit: &'static str,
    pub(super) min: u32,
    pub(super) mean: f64,
    pub(super) p99: u32,
    pub(super) max: u32,
    /// Number of the tick that took the most.
    pub(super) worst_tick: usize,
    /// The most in microseconds of the target's timer; none under an emulator, whose time means nothing.
    pub(super) max_us: Option<f64>,
}

impl Cost {
    /// Statistics of all updates. Where an instruction is known to take a fixed time, ticks are turned into instructions by
    /// the target's own loop of 10,000.
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        reason = "counts are far below 2^53; fewer instructions than ticks"
    )]
    pub(super) fn of(tally: &Tally, ready: &Ready, is_emulated: bool) -> Option<Self> {
        let loop_ticks = u64::from(ready.loop_ticks.max(1));
        let count = |ticks: &u32| {
            if is_emulated {
                ((u64::from(*ticks) * 10_000 + loop_ticks / 2) / loop_ticks) as u32
            } else {
                *ticks
            }
        };
        let costs: Vec<u32> = tally.costs.iter().map(count).collect();
        let (worst_tick, &max) = costs.iter().enumerate().max_by_key(|(i, cost)| (**cost, usize::MAX - i))?;
        let mut sorted = costs.clone();
        sorted.sort_unstable();
        let rank = (sorted.len() * 99).div_ceil(100).max(1) - 1;
        Some(Self {
            unit: if is_emulated { "instructions" } else { "timer ticks" },
            min: *sorted.first()?,
            mean: costs.iter().map(|&cost| f64::from(cost)).sum::<f64>() / costs.len() as f64,
            p99: *sorted.get(rank)?,
            max,
            worst_tick,
            max_us: (!is_emulated).then(|| f64::from(max) * 1e6 / f64::from(ready.ticks_per_second.max(1))),
        })
    }
}

impl Report {
    /// Whether every tick was equal, and the link held.
    pub(super) fn is_good(&self) -> bool {
        self.ticks > 0 && self.equal_ticks == self.ticks && self.link_error.is_none()
    }

    /// For people.
    pub(super) fn text(&self) -> String {
        let Self { frames, firmware, .. } = self;
        let mut out = format!(
            "{} with {} on {} ({}), {}: {} ticks, {} equal, {:.1} s\n\n",
            self.summary.scenario,
            self.summary.controller,
            self.target,
            firmware.target,
            self.precision,
            self.ticks,
            self.equal_ticks,
            self.summary.wall_s
        );
        let mut line = |name: &str, value: String| {
            let _ = writeln!(out, "{name:18} {value}");
        };
        line(
            "bits",
            match &self.first_difference {
                None if self.ticks > 0 => "every torque and every stage as on the host".to_owned(),
                None => "nothing was compared".to_owned(),
                Some(Difference { tick, t_s, stage }) => {
                    format!("DIFFERENT, first at tick {tick} (t = {t_s} s), stage {stage}")
                }
            },
        );
        if let Some(Cost { unit, min, mean, p99, max, worst_tick, max_us }) = &self.cost {
            let us = max_us.map_or_else(String::new, |us| format!(" ({us:.1} us)"));
            line(
                "an update",
                format!(
                    "{unit}: least {min}, mean {mean:.1}, 99 % {p99}, most {max}{us} at tick {worst_tick}"
                ),
            );
        }
        let Frames { sent, received, lost, corrupt, duplicated, retried } = frames;
        line(
            "frames",
            format!(
                "{sent} sent, {received} answered, {lost} lost, {corrupt} corrupt, {duplicated} twice, {retried} retried"
            ),
        );
        if let Some(c) = &self.target_frames {
            line(
                "on the target",
                format!(
                    "{} updates, {} missed, {} twice, {} stale, {} corrupt, {} refused",
                    c.updates, c.missed, c.duplicates, c.stale, c.corrupt, c.refused
                ),
            );
        }
        if let (Some(flash), Some(ram)) = (firmware.flash_bytes, firmware.ram_bytes) {
            line("image", format!("{flash} bytes of flash, {ram} of static RAM"));
        }
        if self.supervised_periods > 0 {
            line("supervisor", format!("held or stopped the robot in {} ticks", self.supervised_periods));
        }
        line("digest", self.digest.clone());
        out.truncate(out.trim_end().len());
        out
    }
}
