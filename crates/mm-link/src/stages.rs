//! Check sums of the signals of an update, by stage: the first that differs says where two computations part.

use core::fmt;

use mm_control::Output;
use mm_model::Torque;
use serde::{Deserialize, Serialize};

use crate::Scalar;
use crate::frame::CRC;

/// The stages of an update in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage {
    /// The velocity, known or estimated.
    Estimate,
    /// Tip, its error, the virtual control, manipulability and damping.
    Kinematics,
    /// nu_r, its rate, the sliding variable, the equivalent force.
    Dynamics,
    /// The forces of the fuzzy system and of the observer.
    Fuzzy,
    /// The torque before and after the limits, and the outcomes.
    Torque,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Estimate => "estimate",
            Self::Kinematics => "kinematics",
            Self::Dynamics => "dynamics",
            Self::Fuzzy => "fuzzy",
            Self::Torque => "torque",
        })
    }
}

/// CRC-32 of the signals of each stage, every number with its lowest byte first; zeros where the stack did not run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Stages([u32; 5]);

impl Stages {
    /// The sums of an update.
    #[must_use]
    pub fn of<T: Scalar>(output: &Output<T, 3>) -> Self {
        let signals = &output.signals;
        let space = |v: &nalgebra::Vector3<T>| [v.x, v.y, v.z];
        let estimate = sum(signals.nu.channels());
        let kinematics = sum(space(&signals.tip)
            .into_iter()
            .chain(space(&signals.error))
            .chain(signals.nu_c.channels())
            .chain([signals.manipulability_squared, signals.damping_squared]));
        let dynamics = sum(signals
            .nu_r
            .channels()
            .chain(signals.dnu_r.channels())
            .chain(signals.sliding.channels())
            .chain(signals.equivalent.channels()));
        let fuzzy = sum(signals.fuzzy.channels().chain(signals.learned.channels()));
        let status = &output.status;
        let outcomes = [
            status.saturated,
            status.near_singular,
            status.speed_limited,
            status.joint_limited,
            status.beyond_joint_limit,
        ];
        let torque = sum(channels(&signals.commanded)
            .chain(channels(&output.torque))
            .chain(outcomes.map(|outcome| if outcome { T::ONE } else { T::ZERO })));
        Self([estimate, kinematics, dynamics, fuzzy, torque])
    }

    /// The first stage in which two updates differ.
    #[must_use]
    pub fn first_difference(&self, other: &Self) -> Option<Stage> {
        let stages = [Stage::Estimate, Stage::Kinematics, Stage::Dynamics, Stage::Fuzzy, Stage::Torque];
        let pairs = self.0.iter().zip(&other.0);
        stages.into_iter().zip(pairs).find(|(_, (here, there))| here != there).map(|(stage, _)| stage)
    }
}

fn channels<T: Scalar>(torque: &Torque<T, 3>) -> impl Iterator<Item = T> + '_ {
    [torque.right, torque.left].into_iter().chain(torque.joints)
}

fn sum<T: Scalar>(numbers: impl Iterator<Item = T>) -> u32 {
    let mut digest = CRC.digest();
    for number in numbers {
        number.each_byte(|bytes| digest.update(bytes));
    }
    digest.finalize()
}
