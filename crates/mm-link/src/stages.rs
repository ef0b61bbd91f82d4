//! Check sums of the signals of an update, by stage: the first that differs says where two computations part.

use mm_control::Output;
use serde::{Deserialize, Serialize};

use crate::Scalar;
use crate::frame::CRC;
use crate::signals::{self, SIGNALS, Stage};

/// All stages, in the order of [`SIGNALS`].
const STAGES: [Stage; 5] = [Stage::Estimate, Stage::Kinematics, Stage::Dynamics, Stage::Fuzzy, Stage::Torque];

/// CRC-32 of the signals of each stage, every number with its lowest byte first; zeros where the stack did not run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Stages([u32; 5]);

impl Stages {
    /// The sums of an update.
    #[must_use]
    pub fn of<T: Scalar>(output: &Output<T, 3>) -> Self {
        let mut numbers = signals::numbers(output);
        let sums = STAGES.map(|stage| {
            let mut digest = CRC.digest();
            for &(_, _, count) in SIGNALS.iter().filter(|(other, _, _)| *other == stage) {
                for number in numbers.by_ref().take(count) {
                    number.each_byte(|bytes| digest.update(bytes));
                }
            }
            if stage == Stage::Torque {
                digest.update(&signals::outcomes(&output.status).to_le_bytes());
            }
            digest.finalize()
        });
        Self(sums)
    }

    /// The first stage in which two updates differ.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<Stage> {
        let pairs = self.0.iter().zip(&other.0);
        STAGES.into_iter().zip(pairs).find(|(_, (here, there))| here != there).map(|(stage, _)| stage)
    }
}
