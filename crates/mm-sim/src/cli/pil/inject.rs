//! Damage done to frames on purpose, always the same for a seed.

use serde::Serialize;

use crate::random::Stream;

/// Chances of each damage, from 0 to 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Chances {
    drop: f64,
    corrupt: f64,
    duplicate: f64,
    delay: f64,
}

impl core::str::FromStr for Chances {
    type Err = String;

    /// Reads `drop=0.01,corrupt=0.01,duplicate=0.01,delay=0.01`, any of them.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut chances = Self::default();
        for part in text.split(',') {
            let (name, value) = part.split_once('=').ok_or_else(|| format!("`{part}` is no NAME=CHANCE"))?;
            let value: f64 = value.parse().map_err(|_| format!("`{value}` is no number"))?;
            if !(0.0..=0.5).contains(&value) {
                return Err(format!("`{name}` must lie between 0 and 0.5"));
            }
            match name {
                "drop" => chances.drop = value,
                "corrupt" => chances.corrupt = value,
                "duplicate" => chances.duplicate = value,
                "delay" => chances.delay = value,
                _ => return Err(format!("`{name}` is none of drop, corrupt, duplicate, delay")),
            }
        }
        Ok(chances)
    }
}

/// What becomes of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fate {
    Sound,
    Dropped,
    Corrupted,
    Duplicated,
    Delayed,
}

/// How many frames were damaged.
#[derive(Debug, Clone, Copy, Default, Serialize)]
pub(super) struct Injected {
    dropped: u64,
    corrupted: u64,
    duplicated: u64,
    delayed: u64,
    /// Answers that came and were thrown away.
    answers_dropped: u64,
}

/// Number of the stream of damages.
const STREAM: u64 = 0x6c69_6e6b;

/// Decides what becomes of frames.
#[derive(Debug)]
pub(super) struct Injector {
    chances: Chances,
    random: Stream,
    pub(super) injected: Injected,
}

impl Injector {
    pub(super) fn new(chances: Chances, seed: u64) -> Self {
        Self { chances, random: Stream::new(seed, STREAM), injected: Injected::default() }
    }

    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    fn unit(&mut self) -> f64 {
        (self.random.next_bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// What becomes of a request.
    pub(super) fn fate(&mut self) -> Fate {
        let Chances { drop, corrupt, duplicate, delay } = self.chances;
        let x = self.unit();
        let (fate, counter) = if x < drop {
            (Fate::Dropped, &mut self.injected.dropped)
        } else if x < drop + corrupt {
            (Fate::Corrupted, &mut self.injected.corrupted)
        } else if x < drop + corrupt + duplicate {
            (Fate::Duplicated, &mut self.injected.duplicated)
        } else if x < drop + corrupt + duplicate + delay {
            (Fate::Delayed, &mut self.injected.delayed)
        } else {
            return Fate::Sound;
        };
        *counter += 1;
        fate
    }

    /// Whether what was held back comes now.
    pub(super) fn comes_now(&mut self) -> bool {
        self.unit() < 0.5
    }

    /// Whether an answer is thrown away.
    pub(super) fn loses_answer(&mut self) -> bool {
        let lost = self.unit() < self.chances.drop;
        self.injected.answers_dropped += u64::from(lost);
        lost
    }

    /// Changes a bit, but for those of the zero at the end.
    pub(super) fn damage(&mut self, bytes: &mut [u8]) {
        let bits = self.random.next_bits();
        let count = bytes.len().saturating_sub(1).max(1) as u64;
        let at = usize::try_from((bits >> 8) % count).unwrap_or(0);
        if let Some(byte) = bytes.get_mut(at) {
            *byte ^= 1 << (bits & 7);
        }
    }
}
